// Shows what was dropped or chosen, or the example.
import { borrow, showBorrowed } from './borrowing.js';
import { endComparison } from './comparing.js';
import { button, element, embeddedBytes, input, isStill, make, say, select } from './elements.js';
import { acceptedSuffixes, charactersOf, droppedFiles, type Given, isCompanion, isRig, readFiles } from './files.js';
import { Life } from './life.js';
import { refusal, showMessages } from './messages.js';
import { faultOf, isStopped, openGiven, type Opened } from './opening.js';
import { showMorphTargets, showPanels } from './panels.js';
import { playClip, setPlaying } from './playing.js';
import { hideResult, showNotices } from './result_card.js';
import { showSizes, shrink } from './saving.js';
import { background, character, handles, session, stage } from './session.js';
import { onTab, selectedTab, selectTab } from './tabs.js';
import { counted } from './units.js';
import { setBusy, showFailure, showProgress } from './working.js';

const exampleName = 'mannequin.bendy';
let exampleBytes: Uint8Array | undefined;
let inspected: Uint8Array | undefined;
let loads = 0;

const isExample = (): boolean => exampleBytes !== undefined && session.shown?.bytes === exampleBytes;

/** Opens files and shows the character in them. An error in them leaves the page usable. */
async function open(given: Given, autoRig = false): Promise<void> {
  const load = ++loads;
  background.stop();
  setBusy(`Reading ${given.main}`);
  say(`Reading ${given.main}`);
  let opened: Opened;
  try {
    opened = await openGiven(given, autoRig, background, showProgress);
  } catch {
    return; // stopped: something else is being opened
  }
  if (load !== loads) return opened.character?.dispose();
  setBusy('');
  show(opened);
}

function show(opened: Opened): void {
  endComparison();
  stage.show([]);
  character()?.dispose();
  Object.assign(session, { shown: opened, life: undefined });
  const { main, faults, warnings } = opened;
  const now = character();
  element('name').textContent = now ? `${main} · ${now.facts}` : main;
  showMessages(faults.length !== 0 ? refusal(faults) : opened.isUnchecked ? 'The file opens.' : 'The file is valid.', faults, warnings);
  stage.show(now ? [now] : []);
  handles.show(now);
  showPanels();
  showBorrowed();
  showSizes();
  if (now && now.clips.length !== 0) {
    playClip(now.firstClip);
    setPlaying(!isStill.matches);
  }
  say(faults.length === 0 ? `${main} is shown` : `${main} cannot be shown`);
  showCard(opened);
  inspected = undefined;
  element<HTMLIFrameElement>('page').srcdoc = '';
  if (faults.length !== 0) selectTab('messages');
  else if (selectedTab() === 'messages') selectTab('move');
  else if (selectedTab() === 'inspect') void inspect();
}

/** Shows the card of what has become of the file; the welcome if it is the example or cannot be shown. */
function showCard(opened: Opened): void {
  button('example').hidden = isExample();
  element('welcome').hidden = opened.character !== undefined && !isExample();
  const others = select('character').options.length;
  showNotices([
    ...(others > 1 ? [`${others} characters were given; the others can be chosen above.`] : []),
    ...(opened.warnings.length > 0 ? [`${counted(opened.warnings.length, 'warning', 'warnings')}: see Messages.`] : []),
  ]);
  if (!opened.character || isExample()) hideResult();
  else void shrink(opened);
}

async function openFiles(list: Iterable<File>): Promise<void> {
  const files = await readFiles(list);
  const names = Object.keys(files);
  const mains = charactersOf(names);
  const { shown } = session;
  // Files that a character may use, without one: they are for the character that is shown.
  if (mains.length === 0 && shown?.character && names.some(isCompanion)) {
    return open({ files: { ...withoutRigs(shown.files, names), ...files }, main: shown.main });
  }
  offerOthers(files, mains);
  const main = mains[0] ?? names[0];
  if (main !== undefined) await open({ files, main });
}

/** Plays the clips in files on the character that is shown. */
async function borrowFiles(list: Iterable<File>): Promise<void> {
  const files = await readFiles(list);
  const main = charactersOf(Object.keys(files))[0] ?? Object.keys(files)[0];
  if (main !== undefined) await borrow({ files, main }, () => void open({ files, main }));
}

/** The files without the rigs among them, if there is a new rig. */
function withoutRigs(files: Given['files'], added: string[]): Given['files'] {
  if (!added.some(isRig)) return files;
  return Object.fromEntries(Object.entries(files).filter(([name]) => !isRig(name)));
}

/** Offers a choice if several characters were given at once. */
function offerOthers(files: Given['files'], mains: string[]): void {
  element('others').hidden = mains.length < 2;
  select('character').replaceChildren(...mains.map((main) => make('option', {}, main)));
  select('character').onchange = () => void open({ files, main: select('character').value });
}

/** Shows the mannequin, which waits to be touched. */
export async function openExample(): Promise<void> {
  exampleBytes ??= embeddedBytes('mannequin');
  offerOthers({}, []);
  await open({ files: { [exampleName]: exampleBytes }, main: exampleName });
  const now = character();
  if (!now || !isExample()) return;
  session.life = new Life(now);
  const arm = now.limbs.find(({ name }) => name === 'IK_LeftArm');
  if (arm) handles.invite(arm.number, 'Drag my hand');
  showMorphTargets();
}

async function inspect(): Promise<void> {
  const { shown } = session;
  if (!shown || inspected === shown.bytes) return;
  const { bytes, name } = shown;
  inspected = bytes;
  try {
    const { html } = await background.ask({ kind: 'inspect', bytes, name });
    if (session.shown?.bytes === bytes) element<HTMLIFrameElement>('page').srcdoc = html;
  } catch (error) {
    inspected = undefined;
    if (!isStopped(error)) say(faultOf(error).message);
  }
}

onTab((name) => name === 'inspect' && void inspect());
for (const id of ['open', 'choose']) button(id).addEventListener('click', () => input('files').click());
button('borrow').addEventListener('click', () => input('clip-files').click());
for (const [id, take] of [['files', openFiles], ['clip-files', borrowFiles]] as const) {
  input(id).accept = acceptedSuffixes;
  input(id).addEventListener('change', async () => {
    await take(input(id).files ?? []).catch(showFailure);
    input(id).value = '';
  });
}
button('example').addEventListener('click', () => void openExample());
button('guess').addEventListener('click', () => session.shown && void open(session.shown, true));
const isForClips = ({ target }: Event): boolean => target instanceof Node && element('drop-clips').contains(target);
addEventListener('dragover', (event) => {
  event.preventDefault();
  element('drop').hidden = false;
  element('drop-clips').classList.toggle('over', isForClips(event));
});
addEventListener('dragleave', (event) => {
  if (event.relatedTarget === null) element('drop').hidden = true;
});
addEventListener('drop', (event) => {
  event.preventDefault();
  element('drop').hidden = true;
  if (event.dataTransfer) droppedFiles(event.dataTransfer.items).then(isForClips(event) ? borrowFiles : openFiles).catch(showFailure);
});
