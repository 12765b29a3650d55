// Gives `bendy/tools` of the npm package mutated seeds and random options: each call answers, or rejects with a BendyError.
//   node tests/fuzz/fuzz_tools.mjs SECONDS [SEED]    after scripts/web.sh, and scripts/fuzz.sh for the seeds
// An input that does neither goes to build/fuzz/findings.
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import * as tools from '../../bindings/web/dist/tools/index.js';

const root = fileURLToPath(new URL('../..', import.meta.url));
const seconds = Number(process.argv[2] ?? 10);
const seed = Number(process.argv[3] ?? 1);
const longest = 60_000; // ms

let state = seed >>> 0 || 1;
/** An integer below `count`; the same numbers for the same seed. */
function below(count) {
  state ^= state << 13;
  state ^= state >>> 17;
  state ^= state << 5;
  return (state >>> 0) % count;
}
const oneOf = (items) => items[below(items.length)];
const sometimes = (options) => Object.fromEntries(Object.entries(options).filter(() => below(3) === 0));

const seeds = {};
for (const kind of ['bendy', 'bvh', 'convert', 'md2', 'rig', 'text', 'x']) {
  const folder = join(root, 'build/fuzz/seeds', kind);
  seeds[kind] = readdirSync(folder).map((name) => new Uint8Array(readFileSync(join(folder, name))));
}

const numbers = [0, 1, 2, 3, 4, 0x7f, 0x80, 0xff, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff, 0x7f800000, 0x7fc00000];

/** A seed with a few changed bits, numbers, lengths or pieces of another seed. */
function mutated(kind) {
  let bytes = oneOf(seeds[kind]).slice();
  for (let changes = below(4); changes > 0 && bytes.length > 8; --changes) {
    const at = below(bytes.length - 4);
    const other = oneOf(seeds[kind]);
    switch (below(5)) {
      case 0:
        bytes[at] ^= 1 << below(8);
        break;
      case 1:
        new DataView(bytes.buffer).setUint32(at, oneOf(numbers), true);
        break;
      case 2:
        bytes = bytes.slice(0, at);
        break;
      case 3:
        bytes = bytes.slice(0, at + below(64)).slice();
        bytes.set(other.subarray(0, Math.min(other.length, bytes.length - at)), Math.min(at, bytes.length));
        break;
      default:
        bytes = Uint8Array.from([...bytes.subarray(0, at), ...other.subarray(0, below(256)), ...bytes.subarray(at + below(64))]);
    }
  }
  return bytes;
}

const text = (kind) => new TextDecoder().decode(mutated(kind));
const name = () => oneOf(['Hips', '#1', '*', 'clip:*', 'mesh:*', 'textures', 'lod', '', '\u202e', 'a\0b', 'x'.repeat(300)]);
const convertOptions = () =>
  sometimes({
    compact: oneOf([true, '0.1mm', '50%', '1e-30m', 'x']),
    lod: true,
    autoRig: true,
    autoSkin: true,
    skeleton: name(),
    rig: text('rig'),
    keepOrder: true,
    images: 'link',
    scene: oneOf([0, 7, name()]),
    instances: true,
    mergeClips: true,
    ticksPerSecond: oneOf([1, 1e-300, 4800]),
    unit: oneOf([1, 1e-300, 0.0254]),
  });

/** Each call, and what it is made with, for a finding. */
const calls = {
  convert: () => [mutated(oneOf(['convert', 'x', 'md2', 'bvh', 'bendy'])), convertOptions()],
  validate: () => [mutated('bendy')],
  inspect: () => [mutated('bendy')],
  summary: () => [mutated('bendy')],
  inspectPage: () => [mutated('bendy'), name()],
  dump: () => [mutated('bendy'), sometimes({ decode: true, ignoreSums: true })],
  assemble: () => [text('text'), sometimes({ allowInvalid: true })],
  strip: () => [mutated('bendy'), name()],
  rename: () => [mutated('bendy'), oneOf(['joints', 'clips', 'meshes', 'x']), { [name()]: name() }, sometimes({ allMustMatch: false })],
  mergeClips: () => [mutated('bendy'), mutated('bendy'), sometimes({ sameName: oneOf(['error', 'replace', 'number']) })],
  extract: () => [mutated('bendy'), name()],
  exportModel: () => [mutated('bendy'), oneOf(['glb', 'gltf', 'x', 'y']), sometimes({ name: name(), lod: oneOf([0.5, 0, NaN, 2]) })],
  diff: () => [mutated('bendy'), mutated('bendy'), sometimes({ tolerance: oneOf(['1mm', '5%', '']) })],
};

function keep(tool, given, why) {
  const folder = join(root, 'build/fuzz/findings');
  mkdirSync(folder, { recursive: true });
  given.forEach((one, number) => {
    const data = one instanceof Uint8Array ? one : typeof one === 'string' ? one : JSON.stringify(one);
    writeFileSync(join(folder, `tools-${tool}-${number}`), data);
  });
  console.error(`${tool}: ${why}; its arguments are in build/fuzz/findings/tools-${tool}-*`);
  process.exitCode = 1;
}

const count = { answered: 0, refused: 0 };
const end = performance.now() + seconds * 1000;
while (performance.now() < end && process.exitCode === undefined) {
  const tool = oneOf(Object.keys(calls));
  const given = calls[tool]();
  const began = performance.now();
  try {
    const answer = await tools[tool](...given);
    ++count.answered;
    if (tool === 'convert' && (await tools.validate(answer.bytes)).faults.length > 0) keep(tool, given, 'an invalid file');
  } catch (error) {
    ++count.refused;
    const isOurs = error instanceof tools.BendyError && !['out_of_memory', 'stopped'].includes(error.kind);
    if (!isOurs) keep(tool, given, `${error.name}: ${error.message}`);
  }
  if (performance.now() - began > longest) keep(tool, given, 'more than a minute');
}
console.log(`tools          ${count.answered} calls answered, ${count.refused} refused${process.exitCode === undefined ? ', nothing found' : ''}`);
