// How characters are drawn in three.js: when tracks are made, by which matrices skeletons and crowds draw.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import * as THREE from 'three';
import { Model } from '../dist/index.js';
import { BendyAnimator, BendyCrowd, BendyLoader, cloneCharacter } from '../dist/three/index.js';
import { convert, example, exampleWithClipExtras, folder, plain, read } from './helpers.mjs';

const load = (name, ...options) => new BendyLoader().parseAsync(read(example(name, ...options)));
const skeletonsOf = ({ parts }) => [...new Set(parts.flatMap(({ object }) => object.skeleton ?? []))];
const isRead = (clip) => Object.getOwnPropertyDescriptor(clip, 'tracks').get === undefined;
const keysOf = ({ tracks }) => tracks.map(({ name, times, values }) => ({ name, times, values }));

/** What skeletons draw: the world matrices of the scene, and then the matrices of all bones. */
function drawn(character) {
  character.scene.updateMatrixWorld();
  return skeletonsOf(character).map((skeleton) => {
    skeleton.update();
    return Array.from(skeleton.boneMatrices);
  });
}

function assertNear(actual, expected, tolerance = 1e-5) {
  const [a, e] = [actual, expected].map((list) => list.flat(2));
  assert.equal(a.length, e.length);
  assert.ok(a.length > 0);
  a.forEach((x, k) => assert.ok(Math.abs(x - e[k]) <= tolerance, `${k}: ${x}, expected ${e[k]}`));
}

for (const option of ['--keep-order', '--compact']) {
  test(`tracks are made when they are first read, also of a disposed model: ${option}`, async () => {
    const before = await load('mannequin', option);
    const expected = before.animations.map(keysOf);
    assert.ok(expected.every((tracks) => tracks.length > 0));
    const { animations, model } = await load('mannequin', option);
    assert.deepEqual(animations.map(isRead), [false, false]);
    assert.deepEqual(keysOf(animations[1]), expected[1]);
    assert.deepEqual(animations.map(isRead), [false, true]);
    model.dispose();
    assert.deepEqual(keysOf(animations[0].clone()), expected[0]);
    animations[0].tracks = [];
    assert.equal(animations[0].tracks.length, 0);
  });
}

test('the memory of a file is released when the model has been disposed and all tracks have been read or set', async () => {
  const bytes = read(example('mannequin', '--compact'));
  const loader = new BendyLoader();
  loader.openOptions = { runtime: plain };
  let size = 0;
  for (let round = 0; round < 30; ++round) {
    const { animations, model } = await loader.parseAsync(bytes);
    if (round % 2 === 0) model.dispose();
    for (const clip of animations) {
      if (round % 3 === 0) clip.tracks = [];
      else assert.ok(clip.tracks.length > 0);
    }
    if (round % 2 !== 0) model.dispose();
    if (round === 3) size = plain.memorySize;
  }
  assert.equal(plain.memorySize, size);
});

test('tracks that have been read stay usable', async () => {
  const model = await Model.open(read(example('mannequin', '--keep-order')));
  const { tracks } = model.clips[0];
  model.dispose();
  assert.equal(model.clips[0].tracks, tracks);
});

/** Writes a glTF file of one triangle with a colour and a normal map, and returns its path. */
function writeTwoImages() {
  const numbers = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1]);
  const uri = (type, base64) => `data:${type};base64,${base64}`;
  const png = 'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42m';
  const file = join(folder, 'two_images.gltf');
  const gltf = {
    asset: { version: '2.0' },
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, material: 0 }] }],
    materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } }, normalTexture: { index: 1 } }],
    textures: [{ source: 0 }, { source: 1 }],
    images: ['Nk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==', 'P8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg=='].map((end) => ({ uri: uri('image/png', png + end) })),
    accessors: [
      { bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 0] },
      { bufferView: 1, componentType: 5126, count: 3, type: 'VEC2' },
    ],
    bufferViews: [{ buffer: 0, byteLength: 36 }, { buffer: 0, byteOffset: 36, byteLength: 24 }],
    buffers: [{ byteLength: 60, uri: uri('application/octet-stream', Buffer.from(numbers.buffer).toString('base64')) }],
  };
  writeFileSync(file, JSON.stringify(gltf));
  return file;
}

test('images are decoded at once', { timeout: 10_000 }, async (t) => {
  const { createImageBitmap } = globalThis;
  t.after(() => (globalThis.createImageBitmap = createImageBitmap));
  const waiting = [];
  globalThis.createImageBitmap = () => new Promise((resolve) => waiting.push(resolve));
  const character = new BendyLoader().parseAsync(read(convert(writeTwoImages())));
  while (waiting.length < 2 && !t.signal.aborted) await new Promise((resolve) => setTimeout(resolve, 1));
  for (const resolve of waiting) resolve({ width: 1, height: 1 });
  const { material } = (await character).parts[0].object;
  assert.ok(material.map !== null && material.normalMap !== null);
});

test('clones share skeletons as the character does', async () => {
  const character = await load('mannequin');
  const clone = cloneCharacter(character);
  const places = ({ parts }) => parts.map(({ object }, _, all) => all.findIndex((other) => other.object.skeleton === object.skeleton));
  assert.ok(new Set(places(character)).size < character.parts.length);
  assert.deepEqual(places(clone), places(character));
  for (const skeleton of skeletonsOf(clone)) for (const bone of skeleton.bones) assert.ok(clone.joints.includes(bone));
  assert.deepEqual(clone.animations, character.animations);
});

test('palettes draw what the joints would, and only the joints that carry something move', async () => {
  const all = await load('mannequin');
  const some = cloneCharacter(all);
  const animators = [new BendyAnimator(all), new BendyAnimator(some, { joints: 'needed' })];
  const set = (time) => animators.forEach((animator) => animator.sample('Walk', time).apply());
  for (const { scene } of [all, some]) {
    scene.position.set(1, 2, 3);
    scene.rotation.set(0.1, 0.2, 0.3);
    scene.scale.setScalar(2);
  }
  for (const time of [0, 0.3, 0.7]) {
    set(time);
    assertNear(drawn(some), drawn(all));
  }
  const hand = all.model.joints.number('mixamorig:RightHand');
  const foot = all.model.joints.number('mixamorig:LeftFoot');
  assert.notDeepEqual(some.joints[hand].matrixWorld.elements, all.joints[hand].matrixWorld.elements);

  const swords = [all, some].map(({ joints }) => {
    const sword = new THREE.Object3D();
    sword.position.set(0, 0.5, 0);
    joints[hand].add(sword);
    return sword;
  });
  set(0.4);
  assertNear(drawn(some), drawn(all));
  assertNear([swords[1].matrixWorld.elements], [swords[0].matrixWorld.elements]);
  assert.notDeepEqual(some.joints[foot].matrixWorld.elements, all.joints[foot].matrixWorld.elements);

  swords[1].removeFromParent();
  set(0.6);
  assertNear(drawn(some), drawn(all));
  assert.notDeepEqual(some.joints[hand].matrixWorld.elements, all.joints[hand].matrixWorld.elements);
  animators[1].updateJoints();
  for (const [k, joint] of some.joints.entries()) assertNear([joint.matrixWorld.elements], [all.joints[k].matrixWorld.elements]);

  set(0.2);
  animators[1].dispose();
  animators[1].dispose();
  assertNear(drawn(some), drawn(all)); // the pose stays
  some.joints[hand].position.x += 1;
  all.joints[hand].position.x += 1;
  assertNear(drawn(some), drawn(all));
  assert.ok(some.joints.every((joint) => !Object.hasOwn(joint, 'updateMatrixWorld')));
});

test('a character that is moved later is inside its bounds, and drawn by the newest animator', async () => {
  const character = await load('mannequin');
  const [first, second] = [new BendyAnimator(character, { joints: 'needed' }), new BendyAnimator(character, { joints: 'needed' })];
  character.scene.position.x = 100;
  second.sample('Walk', 0.3).apply();
  first.dispose();
  const expected = cloneCharacter(character);
  new BendyAnimator(expected).sample('Walk', 0.3).apply();
  assertNear(drawn(character), drawn(expected), 1e-4);
  const { object } = character.parts[0];
  const sphere = object.boundingSphere.clone().applyMatrix4(object.matrixWorld);
  assert.ok(Math.abs(sphere.center.x - 100) < 2, `${sphere.center.x}`);
  character.parts[0].object.removeFromParent();
  assert.ok(cloneCharacter(character).joints.length > 0);
});

/** Writes a file of one triangle, or of its corners as points, that a clip moves by 5 within a second, and returns its path. */
function writeMoving(mode) {
  const gltf = JSON.parse(readFileSync(writeTwoImages(), 'utf8'));
  const times = Buffer.from(new Float32Array([0, 1, 0, 0, 0, 5, 0, 0]).buffer).toString('base64');
  gltf.meshes[0].primitives[0].mode = mode;
  gltf.buffers.push({ byteLength: 32, uri: `data:application/octet-stream;base64,${times}` });
  gltf.bufferViews.push({ buffer: 1, byteLength: 8 }, { buffer: 1, byteOffset: 8, byteLength: 24 });
  gltf.accessors.push(
    { bufferView: 2, componentType: 5126, count: 2, type: 'SCALAR', min: [0], max: [1] },
    { bufferView: 3, componentType: 5126, count: 2, type: 'VEC3' },
  );
  gltf.animations = [{ channels: [{ sampler: 0, target: { node: 0, path: 'translation' } }], samplers: [{ input: 2, output: 3 }] }];
  const file = join(folder, `moving${mode}.gltf`);
  writeFileSync(file, JSON.stringify(gltf));
  return convert(file);
}

test('a clip whose extras say that it does not loop plays once, in an animator and in a crowd', async () => {
  const character = await new BendyLoader().parseAsync(read(exampleWithClipExtras('mannequin', { loop: false })));
  const { start, end } = character.model.clips.get('Walk');
  const last = character.model.sample('Walk', end);
  const animator = new BendyAnimator(character).play('Walk').update(end - start + 0.1);
  assertNear([Array.from(animator.pose.locals)], [Array.from(last.locals)]);
  const crowd = new BendyCrowd(character, 1).play(0, 'Walk', { offset: end - start }).update(0.1);
  const { crowdMatrices, crowdFirst } = uniformsOf(crowd.parts[0].material);
  const palette = Array.from(last.palette(character.parts[0].mesh));
  const first = 16 * crowdFirst.value;
  assertNear([Array.from(crowdMatrices.value.image.data.slice(first, first + palette.length))], [palette]);
  crowd.dispose();
  animator.dispose();
});

test('joints that are points themselves move', async () => {
  const character = await new BendyLoader().parseAsync(read(writeMoving(0)));
  assert.equal(character.parts[0].object.type, 'Points');
  new BendyAnimator(character, { joints: 'needed' }).sample(0, 1).apply();
  character.scene.updateMatrixWorld();
  assert.equal(character.parts[0].object.matrixWorld.elements[12], 5);
  assert.throws(() => new BendyCrowd(character, 1), { code: 'BAD_ARGUMENT', message: /lines or points/ });
});

test('a crowd moves meshes without bones', async () => {
  const crowd = new BendyCrowd(await new BendyLoader().parseAsync(read(writeMoving(4))), 2);
  crowd.play(1, 0).update(0.5);
  const { crowdMatrices, crowdCount } = uniformsOf(crowd.parts[0].material);
  assert.equal(crowdCount.value, 1);
  const xs = [12, 28].map((at) => crowdMatrices.value.image.data[at]);
  assertNear([xs], [[0, 2.5]]);
  crowd.dispose();
});

test('a crowd has the matrices of its members, and advances them', async () => {
  const character = await load('mannequin');
  const { model } = character;
  const crowd = new BendyCrowd(character, 3);
  crowd.play(0, 'Walk', { offset: 0.2 }).play(1, 'Idle', { speed: -1 }).setMatrixAt(2, new THREE.Matrix4().setPosition(4, 5, 6)).update(0.1);
  const walk = model.clips.get('Walk');
  const idle = model.clips.get('Idle');
  const poses = [model.sample(walk, walk.start + 0.3), model.sample(idle, idle.end - 0.1), model.pose()];
  const [part] = crowd.parts;
  const { crowdMatrices, crowdCount, crowdFirst } = uniformsOf(part.material);
  const { data, width } = crowdMatrices.value.image;
  assert.equal(width % 4, 0);
  for (const [member, pose] of poses.entries()) {
    const first = 16 * (member * crowdCount.value + crowdFirst.value);
    const palette = Array.from(pose.palette(character.parts[0].mesh));
    assertNear([Array.from(data.slice(first, first + palette.length))], [palette]);
  }
  assert.equal(crowd.parts.length, character.parts.length);
  assert.ok(crowd.parts.every(({ instanceMatrix }) => instanceMatrix === part.instanceMatrix));
  assert.deepEqual(Array.from(part.instanceMatrix.array.slice(44, 47)), [4, 5, 6]);
  const paletteOf = (member) => {
    const first = 16 * (member * crowdCount.value + crowdFirst.value);
    return [Array.from(data.slice(first, first + 16 * model.meshes[character.parts[0].mesh].boneCount))];
  };
  const expect = (member, pose) => assertNear(paletteOf(member), [Array.from(pose.palette(character.parts[0].mesh))]);
  crowd.play(0, 'Walk', { offset: 1e6, loop: false }).stop(1).play(2, 'Walk', { offset: 0, speed: -1, loop: false }).update(0.1);
  expect(0, model.sample(walk, walk.end));
  expect(1, model.pose());
  expect(2, model.sample(walk, walk.start));
  crowd.play(0, 'Walk', { offset: walk.seconds }).update(0.1);
  expect(0, model.sample(walk, walk.start + 0.1));
  crowd.play(0, 'Walk', { speed: 1e300 }).update(1e300).update(0);

  for (const wrong of [() => crowd.play(3, 'Walk'), () => crowd.play(0, 'Walk', { speed: NaN }), () => crowd.setMatrixAt(-1, new THREE.Matrix4()),
    () => crowd.update(Infinity), () => new BendyCrowd(character, -1), () => new BendyCrowd({}, 1)]) {
    assert.throws(wrong, { code: 'BAD_ARGUMENT' });
  }
  assert.throws(() => crowd.play(0, 'Swim'), { code: 'NOT_FOUND' });
  const indices = part.geometry.index.array.slice();
  character.parts[0].object.geometry.index.array.fill(0);
  assert.deepEqual(part.geometry.index.array, indices);
  const skinned = await load('mannequin');
  new BendyAnimator(skinned, { skin: 'wasm' });
  assert.throws(() => new BendyCrowd(skinned, 1), { code: 'BAD_ARGUMENT', message: /skinned by a BendyAnimator/ });
  crowd.dispose();
  assert.throws(() => crowd.update(0), { code: 'DISPOSED' });
  assert.ok(character.animations[0].tracks.length > 0);
});

/** The uniforms that a material gets when three.js compiles it. Fails if its shader lacks a place that the crowd writes to. */
function uniformsOf(material, name = 'physical') {
  const before = THREE.ShaderLib[name].vertexShader;
  const shader = { uniforms: {}, vertexShader: before };
  material.onBeforeCompile(shader);
  for (const place of ['skinning_pars_vertex', 'skinnormal_vertex', 'skinning_vertex']) {
    assert.ok(before.includes(`#include <${place}>`), `${name}: ${place}`);
    assert.ok(!shader.vertexShader.includes(`#include <${place}>`));
  }
  return shader.uniforms;
}

test('a crowd changes every shader that three.js draws meshes and shadows with', async () => {
  const crowd = new BendyCrowd(await load('mannequin'), 1);
  const [{ material, customDepthMaterial, customDistanceMaterial }] = crowd.parts;
  for (const name of ['physical', 'standard', 'basic', 'lambert', 'phong', 'toon']) {
    if (name in THREE.ShaderLib) uniformsOf(material, name);
  }
  uniformsOf(customDepthMaterial, 'depth');
  uniformsOf(customDistanceMaterial, 'distance' in THREE.ShaderLib ? 'distance' : 'distanceRGBA');
});
