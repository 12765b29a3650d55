import type { BendyRetargetOptions } from '../generated/bindings.js';
import type { ProgramOptions } from '../generated/convert_options.js';

/** A file's content. */
export type FileBytes = Uint8Array | ArrayBuffer;

/** The input of `convert`: a file, or several by name, the main one and those that it refers to. */
export type Source = FileBytes | Readonly<Record<string, FileBytes>>;

/** The options of `bendy convert`, see docs/convert.md. Files are named as the source names them. */
export interface ConvertOptions extends Omit<ProgramOptions, 'compact' | 'maxError' | 'rig' | 'root' | 'scene'> {
  /** The file to convert, if there are several; the first if not given. The name of a single file, for messages. */
  main?: string;
  /** Encode for size: true, or the largest error, "0.1mm" or "0.005%". */
  compact?: boolean | string;
  /** A rig file (spec/rig.md): its text, its bytes, or the object. */
  rig?: string | Uint8Array | object;
  /** The name or number of a glTF file's scene. */
  scene?: string | number;
  /** Called from time to time with the fraction done, 0 to 1. An exception from it rejects the promise at the end. */
  progress?: (share: number) => void;
}

/** Something that the result lacks, or represents differently. */
export interface Warning {
  message: string;
  /** The place where it occurred first. */
  place: string;
  /** How many times it occurred. */
  count: number;
}

/** How compact encodings changed a character. */
export interface CompactReport {
  /** Metres: the requested bound. */
  maxError: number;
  /** Metres: the largest error that was measured. */
  measuredError: number;
  /** Where it was measured: mesh, vertex and pose; "" if nothing moved. */
  place: string;
  /** The height of the character in metres, at rest. */
  height: number;
  /** Bytes of an exact file. */
  exactBytes: number;
  /** Bytes of this file. */
  compactBytes: number;
  /** The same by kind of content: "POSI", "clips", ... */
  kinds: { kind: string; exactBytes: number; compactBytes: number }[];
  /** Bytes that levels of detail add, if there are any. */
  lodBytes?: number;
  /** If there are named curves: how many, how many are packed, and their largest error, as a share of their component's range. */
  curves?: { count: number; packed: number; largestError: number };
}

/** What `convert` tells of its result: the object of `bendy convert --json`, without the names of files. */
export interface ConversionReport {
  /** The size of the bendy file. */
  bytes: number;
  /** How many of the bytes are images. */
  imageBytes: number;
  joints: number;
  constraints: number;
  chains: number;
  meshes: number;
  vertices: number;
  triangles: number;
  /** Triangles of the coarsest level of detail, if there are levels. */
  fewestTriangles?: number;
  morphTargets: number;
  materials: number;
  textures: number;
  /** `start` and `seconds`, the length, in seconds. */
  clips: { name: string; start: number; seconds: number }[];
  /** With `compact`: how it changed the character. */
  compact?: CompactReport;
  /** The files that became part of the result. */
  embedded: { file: string; bytes: number; mediaType: string }[];
  warnings: Warning[];
  /** Lines about what `autoRig` or `autoSkin` has chosen. */
  proposals: string[];
  /** Lines about options that may help. */
  suggestions: string[];
}

/** The result of `convert`. */
export interface Conversion {
  /** The bendy file. */
  bytes: Uint8Array<ArrayBuffer>;
  /** Counts, clips, sizes, errors, proposals, suggestions. */
  report: ConversionReport;
  warnings: Warning[];
  /** The names of the files that were read. */
  sources: string[];
}

/** One fault of a file. */
export interface Fault {
  /** A word that never changes: "CHUNK_TOO_LONG". */
  code: string;
  kind: 'malformed' | 'invalid' | 'unsupported';
  /** A sentence. */
  message: string;
  /** The chunk's path, "HEAD/OBJE/SKIN[1]". */
  path: string;
  /** Bytes from the start of the file. */
  offset: number;
}

/** The faults of a file. */
export interface Faults {
  /** The first thousand. */
  faults: Fault[];
  /** How many more there are. */
  leftOut: number;
}

/** A chunk of a file. */
export interface Chunk {
  /** Four letters. */
  id: string;
  /** The meaning of the id. */
  meaning: string;
  /** Its index in file order. */
  number: number;
  /** Its path from the root, "HEAD/OBJE/SKIN[1]". */
  path: string;
  /** Bytes from the start of the file. */
  offset: number;
  /** Bytes of the payload as stored. */
  size: number;
  /** The stored CRC-32C, as hexadecimal digits. */
  sum: string;
  container: boolean;
  /** How the payload is encoded, if it is. */
  codec?: number;
  /** Its record by name, as in `bendy inspect --json`. */
  fields: Record<string, unknown>;
  children: Chunk[];
}

/** The object "summary" of `bendy inspect --json`, see docs/inspect.md. */
export interface Summary {
  /** The name of the first object; "" if it has none. */
  name: string;
  /** The number of objects in the file; all else is about the first. */
  objects: number;
  /** `parent`: the number of a joint; null for a root. */
  joints: (Listed & { parent: number | null })[];
  /** The number of constraints. */
  constraints: number;
  /** `start` and `effector`: names of joints. `links`: the number of joints from one to the other. */
  chains: (Listed & { start: string; effector: string; links: number })[];
  /** `influences`: the most of any vertex; 0 if the mesh is rigid. `morphTargets`: names. */
  meshes: (Listed & { vertices: number; triangles: number; lines?: number; points?: number; influences: number; morphTargets: string[] })[];
  /** Levels of detail, if there are any: `share` of the triangles, as requested; `error`: metres, null if the file does not say. */
  levels: { share: number; triangles: number; vertices: number; error: number | null }[];
  /** Seconds. `repeats`: the clip's own flag, which files from glTF lack. */
  clips: (Listed & { start: number; end: number; seconds: number; repeats: boolean })[];
  materials: Listed[];
  /** `link`: the URI of an image that is not in the file. `sameAs`: the number of the texture that has the same image. */
  textures: (Listed & { images: { type: string; bytes: number; link?: string; sameAs?: number }[] })[];
  /** Corners of the rest pose, x y z in metres; null if there is nothing. */
  bounds: { min: number[]; max: number[] } | null;
  /** Bytes by kind of content: "skeleton", "positions", ...; kinds without bytes are absent. */
  bytesByKind: Record<string, number>;
}

/** One of a summary's lists. */
interface Listed {
  /** Its index in the list. */
  number: number;
  /** May be empty, and need not be unique. */
  name: string;
}

/** Options of `dump`. */
export interface DumpOptions {
  /** Write encoded chunks decoded. */
  decode?: boolean;
  /** Accept a file with wrong sums. */
  ignoreSums?: boolean;
}

/** A changed file. */
export interface Edited {
  bytes: Uint8Array<ArrayBuffer>;
  /** Lines about what was done. */
  done: string[];
  /** Lines about what to check. */
  warnings: string[];
}

/** What can be done with clips: the options of `bendy edit`, described in docs/cli.md. */
export type ClipWork = 'keep-clip' | 'copy-clip' | 'trim' | 'resample' | 'mirror' | 'loop' | 'root-motion' | 'on-the-spot';

/** What to do if a clip of that name exists: reject; replace the existing clip; or number the new one, as in "Run.001". */
export type SameName = 'error' | 'replace' | 'number';

/** Options of `retargetClips`; those of `Retarget` too. */
export interface RetargetClipsOptions extends BendyRetargetOptions {
  /** Which of the other file's clips: a name, a pattern as in "Walk*", or a number; all if not given. */
  clip?: string | number;
  /** "error" if not given. */
  sameName?: SameName;
}

/** The kinds of things that can be renamed. */
export type NamedKind = 'joint' | 'clip' | 'chain' | 'mesh' | 'target' | 'material' | 'texture' | 'object';

export type ExportFormat = 'glb' | 'gltf' | 'x';

/** Options of `exportModel`. */
export interface ExportOptions {
  /** The fraction of the triangles, 0 to 1, for a file with levels of detail. */
  lod?: number;
  /** The name of the files without a suffix: "model" if not given. */
  name?: string;
}

/** The result of `exportModel`. */
export interface Exported {
  /** The main file's name. */
  main: string;
  files: Record<string, Uint8Array<ArrayBuffer>>;
  warnings: Warning[];
}

/** Options of `diff`. */
export interface DiffOptions {
  /** Compares the characters: how far a point of the skin may deviate, "0.1mm" or "0.005%". */
  tolerance?: string | undefined;
}

/** One difference, as in `bendy diff --json`. */
export interface Difference {
  kind: string;
  [field: string]: unknown;
}

/** The chunks in which two files differ. */
export interface FileDifferences {
  same: boolean;
  differences: Difference[];
  differencesLeftOut: number;
}

/** The ways in which two characters differ by more than the tolerance. */
export interface CharacterDifferences extends FileDifferences {
  /** Metres. */
  tolerance: number;
  unit: 'metres';
  /** The largest measured distance, and where; null if none was measured, because the skeletons differ. */
  worst: number | null;
  worstPlace: string;
  /** The differences between normals, texture coordinates and colours. */
  looks: { place: string; apart: number; allowed: number; unit: string }[];
  /** The contents of the files that were not compared. */
  notCompared: Warning[];
}
