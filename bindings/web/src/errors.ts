import type { Status } from './generated/bindings.js';

/**
 * The kind of an error. In a file: `malformed` (damaged, or not a bendy file), `invalid` (its structure is valid, its content
 * is not), `unsupported` (valid, but this version cannot read it). In a call: `bad_argument`, `not_found`, `out_of_memory`,
 * `disposed`. Outside: `io` (a file or the module could not be loaded), `stopped` (the module has stopped by a fault of its own, and
 * the next call loads it anew). In the tools: `conversion` (the source cannot be converted), `edit` (the
 * file cannot be changed in this way).
 */
export type ErrorKind = Exclude<Status, 'ok'> | 'disposed' | 'stopped' | 'conversion' | 'edit';

/** @internal What a caller gave in the place of something else, in the words of a message. */
export function described(given: unknown): string {
  if (given instanceof Promise) return 'a promise: await it';
  if (typeof given === 'object' && given !== null) {
    const { name } = (given.constructor ?? {}) as { name?: unknown };
    return `an object of type ${typeof name === 'string' && name !== '' ? name : Object.prototype.toString.call(given).slice(8, -1)}`;
  }
  return typeof given === 'string' ? `a text, ${JSON.stringify(given)}` : typeof given === 'function' ? 'a function' : String(given);
}

/** Every error that this package throws. */
export class BendyError extends Error {
  /** The kind of the error. */
  readonly kind: ErrorKind;
  /** A word that never changes: for a file the code of `bendy validate`, "CHUNK_TOO_LONG"; otherwise the kind, "NOT_FOUND". */
  readonly code: string;
  /** The path of the faulty chunk, "HEAD/OBJE/SKIN[1]"; "" if the file is not the cause. */
  readonly path: string;
  /** The position of the fault, in bytes from the start of the file; 0 if the file is not the cause. */
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
