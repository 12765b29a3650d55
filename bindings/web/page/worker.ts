// Long-running work outside the page's thread: converting, checking and describing files.
import { BendyError } from '../src/errors.js';
import * as tools from '../src/tools/index.js';

/** A request of the page. */
export type Request =
  | { kind: 'read'; files: Record<string, Uint8Array>; main: string; autoRig: boolean }
  | { kind: 'check'; bytes: Uint8Array }
  | { kind: 'compact'; bytes: Uint8Array; bound: string }
  | { kind: 'glb'; bytes: Uint8Array }
  | { kind: 'inspect'; bytes: Uint8Array; name: string };

/** A fault of a file, or an error. */
export interface Fault {
  code: string;
  message: string;
  path: string;
  offset?: number | undefined;
}

export interface Warning {
  message: string;
  place: string;
  count: number;
}

export interface Answers {
  read: { bytes: Uint8Array; warnings: Warning[]; faults: Fault[]; sourceSize: number };
  check: { faults: Fault[] };
  compact: { bytes: Uint8Array; bound: number; measured: number };
  glb: { bytes: Uint8Array; warnings: Warning[] };
  inspect: { html: string };
}

export type Reply =
  | { id: number; progress: number }
  | { id: number; answer: Answers[keyof Answers] }
  | { id: number; fault: Fault };

const isBendy = (bytes: Uint8Array): boolean => String.fromCharCode(...bytes.subarray(0, 4)) === 'HEAD';

/** The rig file among the others: the one with the main file's name, or the only one. */
function rigOf(names: string[], main: string): string | undefined {
  const rigs = names.filter((name) => name.toLowerCase().endsWith('.rig.json'));
  return rigs.find((name) => name.toLowerCase() === `${main.replace(/\.[^.]*$/, '')}.rig.json`.toLowerCase()) ?? (rigs.length === 1 ? rigs[0] : undefined);
}

/** A message without its clause about an option of `convert`, which the page does not have. */
const withoutOption = (message: string): string => message.replace(/ unless instances are made \(instances\)$|; (?:ticksPerSecond|unit) sets .*$|: mergeClips makes .*$/, '');

async function read({ files, main, autoRig }: Request & { kind: 'read' }, progress: (share: number) => void): Promise<Answers['read']> {
  const given = files[main]!;
  const rig = rigOf(Object.keys(files), main);
  if (isBendy(given)) {
    const { faults } = await tools.validate(given);
    if (faults.length !== 0 || (rig === undefined && !autoRig)) return { bytes: given, warnings: [], faults, sourceSize: given.length };
  }
  const { bytes, warnings, sources } = await tools.convert(files, { main, autoRig, progress, ...(rig === undefined ? {} : { rig: files[rig]! }) });
  const sourceSize = Object.entries(files).reduce((sum, [name, { length }]) => sum + (name === main || sources.includes(name) ? length : 0), 0);
  return { bytes, warnings: warnings.map((warning) => ({ ...warning, message: withoutOption(warning.message) })), faults: [], sourceSize };
}

async function answer(request: Request, progress: (share: number) => void): Promise<Answers[keyof Answers]> {
  switch (request.kind) {
    case 'read':
      return read(request, progress);
    case 'check':
      return { faults: (await tools.validate(request.bytes)).faults };
    case 'compact': {
      const { bytes, report } = await tools.convert(request.bytes, { compact: request.bound, progress });
      const { maxError, measuredError } = report['compact'] as { maxError: number; measuredError: number };
      return { bytes, bound: maxError, measured: measuredError };
    }
    case 'glb': {
      const { files, warnings } = await tools.exportModel(request.bytes, 'glb');
      return { bytes: Object.values(files)[0]!, warnings };
    }
    case 'inspect':
      return { html: await tools.inspectPage(request.bytes, request.name) };
  }
}

self.onmessage = async ({ data: { id, request } }: MessageEvent<{ id: number; request: Request }>) => {
  const post = (reply: Reply) => self.postMessage(reply);
  try {
    post({ id, answer: await answer(request, (progress) => post({ id, progress })) });
  } catch (error) {
    const message = withoutOption((error as Error).message);
    const fault: Fault = error instanceof BendyError ? { code: error.code, message, path: error.path, offset: error.offset } : { code: '', message, path: '' };
    post({ id, fault });
  }
};
