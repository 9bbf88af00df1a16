/** Names as people mistype them. */

/** Letters to add, leave out, change or swap with the next until one name is the other. */
function typosBetween(a, b) {
  let [before, row] = [[], Array.from({ length: b.length + 1 }, (_, at) => at)];
  for (let i = 1; i <= a.length; ++i) {
    const next = [i];
    for (let j = 1; j <= b.length; ++j) {
      next[j] = Math.min(row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] === b[j - 1] ? 0 : 1));
      const swapped = i > 1 && j > 1 && a[i - 1] === b[j - 2] && a[i - 2] === b[j - 1];
      if (swapped) next[j] = Math.min(next[j], before[j - 2] + 1);
    }
    [before, row] = [row, next];
  }
  return row[b.length];
}

/** The name that somebody may have meant; undefined where none is near: a third of its letters would be wrong. */
export function nearestName(name, names) {
  const typos = names.map((one) => typosBetween(name, one));
  const fewest = Math.min(...typos);
  return fewest <= name.length / 3 ? names[typos.indexOf(fewest)] : undefined;
}

/** Attributes that any element of a page may have. */
const kOfAll = /^(aria-|data-|on|item|x?ml)|^(class|exportparts|is|part|role|slot)$/;
const kOfHtml = new Set(Object.getOwnPropertyNames(HTMLElement.prototype).map((one) => one.toLowerCase()));
export const isOfHtml = (name) => kOfAll.test(name) || kOfHtml.has(name) || name in Element.prototype;
