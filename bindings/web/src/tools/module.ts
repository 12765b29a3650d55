import { BendyError, type ErrorKind } from '../errors.js';
import { compileModule, ioError } from '../fetch.js';
import { decodeModule } from '../load.js';

/** @internal The part of emscripten's file system that is used here. */
interface FileSystem {
  filesystems: { MEMFS: unknown };
  mkdir(path: string): void;
  mkdirTree(path: string): void;
  mount(type: unknown, options: object, path: string): void;
  unmount(path: string): void;
  chdir(path: string): void;
  writeFile(path: string, data: Uint8Array | string): void;
  readFile(path: string): Uint8Array<ArrayBuffer>;
  unlink(path: string): void;
}

interface Instance {
  FS: FileSystem;
  memory: WebAssembly.Memory;
  progress?: (share: number) => void;
  _bendy_tools_run(): number;
}

/** @internal The result of a tool: its answer, and the files that it made. */
export interface Answer<T> {
  answer: T;
  made: { name: string; bytes: Uint8Array<ArrayBuffer> }[];
}

/** @internal Files by the names that the request uses. */
export type Inputs = Record<string, Uint8Array | string>;

interface ErrorAnswer {
  error?: { kind: ErrorKind; code: string; message: string; path: string; offset: number };
  made: string[];
}

// An instance's memory never shrinks, so a large one is not used again.
const mostMemory = 256 * 2 ** 20;

let compiling: Promise<WebAssembly.Module> | undefined;
let starting: Promise<Instance> | undefined;

async function compile(): Promise<WebAssembly.Module> {
  const embedded = await import('../generated/tools.js');
  return compileModule(decodeModule(embedded.default));
}

async function start(): Promise<Instance> {
  compiling ??= compile();
  const [module, glue] = await Promise.all([compiling, import('../generated/tools_glue.js')]);
  let memory: WebAssembly.Memory | undefined;
  const instance = await new Promise<Instance>((resolve, reject) => {
    const made = glue.default({
      instantiateWasm(imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance) => void): object {
        const started = WebAssembly.instantiate(module, imports).then((instance) => {
          memory = Object.values(instance.exports).find((one) => one instanceof WebAssembly.Memory);
          done(instance);
        });
        started.catch(reject); // emscripten would wait for ever
        return {};
      },
      print() {},
      printErr() {},
    }) as Promise<Instance>;
    made.then(resolve, reject);
  });
  instance.memory = memory!;
  instance.FS.mkdir('/given');
  return instance;
}

function load(): Promise<Instance> {
  starting ??= start().catch((error: unknown) => {
    compiling = starting = undefined;
    throw error instanceof BendyError ? error : ioError('the module of the tools cannot be started', error);
  });
  return starting;
}

/** @internal The size of the module's memory, bytes; 0 if it is not loaded. */
export async function memorySize(): Promise<number> {
  return starting === undefined ? 0 : (await starting).memory.buffer.byteLength;
}

function checkName(name: string): void {
  const steps = name.split('/');
  if (name === '' || name.includes('\0') || steps.some((step) => step === '' || step === '.' || step === '..')) {
    throw new BendyError('bad_argument', `${JSON.stringify(name)} is not a valid file name: it must be relative, without . and ..`);
  }
}

function writeInputs(files: FileSystem, inputs: Inputs): void {
  for (const [name, content] of Object.entries(inputs)) {
    checkName(name);
    const folder = name.lastIndexOf('/');
    if (folder > 0) files.mkdirTree(`/given/${name.slice(0, folder)}`);
    files.writeFile(`/given/${name}`, content);
  }
}

function runOn<T>(instance: Instance, request: object, inputs: Inputs): Answer<T> {
  const files = instance.FS;
  for (const folder of ['/given', '/made']) {
    if (folder === '/made') files.mkdirTree(folder);
    files.mount(files.filesystems.MEMFS, {}, folder);
  }
  try {
    files.chdir('/given');
    writeInputs(files, inputs);
    files.writeFile('/request.json', JSON.stringify(request));
    if (instance._bendy_tools_run() !== 0) throw new BendyError('out_of_memory', 'there is not enough memory');
    const answer = JSON.parse(new TextDecoder().decode(files.readFile('/answer.json'))) as T & ErrorAnswer;
    if (answer.error !== undefined) {
      const { kind, message, code, path, offset } = answer.error;
      throw new BendyError(kind, message, code, path, offset);
    }
    const made = answer.made.map((name, number) => ({ name, bytes: files.readFile(`/made/${number}`) }));
    return { answer, made };
  } finally {
    files.chdir('/');
    for (const folder of ['/given', '/made']) files.unmount(folder);
  }
}

/** @internal Runs a tool of bindings/web/tools/tools.cpp. */
export async function runTool<T>(request: object, inputs: Inputs, progress?: (share: number) => void): Promise<Answer<T>> {
  const instance = await load();
  let thrown: { error: unknown } | undefined;
  instance.progress = (share) => {
    try {
      if (thrown === undefined) progress?.(share);
    } catch (error) {
      thrown = { error };
    }
  };
  try {
    const answer = runOn<T>(instance, progress === undefined ? request : { ...request, progress: true }, inputs);
    if (thrown !== undefined) throw thrown.error;
    return answer;
  } catch (error) {
    if (error instanceof BendyError || error === thrown?.error) throw error;
    starting = undefined; // after a trap the instance's memory is in an unknown state
    const kind = error instanceof RangeError ? 'out_of_memory' : 'stopped';
    throw Object.assign(new BendyError(kind, `the module has stopped: ${String(error)}`), { cause: error });
  } finally {
    if (instance.memory.buffer.byteLength > mostMemory) starting = undefined;
  }
}
