// Files from an address, and modules from them. Whatever goes wrong is a BendyError of kind `io`.
import { BendyError } from './errors.js';

/** An error of kind `io` for a failure that the engine has reported, which becomes its cause. */
export function ioError(what: string, cause: unknown): BendyError {
  const why = cause instanceof Error ? cause.message : String(cause);
  return Object.assign(new BendyError('io', `${what}: ${why}`), { cause });
}

/** Fetches a file. Throws IO, also for a status other than 200 to 299. */
export async function fetchFile(address: string | URL): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(address);
  } catch (error) {
    const isFile = typeof location === 'undefined' && !/^(https?|data|blob):/i.test(String(address));
    const hint = isFile ? ' (this engine fetches no files of a disk: read it, and pass its bytes)' : '';
    throw ioError(`${String(address)} cannot be fetched${hint}`, error);
  }
  if (!response.ok) throw new BendyError('io', `${String(address)}: ${response.status} ${response.statusText}`.trimEnd());
  return response;
}

/** Fetches the bytes of a file. Throws IO. */
export async function fetchBytes(address: string | URL): Promise<ArrayBuffer> {
  const response = await fetchFile(address);
  return response.arrayBuffer().catch((error: unknown) => {
    throw ioError(`${String(address)} cannot be fetched`, error);
  });
}

/** Compiles a module: while it arrives, if it comes from an address and the server calls it application/wasm. Throws IO. */
export async function compileModule(wasm: BufferSource | string | URL): Promise<WebAssembly.Module> {
  const isAddress = typeof wasm === 'string' || wasm instanceof URL;
  const name = isAddress ? `the WebAssembly module ${String(wasm)}` : 'the WebAssembly module';
  const response = isAddress ? await fetchFile(wasm) : undefined;
  try {
    if (response === undefined) return await WebAssembly.compile(wasm as BufferSource);
    const isStreamed = response.headers.get('content-type')?.split(';')[0] === 'application/wasm';
    return await (isStreamed ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer()));
  } catch (error) {
    throw ioError(`${name} cannot be compiled`, error);
  }
}
