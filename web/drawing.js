/** How far a picture is that takes long to draw, with a button that ends it. */
export class DrawingBar {
  #text = document.createElement('span');
  #progress = document.createElement('progress');
  element = document.createElement('div');

  /** @param stop  ends the work with what there is */
  constructor(stop) {
    const button = Object.assign(document.createElement('button'), { textContent: 'Stop', type: 'button' });
    button.title = 'Keep the picture as it is now';
    button.addEventListener('click', stop);
    this.#progress.ariaLabel = 'Drawing';
    this.element.className = 'bar drawing';
    this.element.hidden = true;
    this.element.append(this.#progress, this.#text, button);
  }

  /** @param underway  share [0,1] and secondsLeft; undefined: nothing takes long */
  show(underway) {
    this.element.hidden = !underway;
    if (!underway) return;
    this.#progress.value = underway.share;
    const text = `${Math.ceil(underway.secondsLeft)} s left`;
    if (this.#text.textContent !== text) this.#text.textContent = text;
  }
}
