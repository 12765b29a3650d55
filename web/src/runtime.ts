import { BendyError, type ErrorKind } from './errors.js';
import { type Functions, readBendyError, errorLayout, statusWords } from './generated/bindings.js';

/** "None", for any index that a function of the module takes or returns. */
export const none = 0xffffffff;

const decoder = new TextDecoder();
const encoder = new TextEncoder();
const scratchSize = 1024;
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
  /** @internal Where errors are written. */
  readonly error: number;
  /** @internal 1024 bytes for a struct and a few numbers, until the next call. */
  readonly scratch: number;
  #view: DataView;
  #bytes: Uint8Array<ArrayBuffer>;

  /** @internal */
  constructor(functions: Functions, simd: boolean) {
    this.functions = functions;
    this.simd = simd;
    this.#view = new DataView(functions.memory.buffer);
    this.#bytes = new Uint8Array(functions.memory.buffer);
    this.error = this.allocate(errorLayout.size);
    this.scratch = this.allocate(scratchSize);
  }

  /** The size of the module's memory in bytes, whether in use or not. */
  get memorySize(): number {
    return this.functions.memory.buffer.byteLength;
  }

  /** The name of the arithmetic in use: "wasm" for SIMD, or "plain". */
  get kernel(): string {
    return this.text(this.functions.bendy_kernel());
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
    // The byte before the aligned address says how far it is from the allocated one, 1 to 16.
    const aligned = (at + alignment) & -alignment;
    this.bytes[aligned - 1] = aligned - at;
    return aligned;
  }

  /** @internal */
  release(at: number): void {
    this.functions.free(at - this.bytes[at - 1]!);
  }

  /** @internal Calls with `size` bytes that are released afterwards. */
  borrow<T>(size: number, call: (at: number) => T): T {
    const at = this.allocate(size);
    try {
      return call(at);
    } finally {
      this.release(at);
    }
  }

  /** @internal Calls with the text in the module's memory, zero-terminated. */
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

  /** @internal A struct that begins with its size: in the scratch memory, all other fields 0. */
  struct(layout: { size: number }, at = this.scratch): number {
    this.bytes.fill(0, at, at + layout.size);
    this.view.setUint32(at, layout.size, true);
    return at;
  }

  /** @internal Writes numbers to an address: for what is so small that it is in the scratch memory. */
  putFloats(at: number, numbers: ArrayLike<number>, count: number, name: string): number {
    if (numbers.length !== count) {
      throw new BendyError('bad_argument', `${name} has ${numbers.length} numbers, not ${count}`);
    }
    const view = this.view;
    for (let i = 0; i < count; ++i) view.setFloat32(at + 4 * i, numbers[i]!, true);
    return at;
  }

  /** @internal A copy of numbers at an address. */
  copyFloats(at: number, count: number): Float32Array<ArrayBuffer> {
    return new Float32Array(this.functions.memory.buffer, at, count).slice();
  }

  /** @internal */
  copyIntegers(at: number, count: number): Uint32Array<ArrayBuffer> {
    return count === 0 ? new Uint32Array(0) : new Uint32Array(this.functions.memory.buffer, at, count).slice();
  }

  /** @internal Fetches `count` floats by a call that writes them to an address. */
  fetchFloats(count: number, call: (at: number) => number): Float32Array<ArrayBuffer> {
    return this.borrow(4 * count, (at) => {
      this.check(call(at));
      return this.copyFloats(at, count);
    });
  }

  /** @internal */
  fetchIntegers(count: number, call: (at: number) => number): Uint32Array<ArrayBuffer> {
    return this.borrow(4 * count, (at) => {
      this.check(call(at));
      return this.copyIntegers(at, count);
    });
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
    return new BendyError((statusWords[status] ?? 'io') as ErrorKind, message, code, path, offset);
  }

  private outOfMemory(): BendyError {
    return new BendyError('out_of_memory', 'there is not enough memory');
  }
}

/** Numbers in the module's memory that are viewed again and again. */
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

  /** A view that is valid now: made anew only if the memory has grown. */
  get array(): Float32Array<ArrayBuffer> {
    const buffer = this.#runtime.functions.memory.buffer;
    if (this.#array.buffer !== buffer) this.#array = new Float32Array(buffer, this.at, this.length);
    return this.#array;
  }
}

/** What an object has in the module's memory, and how it is given back. */
class Owned {
  readonly releases: (() => void)[] = [];
  isDisposed = false;

  dispose(): void {
    this.isDisposed = true;
    for (const release of this.releases.splice(0).reverse()) release();
  }
}

// A safety net for objects that nobody disposes.
const forgotten = new FinalizationRegistry<Owned>((owned) => owned.dispose());

/** An object in the module's memory. */
export abstract class Handle {
  /** The instance of the module that has it. */
  readonly runtime: Runtime;
  readonly #owned = new Owned();
  readonly #handle: number;

  /** @internal */
  protected constructor(runtime: Runtime, handle: number, release: () => void) {
    this.runtime = runtime;
    this.#handle = handle;
    this.#owned.releases.push(release);
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

  /** @internal Also releases something else with this object. The function must not refer to the object. */
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

// Engines without explicit resource management have no such symbol.
if (Symbol.dispose !== undefined) {
  Object.defineProperty(Handle.prototype, Symbol.dispose, {
    value(this: Handle) {
      this.dispose();
    },
  });
}
