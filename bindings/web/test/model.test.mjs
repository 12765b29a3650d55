// What a model consists of.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { Model } from '../dist/index.js';
import { bendy, convert, corpusFile, difference, example, folder, plain, read, repository, simd } from './helpers.mjs';

test('joints, clips, chains, constraints and meshes of the mannequin', () => {
  const file = example('mannequin');
  const model = Model.openSync(read(file), { runtime: simd });
  const summary = JSON.parse(bendy(['inspect', file, '--json']).toString());
  assert.ok(JSON.stringify(summary).includes('"Walk"'));
  assert.deepEqual(model.clips.names, ['Idle', 'Walk']);
  assert.deepEqual(model.chains.names, ['IK_LeftArm', 'IK_RightArm', 'IK_LeftLeg', 'IK_RightLeg']);
  assert.equal(model.joints.length, 65);
  assert.equal(model.parents.length, 65);
  model.joints.forEach((joint, number) => {
    assert.equal(joint.number, number);
    assert.ok((joint.parent ?? -1) < number);
    assert.equal(model.parents[number], joint.parent ?? -1);
    assert.ok(Math.abs(Math.hypot(...joint.rest.rotation) - 1) < 1e-5);
    assert.equal(model.pose().local(joint).translation[0], joint.rest.translation[0]);
  });
  const chain = model.chains.get('IK_LeftArm');
  assert.equal(chain.links.length, chain.weights.length);
  for (const [above, below] of chain.links.slice(1).map((joint, k) => [chain.links[k], joint])) {
    assert.equal(model.joints[below].parent, above);
  }
  for (const constraint of model.constraints) {
    assert.ok(model.joints[constraint.joint]);
    constraint.rotationMin.forEach((least, axis) => assert.ok(least <= constraint.rotationMax[axis]));
  }
  let first = 0;
  for (const mesh of model.meshes) {
    assert.equal(mesh.firstVertex, first);
    first += mesh.vertexCount;
    assert.equal(mesh.positions.length, 3 * mesh.vertexCount);
    assert.equal(mesh.normals.length, 3 * mesh.vertexCount);
    assert.equal(mesh.indices.length, mesh.indexCount);
    assert.ok(mesh.indices.every((index) => index < mesh.vertexCount));
    assert.equal(mesh.bones.length, mesh.influenceCount * mesh.vertexCount);
    assert.ok(mesh.bones.every((bone) => bone < mesh.boneCount));
    for (let vertex = 0; vertex < mesh.vertexCount; ++vertex) {
      const weights = mesh.weights.subarray(vertex * mesh.influenceCount, (vertex + 1) * mesh.influenceCount);
      assert.ok(Math.abs(weights.reduce((a, b) => a + b) - 1) < 1e-3);
    }
    assert.equal(mesh.inverseBind.length, 16 * mesh.boneJoints.length);
    assert.throws(() => mesh.movers(), { code: 'BAD_ARGUMENT' });
    for (const uv of mesh.textureCoords) assert.equal(uv.length, 2 * mesh.vertexCount);
    const positions = mesh.streams.find((stream) => stream.kind === 'positions');
    assert.deepEqual(positions.stored(), mesh.positions);
  }
  assert.equal(model.vertexCount, first);
  assert.equal(model.submeshes.reduce((sum, submesh) => sum + submesh.count, 0), model.meshes.reduce((sum, mesh) => sum + mesh.indexCount, 0));
  for (const material of model.materials) assert.equal(material.baseColour.length, 4);
  model.dispose();
});

test('constraints, the order of chains and the parts of joints', () => {
  const model = Model.openSync(read(example('mannequin')), { runtime: simd });
  for (const { number, joint, scope } of model.constraints) {
    if (scope !== 'ik_only') assert.equal(model.constraintOf(joint).number, number);
    if (scope !== 'all_but_ik') assert.equal(model.constraintOf(joint, true).number, number);
  }
  const free = model.joints.find((joint) => model.constraints.every((constraint) => constraint.joint !== joint.number));
  assert.equal(model.constraintOf(free), null);
  assert.throws(() => model.constraintOf('Tail'), { code: 'NOT_FOUND' });
  assert.deepEqual(Array.from(model.chainOrder).sort(), model.chains.map((chain) => chain.number));
  for (const { joint, mesh, first, count } of model.jointSubmeshes) {
    assert.ok(model.joints[joint]);
    assert.ok(first + count <= model.meshes[mesh].indexCount);
  }
  assert.match(simd.version, /^\d+\.\d+\.\d+$/);
  model.dispose();
});

test('texts refer to names and numbers as everywhere', () => {
  const lines = readFileSync(join(repository, 'tests/format/name_keys.txt'), 'utf8').trim().split('\n');
  const [[, ...names], ...keys] = lines.filter((line) => !line.startsWith('//')).map((line) => line.split(' '));
  const gltf = {
    asset: { version: '2.0' },
    scenes: [{ nodes: [...names.keys()] }],
    nodes: names.map((name) => ({ name })),
  };
  writeFileSync(join(folder, 'named.gltf'), JSON.stringify(gltf));
  const { joints } = Model.openSync(read(convert(join(folder, 'named.gltf'))), { runtime: simd });
  assert.deepEqual(joints.names, names);
  for (const [key, expected] of keys) {
    if (expected === 'absent') assert.throws(() => joints.get(key), { code: 'NOT_FOUND' }, key);
    else if (expected === 'ambiguous') assert.throws(() => joints.get(key), { code: 'BAD_ARGUMENT', message: new RegExp(`=${key} .*#${key} `) }, key);
    else assert.equal(joints.get(key).number, Number(expected), key);
    assert.equal(joints.has(key), names.includes(key));
  }
});

test('what is no bytes is named', async () => {
  for (const [source, words] of [
    [new Blob([]), /found an object of type Blob, .* arrayBuffer\(\)/],
    [undefined, /found undefined/],
    [7, /found 7/],
    [{ bytes: new Uint8Array(4) }, /found an object of type Object, whose `bytes` are the file/],
  ]) {
    await assert.rejects(Model.open(source, { runtime: simd }), { name: 'BendyError', code: 'BAD_ARGUMENT', message: words });
  }
  const onlyOpen = { code: 'BAD_ARGUMENT', message: /found the address "fox\.bendy", which only Model\.open fetches/ };
  assert.throws(() => Model.openSync('fox.bendy', { runtime: simd }), onlyOpen);
  assert.throws(() => Model.openSync(Promise.resolve(), { runtime: simd }), { code: 'BAD_ARGUMENT', message: /found a promise: await it/ });
  assert.throws(() => new Model(new Uint8Array(4)), { code: 'BAD_ARGUMENT', message: /Model\.open/ });
  const bytes = read(example('tentacle'));
  assert.ok(Model.openSync(new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), { runtime: simd }).joints.length > 0);
});

test('a file of another kind, or what is no part of the model, says what to do', () => {
  const open = (text) => Model.openSync(new TextEncoder().encode(text), { runtime: simd });
  assert.throws(() => open('glTF....'), { code: 'NOT_A_BENDY_FILE', message: /convert\(\) of bendy\/tools/ });
  assert.throws(() => open('\n<!DOCTYPE html><p>404'), { code: 'NOT_A_BENDY_FILE', message: /a web page: is the address right\?/ });

  const model = Model.openSync(read(example('mannequin')), { runtime: simd });
  const bad = (message) => ({ code: 'BAD_ARGUMENT', message });
  assert.throws(() => model.sample('Wal', 0), { code: 'NOT_FOUND', message: /did you mean "Walk"\?/ });
  assert.throws(() => model.sample(undefined, 0), bad(/a clip is a name, .* not undefined/));
  assert.throws(() => model.sample({}, 0), bad(/the clip belongs to another model/));
  assert.throws(() => model.pose().reach('IK_LeftArm', { left: 1 }), bad(/^position is an object of type Object, not \[x, y, z\] or an object with x, y, z$/));
  const simple = Model.openSync(readFileSync(join(repository, 'spec/examples/one_joint.bendy')), { runtime: simd });
  assert.throws(() => simple.pose().reach('Arm', [0, 0, 0]), { code: 'NOT_FOUND', message: /there are none; convert\(\) with \{ autoRig: true \}/ });
});

test('skinning by palette, bones and weights gives the vertices that skin computes', () => {
  const model = Model.openSync(read(example('mannequin')), { runtime: plain });
  const pose = model.sample('Walk', 0.3);
  const all = pose.skin().positions.slice();
  for (const mesh of model.meshes) {
    const palette = pose.palette(mesh);
    const computed = new Float32Array(3 * mesh.vertexCount);
    mesh.bones.forEach((bone, k) => {
      const vertex = Math.floor(k / mesh.influenceCount);
      const [x, y, z] = mesh.positions.subarray(3 * vertex, 3 * vertex + 3);
      for (let axis = 0; axis < 3; ++axis) {
        const at = 16 * bone + axis;
        computed[3 * vertex + axis] += mesh.weights[k] * (palette[at] * x + palette[at + 4] * y + palette[at + 8] * z + palette[at + 12]);
      }
    });
    assert.ok(difference(computed, all.subarray(3 * mesh.firstVertex, 3 * (mesh.firstVertex + mesh.vertexCount))) < 1e-5);
  }
  model.dispose();
});

test('clips: tracks and keys, exact and packed', () => {
  const model = Model.openSync(read(example('mannequin')), { runtime: simd });
  for (const clip of model.clips) {
    assert.ok(clip.tracks.length > 0);
    for (const track of clip.tracks) {
      assert.equal(track.values.length, track.times.length * track.components * (track.interpolation === 'cubic' ? 3 : 1));
      assert.ok(track.times.every((time, key) => key === 0 || time > track.times[key - 1]));
    }
    assert.equal(clip.seconds, clip.end - clip.start);
  }
  const packed = Model.openSync(read(example('mannequin', '--compact')), { runtime: simd });
  assert.ok(packed.clips.some((clip) => clip.isPacked));
  const exact = model.sample('Walk', 0.4).modelMatrices().slice();
  assert.ok(difference(packed.sample('Walk', 0.4).modelMatrices(), exact) < 1e-3);
  packed.dispose();
  model.dispose();
});

test('textures, materials and texture coordinates', (t) => {
  const file = corpusFile('models/fox.glb');
  if (file === undefined) return t.skip('the corpus is not there');
  const model = Model.openSync(read(convert(file)), { runtime: simd });
  const [texture] = model.textures;
  const png = texture.images[0];
  assert.equal(png.media, 'png');
  assert.deepEqual(Array.from(png.bytes.subarray(1, 4)), [...'PNG'].map((letter) => letter.charCodeAt(0)));
  assert.equal(model.materials[0].baseColourTexture.texture, 0);
  assert.equal(model.meshes[0].normals, null);
  assert.equal(model.meshes[0].textureCoords.length, 1);
  model.dispose();
});

test('lists find by name, number and item', () => {
  const { clips, ...rest } = { clips: Model.openSync(read(example('mannequin')), { runtime: simd }).clips };
  assert.deepEqual(rest, {});
  assert.equal(clips.get('Walk'), clips[1]);
  assert.equal(clips.get(1), clips[1]);
  assert.equal(clips.number(clips[1]), 1);
  assert.ok(clips.has('Walk') && !clips.has('Run'));
  assert.ok(clips.map((clip) => clip.name) instanceof Array);
  for (const key of [2, -1, 0.5, Number.NaN]) assert.throws(() => clips.get(key), { code: 'BAD_ARGUMENT' });
  assert.throws(() => clips.get('Run'), { code: 'NOT_FOUND', message: 'there is no clip "Run"; there are: "Idle", "Walk"' });
  assert.throws(() => clips.get('walk'), { message: 'there is no clip "walk"; did you mean "Walk"? There are: "Idle", "Walk"' });
});
