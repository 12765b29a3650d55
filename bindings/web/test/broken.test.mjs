// Broken files and wrong calls throw; nothing traps.
import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { BendyError, Model } from '../dist/index.js';
import { corpusFile, example, plain, read, repository, simd } from './helpers.mjs';

const stored = join(repository, 'tests/compat/0.1');
const files = readdirSync(stored).filter((name) => name.endsWith('.bendy'));
const kinds = ['malformed', 'invalid', 'unsupported', 'out_of_memory'];

/** Opens bytes and, if they are good after all, uses the model. Returns the error. */
function attempt(bytes, runtime, options = {}) {
  try {
    const model = Model.openSync(bytes, { ...options, runtime });
    const pose = model.pose();
    for (const clip of model.clips) pose.sample(clip, clip.start + 0.3 * clip.seconds);
    pose.skin({ normals: true });
    pose.dispose();
    model.dispose();
    return undefined;
  } catch (error) {
    assert.ok(error instanceof BendyError, `${error.stack}`);
    assert.ok(kinds.includes(error.kind), error.message);
    return error;
  }
}

/** Numbers that look random, the same in every run. */
function randomNumbers(seed) {
  let state = seed;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

for (const runtime of [simd, plain]) {
  const name = runtime.kernel;

  test(`files of released versions open: ${name}`, () => {
    for (const file of files) {
      const error = attempt(read(join(stored, file)), runtime);
      // Two have no object.
      if (/smallest|unknown/.test(file)) assert.equal(error.code, 'CHUNK_MISSING');
      else assert.equal(error, undefined, file);
    }
  });

  test(`every truncated file is refused, with its place: ${name}`, () => {
    for (const file of files) {
      const bytes = read(join(stored, file));
      const step = Math.max(1, Math.floor(bytes.length / 100));
      for (let size = 0; size < bytes.length; size += step) {
        const error = attempt(bytes.subarray(0, size), runtime);
        assert.equal(error?.kind, 'malformed', `${file} ${size}`);
        if (size >= 24) assert.equal(error.path, 'HEAD');
      }
    }
  });

  test(`flipped bytes throw or do no harm: ${name}`, () => {
    for (const file of files) {
      const good = read(join(stored, file));
      const random = randomNumbers(good.length);
      for (let round = 0; round < 150; ++round) {
        const bytes = good.slice();
        for (let flips = 0; flips < 1 + (round % 4); ++flips) bytes[random(bytes.length)] ^= 1 << random(8);
        assert.notEqual(attempt(bytes, runtime), undefined); // the sums differ
        attempt(bytes, runtime, { checkSums: false });
      }
    }
  });
}

test('an error says what, in which chunk and where', () => {
  const bytes = read(join(stored, 'mannequin_compact.bendy'));
  bytes[bytes.length - 20] ^= 0xff;
  const error = attempt(bytes, simd);
  assert.equal(error.code, 'SUM_MISMATCH');
  assert.match(error.path, /^HEAD\/TEXT/);
  assert.ok(error.offset > 0 && error.offset < bytes.length);
  assert.match(error.message, new RegExp(`offset ${error.offset}`));
  const model = Model.openSync(bytes, { runtime: simd, checkSums: false });
  assert.throws(() => model.checkSums(), { code: error.code, path: error.path, offset: error.offset });
  model.dispose();
});

test('what is no bendy file is said so', async (t) => {
  for (const text of ['', 'glTF', 'a text that is long enough to have a header']) {
    const error = attempt(new TextEncoder().encode(text), simd);
    assert.equal(error.kind, 'malformed');
  }
  const glb = corpusFile('models/fox.glb');
  if (glb === undefined) return t.diagnostic('the corpus is not there');
  assert.equal(attempt(read(glb), simd).code, 'NOT_A_BENDY_FILE');
});

test('use after dispose throws', () => {
  const model = Model.openSync(read(join(stored, 'character.bendy')), { runtime: simd });
  const pose = model.pose();
  model.dispose();
  model.dispose();
  assert.ok(model.disposed);
  assert.throws(() => model.pose(), { code: 'DISPOSED' });
  assert.throws(() => model.materials, { code: 'DISPOSED' });
  pose.sample(0, 0).skin(); // a pose keeps what it needs
  pose.palette(model.meshes.find((mesh) => !mesh.isRigid));
  const { locals } = pose;
  assert.ok(locals.length > 0);
  pose.dispose();
  for (const use of [() => pose.sample(0, 0), () => pose.skin(), () => pose.locals, () => pose.copy()]) {
    assert.throws(use, { code: 'DISPOSED' });
  }
});

test('running out of memory throws, and the module stays usable', () => {
  const bytes = read(example('mannequin'));
  const model = Model.openSync(bytes, { runtime: plain });
  const taken = [];
  // The memory that is left is taken, first in large pieces, so that the allocations of the C++ code fail, too.
  for (let size = 2 ** 30; size >= 2 ** 8; size /= 2) {
    try {
      for (;;) taken.push(plain.allocate(size));
    } catch (error) {
      assert.equal(error.code, 'OUT_OF_MEMORY');
    }
  }
  assert.throws(() => model.pose(), { code: 'OUT_OF_MEMORY' });
  assert.throws(() => Model.openSync(bytes, { runtime: plain }), { code: 'OUT_OF_MEMORY' });
  // One more piece at a time until opening succeeds: each failure on the way is an allocation that failed.
  let failures = 0;
  let again;
  while (again === undefined) {
    try {
      again = Model.openSync(bytes, { runtime: plain });
    } catch (error) {
      assert.equal(error.code, 'OUT_OF_MEMORY');
      ++failures;
      plain.release(taken.pop());
    }
  }
  assert.ok(failures > 5, `${failures} failures`);
  for (const at of taken) plain.release(at);
  assert.equal(again.sample('Walk', 0.3).skin().positions.length, 3 * again.vertexCount);
  again.dispose();
  model.dispose();
});
