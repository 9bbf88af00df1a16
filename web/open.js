/** The dialog that opens a scene: a file, or a link. Fetched when it is asked for. */
import { make, makeDialog } from './dialog.js';

const kEndings = '.zip,.json,.png,.jpg,.jpeg,.hdr,.exr,.pfm,.glb,.gltf,.bin,.obj,.mtl,.mesh';

let dialog;

/** @param page  openFiles(files) and openLink(text), which open what the person chose */
export function openSceneDialog(page) {
  dialog ??= build(page);
  dialog.showModal();
}

function build({ openFiles, openLink }) {
  const files = make('input', { type: 'file', multiple: true, accept: kEndings, hidden: true });
  const choose = make('button', { type: 'button', textContent: 'Choose files…' });
  const link = make('input', { type: 'text', id: 'scene-link', inputMode: 'url', autocomplete: 'off' });
  const help = make('small', { textContent: 'Of this page, or the address of a scene on this site.' });
  const open = make('button', { textContent: 'Open link' });
  const problem = make('p', { className: 'problem' });
  problem.setAttribute('role', 'alert');
  const close = make('button', { type: 'button', textContent: 'Cancel' });
  const made = makeDialog(
    'Open scene',
    make('p', { textContent: 'A saved scene (.lucent.zip), or a scene file (.json) with all files that it names.' }),
    make('div', { className: 'actions' }, choose, files),
    make(
      'form',
      { method: 'dialog' },
      make('div', { className: 'fields' }, make('label', { htmlFor: 'scene-link', textContent: 'Link' }), link, help),
      problem,
      make('div', { className: 'actions' }, open, close),
    ),
  );
  choose.addEventListener('click', () => files.click());
  files.addEventListener('change', () => {
    const chosen = [...files.files];
    files.value = '';
    if (!chosen.length) return;
    made.close();
    openFiles(chosen);
  });
  made.querySelector('form').addEventListener('submit', (event) => {
    problem.textContent = '';
    if (URL.canParse(link.value, location.href) && link.value.trim()) return void openLink(link.value.trim());
    event.preventDefault();
    problem.textContent = 'This is no link; it must be one of this page, or the address of a scene.';
  });
  close.addEventListener('click', () => made.close());
  return made;
}
