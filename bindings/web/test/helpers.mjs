// What the tests share: characters, the native program and both modules.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { loadRuntime } from '../dist/index.js';

export const repository = fileURLToPath(new URL('../../..', import.meta.url));
export const program = process.env.BENDY_PROGRAM ?? join(repository, 'build/release/cli/bendy');
const corpus = join(repository, '../shared/corpus/visible');

export const folder = mkdtempSync(join(tmpdir(), 'bendy-web-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));

/** Runs the program. `kernel`: which arithmetic it uses. */
export function bendy(args, kernel = '') {
  return execFileSync(program, args, { cwd: folder, stdio: ['ignore', 'pipe', 'pipe'], env: { ...process.env, BENDY_KERNEL: kernel } });
}

let made = 0;

/** Converts a file and returns the path of the result. */
export function convert(file, ...options) {
  const output = join(folder, `${made++}.bendy`);
  bendy(['convert', file, '-o', output, ...options]);
  return output;
}

export function example(name, ...options) {
  return convert(join(repository, 'examples', `${name}.glb`), ...options);
}

/** A file of the corpus, or undefined if the corpus is not there. */
export function corpusFile(name) {
  const file = join(corpus, name);
  return existsSync(file) ? file : undefined;
}

export function read(file) {
  return new Uint8Array(readFileSync(file));
}

/** Both modules, each with a memory of its own. */
export const simd = await loadRuntime({ simd: true });
export const plain = await loadRuntime({ simd: false });

/** The largest difference between numbers of two lists. NaN if one has NaN. */
export function difference(a, b) {
  if (a.length !== b.length) throw new Error(`${a.length} numbers, expected ${b.length}`);
  let most = 0;
  for (let i = 0; i < a.length; ++i) most = Math.max(most, Math.abs(a[i] - b[i]));
  return most;
}

/** The largest absolute number of a list, at least 1. */
export function extent(numbers) {
  return numbers.reduce((most, number) => Math.max(most, Math.abs(number)), 1);
}
