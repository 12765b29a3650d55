import { BendyError, described } from './errors.js';

/** Returns a file's bytes, not copied. Throws BAD_ARGUMENT for anything else, such as a URL. */
export function asBytes(source: unknown): Uint8Array {
  if (source instanceof Uint8Array) return source;
  if (ArrayBuffer.isView(source)) return new Uint8Array(source.buffer, source.byteOffset, source.byteLength);
  const tag = Object.prototype.toString.call(source); // also for an ArrayBuffer of another frame
  if (tag === '[object ArrayBuffer]' || tag === '[object SharedArrayBuffer]') return new Uint8Array(source as ArrayBuffer);
  const found =
    typeof source === 'string' || source instanceof URL
      ? `the address ${JSON.stringify(String(source))}, which only Model.open fetches: await (await fetch(address)).arrayBuffer()`
      : described(source) + whereBytesAre(source);
  throw new BendyError('bad_argument', `expected the bytes of a file, an ArrayBuffer or a Uint8Array, found ${found}`);
}

/** What to do with an object that has the bytes of a file. */
function whereBytesAre(source: unknown): string {
  if (typeof source !== 'object' || source === null || source instanceof Promise) return '';
  if ('bytes' in source && source.bytes instanceof Uint8Array) return ', whose `bytes` are the file: pass those';
  if ('arrayBuffer' in source) return ', which is not its bytes: await its arrayBuffer() first';
  return '';
}
