import { element } from './numbers.js';

const byId = (id) => document.getElementById(id);
const chosen = (name) => document.querySelector(`input[name="${name}"]:checked`).value;
const sourceOf = ({ png }) => `data:image/png;base64,${png}`;
const sides = ['left', 'right'];

/// The contact sheet of a view, and two of its pictures beside each other.
export function showPictures({ pictures, table }, tellOf) {
  byId('look').hidden = pictures.length === 0;
  if (pictures.length === 0) return;
  const views = [...new Set(pictures.map(({ view }) => view))];
  const cellOf = (picture) => table.cells[picture.cell];
  const ofView = () => pictures.filter(({ view }) => view === views[byId('view').selectedIndex]);
  /// Places in table.cells, so that a choice stays when the view changes.
  const shown = { left: pictures[0].cell, right: pictures[pictures.length - 1].cell };
  let next = 'left';

  function showLayout() {
    const wipe = chosen('layout') === 'wipe', part = byId('wipe').value;
    byId('views').classList.toggle('wipe', wipe);
    byId('wipe-row').hidden = !wipe;
    byId('wipe-out').textContent = `${part} %`;
    byId('figure-right').style.clipPath = wipe ? `inset(0 0 0 ${part}%)` : '';
    byId('divider').style.left = `${part}%`;
  }

  function showSides() {
    for (const side of sides) {
      const picture = ofView().find(({ cell }) => cell === shown[side]) ?? ofView()[0];
      const cell = cellOf(picture);
      byId(side).value = String(picture.cell);
      byId(`image-${side}`).src = sourceOf(picture);
      byId(`image-${side}`).alt = `${cell.name}: ${tellOf(cell.result)}`;
      byId(`caption-${side}`).replaceChildren(cell.name, element('span', tellOf(cell.result)));
    }
    for (const button of byId('sheet').querySelectorAll('button')) {
      button.setAttribute('aria-pressed', String(Object.values(shown).includes(Number(button.dataset.cell))));
    }
  }

  function showView() {
    for (const side of sides) {
      byId(side).replaceChildren(...ofView().map((picture) => element('option', cellOf(picture).name, { value: picture.cell })));
    }
    byId('sheet').replaceChildren(...ofView().map((picture) => {
      const cell = cellOf(picture), item = element('li');
      const button = element('button', undefined, { type: 'button', 'data-cell': picture.cell });
      button.append(element('img', undefined, { src: sourceOf(picture), alt: '' }), cell.name,
        element('small', tellOf(cell.result)));
      button.addEventListener('click', () => {
        shown[next] = picture.cell;
        next = next === 'left' ? 'right' : 'left';
        showSides();
      });
      item.append(button);
      return item;
    }));
    showSides();
  }

  byId('view').append(...views.map((view) => element('option', view || 'the scene’s first camera')));
  byId('view-row').hidden = views.length === 1;
  byId('view').addEventListener('change', showView);
  for (const side of sides) {
    byId(side).addEventListener('change', () => { shown[side] = Number(byId(side).value); showSides(); });
  }
  byId('controls').addEventListener('submit', (event) => event.preventDefault());
  byId('controls').addEventListener('input', showLayout);
  if (window.matchMedia('(max-width: 700px)').matches) document.querySelector('input[value=wipe]').checked = true;
  showView();
  showLayout();
}
