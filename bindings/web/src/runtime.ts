/// <reference lib="esnext.disposable" preserve="true" />
import { BendyError, described, type ErrorKind } from './errors.js';
import { Calls, errorLayout, type Functions, readBendyError } from './generated/bindings.js';
import type { Model } from './model.js';
import { component, type Numbers } from './numbers.js';

/** "None", for any index that a function of the module takes or returns. */
export const none = 0xffffffff;

const decoder = new TextDecoder();
const encoder = new TextEncoder();
const scratchSize = 512;
const alignment = 16;

/**
 * An instance of the WebAssembly module, with a memory of its own. `init` makes the one that everything uses by default;
 * `loadRuntime` makes others, for instance to keep characters apart or to give back all memory at once.
 *
 * Its memory grows up to 2 GiB and never shrinks. When it grows, JavaScript detaches every typed array that views it, so do not
 * keep such an array across a call that may allocate: ask for it again, which costs nothing.
 */
export class Runtime {
  /** Whether this is the module with SIMD instructions. */
  readonly simd: boolean;
  /** @internal */
  readonly functions: Functions;
  /** @internal The memory that receives errors. */
  readonly error: number;
  /** @internal */
  readonly calls: Calls;
  /** @internal 512 bytes for the arguments of `calls`, valid until the next call. */
  readonly scratch: number;
  /** @internal 512 bytes for a struct or a few numbers whose address is passed to `calls`. */
  readonly spare: number;
  #view: DataView;
  #bytes: Uint8Array<ArrayBuffer>;

  /** @internal */
  constructor(functions: Functions, simd: boolean) {
    this.functions = functions;
    this.simd = simd;
    this.#view = new DataView(functions.memory.buffer);
    this.#bytes = new Uint8Array(functions.memory.buffer);
    this.calls = new Calls(this);
    this.error = this.allocate(errorLayout.size);
    this.scratch = this.allocate(2 * scratchSize);
    this.spare = this.scratch + scratchSize;
  }

  /** The size of the module's memory in bytes, whether in use or not. */
  get memorySize(): number {
    return this.functions.memory.buffer.byteLength;
  }

  /** The version of the runtime: "0.1.0". */
  get version(): string {
    return this.calls.bendy_version_string();
  }

  /** The name of the arithmetic in use: "wasm" for SIMD, or "plain". */
  get kernel(): string {
    return this.calls.bendy_kernel();
  }

  /** @internal */
  get view(): DataView {
    if (this.#view.buffer !== this.functions.memory.buffer) this.#view = new DataView(this.functions.memory.buffer);
    return this.#view;
  }

  /** @internal */
  get bytes(): Uint8Array<ArrayBuffer> {
    if (this.#bytes.buffer !== this.functions.memory.buffer) this.#bytes = new Uint8Array(this.functions.memory.buffer);
    return this.#bytes;
  }

  /** @internal Returns bytes on a 16-byte boundary. Throws OUT_OF_MEMORY. */
  allocate(size: number): number {
    if (size > 0x7fff0000) throw this.outOfMemory();
    const at = this.functions.malloc(size + alignment);
    if (at === 0) throw this.outOfMemory();
    // The byte before the aligned address is the distance from the allocated one, 1 to 16.
    const aligned = (at + alignment) & -alignment;
    this.bytes[aligned - 1] = aligned - at;
    return aligned;
  }

  /** @internal */
  release(at: number): void {
    this.functions.free(at - this.bytes[at - 1]!);
  }

  /** @internal Calls a function with `size` bytes that are released afterwards. */
  borrow<T>(size: number, call: (at: number) => T): T {
    const at = this.allocate(size);
    try {
      return call(at);
    } finally {
      this.release(at);
    }
  }

  /** @internal Calls a function with the text in the module's memory, zero-terminated. */
  withText<T>(text: string, call: (at: number) => T): T {
    const bytes = encoder.encode(text);
    return this.borrow(bytes.length + 1, (at) => {
      this.bytes.set(bytes, at);
      this.bytes[at + bytes.length] = 0;
      return call(at);
    });
  }

  /** @internal The zero-terminated text at an address; "" for none. */
  text(at: number): string {
    if (at === 0) return '';
    return decoder.decode(this.bytes.subarray(at, this.bytes.indexOf(0, at)));
  }

  /** @internal JSON of a file, which the format does not check, at an address; null for none. */
  json(at: number): unknown {
    const text = this.text(at);
    if (text === '') return null;
    try {
      return JSON.parse(text) as unknown;
    } catch {
      return text;
    }
  }

  /** @internal A struct that begins with its size, all other fields 0. */
  struct(layout: { size: number }, at: number): number {
    this.bytes.fill(0, at, at + layout.size);
    this.view.setUint32(at, layout.size, true);
    return at;
  }

  /** @internal The address of an object, 0 for none. Throws DISPOSED; BAD_ARGUMENT for an object of another runtime. */
  address(object: Handle | null | undefined, name: string): number {
    if (object == null) return 0;
    if (object.runtime === this) return object.handle;
    throw new BendyError('bad_argument', `the ${name} belongs to another model, in another runtime`);
  }

  /** @internal The number of a word in an enumeration. */
  word<T extends string>(words: readonly T[], word: T, name: string): number {
    const number = words.indexOf(word);
    if (number < 0) throw new BendyError('bad_argument', `${name} ${JSON.stringify(word)} is none of ${words.join(', ')}`);
    return number;
  }

  /** @internal */
  putWord<T extends string>(at: number, words: readonly T[], word: T, name: string): void {
    this.view.setUint32(at, this.word(words, word, name), true);
  }

  /** @internal */
  putWhole(at: number, number: number, name: string): void {
    if (!Number.isInteger(number) || number < 0 || number > none) {
      throw new BendyError('bad_argument', `${name} is ${described(number)}, not a whole number from 0`);
    }
    this.view.setUint32(at, number, true);
  }

  /** @internal Writes numbers to an address. */
  putFloats(at: number, numbers: Numbers, count: number, name: string): number {
    const { view } = this;
    for (let i = 0; i < count; ++i) view.setFloat32(at + 4 * i, component(numbers, i, count, name), true);
    return at;
  }

  /** @internal */
  putDoubles(at: number, numbers: Numbers, count: number, name: string): number {
    const { view } = this;
    for (let i = 0; i < count; ++i) view.setFloat64(at + 8 * i, component(numbers, i, count, name), true);
    return at;
  }

  /** @internal A copy of numbers at an address. */
  copyFloats(at: number, count: number): Float32Array<ArrayBuffer> {
    return new Float32Array(this.functions.memory.buffer, at, count).slice();
  }

  /** @internal */
  copyDoubles(at: number, count: number): Float64Array<ArrayBuffer> {
    return new Float64Array(this.functions.memory.buffer, at, count).slice();
  }

  /** @internal */
  copyIntegers(at: number, count: number): Uint32Array<ArrayBuffer> {
    return count === 0 ? new Uint32Array(0) : new Uint32Array(this.functions.memory.buffer, at, count).slice();
  }

  /** @internal A copy of indices, -1 for none. */
  copyIndices(at: number, count: number): Int32Array<ArrayBuffer> {
    return new Int32Array(this.copyIntegers(at, count).buffer);
  }

  /** @internal Throws the error of a call that returned a status other than 0. */
  check(status: number): void {
    if (status !== 0) throw this.failure();
  }

  /** @internal Throws the error of a call that returned no object. */
  checkHandle(handle: number): number {
    if (handle === 0) throw this.failure();
    return handle;
  }

  private failure(): BendyError {
    const { status, code, message, offset } = readBendyError(this, this.error);
    // A fault in a file ends with its place: "... (HEAD/OBJE, offset 120)".
    const path = /\((HEAD.*), offset \d+\)$/.exec(message)?.[1] ?? '';
    return new BendyError(status as ErrorKind, message, code, path, offset);
  }

  private outOfMemory(): BendyError {
    return new BendyError('out_of_memory', 'there is not enough memory');
  }
}

/** Numbers in the module's memory that are viewed repeatedly. */
export class FloatBuffer {
  readonly at: number;
  readonly length: number;
  readonly #runtime: Runtime;
  #array: Float32Array<ArrayBuffer>;

  constructor(runtime: Runtime, length: number) {
    this.#runtime = runtime;
    this.length = length;
    this.at = runtime.allocate(4 * length);
    this.#array = new Float32Array(runtime.functions.memory.buffer, this.at, length);
  }

  /** A view that is currently valid: made anew only if the memory has grown. */
  get array(): Float32Array<ArrayBuffer> {
    const buffer = this.#runtime.functions.memory.buffer;
    if (this.#array.buffer !== buffer) this.#array = new Float32Array(buffer, this.at, this.length);
    return this.#array;
  }
}

/** The memory that an object owns in the module, and how to release it. */
class Owned {
  readonly releases: (() => void)[] = [];
  isDisposed = false;

  dispose(): void {
    this.isDisposed = true;
    for (const release of this.releases.splice(0).reverse()) release();
  }
}

// A safety net for objects that are never disposed.
const forgotten = new FinalizationRegistry<Owned>((owned) => owned.dispose());

/** An object in the module's memory. */
export abstract class Handle {
  /** The instance of the module that contains it. */
  readonly runtime: Runtime;
  readonly #owned = new Owned();
  readonly #handle: number;

  /** @internal */
  protected constructor(runtime: Runtime, handle: number, free: (handle: number) => void) {
    // `new Model(bytes)` in JavaScript: it would fail when the garbage collector frees it, and end the program.
    if (typeof handle !== 'number') throw new BendyError('bad_argument', `new ${new.target.name}() is not for callers: use Model.open()`);
    this.runtime = runtime;
    this.#handle = handle;
    this.#owned.releases.push(() => free(handle));
    forgotten.register(this, this.#owned, this);
  }

  /** @internal The address of the object. Throws DISPOSED. */
  get handle(): number {
    if (this.#owned.isDisposed) throw new BendyError('disposed', `this ${this.constructor.name} has been disposed`);
    return this.#handle;
  }

  /** Whether `dispose` has been called. */
  get disposed(): boolean {
    return this.#owned.isDisposed;
  }

  /**
   * Gives back the memory of the object; any further use of it throws DISPOSED. Does nothing the second time. Objects may be
   * disposed in any order: a pose keeps what it needs of its model. `using pose = model.pose()` calls it, too.
   */
  dispose(): void {
    forgotten.unregister(this);
    this.#owned.dispose();
  }

  /** @internal Also runs this function when the object is released. The function must not refer to the object. */
  protected own(release: () => void): void {
    this.#owned.releases.push(release);
  }

  /** @internal Memory that is released with this object. */
  protected ownFloats(length: number): FloatBuffer {
    const { runtime } = this;
    const buffer = new FloatBuffer(runtime, length);
    const { at } = buffer;
    this.own(() => runtime.release(at));
    return buffer;
  }

  /** @internal */
  protected ownBytes(size: number): number {
    const { runtime } = this;
    const at = runtime.allocate(size);
    this.own(() => runtime.release(at));
    return at;
  }
}

export interface Handle extends Disposable {}

/** An object that is made from a model, and uses its file. */
export abstract class OfModel extends Handle {
  readonly model: Model;

  /** @internal */
  protected constructor(model: Model, handle: number, free: (handle: number) => void) {
    super(model.runtime, handle, free);
    this.own(model.useFile());
    this.model = model;
  }
}

// Engines without explicit resource management lack the symbol.
if (Symbol.dispose !== undefined) {
  Object.defineProperty(Handle.prototype, Symbol.dispose, {
    value(this: Handle) {
      this.dispose();
    },
  });
}
