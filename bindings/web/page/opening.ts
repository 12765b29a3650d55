// Opens what was given: a bendy file by the runtime alone, anything else by the converter, in the worker.
import type { Background } from './background.js';
import { Character } from './character.js';
import { baseName, type Given, isRig, linkedFile } from './files.js';
import type { Fault, Warning } from './worker.js';

/** What was given, and what has become of it. */
export interface Opened extends Given {
  name: string;
  /** The bendy file; empty if there is none. */
  bytes: Uint8Array;
  /** Bytes of the source and of the files that it uses. */
  sourceSize: number;
  faults: Fault[];
  warnings: Warning[];
  /** Whether the values in the file are still to be checked. */
  isUnchecked: boolean;
  character?: Character;
}

export const isStopped = (error: unknown): boolean => (error as Fault).code === 'STOPPED';

export function faultOf(error: unknown): Fault {
  const { code, message, path, offset } = error as Partial<Fault>;
  return { code: code ?? '', message: message ?? String(error), path: path ?? '', offset };
}

const isBendy = (bytes: Uint8Array): boolean => String.fromCharCode(...bytes.subarray(0, 4)) === 'HEAD';

async function openCharacter(opened: Opened): Promise<void> {
  const character = await Character.open(opened.bytes, (uri) => linkedFile(opened, uri));
  opened.character = character;
  opened.warnings = [...opened.warnings, ...character.warnings.map((message) => ({ message, place: '', count: 1 }))];
}

/** The bytes of a bendy file, which the worker makes of anything else. Rejects with the first fault. */
export async function readBytes({ files, main }: Given, background: Background, progress: (share: number) => void): Promise<Uint8Array> {
  if (isBendy(files[main]!)) return files[main]!;
  const { faults, bytes } = await background.ask({ kind: 'read', files, main, autoRig: false }, progress);
  if (faults.length !== 0) throw faults[0];
  return bytes;
}

/** Opens a bendy file without the converter; undefined if the runtime refuses it, so that the worker says all that is wrong. */
async function openDirectly(opened: Opened): Promise<Opened | undefined> {
  try {
    await openCharacter(opened);
    return opened;
  } catch {
    return undefined;
  }
}

/** Opens files. Whatever is wrong with them is among the faults of the result. Rejects only if the worker is stopped. */
export async function openGiven(given: Given, autoRig: boolean, background: Background, progress: (share: number) => void): Promise<Opened> {
  const { files, main } = given;
  const bytes = files[main]!;
  const opened: Opened = { files, main, name: baseName(main), bytes, sourceSize: bytes.length, faults: [], warnings: [], isUnchecked: true };
  const needsConverter = !isBendy(bytes) || autoRig || Object.keys(files).some(isRig);
  if (!needsConverter) {
    const direct = await openDirectly(opened);
    if (direct) return direct;
  }
  opened.isUnchecked = false;
  try {
    const { faults, warnings, bytes: made, sourceSize } = await background.ask({ kind: 'read', files, main, autoRig }, progress);
    Object.assign(opened, { faults, warnings, bytes: made, sourceSize });
    if (faults.length === 0) await openCharacter(opened);
  } catch (error) {
    if (isStopped(error)) throw error;
    opened.faults = [faultOf(error)];
  }
  return opened;
}
