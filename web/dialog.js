/** Dialogs of the page: keyboards reach all of them, Escape leaves, and the focus goes back to where it was. */

/** @return element with properties and children */
export function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** A dialog in the page under a heading; showModal() opens it. */
export function makeDialog(title, ...children) {
  const heading = make('h2', { textContent: title, id: `dialog-${crypto.randomUUID()}` });
  const dialog = make('dialog', { className: 'dialog' }, heading, ...children);
  dialog.setAttribute('aria-labelledby', heading.id);
  document.body.append(dialog);
  return dialog;
}

/**
 * Asks a person. @param answers  [value, label] of each button; the first is the one that has the focus
 * @return {Promise<string>}  the value of the button; 'cancel' for Escape
 */
export function ask(title, text, ...answers) {
  const buttons = answers.map(([value, textContent]) => make('button', { value, textContent }));
  const actions = make('div', { className: 'actions' }, ...buttons);
  const dialog = makeDialog(title, make('form', { method: 'dialog' }, make('p', { textContent: text }), actions));
  dialog.showModal();
  return new Promise((done) =>
    dialog.addEventListener('close', () => {
      dialog.remove();
      done(dialog.returnValue || 'cancel');
    }),
  );
}

/** Hands a file to the person. */
export function download(blob, name) {
  const address = URL.createObjectURL(blob);
  make('a', { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60000); // a browser may ask where to put it first
}
