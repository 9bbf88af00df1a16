/** How far something is that takes long, with a button that ends it. */
export class WorkBar {
  #verb;
  #text = document.createElement('span');
  #bar = document.createElement('progress');
  element = document.createElement('div');

  /**
   * @param name    of the bar's class
   * @param verb    what is going on: "Drawing"
   * @param button  its label, what it does in words (title), and what happens (act)
   */
  constructor(name, verb, { label, title, act }) {
    const button = Object.assign(document.createElement('button'), { textContent: label, title, type: 'button' });
    button.addEventListener('click', act);
    this.#verb = verb;
    this.#bar.ariaLabel = verb;
    this.element.className = `bar work ${name}`;
    this.element.hidden = true;
    this.element.append(this.#text, this.#bar, button);
  }

  /**
   * @param progress  share [0,1]; secondsLeft, where that is known; task, what is going on if that changes;
   *                  undefined: nothing takes long
   */
  show(progress) {
    this.element.hidden = !progress;
    if (!progress) return;
    const { share, secondsLeft, task = this.#verb } = progress;
    this.#bar.value = share;
    this.#bar.ariaLabel = task;
    const text = secondsLeft === undefined ? task : `${task}: ${Math.ceil(secondsLeft)} s left`;
    if (this.#text.textContent !== text) this.#text.textContent = text;
  }
}

/** Tells a bar of work that has a share alone, once it turns out to take more than a moment. */
export class Watch {
  #bar;
  #start = performance.now();

  constructor(bar) {
    this.#bar = bar;
  }
  tell(share) {
    const kMoment = 1; // s
    const seconds = (performance.now() - this.#start) / 1000;
    const secondsLeft = seconds * (1 / share - 1);
    if (seconds > kMoment) this.#bar.show(share < 1 ? { share, secondsLeft } : undefined);
  }
}
