/** What stands in a viewer's shadow: the picture, what lies over it, and what a screen reader says. */
import css from './viewer.css';

const kHintTime = 1600; // ms
const kVoiceTime = 400; // ms without a change until it is said
const kKeys =
  'Arrow keys on a relief move the light or turn the environment, page up and page down raise or lower the light or ' +
  'zoom, shift with arrow keys orbits the camera. Arrow keys in other scenes orbit the camera, page up and page down ' +
  'zoom, shift with arrow keys turns the environment or moves the light, D lets a drop fall into water. Space plays or ' +
  'pauses, L chooses the next lamp, 0 resets camera and light, question mark lists all keys, Escape leaves. In mode ' +
  'paint brackets make the brush smaller and larger, 1 to 4 choose translucency, blur, glow and outgoing, X erases back ' +
  'to how the object began, G fills.';

const kStyle = new CSSStyleSheet();
kStyle.replaceSync(css);

const kMarkup = `
<div class="stage" part="stage">
  <canvas tabindex="0" role="img" aria-describedby="keys"></canvas>
  <img class="poster" part="poster" alt="">
  <div class="zones"><div>New scene</div><div>Environment</div></div>
  <input class="unseen" id="divider" type="range" min="0" max="1" step="0.01" hidden
    aria-label="Divider: share of the picture left of it">
  <button class="play" type="button" hidden></button>
  <details class="undrawn" part="undrawn" hidden><summary></summary><ul></ul></details>
  <div class="hint"></div>
  <div class="status"></div>
  <div class="bars"></div>
</div>
<div class="unseen" id="keys"></div>
<div class="unseen" role="status"></div>`;

export class Stage {
  /** ShadowRoot */
  root;
  canvas;
  /** <img> that is shown until there is a picture */
  poster;
  /** For what a person drops: see acceptDrops() */
  zones;
  /** <input> by which the keyboard moves the divider between two pictures */
  divider;
  /** <button> that plays and pauses */
  play;
  #undrawn; // <details>
  #hint;
  #status;
  #bars;
  #voice;
  #timers = {};

  /** @param element  whose shadow it is */
  constructor(element) {
    this.root = element.attachShadow({ mode: 'open' });
    this.root.adoptedStyleSheets = [kStyle];
    this.root.innerHTML = kMarkup;
    const find = (selector) => this.root.querySelector(selector);
    this.canvas = find('canvas');
    this.poster = find('.poster');
    this.zones = find('.zones');
    this.divider = find('#divider');
    this.play = find('.play');
    this.#undrawn = find('.undrawn');
    this.#hint = find('.hint');
    this.#status = find('.status');
    this.#bars = find('.bars');
    this.#voice = find('[role=status]');
    find('#keys').textContent = kKeys;
  }

  /** Whether the person is at the picture. */
  get hasFocus() {
    return this.root.activeElement === this.canvas;
  }

  /** In the middle, in place of a picture; '': nothing. */
  set status(text) {
    this.#status.textContent = text;
  }

  addBars(...elements) {
    this.#bars.append(...elements);
  }
  /** Where neither panel nor numbers are. @param open  size of what they leave, CSS pixels from the top left */
  placeBars([width, height]) {
    Object.assign(this.#bars.style, { bottom: `calc(100% - ${height - 12}px)`, maxWidth: `${width - 24}px` });
  }

  /** Shows a question() over the picture, until the next one or closeQuestion(). */
  ask(dialog) {
    this.root.querySelector('.stage').append(dialog);
  }
  closeQuestion() {
    this.root.querySelector('.question')?.remove();
  }

  showPlay(moves, paused) {
    const label = paused ? 'Play' : 'Pause';
    this.play.hidden = !moves;
    if (this.play.ariaLabel !== label) Object.assign(this.play, { ariaLabel: label, title: label });
    this.play.classList.toggle('playing', !paused);
  }

  /** What the scene asks for and the picture lacks, each in words. */
  showUndrawn(wanted, isShown) {
    const [title, list] = this.#undrawn.children;
    this.#undrawn.hidden = !isShown || !wanted.length;
    title.textContent = `Not drawn (${wanted.length})`;
    const lines = [...list.children].map((item) => item.textContent);
    if (lines.join('\n') === wanted.join('\n')) return;
    list.replaceChildren(...wanted.map((textContent) => Object.assign(document.createElement('li'), { textContent })));
  }

  /** How a person who only looked can take hold. */
  showHint(touch) {
    this.#hint.textContent = touch ? 'Tap to interact, or use two fingers' : 'Click to interact; Esc to leave';
    this.#hint.classList.add('shown');
    clearTimeout(this.#timers.hint);
    this.#timers.hint = setTimeout(() => this.#hint.classList.remove('shown'), kHintTime);
  }

  /** For those who do not see it. */
  say(text) {
    this.#voice.textContent = text;
  }
  /** The same once nothing else was to be said for a while: one word after a gesture, not a hundred during it. */
  sayLater(text) {
    clearTimeout(this.#timers.voice);
    this.#timers.voice = setTimeout(() => this.say(text), kVoiceTime);
  }
}
