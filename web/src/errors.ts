import type { Status } from './generated/bindings.js';

/**
 * What kind of error it is. Of a file: `malformed` (damaged, or not a bendy file), `invalid` (its structure is sound, its content
 * is not), `unsupported` (valid, but this version cannot read it). Of a call: `bad_argument`, `not_found`, `out_of_memory`,
 * `disposed`. Of the module: `io` (it could not be loaded). Of the tools: `conversion` (the source cannot be converted), `edit` (the
 * file cannot be changed so).
 */
export type ErrorKind = Exclude<Status, 'ok'> | 'disposed' | 'conversion' | 'edit';

/** Every error that this package throws. */
export class BendyError extends Error {
  /** What kind of error it is. */
  readonly kind: ErrorKind;
  /** A word that never changes: for a file what `bendy validate` prints, "CHUNK_TOO_LONG"; otherwise the kind, "NOT_FOUND". */
  readonly code: string;
  /** The path of the chunk that is at fault, "HEAD/OBJE/SKIN[1]"; "" if the file is not the cause. */
  readonly path: string;
  /** Where the fault is, in bytes from the start of the file; 0 if the file is not the cause. */
  readonly offset: number;

  constructor(kind: ErrorKind, message: string, code: string = kind.toUpperCase(), path = '', offset = 0) {
    super(message);
    this.name = 'BendyError';
    this.kind = kind;
    this.code = code;
    this.path = path;
    this.offset = offset;
  }
}
