// What GltfRigPlugin makes of the glTF extensions BENDY_joint_limits and BENDY_ik_chains, and what CCDIKSolver does with it.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import * as THREE from 'three';
import { CCDIKSolver } from 'three/addons/animation/CCDIKSolver.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { Model } from '../dist/index.js';
import { GltfRigPlugin } from '../dist/three/index.js';
import { bendy, example, folder } from './helpers.mjs';

globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= class extends Event {};

const samples = fileURLToPath(new URL('../../../spec/gltf/', import.meta.url));
const sample = (name) => JSON.parse(readFileSync(join(samples, name), 'utf8'));

/** Numbers between -1 and 1, the same in every run. */
function* numbers(seed) {
  for (let state = seed; ; ) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    yield state / 2 ** 31 - 1;
  }
}

async function load(source) {
  const bytes = source instanceof Uint8Array ? source.buffer.slice(source.byteOffset, source.byteOffset + source.byteLength) : JSON.stringify(source);
  const loader = new GLTFLoader().register((parser) => new GltfRigPlugin(parser));
  return new Promise((resolve, reject) => loader.parse(bytes, '', resolve, reject));
}

/** Radians: a box is made of samples, and what lies between two of them may be that much outside. */
const betweenSamples = 1e-3;

/** What is warned while `work` runs. */
async function warnings(t, work) {
  const { mock } = t.mock.method(console, 'warn', () => {});
  await work();
  return mock.calls.map(({ arguments: [text] }) => text);
}

test('a chain and its limits reach CCDIKSolver', async () => {
  const { scene, userData } = await load(sample('arm.gltf'));
  const { mesh, iks, targets } = userData.rig;
  const { bones } = mesh.skeleton;
  assert.equal(iks.length, 1);
  assert.equal(targets.get('Arm'), scene.getObjectByName('HandTarget'));
  assert.equal(bones[iks[0].effector].name, 'Hand');
  assert.deepEqual(iks[0].links.map(({ index }) => bones[index].name), ['LowerArm', 'UpperArm']);
  const [{ rotationMin, rotationMax }] = iks[0].links;
  assert.ok(rotationMin.distanceTo(new THREE.Vector3(0, 0, 0)) < 1e-9 && rotationMax.distanceTo(new THREE.Vector3(2.6, 0, 0)) < 1e-9);
});

test('roles lead to their objects, a chain\'s from the body outwards', async (t) => {
  const { scene, userData } = await load(sample('arm.gltf'));
  assert.deepEqual([...userData.rig.roles], [['leftHand', [scene.getObjectByName('Hand')]]]);
  const gltf = sample('arm.gltf');
  const give = (name, extension) => {
    gltf.nodes.find((node) => node.name === name).extensions = { BENDY_joint_role: extension };
  };
  give('Hand', { role: 'tail', place: 0 });
  give('UpperArm', { role: 'tail', place: 3 });
  give('LowerArm', { role: 'tail', place: 2 });
  give('HandTarget', { place: 2 });
  const warned = await warnings(t, async () => {
    const { scene, userData } = await load(gltf);
    assert.deepEqual(userData.rig.roles.get('tail'), ['Hand', 'LowerArm', 'UpperArm'].map((name) => scene.getObjectByName(name)));
  });
  assert.equal(warned.filter((text) => /nodes\[\d\]\.extensions\.BENDY_joint_role left out/.test(text)).length, 1);
});

test('the hand reaches where the limits let it, and the elbow stays a hinge', async () => {
  const { scene, userData } = await load(sample('arm.gltf'));
  const { mesh, iks, targets } = userData.rig;
  const [hand, elbow, shoulder] = ['Hand', 'LowerArm', 'UpperArm'].map((name) => scene.getObjectByName(name));
  const rest = shoulder.quaternion.clone();
  const random = numbers(1);
  const solver = new CCDIKSolver(mesh, iks);
  let reached = 0;
  for (let round = 0; round < 50; ++round) {
    // Where the hand is in a pose within the limits.
    const swing = new THREE.Quaternion(0.5 * random.next().value, 0, 0.5 * random.next().value, 1).normalize();
    shoulder.quaternion.copy(rest).multiply(swing);
    elbow.quaternion.setFromAxisAngle(new THREE.Vector3(1, 0, 0), 1.3 + 1.2 * random.next().value);
    scene.updateMatrixWorld(true);
    const goal = targets.get('Arm').position.copy(hand.getWorldPosition(new THREE.Vector3()));
    shoulder.quaternion.copy(rest);
    elbow.quaternion.setFromAxisAngle(new THREE.Vector3(1, 0, 0), 0.5);
    scene.updateMatrixWorld(true);
    for (let step = 0; step < 30; ++step) solver.update();
    const angle = 2 * Math.atan2(elbow.quaternion.x, elbow.quaternion.w);
    assert.ok(angle > -1e-6 && angle < 2.6 + 1e-6, `round ${round}: the elbow is at ${angle}`);
    assert.ok(Math.hypot(elbow.quaternion.y, elbow.quaternion.z) < 1e-6, `round ${round}: the elbow turns about another axis`);
    if (hand.getWorldPosition(new THREE.Vector3()).distanceTo(goal) < 1e-3) ++reached;
  }
  assert.ok(reached >= 40, `${reached} of 50 reached`);
});

test('what the runtime calls legal is inside the boxes', async () => {
  const gltf = sample('every_field.gltf');
  // Every model, on bones whose rest rotations differ.
  const models = [
    { model: 'hinge', frame: [0, 0.6, 0, 0.8], x: [-1, 2] },
    { model: 'swingTwistEllipse', frame: [0.5, 0.5, 0.5, 0.5], x: [-0.5, 1], y: [-1, 0.5], z: [-0.25, 1.5] },
    { model: 'swingTwistPyramid', x: [-0.5, 0.5], y: [-1, 0.75], z: [-0.5, 0.5] },
    { model: 'eulerBox', order: 'YZX', x: [-1, 0.5], y: [-0.25, 0.5], z: [-0.5, 0.75] },
    { model: 'largestAngle', angle: 0.75 },
    { model: 'locked' },
  ];
  const random = numbers(2);
  const nodes = models.map((limit, k) => ({
    name: `bone${k}`,
    translation: [0, 1, 0],
    rotation: new THREE.Quaternion(random.next().value, random.next().value, random.next().value, 1).normalize().toArray(),
    ...(k + 1 < models.length ? { children: [k + 1] } : {}),
    extensions: { BENDY_joint_limits: { limits: [limit] } },
  }));
  gltf.nodes = nodes;
  gltf.scenes = [{ nodes: [0] }];
  gltf.extensions.BENDY_ik_chains.chains = [{ name: 'all', start: 0, effector: models.length - 1, tipOffset: [0, 1, 0] }];
  const { userData } = await load(gltf);
  const { mesh, iks } = userData.rig;
  const source = join(folder, 'models.gltf');
  writeFileSync(source, JSON.stringify(gltf));
  bendy(['convert', source, '-q', '-o', join(folder, 'models.bendy')]);
  const model = await Model.open(readFileSync(join(folder, 'models.bendy')));
  const pose = model.pose();
  assert.equal(model.constraints.length, models.length);
  const { rotationMin, rotationMax } = iks[0].links[0];
  assert.ok(rotationMin.distanceTo(rotationMax) < 1e-6, 'what is locked has no width');
  for (let round = 0; round < 400; ++round) {
    for (const { number } of model.joints) {
      const rotation = new THREE.Quaternion(...Array.from({ length: 4 }, () => random.next().value)).normalize().toArray();
      pose.setLocal(number, { rotation });
    }
    pose.constrain();
    for (const { index, rotationMin, rotationMax } of iks[0].links) {
      const bone = mesh.skeleton.bones[index];
      const { rotation } = pose.local(bone.name);
      const euler = new THREE.Euler().setFromQuaternion(new THREE.Quaternion(...rotation), bone.rotation.order);
      for (const axis of ['x', 'y', 'z']) {
        const centre = (rotationMin[axis] + rotationMax[axis]) / 2;
        const away = Math.atan2(Math.sin(euler[axis] - centre), Math.cos(euler[axis] - centre));
        const outside = Math.abs(away) - (rotationMax[axis] - rotationMin[axis]) / 2;
        assert.ok(outside < betweenSamples, `${bone.name}: ${axis} is ${outside} outside`);
      }
    }
  }
});

test('a chain without a target gets one at its tip', async () => {
  const { scene, userData } = await load(sample('every_field.gltf'));
  const { mesh, iks, targets } = userData.rig;
  assert.deepEqual(iks.map(({ name }) => name), ['Leg']); // the effector of the other is all of it
  assert.equal(targets.get('Leg').name, 'FootTarget');
  assert.deepEqual([iks[0].iteration, iks[0].blendFactor, mesh.skeleton.bones[iks[0].effector].name], [20, 0.75, 'Leg tip']);
  const gltf = sample('every_field.gltf');
  delete gltf.extensions.BENDY_ik_chains.chains[0].target;
  const other = await load(gltf);
  const target = other.userData.rig.targets.get('Leg');
  const tip = other.scene.getObjectByName('Leg tip');
  assert.ok(target.getWorldPosition(new THREE.Vector3()).distanceTo(tip.getWorldPosition(new THREE.Vector3())) < 1e-9);
  assert.equal(scene.getObjectByName('Leg target'), undefined);
});

test('what is faulty is left out and named', async (t) => {
  const faults = [
    [(gltf) => (gltf.extensions.BENDY_ik_chains.chains[0].start = 9), 'chains[0] left out: start: the number of a node is expected, below 5'],
    [(gltf) => (gltf.extensions.BENDY_ik_chains.chains[0].start = 4), 'chains[0] left out: start: it is neither the effector nor above it'],
    [(gltf) => (gltf.extensions.BENDY_ik_chains.chains[0].effector = 'Hand'), 'chains[0] left out: effector: the number of a node is expected'],
    [(gltf) => (gltf.extensions.BENDY_ik_chains.chains[0].tipOffset = [1]), 'chains[0] left out: tipOffset: three numbers are expected'],
    [(gltf) => (gltf.nodes[2].extensions.BENDY_joint_limits.limits[0].x = [2, 1]), 'nodes[2].extensions.BENDY_joint_limits.limits[0] left out: x: the minimum'],
    [(gltf) => (gltf.nodes[2].extensions.BENDY_joint_limits.limits[0].model = 'elbow'), 'limits[0] left out: model: it is not known'],
    [(gltf) => (gltf.nodes[1].extensions.BENDY_joint_limits.limits[0].frame = [0, 0, 0, 0]), 'limits[0] left out: frame: four numbers'],
  ];
  for (const [breaks, text] of faults) {
    const gltf = sample('arm.gltf');
    breaks(gltf);
    const found = await warnings(t, () => load(gltf));
    t.mock.restoreAll();
    assert.equal(found.length, 1, text);
    assert.ok(found[0].startsWith('GltfRigPlugin: ') && found[0].includes(text), `${found[0]} is not ${text}`);
  }
  for (const strange of [undefined, 3, [], { chains: 3 }, { chains: [3] }]) {
    const gltf = sample('arm.gltf');
    gltf.extensions.BENDY_ik_chains = strange;
    assert.deepEqual((await load(gltf)).userData.rig.iks, []);
  }
});

test('an export has the chains of its file', async () => {
  const file = example('mannequin');
  const glb = join(folder, 'mannequin.glb');
  bendy(['export', file, '-q', '-o', glb]);
  const model = await Model.open(readFileSync(file));
  const json = readFileSync(glb);
  const text = json.toString('utf8', 20, 20 + json.readUInt32LE(12));
  const document = JSON.parse(text);
  for (const kind of ['materials', 'textures', 'images', 'samplers']) delete document[kind];
  for (const mesh of document.meshes) for (const primitive of mesh.primitives) delete primitive.material;
  document.buffers[0].uri = `data:application/octet-stream;base64,${json.subarray(28 + json.readUInt32LE(12)).toString('base64')}`;
  const { userData } = await load(document);
  assert.deepEqual([...userData.rig.targets.keys()], [...model.chains].map(({ name }) => name));
  for (const { links } of userData.rig.iks) assert.ok(links.length > 0);
});
