// The page: what was dropped, what is shown, and what people do with it.
import { BendyError } from '../src/index.js';
import { Character } from './character.js';
import { Stage } from './stage.js';

declare const bendyExample: string; // the mannequin, base64

function element<T extends HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element "${id}"`);
  return found as T;
}
const button = (id: string) => element<HTMLButtonElement>(id);
const input = (id: string) => element<HTMLInputElement>(id);

function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// What is shown.

const stage = new Stage(element<HTMLCanvasElement>('view'));
let character: Character | undefined;
let isPlaying = true;
let loads = 0;

function say(text: string): void {
  element('status').textContent = text;
}

function showVerdict(name: string, error?: unknown): void {
  const verdict = element('verdict');
  verdict.className = error === undefined ? 'good' : 'bad';
  verdict.textContent = error === undefined ? 'The file is valid.' : `${name} cannot be shown.`;
  const lines: Node[] = [];
  if (error !== undefined) {
    const { message } = error as Error;
    const fault = error instanceof BendyError ? error : undefined;
    lines.push(make('p', {}, fault ? make('code', {}, fault.code) : '', ` ${message}`));
    if (fault?.code === 'NOT_A_BENDY_FILE') lines.push(make('p', {}, 'Convert glTF, X-files and Quake II models first: ', make('code', {}, `bendy convert ${name}`)));
  }
  element('faults').replaceChildren(...lines);
}

function slider(label: string, value: number, low: number, high: number, change: (value: number) => void): HTMLElement {
  const output = make('output', {}, value.toFixed(2));
  const range = make('input', { type: 'range', min: String(low), max: String(high), step: '0.01', value: String(value) });
  range.addEventListener('input', () => {
    output.textContent = range.valueAsNumber.toFixed(2);
    change(range.valueAsNumber);
  });
  return make('label', { className: 'row' }, label, range, output);
}

/** Fills the panels for a character. */
function showPanels(): void {
  const clips = character?.clips ?? [];
  element('clips').replaceChildren(
    ...clips.map((clip, number) => {
      const choice = make('button', { type: 'button' }, clip.name || `clip ${number}`);
      choice.addEventListener('click', () => playClip(number));
      return choice;
    }),
  );
  if (character && clips.length === 0) element('clips').append('This character has no clips.');
  element('transport').hidden = clips.length === 0;
  const targets = character?.morphTargets ?? [];
  element('shapes').hidden = targets.length === 0;
  element('shapes').lastElementChild!.replaceChildren(
    ...targets.map(({ name, number, weight }) =>
      slider(name || `target ${number}`, weight, Math.min(0, weight), Math.max(1, weight), (value) => character?.weights.set(number, value)),
    ),
  );
  element('detail').hidden = !character?.hasLevels;
  input('share').value = '1';
  showTriangles();
  const chains = character?.limbs ?? [];
  const hasNone = (character?.chains.length ?? 0) === 0;
  element('nochains').hidden = !hasNone;
  element('haschains').hidden = hasNone;
  element('chains').replaceChildren(
    ...chains.map((chain) => {
      const free = make('button', { type: 'button' }, 'Let go');
      free.setAttribute('aria-label', `Let go of ${chain.name}`);
      free.addEventListener('click', () => character?.targets.delete(chain.number));
      return make('div', { className: 'row' }, chain.name || `chain ${chain.number}`, make('output', { id: `reached-${chain.number}` }), free);
    }),
  );
  input('look').checked = character?.lookChain !== undefined;
  input('look').disabled = character?.lookChain === undefined;
  input('bones').checked = false;
  input('wireframe').checked = false;
}

function showTriangles(): void {
  element('triangles').textContent = character ? character.triangles.toLocaleString('en') : '';
}

function playClip(number: number): void {
  if (!character || character.clips.length === 0) return;
  const count = character.clips.length;
  const wanted = (number + count) % count;
  character.play(wanted, input('fade').valueAsNumber);
  for (const [k, choice] of [...element('clips').children].entries()) {
    choice.setAttribute('aria-pressed', String(k === wanted));
  }
  setPlaying(true);
}

function setPlaying(playing: boolean): void {
  isPlaying = playing;
  button('play').textContent = playing ? 'Pause' : 'Play';
  button('play').setAttribute('aria-pressed', String(playing));
}

/** Shows what a file holds. Whatever is in it, the page stays. */
async function open(name: string, bytes: Uint8Array): Promise<void> {
  const load = ++loads;
  let next: Character | undefined;
  let failure: unknown;
  try {
    next = await Character.open(bytes);
  } catch (error) {
    failure = error;
  }
  if (load !== loads) return next?.dispose(); // another file has been opened meanwhile
  stage.show(undefined);
  character?.dispose();
  character = next;
  element('name').textContent = character ? `${name} · ${character.facts}, ${bytes.length.toLocaleString('en')} bytes` : name;
  showVerdict(name, failure);
  stage.show(character);
  showPanels();
  if (character && character.clips.length !== 0) playClip(character.firstClip);
  if (failure !== undefined) selectTab('messages');
  else if (selected === 'messages') selectTab('move');
  say(failure === undefined ? `${name} is shown` : `${name} cannot be shown`);
}

async function openFile(file: File | null | undefined): Promise<void> {
  if (!file) return;
  try {
    await open(file.name, new Uint8Array(await file.arrayBuffer()));
  } catch (error) {
    showVerdict(file.name, error);
    selectTab('messages');
  }
}

// Tabs.

const tabs = ['move', 'reach', 'messages'];
let selected = '';

function selectTab(name: string): void {
  selected = name;
  for (const tab of tabs) {
    button(`tab-${tab}`).setAttribute('aria-selected', String(tab === name));
    button(`tab-${tab}`).tabIndex = tab === name ? 0 : -1;
    element(tab).hidden = tab !== name;
  }
  stage.showsHandles = name === 'reach';
}

// What people do.

for (const tab of tabs) button(`tab-${tab}`).addEventListener('click', () => selectTab(tab));
element('tabs').addEventListener('keydown', (event) => {
  const step = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
  if (step === 0) return;
  event.stopPropagation();
  selectTab(tabs[(tabs.indexOf(selected) + step + tabs.length) % tabs.length]!);
  button(`tab-${selected}`).focus();
});
button('play').addEventListener('click', () => setPlaying(!isPlaying));
input('time').addEventListener('input', () => {
  setPlaying(false);
  character?.seek(input('time').valueAsNumber);
});
for (const id of ['speed', 'fade']) {
  input(id).addEventListener('input', () => (document.querySelector(`output[for=${id}]`)!.textContent = input(id).value));
}
input('share').addEventListener('input', () => {
  character?.setShare(input('share').valueAsNumber);
  showTriangles();
});
input('bones').addEventListener('change', () => stage.setSkeleton(input('bones').checked));
input('wireframe').addEventListener('change', () => stage.setWireframe(input('wireframe').checked));
button('open').addEventListener('click', () => input('files').click());
input('files').addEventListener('change', () => void openFile(input('files').files?.[0]).then(() => (input('files').value = '')));
button('example').addEventListener('click', () => void openExample());

addEventListener('dragover', (event) => {
  event.preventDefault();
  element('drop').hidden = false;
});
addEventListener('dragleave', (event) => {
  if (event.relatedTarget === null) element('drop').hidden = true;
});
addEventListener('drop', (event) => {
  event.preventDefault();
  element('drop').hidden = true;
  void openFile(event.dataTransfer?.files[0]);
});
addEventListener('keydown', (event) => {
  const { target } = event;
  if (event.ctrlKey || event.metaKey || event.altKey || target instanceof HTMLInputElement || target instanceof HTMLSelectElement) return;
  if (event.key === ' ' && !(target instanceof HTMLButtonElement)) setPlaying(!isPlaying);
  else if (event.key === 'ArrowLeft' || event.key === 'ArrowRight') {
    setPlaying(false);
    character?.step((event.key === 'ArrowRight' ? 1 : -1) / 30);
  } else if (event.key === '[' || event.key === ']') playClip((character?.clip ?? 0) + (event.key === ']' ? 1 : -1));
  else if (event.key === 'o') input('files').click();
  else return;
  event.preventDefault();
});

function openExample(): Promise<void> {
  const bytes = Uint8Array.from(atob(bendyExample), (letter) => letter.charCodeAt(0));
  return open('mannequin.bendy', bytes);
}

let before = performance.now();
function frame(now: number): void {
  const seconds = Math.min((now - before) / 1000, 0.1);
  before = now;
  if (character) {
    const pointer = input('look').checked ? stage.pointerTarget() : undefined;
    character.obeysConstraints = input('constrained').checked;
    character.update(isPlaying ? seconds * input('speed').valueAsNumber : 0, pointer);
    if (isPlaying || document.activeElement !== input('time')) input('time').value = String(character.share);
    element('seconds').textContent = `${character.seconds.toFixed(2)} s`;
    for (const { number } of character.limbs) element(`reached-${number}`).textContent = character.results.get(number) ?? '';
  }
  stage.draw();
  requestAnimationFrame(frame);
}

selectTab('move');
void openExample();
requestAnimationFrame(frame);

// For tests that drive the page.
Object.assign(globalThis, { bendyPage: { handlePlace: (chain: number) => stage.handlePlace(chain), get character() { return character; } } });
