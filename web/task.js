/** Resolves when whatever else waits has had its turn. */
export const nextTask = () => new Promise((done) => setTimeout(done));
