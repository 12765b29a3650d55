import { BendyError } from './errors.js';
import { compileModule, ioError } from './fetch.js';
import type { Functions } from './generated/bindings.js';
import { checkOptions, optionNames } from './options.js';
import { Runtime } from './runtime.js';

/** Options for loading the module. */
export interface LoadOptions {
  /**
   * The WebAssembly module to use instead of the one in this package: its bytes, its address, or the compiled module. It must be
   * of the same version. The package has both as files: `bendy/bendy.wasm`, and without SIMD `bendy/bendy-plain.wasm`. A module
   * from an address is compiled while it arrives.
   */
  wasm?: BufferSource | string | URL | WebAssembly.Module;
  /** Whether to use SIMD; by default, if the engine has it. With `wasm`, it says which instructions that module uses. */
  simd?: boolean;
}

const loadNames = optionNames<LoadOptions>({ wasm: true, simd: true });

// (func (result v128) (i8x16.splat (i32.const 0))) and an instruction that uses it.
const simdModule = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
]);

/** Returns whether this engine has WebAssembly's SIMD instructions. */
export function hasSimd(): boolean {
  return WebAssembly.validate(simdModule);
}

/** @internal Decodes the module from the text that embed.mjs made. */
export function decodeModule(text: string): Uint8Array<ArrayBuffer> {
  const shift = 35;
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i) - shift;
  return bytes;
}

async function compile(wasm: LoadOptions['wasm'], simd: boolean): Promise<WebAssembly.Module> {
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (wasm !== undefined) return compileModule(wasm);
  // In the bundle of one file, bundle.mjs puts the address of the plain module in the place of its text.
  const embedded: { default: string | URL } = await (simd ? import('./generated/simd.js') : import('./generated/plain.js'));
  return compileModule(typeof embedded.default === 'string' ? decodeModule(embedded.default) : embedded.default);
}

/** @internal The module's imports: it has no environment, and its memory is viewed anew before every use. */
export function imports(memory: () => WebAssembly.Memory): WebAssembly.Imports {
  const noEnvironment = (count: number, size: number): number => {
    const view = new DataView(memory().buffer);
    view.setUint32(count, 0, true);
    view.setUint32(size, 0, true);
    return 0;
  };
  return {
    env: { emscripten_notify_memory_growth: () => {} },
    wasi_snapshot_preview1: {
      environ_sizes_get: noEnvironment,
      environ_get: () => 0,
      proc_exit: (status: number) => {
        throw new BendyError('stopped', `the module has ended with status ${status}`);
      },
    },
  };
}

/**
 * Makes an instance of the module, with a memory of its own, for `Model.open`. Throws IO if `wasm` cannot be fetched, or the
 * engine cannot compile it, for instance because a content security policy forbids it.
 */
export async function loadRuntime(options: LoadOptions = {}): Promise<Runtime> {
  checkOptions('init', options, loadNames);
  const simd = options.simd ?? hasSimd();
  const module = await compile(options.wasm, simd);
  let functions: Functions;
  try {
    const instance = await WebAssembly.instantiate(
      module,
      imports(() => functions.memory),
    );
    functions = instance.exports as unknown as Functions;
    functions._initialize();
    return new Runtime(functions, simd);
  } catch (error) {
    throw ioError('the WebAssembly module is not one of this package, or there is no memory for it', error);
  }
}

let starting: Promise<Runtime> | undefined;
let started: Runtime | undefined;

/**
 * Loads the module. `Model.open` does it, too; call it to do it earlier, to choose which module, or before functions that need the
 * module at once, such as `Model.openSync`. A second call returns the same instance; with options it throws BAD_ARGUMENT. After a
 * failure the next call tries again.
 */
export function init(options?: LoadOptions): Promise<Runtime> {
  if (starting !== undefined && options !== undefined) {
    return Promise.reject(new BendyError('bad_argument', 'the module has been loaded before: call init first'));
  }
  starting ??= loadRuntime(options).then(
    (runtime) => (started = runtime),
    (error: unknown) => {
      starting = undefined;
      throw error;
    },
  );
  return starting;
}

/** @internal The default instance, synchronously. */
export function loadedRuntime(): Runtime {
  if (started === undefined) throw new BendyError('bad_argument', 'the module is not loaded yet: await init() first');
  return started;
}
