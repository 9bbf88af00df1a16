/**
 * The panel's controls once more as HTML, made from the same descriptors: what a screen reader reads, what the
 * keyboard walks through, and what is seen where the drawn panel has no room.
 */
import { kPageSlice } from './answering.js';
import { nextTask } from './task.js';
import { hexOfLinear, valueOf } from './values.js';

const kSteps = 200; // of a slider: half a percent a key press
const kColorNames = { r: 'red', g: 'green', b: 'blue' }; // of an axis; others are called by their letter

/** @return element with properties, attributes ("aria-…") and children */
function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties))
    if (name.includes('-')) element.setAttribute(name, value);
    else element[name] = value;
  element.append(...children);
  return element;
}

/** Between a value and its place on a slider, [0, kSteps]. */
function scaleOf({ low, high, logarithmic, kind }) {
  const [bend, unbend] = logarithmic ? [Math.log, Math.exp] : [(x) => x, (x) => x];
  const start = bend(low);
  const length = bend(high) - start;
  const round = kind === 'integer' ? Math.round : (x) => Number(x.toPrecision(4));
  return {
    place: (value) => ((bend(Math.min(high, Math.max(low, value))) - start) / length) * kSteps,
    value: (place) => round(unbend(start + (place / kSteps) * length)),
  };
}

const withUnit = (text, control) => (control.unit ? `${text} ${control.unit}` : text);
const described = (control) => ({ title: control.doc, 'aria-description': control.doc });

function numberInput(control, name, commit) {
  const input = make('input', {
    type: 'number',
    step: control.kind === 'integer' ? '1' : 'any',
    'aria-label': name,
    ...described(control),
  });
  if (control.min !== null) input.min = control.min;
  if (control.max !== null) input.max = control.max;
  input.addEventListener('change', () => commit(input.value));
  return input;
}

/** A slider and the number beside it. */
function sliderPair(control, name, commit) {
  const scale = scaleOf(control);
  const slider = make('input', {
    type: 'range',
    min: 0,
    max: kSteps,
    step: 1,
    'aria-label': name,
    ...described(control),
  });
  const number = numberInput(control, name, commit);
  slider.addEventListener('input', () => commit(String(scale.value(slider.valueAsNumber))));
  const show = (value) => {
    number.value = value;
    slider.value = scale.place(value);
    slider.setAttribute('aria-valuetext', withUnit(value, control));
  };
  return { nodes: [slider, number], show };
}

/** Several inputs that make one value: each commit sends all of them. */
function components(control, names, makeOne, commit) {
  let values = [];
  const parts = names.map((name, index) =>
    makeOne(control, `${control.label} ${name}`, (text) => {
      const next = [...values];
      next[index] = text;
      commit(next.join(' '));
    }),
  );
  const show = (next) => {
    values = next;
    parts.forEach((part, index) => part.show(next[index]));
  };
  return { nodes: parts.flatMap((part) => part.nodes), show };
}

function plainNumber(control, name, commit) {
  const input = numberInput(control, name, commit);
  return { nodes: [input], show: (value) => (input.value = value) };
}

const axesOf = ({ axes }) => [...axes].map((axis) => kColorNames[axis] ?? axis);

/** For each kind: (control, commit(text)) -> { nodes, show(value) } */
const kEditors = {
  number: (control, commit) => sliderPair(control, withUnit(control.label, control), commit),
  integer: (control, commit) => sliderPair(control, withUnit(control.label, control), commit),
  toggle(control, commit) {
    const input = make('input', { type: 'checkbox', 'aria-label': control.label, ...described(control) });
    input.addEventListener('change', () => commit(String(input.checked)));
    return { nodes: [input], show: (value) => (input.checked = value) };
  },
  choice(control, commit) {
    const options = control.choices.map((choice) => make('option', { value: choice, textContent: choice }));
    const input = make('select', { 'aria-label': control.label, ...described(control) }, ...options);
    input.addEventListener('change', () => commit(input.value));
    return { nodes: [input], show: (value) => (input.value = value) };
  },
  color(control, commit) {
    const input = make('input', { type: 'color', 'aria-label': control.label, ...described(control) });
    input.addEventListener('input', () => commit(input.value));
    return { nodes: [input], show: (value) => (input.value = hexOfLinear(value)) };
  },
  vector: (control, commit) => components(control, axesOf(control), plainNumber, commit),
  pair: (control, commit) => components(control, axesOf(control), plainNumber, commit),
  range: (control, commit) => components(control, ['low end', 'high end'], sliderPair, commit),
};

/** Tells lists of controls apart by what they are made for. */
const contentOf = (controls) => controls.map(({ path, group, choices }) => group && [path, ...choices]).join();

/** The part of a group that holds the controls of one object, lamp or technique: that which was begun last. */
function ownerPart(group, owner) {
  if (!owner) return group;
  const last = group.lastElementChild;
  if (last.getAttribute('aria-label') === owner) return last;
  const title = make('div', { className: 'owner', textContent: owner, 'aria-hidden': 'true' });
  const part = make('div', { role: 'group', 'aria-label': owner }, title);
  group.append(part);
  return part;
}

/** What takes the focus within a group, in order. */
const stopsOf = (group) => [...group.querySelectorAll('input, select, button')];

// A list that has been opened needs the arrow keys itself; browsers that do not know of it handle them before us.
const isOpen = (element) => element.tagName === 'SELECT' && CSS.supports('selector(:open)') && element.matches(':open');

export class Controls {
  #actions;
  #shows = new Map(); // path -> show(value)
  #built = ''; // what there are controls for
  #latest = []; // of which the values are shown
  #number = 0; // of times that all were made
  element = make('div', {
    className: 'twin',
    role: 'group',
    'aria-label': 'Controls',
    'aria-description': 'Tab goes from group to group, arrow keys up and down through the controls of one',
  });

  /**
   * @param actions  set(path, text): true when it was taken; reset(path); act(path) of a button; focus(path), "" when
   *                 none has it
   */
  constructor(actions) {
    this.#actions = actions;
    const pathOf = (event) => event.target.closest('[data-path]')?.dataset.path ?? '';
    this.element.addEventListener('focusin', (event) => {
      this.#rove(event.target);
      actions.focus(pathOf(event));
    });
    this.element.addEventListener('focusout', () => actions.focus(''));
    this.element.addEventListener('keydown', (event) => this.#walk(event));
  }

  // A group is one stop of the tab key: where the focus was last in it.
  #rove(stop) {
    for (const other of stopsOf(stop.closest('fieldset'))) other.tabIndex = other === stop ? 0 : -1;
  }

  // Up and down go through a group; left and right stay with sliders and text.
  #walk(event) {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey || isOpen(event.target)) return;
    const stops = stopsOf(event.target.closest('fieldset'));
    event.preventDefault();
    stops[stops.indexOf(event.target) + step]?.focus();
  }

  /**
   * Makes all controls anew, a few at a time.
   * @param controls  descriptors in the order of the panel; those without a group are left out
   */
  async buildLater(controls) {
    const mine = this.#begin(controls);
    const making = this.#making(controls);
    for (let start = performance.now(); !making.next().done; ) {
      if (performance.now() - start < kPageSlice) continue;
      await nextTask();
      if (mine !== this.#number) return; // others are made
      start = performance.now();
    }
    this.update(this.#latest);
  }

  #build(controls) {
    this.#begin(controls);
    for (const making = this.#making(controls); !making.next().done; );
  }

  #begin(controls) {
    this.#built = contentOf(controls);
    this.#latest = controls;
    return ++this.#number;
  }

  // Yields after each control; shows all of them in the end.
  *#making(controls) {
    const shows = new Map();
    const groups = new Map();
    for (const control of controls.filter(({ group }) => group)) {
      if (!groups.has(control.group))
        groups.set(control.group, make('fieldset', {}, make('legend', { textContent: control.group })));
      const row = control.kind === 'action' ? this.#button(control) : this.#row(control, shows);
      ownerPart(groups.get(control.group), control.owner).append(row);
      yield;
    }
    for (const group of groups.values()) this.#rove(stopsOf(group)[0]);
    this.#shows = shows;
    this.element.replaceChildren(...groups.values());
  }

  /** Shows the values as they are now; where there are other controls than before, the focus stays on its own. */
  update(controls) {
    this.#latest = controls;
    if (contentOf(controls) !== this.#built) {
      const focused = this.element.getRootNode().activeElement?.closest('[data-path]')?.dataset.path;
      this.#build(controls);
      if (focused) this.#focus(focused);
    }
    for (const control of controls) this.#shows.get(control.path)?.(valueOf(control, control.value));
  }

  /** @param profiles  of translucent and glossy objects: owner, and text in place of the panel's curves */
  describe(profiles) {
    for (const { owner, text } of profiles) this.#profileOf(owner).textContent = text;
  }

  /** The line below the controls of an object that says how far its light spreads. */
  #profileOf(owner) {
    const found = [...this.element.querySelectorAll('.profile')].find((line) => line.dataset.owner === owner);
    if (found) return found;
    const line = make('p', { className: 'profile', role: 'note' });
    line.dataset.owner = owner;
    const last = [...this.element.querySelectorAll('[data-path]')].findLast(({ dataset }) =>
      dataset.path.startsWith(`objects.${owner}.material.`),
    );
    last?.after(line);
    return line;
  }

  #focus(path) {
    this.element.querySelector(`[data-path="${CSS.escape(path)}"] :is(input, select, button)`)?.focus();
  }

  #button(control) {
    const button = make('button', { type: 'button', textContent: control.label, ...described(control) });
    button.addEventListener('click', () => this.#actions.act(control.path));
    const row = make('div', { className: 'action' }, button);
    row.dataset.path = control.path;
    return row;
  }

  #row(control, shows) {
    const commit = (text) => {
      if (!this.#actions.set(control.path, text)) show(valueOf(control, this.#actions.get(control.path)));
    };
    const { nodes, show } = kEditors[control.kind](control, commit);
    shows.set(control.path, show);
    const unit = make('small', { textContent: control.unit });
    const label = make(
      'span',
      { className: 'label', title: control.doc, 'aria-hidden': 'true' },
      `${control.label} `,
      unit,
    );
    const reset = make('button', { type: 'button', textContent: 'Reset', 'aria-label': `Reset ${control.label}` });
    reset.addEventListener('click', () => this.#actions.reset(control.path));
    const inputs = make('div', { className: `inputs ${control.kind}` }, ...nodes);
    if (nodes.length > 1)
      for (const [name, value] of [
        ['role', 'group'],
        ['aria-label', control.label],
      ])
        inputs.setAttribute(name, value);
    const row = make('div', { className: 'row' }, label, inputs, reset);
    row.dataset.path = control.path;
    return row;
  }
}
