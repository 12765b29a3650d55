// Memory is given back; views survive its growth.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Binding, Bounds, CrossFade, Crowd, LevelOfDetail, loadRuntime, Model, Playback, RootPath } from '../dist/index.js';
import { example, plain, read, simd } from './helpers.mjs';

test('memory does not grow over 200 rounds', () => {
  const bytes = read(example('mannequin', '--compact', '--lod'));
  for (const runtime of [simd, plain]) {
    let size = 0;
    for (let round = 0; round < 200; ++round) {
      const model = Model.openSync(bytes, { runtime });
      const pose = model.sample('Walk', 0.3);
      pose.skin({ normals: true, tangents: true, method: 'dual_quaternion' });
      pose.palette(0);
      void model.meshes[0].positions;
      const made = [pose, pose.copy(), new LevelOfDetail(model, 0.5), new Bounds(model), new Playback(model, 'Walk'), new CrossFade(model),
        new RootPath(model, 0), new Binding(model, model), new Crowd(model, 3, { positions: true })];
      const order = round % 2 === 0 ? [model, ...made] : [...made, model];
      for (const object of order) object.dispose();
      assert.throws(() => Model.openSync(bytes.subarray(0, bytes.length - 1), { runtime }));
      if (round === 2) size = runtime.memorySize;
    }
    assert.equal(runtime.memorySize, size);
  }
});

test('views are valid again after the memory has grown', async () => {
  const runtime = await loadRuntime();
  const model = await Model.open(read(example('mannequin')), { runtime });
  const pose = model.sample('Walk', 0.3);
  const skinned = pose.skin({ normals: true });
  const positions = skinned.positions;
  assert.equal(skinned.positions, positions); // the same object: nothing is allocated
  const copy = positions.slice();
  const matrices = pose.modelMatrices().slice();
  runtime.release(runtime.allocate(64 * 2 ** 20));
  assert.equal(positions.length, 0); // detached by the engine
  assert.deepEqual(skinned.positions, copy);
  assert.deepEqual(pose.modelMatrices(), matrices);
  assert.equal(pose.skin().normals.length, copy.length);
  assert.throws(() => pose.skin().tangents, { code: 'BAD_ARGUMENT' });
});

test('using, where the language has it', () => {
  const model = Model.openSync(read(example('tentacle')), { runtime: simd });
  if (Symbol.dispose === undefined) return;
  model[Symbol.dispose]();
  assert.ok(model.disposed);
});

test('sampling, blending, palettes and skinning do not allocate in the module', () => {
  const model = Model.openSync(read(example('mannequin')), { runtime: simd });
  const pose = model.pose();
  const other = model.sample('Idle', 0);
  pose.skin({ normals: true });
  const options = { normals: true };
  const { functions } = simd;
  const views = [pose.palette(0), pose.modelMatrices(), pose.skin(options).positions];
  // A block that malloc gives out, and gives out again if nothing was allocated in between.
  const block = functions.malloc(1000);
  functions.free(block);
  for (let frame = 0; frame < 100; ++frame) {
    pose.sample('Walk', frame / 60).blend(other, 0.5);
    assert.equal(pose.palette(0), views[0]);
    assert.equal(pose.modelMatrices(), views[1]);
    assert.equal(pose.skin(options).positions, views[2]);
  }
  assert.equal(functions.malloc(1000), block);
  functions.free(block);
  model.dispose();
});
