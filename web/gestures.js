/**
 * Pointer, wheel and keys of one canvas, with manners: the page scrolls under a wheel or a single finger unless the
 * canvas has the focus. A mouse drag and two fingers act at once, and a wheel over the panel scrolls the panel, up to
 * its ends.
 */
const Pointer = { down: 0, move: 1, up: 2, leave: 3 };
const kLine = 16; // CSS pixels that a wheel step in lines stands for
// A trackpad's pinch arrives as a wheel of a few pixels with control held, a real wheel with some 100: chosen by eye.
const kPinchPixel = 0.01;
const kPinchMost = 20;

const modifiersOf = (event) =>
  (event.shiftKey ? 1 : 0) | (event.ctrlKey || event.metaKey ? 2 : 0) | (event.altKey ? 4 : 0);

function wheelPixels(event) {
  const delta = event.deltaY || event.deltaX; // with shift held, some browsers scroll sideways
  if (event.deltaMode === WheelEvent.DOM_DELTA_LINE) return delta * kLine;
  return event.deltaMode === WheelEvent.DOM_DELTA_PAGE ? delta * event.target.clientHeight : delta;
}

export class Gestures {
  #canvas;
  #viewer;
  #fingers = new Map(); // pointer id -> [x, y]
  #spread = 0; // distance of two fingers, 0 when there are not two
  #held = null; // id of the pointer that the viewer follows
  #used = false; // the viewer did something with the last button
  #overPanel = false; // the mouse rests on the panel
  #tap = false; // a finger went down on a viewer without the focus: a tap, or the page scrolls

  /**
   * @param viewer  pointer(event, x, y, button, modifiers, touch, pressure), wheel(x, y, pixels, modifiers), pinch(factor),
   *                key(name, modifiers): true when used; hint(touch): the person may want to interact
   */
  constructor(canvas, viewer) {
    this.#canvas = canvas;
    this.#viewer = viewer;
    const listen = (type, handle, options) => canvas.addEventListener(type, handle, options);
    listen('pointerdown', (event) => this.#down(event));
    listen('pointermove', (event) => this.#move(event));
    listen('pointerup', (event) => this.#up(event));
    listen('pointercancel', (event) => this.#cancel(event));
    listen('pointerleave', (event) => event.pointerId !== this.#held && this.#leave(event));
    listen('click', (event) => this.#click(event));
    listen('contextmenu', (event) => this.#used && event.preventDefault());
    listen('keydown', (event) => this.#key(event));
    listen('touchstart', (event) => event.touches.length > 1 && event.preventDefault(), { passive: false });
    listen('focus', () => this.#activate(true));
    listen('blur', () => this.#activate(false));
    this.#activate(false);
    this.#heedWheel();
  }

  get #active() {
    return this.#canvas.matches(':focus');
  }

  #activate(active) {
    this.#canvas.style.touchAction = active ? 'none' : 'pan-x pan-y';
    this.#heedWheel();
  }

  // A wheel listener that may stop the scrolling makes it slow, so there is one only while it is needed.
  #heedWheel() {
    this.#canvas.removeEventListener('wheel', this.#wheel);
    this.#canvas.addEventListener('wheel', this.#wheel, { passive: !this.#active && !this.#overPanel });
  }

  #hover(overPanel) {
    if (overPanel === this.#overPanel) return;
    this.#overPanel = overPanel;
    this.#heedWheel();
  }

  #leave(event) {
    this.#hover(false);
    this.#send(Pointer.leave, event);
  }

  #send(kind, event) {
    return this.#viewer.pointer(
      kind,
      event.offsetX,
      event.offsetY,
      Math.max(0, event.button),
      modifiersOf(event),
      event.pointerType !== 'mouse',
      event.pointerType === 'pen' ? event.pressure : 1, // mice and fingers tell nothing of theirs
    );
  }

  #down(event) {
    if (event.pointerType !== 'mouse' && !this.#fingerDown(event)) return;
    if (this.#held !== null) return;
    this.#held = event.pointerId;
    this.#canvas.setPointerCapture(event.pointerId);
    this.#canvas.focus({ preventScroll: true });
    this.#used = Boolean(this.#send(Pointer.down, event));
  }

  // True when the finger acts like a mouse.
  #fingerDown(event) {
    this.#fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
    this.#tap = !this.#active && this.#fingers.size === 1;
    if (this.#fingers.size === 1) return this.#active;
    if (this.#held !== null) this.#release(event);
    this.#spread = this.#measureSpread();
    return false;
  }

  #measureSpread() {
    if (this.#fingers.size !== 2) return 0;
    const [[ax, ay], [bx, by]] = this.#fingers.values();
    return Math.hypot(ax - bx, ay - by);
  }

  #move(event) {
    if (this.#fingers.has(event.pointerId)) {
      this.#fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
      const spread = this.#measureSpread();
      if (spread && this.#spread) this.#viewer.pinch(spread / this.#spread);
      this.#spread = spread;
      if (this.#held !== event.pointerId) return;
    }
    const used = this.#send(Pointer.move, event);
    if (this.#held === null) this.#hover(Boolean(used) && event.pointerType === 'mouse');
  }

  #up(event) {
    this.#fingers.delete(event.pointerId);
    this.#spread = this.#measureSpread();
    if (this.#held === event.pointerId) this.#release(event);
  }

  #release(event) {
    this.#held = null;
    this.#send(Pointer.up, event);
    if (event.pointerType !== 'mouse') this.#send(Pointer.leave, event); // a finger does not hover
  }

  #cancel(event) {
    if (this.#tap) this.#viewer.hint(true);
    this.#tap = false;
    this.#up(event);
  }

  // A tap gives the focus and also does what a click there does.
  #click(event) {
    if (!this.#tap) return;
    this.#tap = false;
    this.#canvas.focus({ preventScroll: true });
    this.#send(Pointer.down, event);
    this.#send(Pointer.up, event);
    this.#send(Pointer.leave, event);
  }

  #wheel = (event) => {
    if (!this.#active && !this.#overPanel) return this.#viewer.hint(false);
    if (!this.#active && event.ctrlKey) return; // the page is made larger
    const pixels = wheelPixels(event);
    const pinched = Math.max(-kPinchMost, Math.min(kPinchMost, pixels));
    const used = event.ctrlKey
      ? this.#viewer.pinch(Math.exp(-kPinchPixel * pinched))
      : this.#viewer.wheel(event.offsetX, event.offsetY, pixels, modifiersOf(event));
    if (used) event.preventDefault();
  };

  #key(event) {
    if (event.key === 'Tab') return; // the focus moves on
    if (this.#viewer.key(event.key, modifiersOf(event))) event.preventDefault();
    else if (event.key === 'Escape') this.#canvas.blur();
  }
}
