// The list of clips: their lengths, a search, and the one that plays.
import { element, input, make, say } from './elements.js';
import { counted } from './units.js';

interface Listed {
  name: string;
  seconds: number;
}

const fewClips = 8; // more than these can be searched

export const clipName = ({ name }: Listed, number: number): string => name || `clip ${number}`;

/** Lists clips; `choose` is called with the number of one that is clicked. */
export function listClips(clips: readonly Listed[], choose: (number: number) => void): void {
  element('clips').replaceChildren(
    ...clips.map((clip, number) => {
      const choice = make('button', { type: 'button' }, make('span', {}, clipName(clip, number)), make('span', {}, `${clip.seconds.toFixed(2)} s`));
      choice.addEventListener('click', () => choose(number));
      return make('li', {}, choice);
    }),
  );
  element('clips-title').textContent = clips.length > 1 ? `${clips.length} clips` : 'Clips';
  input('search').value = '';
  input('search').hidden = clips.length <= fewClips;
}

/** Marks the clip that plays, and brings it into view within the list. */
export function markClip(number: number): void {
  const list = element('clips');
  for (const [k, { firstElementChild: choice }] of [...list.children].entries()) {
    if (k === number) choice!.setAttribute('aria-current', 'true');
    else choice!.removeAttribute('aria-current');
  }
  const marked = list.children[number] as HTMLElement | undefined;
  if (!marked) return;
  const above = marked.offsetTop - list.offsetTop;
  if (above < list.scrollTop) list.scrollTop = above;
  else if (above + marked.offsetHeight > list.scrollTop + list.clientHeight) list.scrollTop = above + marked.offsetHeight - list.clientHeight;
}

input('search').addEventListener('input', () => {
  const wanted = input('search').value.trim().toLowerCase();
  const items = [...element('clips').children] as HTMLElement[];
  for (const item of items) item.hidden = !item.textContent.toLowerCase().includes(wanted);
  const found = items.filter(({ hidden }) => !hidden).length;
  element('noclips').hidden = found !== 0;
  element('noclips').textContent = 'No clip has such a name.';
  say(`${counted(found, 'clip', 'clips')} of ${items.length}`);
});
