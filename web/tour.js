/** The first look at the page: four things that one can do, on one screen. It is shown once. */

const kSeen = 'lucent.tour';

const kMarkup = `
<h2 id="tour-title">Four things to try</h2>
<ul>
<li><svg viewBox="0 0 120 80" aria-hidden="true"><path class="shape" d="M20 66a40 40 0 0 1 80 0z"/>
<circle class="lit" cx="34" cy="18" r="5"/><circle cx="34" cy="18" r="10"/><path d="M50 18h40m-8-6 8 6-8 6"/></svg>
<b>Move the lamp</b> Drag across the picture, or drag a lamp by its dot. An arrow at the border leads to a lamp that stands
outside.</li>
<li><svg viewBox="0 0 120 80" aria-hidden="true"><path class="shape" d="M40 60 60 20l20 40z"/>
<path d="M22 52c10 22 66 22 76 0m-10 0 10 0 2 10"/></svg>
<b>Walk around</b> Hold Shift and drag; where there is no relief, just drag. Click once, and the wheel comes nearer.</li>
<li><svg viewBox="0 0 120 80" aria-hidden="true"><path d="M20 24h80M20 42h80M20 60h80"/>
<circle class="lit" cx="46" cy="24" r="6"/><circle class="lit" cx="82" cy="42" r="6"/><circle class="lit" cx="32" cy="60" r="6"/></svg>
<b>Change the material</b> Every slider says what it does when you rest on its name. Undo takes back each step.</li>
<li><svg viewBox="0 0 120 80" aria-hidden="true"><path class="shape" d="M18 62a40 40 0 0 1 42-40v40z"/>
<path class="lit" d="M60 22a40 40 0 0 1 42 40H60z"/><path d="M60 10v60"/></svg>
<b>Check it</b> <em>Compare</em> puts the exact picture beside yours, and says how far apart they are.</li>
</ul>
<div class="actions"><button type="button" data-do="close">Close, and never show again</button></div>`;

export function showTour() {
  const dialog = Object.assign(document.createElement('dialog'), { className: 'tour', innerHTML: kMarkup });
  dialog.setAttribute('aria-labelledby', 'tour-title');
  dialog.addEventListener('close', () => {
    dialog.remove();
    try {
      localStorage.setItem(kSeen, 'seen');
    } catch {
      // a page that may remember nothing shows it on request only
    }
  });
  dialog.addEventListener('click', ({ target }) => target.dataset.do && dialog.close());
  document.body.append(dialog);
  dialog.showModal();
}
