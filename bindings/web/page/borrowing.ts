// The clips of another file on the character that is shown.
import { Model } from '../src/index.js';
import { listClips } from './clip_list.js';
import { button, element, say } from './elements.js';
import { baseName, type Given } from './files.js';
import { faultOf, isStopped, readBytes } from './opening.js';
import { playClip } from './playing.js';
import { background, character, session } from './session.js';
import { selectTab } from './tabs.js';
import { setBusy, showProgress } from './working.js';

let showInstead: (() => void) | undefined;

/** Fills the part of the panel that says whose clips are listed, or why another file's are not. */
export function showBorrowed(text = '', isBorrowed = false): void {
  element('borrowed').hidden = text === '';
  element('borrowed-text').textContent = text;
  button('return').hidden = !isBorrowed;
  button('borrow').hidden = character() === undefined;
  element('drop-clips-text').textContent = `Drop here to play its clips on ${session.shown?.name}`;
  element('drop-clips').hidden = character() === undefined;
}

/** Lists the clips that move the character, and plays one. */
function playListed(clip: number): void {
  const now = character();
  const hasClips = now !== undefined && now.clips.length !== 0;
  listClips(now?.clips ?? [], playClip);
  element('noclips').hidden = hasClips;
  for (const id of ['transport', 'tempo']) element(id).hidden = !hasClips;
  if (hasClips) playClip(clip);
}

/** Plays the clips of a file on the character that is shown; `show` shows the file instead. */
export async function borrow(given: Given, show: () => void): Promise<void> {
  const now = character();
  if (!now) return show();
  const [name, own] = [baseName(given.main), session.shown!.name];
  showInstead = show;
  setBusy(`Reading ${name}`);
  let source: Model | undefined;
  try {
    source = await Model.open(await readBytes(given, background, showProgress));
    if (now !== character()) return source.dispose(); // another one was opened meanwhile
    if (source.clips.length === 0) throw new Error('it has no clips');
    now.borrow(source);
    playListed(now.firstClip);
    showBorrowed(`The clips are those of ${name}.`, true);
    say(`${name} moves ${own}`);
  } catch (error) {
    source?.dispose();
    if (isStopped(error) || now !== character()) return;
    showBorrowed(`${name} cannot move ${own}: ${faultOf(error).message}.`, now.isBorrowing);
    say(`${name} cannot move ${own}`);
  } finally {
    setBusy('');
  }
  selectTab('move');
}

button('return').addEventListener('click', () => {
  character()?.returnClips();
  playListed(character()?.firstClip ?? 0);
  showBorrowed();
  button('borrow').focus();
});
button('show-instead').addEventListener('click', () => showInstead?.());
