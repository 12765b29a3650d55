/**
 * The tools of the program `bendy`: convert, validate, inspect, edit, export and compare files, with the same bytes as the program.
 * They run in a WebAssembly module of their own, which the first call loads. A call computes without pause: for large files, call
 * from a worker.
 *
 * Every function returns a promise, which is rejected with a {@link BendyError}.
 *
 * @packageDocumentation
 */
import { asBytes } from '../bytes.js';
import { BendyError, described } from '../errors.js';
import { programOptions } from '../generated/convert_options.js';
import { checkNumber } from '../numbers.js';
import { checkOptions, optionNames } from '../options.js';
import { type Inputs, runTool } from './module.js';
import type {
  Chunk,
  ClipWork,
  Conversion,
  ConversionReport,
  ConvertOptions,
  CharacterDifferences,
  DiffOptions,
  DumpOptions,
  Edited,
  Exported,
  ExportFormat,
  ExportOptions,
  Faults,
  FileBytes,
  FileDifferences,
  NamedKind,
  RetargetClipsOptions,
  SameName,
  Source,
  Summary,
  Warning,
} from './types.js';

export { BendyError, type ErrorKind } from '../errors.js';
export type * from './types.js';

/** Whether it is one file; otherwise it is files by name. */
function isOneFile(source: Source): source is FileBytes {
  return Object.prototype.toString.call(source) !== '[object Object]';
}

/** The only file that a tool made. */
async function made(request: object, inputs: Inputs): Promise<Uint8Array<ArrayBuffer>> {
  return (await runTool(request, inputs)).made[0]!.bytes;
}

/** Runs a tool on the file "a.bendy". */
async function answered<T>(request: object, bytes: FileBytes): Promise<T> {
  return (await runTool<T>({ ...request, file: 'a.bendy' }, { 'a.bendy': asBytes(bytes) })).answer;
}

async function edited(request: object, inputs: Inputs): Promise<Edited> {
  const { answer, made } = await runTool<{ done: string[]; warnings: string[] }>({ ...request, file: 'a.bendy' }, inputs);
  return { bytes: made[0]!.bytes, done: answer.done, warnings: answer.warnings };
}

const convertOptions: readonly string[] = programOptions.filter((name) => name !== 'maxError' && name !== 'root');
const convertAdvice = { maxError: "compact: '1mm'", 'max-error': "compact: '1mm'" };
const retargetOptions = optionNames<RetargetClipsOptions>({
  clip: true, sameName: true, restPoses: true, limits: true, plantsFeet: true,
});
const dumpOptions = optionNames<DumpOptions>({ decode: true, ignoreSums: true });
const exportOptions = optionNames<ExportOptions>({ lod: true, name: true });

/**
 * Converts another format (.gltf, .glb, .vrm, .vrma, .x, .md2, .bvh), or a bendy file, to a bendy file, exactly unless `compact`.
 *
 * A source of several files is a map from names to bytes, `{ 'a.gltf': ..., 'a.bin': ... }`; the names are the paths that the main
 * file uses. Rejects with `conversion` for what cannot be converted; its `path` is the place in the source.
 */
export async function convert(source: Source, options: ConvertOptions = {}): Promise<Conversion> {
  const { main, rig, compact, progress, scene, ...others } = options;
  checkOptions('convert', others, convertOptions, convertAdvice);
  if (compact !== undefined && typeof compact !== 'boolean' && typeof compact !== 'string') {
    throw new BendyError('bad_argument', `compact is ${described(compact)}, not true or the largest error, "0.1mm"`);
  }
  const inputs: Inputs = {};
  let file = main ?? 'source';
  if (isOneFile(source)) {
    inputs[file] = asBytes(source);
  } else {
    for (const [name, bytes] of Object.entries(source)) inputs[name] = asBytes(bytes);
    file = main ?? Object.keys(source)[0] ?? '';
  }
  const request: Record<string, unknown> = { do: 'convert', file, ...others };
  if (scene !== undefined) request['scene'] = typeof scene === 'number' ? `#${scene}` : scene;
  if (compact === true) request['compact'] = true;
  if (typeof compact === 'string') request['maxError'] = compact;
  if (rig !== undefined) {
    let name = 'rig.json';
    while (name in inputs) name = `_${name}`;
    inputs[name] = typeof rig === 'string' ? rig : rig instanceof Uint8Array ? rig : JSON.stringify(rig);
    request['rig'] = name;
  }
  const { answer, made } = await runTool<{ report: ConversionReport; sources: string[] }>(
    request,
    inputs,
    progress,
  );
  return { bytes: made[0]!.bytes, report: answer.report, warnings: answer.report.warnings, sources: answer.sources };
}

/** Returns every fault of a bendy file; none if it is valid. Rejects with `malformed` for a file of another kind. */
export async function validate(bytes: FileBytes): Promise<Faults> {
  const { faults, leftOut } = await answered<Faults>({ do: 'validate' }, bytes);
  return { faults, leftOut };
}

/** Returns the chunks of a bendy file as a tree, whatever they hold. Rejects with `malformed` if the grammar is broken. */
export async function inspect(bytes: FileBytes): Promise<Chunk> {
  interface Entry extends Omit<Chunk, 'children' | 'path' | 'fields'> {
    parent: number | null;
    fields?: Chunk['fields'];
  }
  const { chunks } = await answered<{ chunks: Entry[] }>({ do: 'inspect' }, bytes);
  const tree: Chunk[] = [];
  const counts: Record<string, number>[] = []; // of each chunk's children, by id
  for (const { parent, ...entry } of chunks) {
    const chunk: Chunk = { ...entry, fields: entry.fields ?? {}, path: entry.id, children: [] };
    if (parent !== null) {
      const index = counts[parent]![chunk.id] ?? 0;
      counts[parent]![chunk.id] = index + 1;
      chunk.path = `${tree[parent]!.path}/${chunk.id}${index === 0 ? '' : `[${index}]`}`;
      tree[parent]!.children.push(chunk);
    }
    tree.push(chunk);
    counts.push({});
  }
  return tree[0]!;
}

/** A summary of a character: the object "summary" of `bendy inspect --json`, see docs/inspect.md. Rejects for a faulty file. */
export async function summary(bytes: FileBytes): Promise<Summary> {
  return (await answered<{ summary: Summary }>({ do: 'summary' }, bytes)).summary;
}

/**
 * The page of `bendy inspect --html`, as HTML text: facts, faults, chunks, skeleton, clips, textures and materials, without
 * pictures. It loads nothing. Faulty files have one too.
 *
 * @param name - of the file, for the page's title
 */
export async function inspectPage(bytes: FileBytes, name: string): Promise<string> {
  return new TextDecoder().decode(await made({ do: 'page', file: 'a.bendy', name }, { 'a.bendy': asBytes(bytes) }));
}

/** The text form of a file (spec/text.md): JSON that `assemble` turns back into the same bytes. */
export async function dump(bytes: FileBytes, options: DumpOptions = {}): Promise<string> {
  checkOptions('dump', options, dumpOptions);
  return new TextDecoder().decode(await made({ do: 'dump', file: 'a.bendy', ...options }, { 'a.bendy': asBytes(bytes) }));
}

/**
 * The file that a text form describes. Rejects with `malformed` for a fault in the text, whose `path` is its line and column, and
 * for an invalid file unless `allowInvalid`.
 */
export async function assemble(text: string, options: { allowInvalid?: boolean } = {}): Promise<Uint8Array<ArrayBuffer>> {
  checkOptions('assemble', options, ['allowInvalid']);
  return made({ do: 'assemble', file: 'a.json', ...options }, { 'a.json': text });
}

/**
 * Removes a part of a file: "textures", "clips", "clip:Run", "mesh:Hat*", "lod", "extras", ... What the change does not concern
 * keeps its bytes.
 */
export function strip(bytes: FileBytes, part: string): Promise<Edited> {
  return edited({ do: 'strip', part }, { 'a.bendy': asBytes(bytes) });
}

/**
 * Renames things of one kind: `{ 'mixamorig:*': '*' }`. All pairs are matched against the names in the file.
 *
 * @param options - allMustMatch: false: a pair without a match is a warning
 */
export async function rename(
  bytes: FileBytes,
  kind: NamedKind,
  names: Readonly<Record<string, string>>,
  options: { allMustMatch?: boolean } = {},
): Promise<Edited> {
  checkOptions('rename', options, ['allMustMatch']);
  return edited({ do: 'rename', kind, names: Object.entries(names), ...options }, { 'a.bendy': asBytes(bytes) });
}

/**
 * Appends the clips of another bendy file, by the names of the joints.
 *
 * @param options - sameName: what to do if a clip of that name exists; "error" by default
 */
export async function mergeClips(bytes: FileBytes, other: FileBytes, options: { sameName?: SameName } = {}): Promise<Edited> {
  checkOptions('mergeClips', options, ['sameName']);
  const request = { do: 'mergeClips', other: 'b.bendy', sameName: options.sameName ?? 'error' };
  return edited(request, { 'a.bendy': asBytes(bytes), 'b.bendy': asBytes(other) });
}

/**
 * Puts clips of another bendy file on this character, whatever its build: see docs/retarget.md. Both characters need roles. `done` has
 * a line for each clip with what had to give way, and `warnings` what is lost. Without restPoses, those of animals on four legs are
 * taken as alike if that brings feet much nearer, and `done` says so.
 */
export async function retargetClips(bytes: FileBytes, other: FileBytes, options: RetargetClipsOptions = {}): Promise<Edited> {
  checkOptions('retargetClips', options, retargetOptions);
  const { clip = '', sameName = 'error', ...others } = options;
  const request = { ...others, do: 'retargetClips', other: 'b.bendy', clip: String(clip), sameName };
  return edited(request, { 'a.bendy': asBytes(bytes), 'b.bendy': asBytes(other) });
}

/**
 * Says what a joint is in the body, as `Joint.role` has it: `setRole(bytes, 'left_hand', 'Hand.L')`, `setRole(bytes, 'tail:2', 'Tail3')`.
 * Null: nobody is it.
 */
export function setRole(bytes: FileBytes, role: string, joint: string | null): Promise<Edited> {
  return edited({ do: 'setRole', text: `${role}=${joint ?? ''}` }, { 'a.bendy': asBytes(bytes) });
}

/**
 * Says that the body stands upright at this time of a clip, a name or a number: retargeting measures from that pose, not from the rest
 * pose. `strip(bytes, 'standing-pose')` takes it back.
 */
export async function stand(bytes: FileBytes, clip: string | number, seconds: number): Promise<Edited> {
  return edited({ do: 'stand', clip: String(clip), seconds: checkNumber(seconds, 'seconds') }, { 'a.bendy': asBytes(bytes) });
}

/** Says that the body stands as the character of another bendy file rests; joints are found there by their names. */
export function standAs(bytes: FileBytes, other: FileBytes): Promise<Edited> {
  return edited({ do: 'standAs', other: 'b.bendy' }, { 'a.bendy': asBytes(bytes), 'b.bendy': asBytes(other) });
}

/**
 * Changes a field of a material's SURF record: `setMaterial(bytes, 'Wood', 'roughness', 0.4)`, `setMaterial(bytes, '*', 'base_colour', [1, 0.5, 0, 1])`,
 * `setMaterial(bytes, 'Wood', 'alpha_mode', 'blend')`, `setMaterial(bytes, 'Wood', 'normal_texture.texture', null)`. The error for another
 * field lists them.
 */
export function setMaterial(bytes: FileBytes, material: string, field: string, value: number | readonly number[] | string | null): Promise<Edited> {
  return edited({ do: 'setMaterial', material, field, value: value === null ? 'none' : String(value) }, { 'a.bendy': asBytes(bytes) });
}

/** Keeps the joint with this name and its descendants, with everything that belongs to them. */
export function extract(bytes: FileBytes, joint: string): Promise<Edited> {
  return edited({ do: 'extract', joint }, { 'a.bendy': asBytes(bytes) });
}

/**
 * Changes clips as an option of `bendy edit` does: `changeClips(bytes, 'trim', 'Run=0.5..1.2')`. Only "keep-clip" takes several
 * texts.
 */
export function changeClips(bytes: FileBytes, work: ClipWork, text: string | readonly string[]): Promise<Edited> {
  const texts = typeof text === 'string' ? [text] : text;
  return edited({ do: 'changeClips', work, texts }, { 'a.bendy': asBytes(bytes) });
}

/** Leaves each vertex its `most` largest influences at most, scaled to the same sum. */
export function limitInfluences(bytes: FileBytes, most: number): Promise<Edited> {
  return edited({ do: 'limitInfluences', most }, { 'a.bendy': asBytes(bytes) });
}

/**
 * Writes a bendy file as glTF ("glb"; "gltf" with a .bin beside it) or as an X-file ("x", with images beside it). The files' names
 * start with `options.name`.
 */
export async function exportModel(bytes: FileBytes, format: ExportFormat, options: ExportOptions = {}): Promise<Exported> {
  checkOptions('exportModel', options, exportOptions);
  const request = { do: 'export', file: 'a.bendy', format, name: options.name ?? 'model', lod: options.lod ?? 1 };
  const { answer, made } = await runTool<{ warnings: Warning[] }>(request, { 'a.bendy': asBytes(bytes) });
  const files = Object.fromEntries(made.map((file) => [file.name, file.bytes]));
  return { main: made[0]!.name, files, warnings: answer.warnings };
}

/**
 * Everything in which two bendy files differ, chunk by chunk; with `tolerance`, in which the characters in them differ. Rejects
 * for a faulty file.
 */
export async function diff(a: FileBytes, b: FileBytes, options: DiffOptions & { tolerance: string }): Promise<CharacterDifferences>;
export async function diff(a: FileBytes, b: FileBytes, options?: { tolerance?: undefined }): Promise<FileDifferences>;
export async function diff(a: FileBytes, b: FileBytes, options: DiffOptions = {}): Promise<FileDifferences | CharacterDifferences> {
  checkOptions('diff', options, ['tolerance']);
  const request = { do: 'diff', file: 'a.bendy', other: 'b.bendy', tolerance: options.tolerance ?? '' };
  const inputs = { 'a.bendy': asBytes(a), 'b.bendy': asBytes(b) };
  const { answer } = await runTool<(FileDifferences | CharacterDifferences) & { made?: unknown }>(request, inputs);
  delete answer.made;
  return answer;
}
