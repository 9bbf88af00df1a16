/** What a person is asked once, in words, on the picture. */

/**
 * @param title    what it is about
 * @param text     the question
 * @param answers  [label, act()] of each button; Escape does nothing
 * @return {HTMLElement}  a dialog that removes itself when it was answered
 */
export function question(title, text, answers) {
  const make = (tag, properties) => Object.assign(document.createElement(tag), properties);
  const dialog = make('div', { className: 'question', ariaLabel: title });
  dialog.setAttribute('role', 'dialog');
  const buttons = answers.map(([label, act]) => {
    const button = make('button', { type: 'button', textContent: label });
    button.addEventListener('click', () => (dialog.remove(), act()));
    return button;
  });
  dialog.addEventListener('keydown', ({ key }) => key === 'Escape' && dialog.remove());
  dialog.append(make('b', { textContent: title }), make('p', { textContent: text }), ...buttons);
  return dialog;
}
