// The page: what was dropped, what is shown, and what the user does.
import { Character } from './character.js';
import { Stage } from './stage.js';
import type { Answers, Fault, Reply, Request, Warning } from './worker.js';

declare const bendyWorker: string; // the text of worker.ts, bundled
declare const bendyExample: string; // the mannequin, base64

const suffixes = ['.gltf', '.x', '.glb', '.vrm', '.md2', '.bendy']; // of characters; those that refer to other files come first

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

// Long-running work.

/** A worker that answers one request after another. It is terminated once nobody waits for its answer. */
class Background {
  #worker: Worker | undefined;
  #next = 0;
  #waiting = new Map<number, { resolve: (answer: never) => void; reject: (fault: Fault) => void; progress: (share: number) => void }>();

  ask<K extends Request['kind']>(request: Request & { kind: K }, progress: (share: number) => void = () => {}): Promise<Answers[K]> {
    this.#worker ??= this.#start();
    const id = this.#next++;
    return new Promise<Answers[K]>((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject, progress });
      this.#worker!.postMessage({ id, request });
    });
  }

  stop(): void {
    if (this.#waiting.size === 0) return;
    this.#worker?.terminate();
    this.#worker = undefined;
    for (const { reject } of this.#waiting.values()) reject({ code: 'STOPPED', message: 'stopped', path: '' });
    this.#waiting.clear();
  }

  #start(): Worker {
    const address = URL.createObjectURL(new Blob([bendyWorker], { type: 'text/javascript' }));
    const worker = new Worker(address);
    worker.onmessage = ({ data }: MessageEvent<Reply>) => {
      const waiting = this.#waiting.get(data.id);
      if (!waiting) return;
      if ('progress' in data) return waiting.progress(data.progress);
      this.#waiting.delete(data.id);
      if ('fault' in data) waiting.reject(data.fault);
      else waiting.resolve(data.answer as never);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      for (const { reject } of this.#waiting.values()) reject({ code: '', message: event.message || 'the worker has failed', path: '' });
      this.#waiting.clear();
      this.#worker = undefined;
    };
    return worker;
  }
}

// The current files and character.

/** The files that the user dropped or chose. */
interface Given {
  files: Record<string, Uint8Array>;
  main: string;
}

interface Shown extends Given {
  name: string;
  bytes: Uint8Array;
  sourceSize: number;
  compact?: Uint8Array;
}

const stage = new Stage(element<HTMLCanvasElement>('view'));
const background = new Background();
let shown: Shown | undefined;
let character: Character | undefined;
let isPlaying = true;
let inspected: Uint8Array | undefined;
let loads = 0;

function say(text: string): void {
  element('status').textContent = text;
}

function setBusy(text: string): void {
  element('busy').hidden = text === '';
  element('doing').textContent = text;
  element<HTMLProgressElement>('progress').removeAttribute('value');
}

const showProgress = (share: number) => (element<HTMLProgressElement>('progress').value = share);

function listFault(fault: Fault): HTMLLIElement {
  const place = [fault.path, fault.offset === undefined || fault.path === '' ? '' : `offset ${fault.offset.toLocaleString('en')}`].filter(Boolean).join(', ');
  const line = make('li', {}, fault.code ? make('code', {}, fault.code) : '', ` ${fault.message}`);
  if (place && !fault.message.includes(fault.path)) line.append(make('br'), make('code', { className: 'quiet' }, place));
  return line;
}

function showMessages(faults: Fault[], warnings: Warning[]): void {
  const verdict = element('verdict');
  verdict.className = faults.length === 0 ? 'good' : 'bad';
  verdict.textContent =
    faults.length === 0 ? 'The file is valid.' : faults.length === 1 ? 'The file cannot be shown: it has a fault.' : `The file cannot be shown: it has ${faults.length} faults.`;
  element('faults').replaceChildren(...faults.map(listFault));
  element('warned').hidden = warnings.length === 0;
  element('warnings').replaceChildren(
    ...warnings.map(({ message, place, count }) => {
      const line = make('li', {}, message + (count > 1 ? ` (${count} times)` : ''));
      if (place) line.prepend(make('code', {}, place), ' ');
      return line;
    }),
  );
  const count = faults.length + warnings.length;
  button('tab-messages').textContent = count === 0 ? 'Messages' : `Messages (${count})`;
}

function showSizes(): void {
  const rows: [string, number][] = [];
  if (shown && !shown.name.toLowerCase().endsWith('.bendy')) rows.push(['source', shown.sourceSize]);
  if (shown) rows.push(['.bendy', shown.bytes.length]);
  if (shown?.compact) rows.push(['compact .bendy', shown.compact.length]);
  element('sizes').replaceChildren(
    ...rows.map(([label, size]) =>
      make(
        'tr',
        {},
        make('td', {}, label),
        make('td', {}, size.toLocaleString('en')),
        make('td', {}, `${((100 * size) / shown!.sourceSize).toFixed(0)} %`),
      ),
    ),
  );
  for (const id of ['save-bendy', 'save-compact', 'save-glb']) button(id).disabled = !character;
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
  element('nochains').hidden = !hasNone || !character;
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
  input('bones').checked = character !== undefined && !character.hasMesh;
  stage.setSkeleton(input('bones').checked);
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

/** Shows the content of the files. An error in them leaves the page usable. */
async function open({ files, main }: Given, autoRig = false): Promise<void> {
  const load = ++loads;
  background.stop();
  setBusy(`Reading ${main}`);
  say(`Reading ${main}`);
  let faults: Fault[] = [];
  let warnings: Warning[] = [];
  let next: Shown | undefined;
  let nextCharacter: Character | undefined;
  try {
    const read = await background.ask({ kind: 'read', files, main, autoRig }, showProgress);
    if (load !== loads) return;
    ({ faults, warnings } = read);
    next = { files, main, name: main.replace(/.*\//, ''), bytes: read.bytes, sourceSize: read.sourceSize };
    if (faults.length === 0) {
      nextCharacter = await Character.open(read.bytes, (uri) => linkedFile(files, main, uri));
      warnings = [...warnings, ...nextCharacter.warnings.map((message) => ({ message, place: '', count: 1 }))];
    }
  } catch (error) {
    const fault = error as Fault & Error;
    if (load !== loads || fault.code === 'STOPPED') return;
    faults = [{ code: fault.code ?? '', message: fault.message, path: fault.path ?? '', offset: fault.offset }];
  }
  if (load !== loads) return nextCharacter?.dispose();
  setBusy('');
  stage.show(undefined);
  character?.dispose();
  character = nextCharacter;
  shown = next;
  inspected = undefined;
  element<HTMLIFrameElement>('page').srcdoc = '';
  element('name').textContent = character ? `${main} · ${character.facts}` : main;
  showMessages(faults, warnings);
  stage.show(character);
  showPanels();
  showSizes();
  if (character && character.clips.length !== 0) playClip(character.firstClip);
  say(faults.length === 0 ? `${main} is shown` : `${main} cannot be shown`);
  if (faults.length !== 0) selectTab('messages');
  else if (selected === 'messages' && faults.length === 0) selectTab('move');
  if (selected === 'inspect') void inspect();
}

/** The file that a link in the main one names: relative to it, or the only file with that name anywhere. */
function linkedFile(files: Record<string, Uint8Array>, main: string, uri: string): Uint8Array | undefined {
  const nameOf = (path: string): string => path.replace(/.*\//, '').toLowerCase();
  let link = uri.replace(/\\/g, '/');
  try {
    link = decodeURIComponent(link);
  } catch {} // the name contains a literal %
  const path = `${main.replace(/[^/]*$/, '')}${link.replace(/^(\.\/)+/, '')}`;
  const alike = Object.keys(files).filter((name) => nameOf(name) === nameOf(link));
  const found = files[path] !== undefined ? path : alike.length === 1 ? alike[0]! : undefined;
  return found === undefined || found === main ? undefined : files[found];
}

/** The main file, which the others belong to; undefined if none is a character. */
function mainOf(names: string[]): string | undefined {
  return suffixes.flatMap((suffix) => names.filter((name) => name.toLowerCase().endsWith(suffix)))[0];
}

async function openFiles(list: Iterable<File>): Promise<void> {
  const files: Record<string, Uint8Array> = {};
  try {
    for (const file of list) files[file.webkitRelativePath || file.name] = new Uint8Array(await file.arrayBuffer());
  } catch (error) {
    showMessages([{ code: '', message: `the files cannot be read: ${(error as Error).message}`, path: '' }], []);
    return selectTab('messages');
  }
  const names = Object.keys(files);
  const main = mainOf(names);
  if (main !== undefined) return open({ files, main });
  // A rig file on its own applies to the character that is shown.
  if (shown && character && names.some((name) => name.toLowerCase().endsWith('.rig.json'))) {
    const others = Object.fromEntries(Object.entries(shown.files).filter(([name]) => !name.toLowerCase().endsWith('.rig.json')));
    return open({ files: { ...others, ...files }, main: shown.main });
  }
  if (names[0] !== undefined) await open({ files, main: names[0] });
}

/** The dropped files, including those in folders, with their paths. */
async function droppedFiles(items: DataTransferItemList): Promise<File[]> {
  const walk = async (entry: FileSystemEntry): Promise<File[]> => {
    if (entry.isFile) {
      const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
      Object.defineProperty(file, 'webkitRelativePath', { value: entry.fullPath.replace(/^\//, '') });
      return [file];
    }
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    const files: File[] = [];
    for (;;) {
      const entries = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
      if (entries.length === 0) return files;
      for (const one of entries) files.push(...(await walk(one)));
    }
  };
  const entries = [...items].filter((item) => item.kind === 'file').map((item) => item.webkitGetAsEntry() ?? item.getAsFile());
  const lists = await Promise.all(entries.map((entry) => (entry === null ? [] : entry instanceof File ? [entry] : walk(entry))));
  return lists.flat();
}

// Tabs.

const tabs = ['move', 'reach', 'messages', 'save', 'inspect'];
let selected = '';

function selectTab(name: string): void {
  selected = name;
  for (const tab of tabs) {
    button(`tab-${tab}`).setAttribute('aria-selected', String(tab === name));
    button(`tab-${tab}`).tabIndex = tab === name ? 0 : -1;
    element(tab).hidden = tab !== name;
  }
  document.querySelector('aside')!.classList.toggle('wide', name === 'inspect');
  stage.showsHandles = name === 'reach';
  if (name === 'inspect') void inspect();
}

async function inspect(): Promise<void> {
  if (!shown || inspected === shown.bytes) return;
  const { bytes, name } = shown;
  inspected = bytes;
  try {
    const { html } = await background.ask({ kind: 'inspect', bytes, name });
    if (shown?.bytes === bytes) element<HTMLIFrameElement>('page').srcdoc = html;
  } catch (error) {
    inspected = undefined;
    say((error as Fault).message);
  }
}

// Saving.

function download(bytes: Uint8Array, suffix: string): void {
  const address = URL.createObjectURL(new Blob([bytes as BlobPart], { type: 'application/octet-stream' }));
  const link = make('a', { href: address, download: shown!.name.replace(/\.[^.]*$/, '') + suffix });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

async function save(text: string, work: () => Promise<void>): Promise<void> {
  setBusy(text);
  try {
    await work();
  } catch (error) {
    const fault = error as Fault;
    showMessages([fault], []);
    element('verdict').textContent = 'The file cannot be made.';
    selectTab('messages');
  }
  setBusy('');
}

button('save-bendy').addEventListener('click', () => shown && download(shown.bytes, '.bendy'));
button('save-compact').addEventListener('click', () =>
  save('Making the compact file', async () => {
    const of = shown!;
    const { bytes } = await background.ask({ kind: 'compact', bytes: of.bytes, bound: element<HTMLSelectElement>('bound').value }, showProgress);
    of.compact = bytes;
    showSizes();
    download(bytes, '.compact.bendy');
  }),
);
button('save-glb').addEventListener('click', () =>
  save('Writing glTF', async () => download((await background.ask({ kind: 'glb', bytes: shown!.bytes })).bytes, '.glb')),
);

// The user's actions.

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
input('files').accept = [...suffixes, '.bin', '.json', '.png', '.jpg', '.jpeg', '.webp', '.ktx2', '.tga', '.bmp', '.dds', '.pcx'].join();
input('files').addEventListener('change', () => void openFiles(input('files').files ?? []).then(() => (input('files').value = '')));
button('example').addEventListener('click', () => void openExample());
button('guess').addEventListener('click', () => shown && void open(shown, true));

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
  if (event.dataTransfer) void droppedFiles(event.dataTransfer.items).then(openFiles, (error: Error) => say(error.message));
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
  return open({ files: { 'mannequin.bendy': bytes }, main: 'mannequin.bendy' });
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
