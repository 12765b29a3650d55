// Files to save: the exact one, the compact one, which the worker makes once a character is shown, and glTF.
import { download } from './capture.js';
import { endComparison } from './comparing.js';
import { button, element, make, say, select } from './elements.js';
import { showMessages } from './messages.js';
import { faultOf, isStopped, type Opened } from './opening.js';
import { bestSize, type Result, showNoCompact, showResult } from './result_card.js';
import { background, session, stem } from './session.js';
import { bytesText, counted } from './units.js';
import type { Answers } from './worker.js';
import { working } from './working.js';

const patience = 400; // milliseconds: somebody who opens one file after another waits for none

let compact: { of: Opened; file: Promise<Answers['compact']> } | undefined;

const resultOf = ({ name, sourceSize, bytes }: Opened): Result => ({ name, sourceSize, exactSize: bytes.length });

/** The compact file, with the bound that is chosen: made once. */
export function compactFile(of: Opened): Promise<Answers['compact']> {
  if (compact?.of === of) return compact.file;
  const progress = element<HTMLProgressElement>('shrinking');
  const made = { of, file: background.ask({ kind: 'compact', bytes: of.bytes, bound: select('bound').value }, (share) => (progress.value = share)) };
  made.file.catch(() => compact === made && (compact = undefined));
  return (compact = made).file;
}

/** Fills the table of sizes. */
export function showSizes(compactSize?: number): void {
  const { shown } = session;
  const rows: [string, number][] = [];
  if (shown && !shown.name.toLowerCase().endsWith('.bendy')) rows.push(['source', shown.sourceSize]);
  if (shown?.character) rows.push(['.bendy, exact', shown.bytes.length]);
  if (compactSize !== undefined) rows.push(['.bendy, compact', compactSize]);
  element('sizes').replaceChildren(
    ...rows.map(([label, size]) =>
      make('tr', {}, make('td', {}, label), make('td', { title: counted(size, 'byte', 'bytes') }, bytesText(size)), make('td', {}, `${((100 * size) / shown!.sourceSize).toFixed(0)} %`)),
    ),
  );
  for (const id of ['save-bendy', 'save-compact', 'save-glb']) button(id).disabled = !shown?.character;
}

/** Checks a file that is shown, and makes the compact one. */
export async function shrink(opened: Opened): Promise<void> {
  showResult(resultOf(opened));
  await new Promise((resolve) => setTimeout(resolve, patience));
  if (session.shown === opened && opened.isUnchecked) await check(opened);
  if (session.shown === opened) await showCompact(opened);
}

async function check(opened: Opened): Promise<void> {
  try {
    const { faults } = await background.ask({ kind: 'check', bytes: opened.bytes });
    opened.isUnchecked = false;
    if (session.shown !== opened) return;
    const verdict = faults.length === 0 ? 'The file is valid.' : `The file is shown, but it has ${counted(faults.length, 'fault', 'faults')}.`;
    showMessages(verdict, faults, opened.warnings);
  } catch (error) {
    if (!isStopped(error)) say(faultOf(error).message);
  }
}

async function showCompact(opened: Opened): Promise<void> {
  try {
    const { bytes, measured } = await compactFile(opened);
    if (session.shown !== opened) return;
    showResult({ ...resultOf(opened), compactSize: bytes.length, error: measured });
    showSizes(bytes.length);
  } catch (error) {
    if (session.shown === opened && !isStopped(error)) showNoCompact(resultOf(opened), `There is no compact file: ${faultOf(error).message}`);
  }
}

async function saveCompact(): Promise<void> {
  await working('Making the compact file', async () => {
    const { bytes } = await compactFile(session.shown!);
    showSizes(bytes.length);
    download(bytes, `${stem()}.compact.bendy`);
  });
}

async function saveGltf(): Promise<void> {
  await working('Writing glTF', async () => download((await background.ask({ kind: 'glb', bytes: session.shown!.bytes })).bytes, `${stem()}.glb`));
}

/** Saves the smaller one of the exact and the compact file. */
async function saveBest(): Promise<void> {
  const of = session.shown!;
  const made = await compactFile(of).catch(() => undefined);
  const isCompact = made !== undefined && bestSize({ ...resultOf(of), compactSize: made.bytes.length }) === made.bytes.length;
  download(isCompact ? made.bytes : of.bytes, `${stem()}.bendy`);
}

button('save-bendy').addEventListener('click', () => session.shown && download(session.shown.bytes, `${stem()}.bendy`));
button('save-compact').addEventListener('click', () => void saveCompact());
button('save-glb').addEventListener('click', () => void saveGltf());
button('download').addEventListener('click', () => void saveBest());
select('bound').addEventListener('change', () => {
  compact = undefined;
  endComparison();
  if (!session.shown?.character || element('result').hidden) return;
  showResult(resultOf(session.shown));
  void showCompact(session.shown);
});
