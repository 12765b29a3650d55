// What the tests share: characters, the native program and both modules.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
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

/** Converts an example whose clips have these extras, or none, and returns the path of the result. */
export function exampleWithClipExtras(name, extras) {
  const glb = readFileSync(join(repository, 'examples', `${name}.glb`));
  const rest = 20 + glb.readUInt32LE(12);
  const gltf = JSON.parse(glb.subarray(20, rest));
  for (const animation of gltf.animations) animation.extras = extras;
  const text = JSON.stringify(gltf);
  const json = Buffer.from(text.padEnd(4 * Math.ceil(text.length / 4)));
  const head = Buffer.from(glb.subarray(0, 20));
  head.writeUInt32LE(20 + json.length + glb.length - rest, 8);
  head.writeUInt32LE(json.length, 12);
  const file = join(folder, `${made++}.glb`);
  writeFileSync(file, Buffer.concat([head, json, glb.subarray(rest)]));
  return convert(file);
}

/** The bytes of a bendy file whose images are these links, one for each material. */
export function linking(links) {
  const bytes = Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1]).buffer);
  const gltf = {
    asset: { version: '2.0' },
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: links.map((_, k) => ({ attributes: { POSITION: 0, TEXCOORD_0: 1 }, material: k })) }],
    materials: links.map((_, k) => ({ pbrMetallicRoughness: { baseColorTexture: { index: k } } })),
    textures: links.map((_, k) => ({ source: k })),
    images: links.map((_, k) => ({ uri: `link_${k}_.png` })),
    accessors: [
      { bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 0] },
      { bufferView: 1, componentType: 5126, count: 3, type: 'VEC2' },
    ],
    bufferViews: [{ buffer: 0, byteLength: 36 }, { buffer: 0, byteOffset: 36, byteLength: 24 }],
    buffers: [{ byteLength: 60, uri: `data:;base64,${bytes.toString('base64')}` }],
  };
  const [source, named, text, linked] = ['gltf', 'bendy', 'json', 'bendy'].map((suffix) => join(folder, `${made++}.${suffix}`));
  writeFileSync(source, JSON.stringify(gltf));
  bendy(['convert', '-q', source, '--images', 'link', '-o', named]);
  // Conversion would rewrite some of them.
  bendy(['dump', named, '-o', text]);
  writeFileSync(text, readFileSync(text, 'utf8').replace(/"link_(\d+)_.png"/g, (_, k) => JSON.stringify(links[k])));
  bendy(['assemble', text, '-o', linked, '--allow-invalid']);
  return read(linked);
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
