/** How far a picture is that takes long to draw, with a button that ends it. */
export class DrawingBar {
  #text = document.createElement('span');
  #bar = document.createElement('progress');
  element = document.createElement('div');

  /** @param stop  ends the work with what there is */
  constructor(stop) {
    const button = Object.assign(document.createElement('button'), { textContent: 'Stop', type: 'button' });
    button.title = 'Keep the picture as it is now';
    button.addEventListener('click', stop);
    this.#bar.ariaLabel = 'Drawing';
    this.element.className = 'bar drawing';
    this.element.hidden = true;
    this.element.append(this.#bar, this.#text, button);
  }

  /** @param progress  share [0,1] and secondsLeft; undefined: nothing takes long */
  show(progress) {
    this.element.hidden = !progress;
    if (!progress) return;
    this.#bar.value = progress.share;
    const text = `${Math.ceil(progress.secondsLeft)} s left`;
    if (this.#text.textContent !== text) this.#text.textContent = text;
  }
}
