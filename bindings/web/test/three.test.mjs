// Compares what BendyLoader makes with what GLTFLoader makes of the source.
//   BENDY_PROGRAM: the native program, build/release/cli/bendy of the repository if not given
//   BENDY_CORPUS: folder with glTF files, ../shared/corpus/visible beside the repository if not given
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import { after, before, describe, it, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import * as THREE from 'three';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { clone } from 'three/addons/utils/SkeletonUtils.js';
import { BendyError, CrossFade, Model, ReachState, Retarget, RetargetState } from '../dist/index.js';
import { BendyAnimator, BendyCrowd, BendyLoader, cloneCharacter, setLevelOfDetail } from '../dist/three/index.js';

const repository = fileURLToPath(new URL('../../../', import.meta.url));
const program = process.env.BENDY_PROGRAM ?? path.join(repository, 'build/release/cli/bendy');
const corpus = process.env.BENDY_CORPUS ?? path.join(repository, '../shared/corpus/visible');
const tolerance = 1e-5; // of the diagonal
const shares = [0, 0.13, 0.37, 0.5, 0.81, 1];

/** Files with which GLTFLoader cannot be compared, and why. */
const leftOut = {
  'derived/fox_draco.glb': 'DRACOLoader needs a browser',
  'models/box_draco/BoxDraco.gltf': 'DRACOLoader needs a browser',
  'generated/interleaved_unpadded_tail.glb': 'GLTFLoader cannot load it',
  'models/kenney_tile.glb': 'GLTFLoader ignores the parent of the node that the scene lists',
  'generated/joints8.glb': 'GLTFLoader takes four influences; compared with the runtime below',
};

// What GLTFLoader takes from a browser. Images are not decoded: an "image" is the bytes of its file.
globalThis.self ??= globalThis;
globalThis.ProgressEvent ??= class extends Event {};
globalThis.createImageBitmap = async (blob) => ({ width: 1, height: 1, bytes: Buffer.from(await blob.arrayBuffer()) });

// GLTFLoader writes the normalised weights back into the integers of the file, which rounds them. Here they become floats first.
const { normalizeSkinWeights } = THREE.SkinnedMesh.prototype;
THREE.SkinnedMesh.prototype.normalizeSkinWeights = function () {
  const { skinWeight } = this.geometry.attributes;
  const floats = Float32Array.from({ length: 4 * skinWeight.count }, (_, k) => skinWeight.getComponent(k >> 2, k & 3));
  this.geometry.setAttribute('skinWeight', new THREE.BufferAttribute(floats, 4));
  normalizeSkinWeights.call(this);
};

const isReady = fs.existsSync(program) && fs.existsSync(corpus);
const skip = isReady ? false : `needs ${program} and ${corpus}`;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'bendy-three-'));
const server = http.createServer((request, response) => {
  const file = path.join(folder, decodeURIComponent(new URL(request.url, 'http://x').pathname));
  response.writeHead(fs.existsSync(file) ? 200 : 404, { connection: 'close' });
  response.end(fs.existsSync(file) ? fs.readFileSync(file) : undefined);
});
let address;
before(async () => {
  if (isReady) fs.symlinkSync(corpus, path.join(folder, 'corpus'));
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  address = `http://127.0.0.1:${server.address().port}/`;
});
after(() => {
  server.close();
  fs.rmSync(folder, { recursive: true });
});

/** The glTF files of a folder, relative to it. */
function sources(below = '') {
  return fs.readdirSync(path.join(corpus, below), { withFileTypes: true }).flatMap((entry) => {
    const name = path.join(below, entry.name);
    if (entry.isDirectory()) return entry.name === 'malformed' ? [] : sources(name);
    return /\.(glb|gltf)$/.test(entry.name) ? [name] : [];
  });
}

function convert(source, ...options) {
  const name = `${source.replaceAll(/[^A-Za-z0-9]/g, '_')}${options.join('')}.bendy`;
  const output = path.join(folder, name);
  if (!fs.existsSync(output))
    execFileSync(program, ['convert', path.join(corpus, source), '-q', '-o', output, ...options], { stdio: 'pipe' });
  return address + name;
}

const url = (source) => `${address}corpus/${source.split(path.sep).map(encodeURIComponent).join('/')}`;
const loadGltf = (source) => new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).loadAsync(url(source));
// Vertex by vertex, only the source's order can be compared with GLTFLoader's.
const loadBendy = (source, ...options) =>
  new BendyLoader().loadAsync(convert(source, ...(options.some((option) => /--(lod|compact)/.test(option)) ? options : [...options, '--keep-order'])));

/** The objects of a glTF file's nodes in the order of a character's joints. */
async function objectsOfNodes({ parser }) {
  const { json } = parser;
  const inPreOrder = (node) => [node, ...(json.nodes[node].children ?? []).flatMap(inPreOrder)];
  const nodes = (json.scenes?.[json.scene ?? 0]?.nodes ?? []).flatMap(inPreOrder);
  return Promise.all(nodes.map((node) => parser.getDependency('node', node)));
}

/** For each of several joints or nodes the meshes that it is or carries. */
function meshesOf(objects) {
  return objects.map((object) =>
    [object, ...object.children.filter((child) => !objects.includes(child))].filter(({ isMesh }) => isMesh),
  );
}

/**
 * As the converter does: GLTFLoader's rotations with three digits or from 16-bit integers get length 1. three.js would scale by
 * their length.
 */
function normaliseRotations(animations) {
  for (const track of animations.flatMap((clip) => clip.tracks)) {
    if (track.ValueTypeName !== 'quaternion' || track.createInterpolant.isInterpolantFactoryMethodGLTFCubicSpline) continue;
    track.values = track.values.slice(); // shared by samplers
    for (let k = 0; k < track.values.length; k += 4) {
      new THREE.Quaternion().fromArray(track.values, k).normalize().toArray(track.values, k);
    }
  }
}

/** World positions of all vertices, node by node; of an attribute that a node's meshes share, once. */
function positionsOf(nodes) {
  const arrays = [];
  for (const meshes of nodes) {
    const seen = new Set();
    for (const object of meshes) {
      const { position } = object.geometry.attributes;
      if (position === undefined || seen.has(position)) continue;
      seen.add(position);
      const array = new Float64Array(3 * position.count);
      for (let vertex = 0; vertex < position.count; ++vertex) positionOf(object, vertex).toArray(array, 3 * vertex);
      arrays.push(array);
    }
  }
  return join(arrays);
}

const join = (arrays) => Float64Array.from(arrays.flatMap((array) => Array.from(array)));
const positionOf = (object, vertex) => object.getVertexPosition(vertex, new THREE.Vector3()).applyMatrix4(object.matrixWorld);
const originsOf = (objects) =>
  join(objects.map((object) => new THREE.Vector3().setFromMatrixPosition(object.matrixWorld).toArray()));

function diagonalOf(positions) {
  const box = new THREE.Box3();
  for (let i = 0; i < positions.length; i += 3) box.expandByPoint(new THREE.Vector3().fromArray(positions, i));
  return box.isEmpty() ? 0 : box.getSize(new THREE.Vector3()).length();
}

function worstDistance(a, b) {
  assert.equal(a.length, b.length);
  let worst = 0;
  for (let i = 0; i < a.length; i += 3)
    worst = Math.max(worst, Math.hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  return worst;
}

/** Poses a scene by AnimationMixer. */
function mix(scene, clip, seconds) {
  const mixer = new THREE.AnimationMixer(scene);
  const action = mixer.clipAction(clip).setLoop(THREE.LoopOnce, 1);
  action.clampWhenFinished = true;
  action.play();
  mixer.setTime(seconds);
  scene.updateMatrixWorld(true);
  return () => {
    mixer.stopAllAction(); // restores what the clip has changed
    mixer.uncacheRoot(scene);
    scene.updateMatrixWorld(true);
  };
}

const times = (clip) => shares.map((share) => share * clip.duration);

describe('poses', { skip }, () => {
  for (const source of isReady ? sources() : []) {
    it(source, { skip: leftOut[source] }, async (context) => {
      const gltf = await loadGltf(source);
      const character = await loadBendy(source);
      const gpu = await loadBendy(source);
      const wasm = await loadBendy(source);
      const animators = [new BendyAnimator(gpu), new BendyAnimator(wasm, { skin: 'wasm' })];
      const nodes = await objectsOfNodes(gltf);
      const meshes = meshesOf(nodes);
      normaliseRotations(gltf.animations);
      const worst = { mixer: 0, gpu: 0, wasm: 0 };
      let count = 0;
      const compare = (pose) => {
        const expected = positionsOf(meshes);
        const origins = originsOf(nodes);
        const diagonal = diagonalOf(expected.length > 0 ? expected : origins) || 1;
        for (const [name, other] of Object.entries({ mixer: character, gpu, wasm })) {
          const moved = worstDistance(expected, positionsOf(meshesOf(other.joints)));
          const error = Math.max(moved, worstDistance(origins, originsOf(other.joints))) / diagonal;
          worst[name] = Math.max(worst[name], error);
          assert.ok(error <= tolerance, `${name}, ${pose}: ${error} of the diagonal`);
        }
        count = expected.length / 3;
      };
      gltf.scene.updateMatrixWorld(true);
      for (const animator of animators) {
        animator.apply();
        animator.character.scene.updateMatrixWorld(true);
      }
      compare('rest');
      assert.equal(character.animations.length, gltf.animations.length);
      for (const [number, clip] of gltf.animations.entries()) {
        const ours = character.animations[number];
        assert.equal(ours.name, clip.name);
        assert.equal(ours.duration, clip.duration);
        for (const seconds of times(clip)) {
          const ends = [mix(gltf.scene, clip, seconds), mix(character.scene, ours, seconds)];
          for (const animator of animators) {
            animator.sample(number, seconds).apply();
            animator.character.scene.updateMatrixWorld(true);
          }
          compare(`${clip.name} at ${seconds}`);
          for (const end of ends) end();
        }
      }
      for (const animator of animators) animator.dispose();
      const errors = Object.entries(worst).map(([name, error]) => `${name} ${error.toExponential(1)}`);
      context.diagnostic(`${gltf.animations.length} clips, ${count} vertices; of the diagonal: ${errors.join(', ')}`);
    });
  }
});

/** Compares what AnimationMixer and three.js make of a character with what the runtime makes of it. Returns the worst distance. */
function compareWithRuntime(character, clip, seconds) {
  const end = mix(character.scene, character.animations[clip], seconds);
  const pose = character.model.sample(clip, seconds);
  const skinned = pose.skin().positions;
  const expected = [];
  const actual = [];
  for (const { object, mesh } of character.parts) {
    for (const vertex of new Set(object.geometry.index.array)) {
      const first = 3 * (character.model.meshes[mesh].firstVertex + vertex);
      expected.push(...skinned.subarray(first, first + 3));
      actual.push(...positionOf(object, vertex));
    }
  }
  pose.dispose();
  end();
  return worstDistance(expected, actual) / (diagonalOf(expected) || 1);
}

function worstOverClips(character) {
  const errors = character.animations.flatMap((clip, number) =>
    times(clip).map((time) => compareWithRuntime(character, number, time)),
  );
  return Math.max(...errors);
}

describe('what GLTFLoader cannot do', { skip }, () => {
  it('more than four influences', async (context) => {
    const character = await loadBendy('generated/joints8.glb');
    const worst = worstOverClips(character);
    assert.ok(worst <= tolerance, String(worst));
    // What the shader computes.
    mix(character.scene, character.animations[0], 0.4);
    const { object } = character.parts[0];
    const check = ({ geometry, skeleton, matrixWorld, bindMatrixInverse }, positionAt) => {
      skeleton.computeBoneTexture();
      skeleton.update();
      const { position, skinIndex, skinWeight } = geometry.attributes;
      for (let vertex = 0; vertex < position.count; ++vertex) {
        const sum = new THREE.Vector3();
        for (let k = 0; k < 4; ++k) {
          const matrix = new THREE.Matrix4().fromArray(skeleton.boneTexture.image.data, 16 * skinIndex.getComponent(vertex, k));
          const point = new THREE.Vector3().fromBufferAttribute(position, vertex).applyMatrix4(matrix);
          sum.addScaledVector(point, skinWeight.getComponent(vertex, k));
        }
        sum.applyMatrix4(bindMatrixInverse).applyMatrix4(matrixWorld);
        assert.ok(sum.distanceTo(positionAt(vertex)) <= 1e-5, `vertex ${vertex}`);
      }
    };
    check(object, (vertex) => positionOf(object, vertex));
    const copy = clone(character.scene);
    copy.updateMatrixWorld(true);
    check(copy.getObjectByName(object.name), (vertex) => positionOf(object, vertex));
    context.diagnostic(`${worst.toExponential(1)} of the diagonal`);
  });

  it('packed clips', async (context) => {
    for (const source of ['models/robot.glb', 'models/fox.glb', 'models/cesium_man.gltf']) {
      const character = await loadBendy(source, '--compact');
      assert.ok(character.model.clips.some((clip) => clip.isPacked));
      const worst = worstOverClips(character);
      context.diagnostic(`${source}: ${worst.toExponential(1)} of the diagonal`);
      assert.ok(worst <= tolerance, `${source}: ${worst}`);
    }
  });

  it('levels of detail', async () => {
    const character = await loadBendy('models/robot.glb', '--lod');
    const triangles = () =>
      character.parts.reduce(
        (sum, { object }) => sum + Math.min(object.geometry.drawRange.count, object.geometry.index.count) / 3,
        0,
      );
    const all = triangles();
    assert.ok(setLevelOfDetail(character, 0.4) > 0);
    assert.ok(Math.abs(triangles() - 0.4 * all) < 0.05 * all, `${triangles()} of ${all}`);
    for (const { object } of character.parts) {
      const { position } = object.geometry.attributes;
      assert.ok(object.geometry.index.array.every((index) => index < position.count));
    }
    assert.equal(setLevelOfDetail(character, 1), 0);
    assert.equal(triangles(), all);
    assert.ok(worstOverClips(character) <= tolerance);
  });

  it('shear', async () => {
    const character = await loadBendy(writeGltf('sheared.gltf', sheared));
    assert.ok(character.model.joints.some((joint) => joint.shear.some((x) => x !== 0)));
    assert.ok(compareWithRuntime(character, 0, 0.3) <= 1e-6);
    const copy = cloneCharacter(character);
    const end = mix(copy.scene, copy.animations[0], 0.3);
    const pose = character.model.sample(0, 0.3);
    assert.ok(worstDistance(pose.skin().positions, positionsOf(meshesOf(copy.joints))) <= 1e-6);
    end();
  });

  it('frames', async () => {
    const file = fs.readFileSync(path.join(repository, 'spec/examples/every_chunk.bendy'));
    const character = await new BendyLoader().parseAsync(file);
    assert.ok(worstOverClips(character) <= 1e-6);
    assert.deepEqual(Object.keys(character.parts[1].object.morphTargetDictionary), ['up', 'high']);
    assert.deepEqual([character.userData, character.asset, character.scene.userData], [{ author: 'us' }, {}, { species: 'worm' }]);
  });
});

describe('BendyAnimator', { skip }, () => {
  it('says what it expects in the place of other things', async () => {
    const bad = (message) => ({ code: 'BAD_ARGUMENT', message });
    const character = await loadBendy('models/cesium_man.gltf', '--auto-rig');
    assert.throws(() => new BendyAnimator(Promise.resolve(character)), bad(/the result of BendyLoader, .* found a promise: await it/));
    assert.throws(() => new BendyAnimator(character.scene), bad(/the result of BendyLoader, .* found an object/));
    const animator = new BendyAnimator(character);
    for (const [target, found] of [[undefined, 'missing'], ['123', 'a text, "123"'], [new THREE.Object3D(), 'an object of type Object3D']]) {
      assert.throws(() => animator.reach(character.chains[0], target), bad(new RegExp(`^target is ${found}, not \\[x, y, z\\] or an object`)));
    }
    assert.throws(() => animator.reach(character.chains[0], new THREE.Object3D()), bad(/did you mean its position\?$/));
    assert.throws(() => animator.reach(character.chains[0], [0, 1, 0], { obeyConstraint: false }), bad(/did you mean obeyConstraints\?$/));
    assert.throws(() => animator.play(0, { loops: false }), bad(/^play has no option "loops"; did you mean loop\?$/));
    assert.throws(() => animator.crossFade(0, '1'), bad(/^fade is a text, "1", not a number$/));
    assert.throws(() => animator.update(), bad(/^seconds is missing/));
    assert.throws(() => new BendyAnimator(character, { joint: 'needed' }), bad(/^BendyAnimator has no option "joint"; did you mean joints\?$/));
    const crowd = new BendyCrowd(character, 1);
    assert.throws(() => crowd.play(0, 0, { offsets: 1 }), bad(/^play has no option "offsets"; did you mean offset\?$/));
    assert.throws(() => crowd.update(), bad(/^seconds is missing/));
    crowd.dispose();
    assert.throws(() => crowd.update(0), { kind: 'disposed', message: 'this BendyCrowd has been disposed' });
    animator.dispose();
    for (const use of [() => animator.update(0), () => animator.play(0), () => animator.reach(0, [0, 1, 0]), () => animator.sample(0, 0), () => animator.stop(), () => animator.apply()]) {
      assert.throws(use, { kind: 'disposed', message: 'this BendyAnimator has been disposed' });
    }
    animator.dispose();
  });

  it('takes targets, poles and rotations as arrays and as objects', async () => {
    const character = await loadBendy('models/cesium_man.gltf', '--auto-rig');
    character.scene.position.set(1, 2, 3);
    const [array, object] = [new BendyAnimator(character), new BendyAnimator(character)];
    const [target, rotation] = [new THREE.Vector3(1.3, 3.2, 3.4), new THREE.Quaternion(0, 0.6, 0, 0.8)];
    array.reach('LeftArm', target.toArray(), { pole: target.toArray(), rotation: rotation.toArray() });
    object.reach('LeftArm', target, { pole: target, rotation });
    assert.deepEqual(array.pose.locals, object.pose.locals);
    assert.notDeepEqual(array.pose.locals, character.model.pose().locals);
  });

  it('is refused an address that is none', async () => {
    await assert.rejects(new BendyLoader().loadAsync(), { name: 'BendyError', code: 'BAD_ARGUMENT', message: /the address of the file is missing/ });
    await assert.rejects(new BendyLoader().loadAsync(new Uint8Array(4)), { code: 'BAD_ARGUMENT', message: /is an object of type Uint8Array: .*parseAsync takes bytes/ });
  });

  it('reaches within the limits', async () => {
    const character = await loadBendy('models/cesium_man.gltf', '--auto-rig');
    const { model, scene } = character;
    const world = new THREE.Group();
    world.position.set(3, 1, -2);
    world.rotation.set(0.3, 0.5, 0.1);
    world.scale.setScalar(2);
    world.add(scene);
    const animator = new BendyAnimator(character);
    const pose = model.pose();
    const start = model.sample(0, 0.4).constrain();
    for (const chain of character.chains.filter(({ solver }) => solver !== 'aim')) {
      for (const offset of [
        [0.1, 0.05, 0.1],
        [-0.3, 0.2, 0.4],
        [0, 1, 0],
      ]) {
        pose.sample(0, 0.4).constrain();
        const tip = start.socket(chain.links.at(-1)).slice(12, 15);
        const target = new THREE.Vector3().fromArray(tip).add(new THREE.Vector3().fromArray(offset));
        const expected = pose.reach(chain, target.toArray());
        animator.sample(0, 0.4).pose.constrain();
        scene.updateWorldMatrix(true, false);
        const result = animator.reach(chain.name, target.clone().applyMatrix4(scene.matrixWorld));
        animator.apply();
        scene.updateMatrixWorld(true);
        assert.equal(result.reached, expected.reached);
        assert.ok(Math.abs(result.distance - expected.distance) < 1e-4, `${result.distance} ${expected.distance}`);
        const matrices = animator.pose.modelMatrices();
        character.joints.forEach((joint, k) => {
          const matrix = new THREE.Matrix4().fromArray(matrices, 16 * k).premultiply(scene.matrixWorld);
          matrix.elements.forEach((x, i) => assert.ok(Math.abs(x - joint.matrixWorld.elements[i]) < 1e-5));
        });
        for (const constraint of model.constraints) {
          const { violation } = model.clampRotation(constraint, character.joints[constraint.joint].quaternion.toArray());
          assert.ok(violation < 1e-3, `${chain.name} turns joint ${constraint.joint} by ${violation} too far`);
        }
        // In model space it is the same call.
        animator.sample(0, 0.4).pose.constrain();
        assert.deepEqual(animator.reach(chain, target, { space: 'model' }), expected);
        assert.deepEqual(animator.pose.locals, pose.locals);
      }
    }
  });

  it('plays and blends', async () => {
    const character = await loadBendy('models/fox.glb');
    const { model } = character;
    const animator = new BendyAnimator(character, { skin: 'wasm' });
    const expect = (pose) => {
      const { rotation } = pose.local(5);
      character.joints[5].quaternion.toArray().forEach((x, k) => assert.ok(Math.abs(x - rotation[k]) < 1e-5));
      character.scene.updateMatrixWorld(true);
      const actual = positionsOf(meshesOf(character.joints));
      assert.ok(worstDistance(pose.skin().positions, actual) < 1e-3); // of 150 metres
    };
    animator.play('Walk').update(0.2);
    expect(model.sample('Walk', 0.2));
    animator.crossFade('Run', 0.4, { easing: 'linear' }).update(0.1);
    expect(model.sample('Walk', 0.3).blend(model.sample('Run', 0.1), 0.25));
    animator.update(0.5);
    expect(model.sample('Run', 0.6));
    animator.sample('Survey', 1).blend('Walk', 0.3, 0.5).apply();
    expect(model.sample('Survey', 1).blend(model.sample('Walk', 0.3), 0.5));
    animator.update(0.1, () => animator.sample('Survey', 2));
    expect(model.sample('Survey', 2));
    const { start, end } = model.clips.get('Walk');
    animator.play('Walk').update(end - start + 0.1);
    expect(model.sample('Walk', start + 0.1));
    animator.play('Walk', { loop: false, speed: 2 }).update(10);
    expect(model.sample('Walk', end));
    assert.throws(
      () => animator.play('Fly'),
      (error) => error instanceof BendyError && error.code === 'NOT_FOUND',
    );
    const { object } = character.parts[0];
    const skinned = object.geometry;
    animator.dispose();
    assert.notEqual(object.geometry, skinned);
    assert.ok(worstOverClips(character) <= tolerance);
  });

  it('plays clips on clones whose joints have no names', async () => {
    const first = await loadBendy('models/cesium_man.gltf');
    assert.ok(first.model.joints.some(({ name }) => name === ''));
    const second = cloneCharacter(first);
    const { start, end } = first.model.clips[0];
    const seconds = (start + end) / 2;
    const stop = mix(second.scene, second.animations[0], seconds);
    second.scene.updateMatrixWorld(true);
    const expected = first.model.sample(0, seconds).skin().positions;
    assert.ok(worstDistance(expected, positionsOf(meshesOf(second.joints))) <= 1e-5);
    stop();
  });

  it('poses clones independently', async () => {
    const first = await loadBendy('models/fox.glb');
    const second = cloneCharacter(first);
    new BendyAnimator(first, { skin: 'wasm' }).sample('Walk', 0.2).apply();
    new BendyAnimator(second).sample('Run', 0.3).apply();
    const expected = [first.model.sample('Walk', 0.2), first.model.sample('Run', 0.3)];
    for (const [k, { scene, joints }] of [first, second].entries()) {
      scene.updateMatrixWorld(true);
      assert.ok(worstDistance(expected[k].skin().positions, positionsOf(meshesOf(joints))) < 1e-3);
    }
  });
});

/** Writes a glTF file with one triangle, and returns its path relative to the corpus. */
function writeGltf(name, members) {
  const floats = [0, 0, 0, 1, 0, 0, 0, 1, 0, /* times */ 0, 1, /* translations */ 0, 0, 0, 0, 2, 0];
  const bytes = Buffer.from(Float32Array.from(floats).buffer);
  const accessor = (byteOffset, count, type, more) => ({ bufferView: 0, byteOffset, count, type, componentType: 5126, ...more });
  const json = {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
    bufferViews: [{ buffer: 0, byteLength: bytes.length }],
    accessors: [
      accessor(0, 3, 'VEC3', { min: [0, 0, 0], max: [1, 1, 0] }),
      accessor(36, 2, 'SCALAR', { min: [0], max: [1] }),
      accessor(44, 2, 'VEC3'),
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    ...members,
  };
  fs.writeFileSync(path.join(folder, name), JSON.stringify(json));
  return path.relative(corpus, path.join(folder, name));
}

const sheared = {
  nodes: [
    { name: 'top', children: [1] },
    { name: 'sheared', matrix: [2, 0, 0, 0, 0.5, 1, 0, 0, 0.2, -0.3, 3, 0, 1, 2, 3, 1], mesh: 0, children: [2] },
    { name: 'below', mesh: 0, translation: [0, 1, 0] },
  ],
  animations: [{ channels: [{ sampler: 0, target: { node: 1, path: 'translation' } }], samplers: [{ input: 1, output: 2 }] }],
};

const image =
  'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==';
const transform = { KHR_texture_transform: { offset: [0.1, 0.2], scale: [2, 3], rotation: 0.4 } };
const everyExtension = {
  nodes: [{ mesh: 0 }, { mesh: 1 }],
  scenes: [{ nodes: [0, 1] }],
  meshes: [
    {
      primitives: [
        { attributes: { POSITION: 0 }, material: 0 },
        { attributes: { POSITION: 0 }, material: 1, mode: 0 },
      ],
    },
    { primitives: [{ attributes: { POSITION: 0 }, material: 2 }, { attributes: { POSITION: 0 } }] },
  ],
  // GLTFLoader has one texture for each image and sampler, so colours and other data need different ones.
  images: [{ uri: image }, { uri: `${image.slice(0, -4)}ggAA` }],
  samplers: [{ magFilter: 9728, minFilter: 9985, wrapS: 33071, wrapT: 33648 }],
  textures: [{ source: 0, sampler: 0 }, { source: 0 }, { source: 1, sampler: 0 }, { source: 1 }],
  extensionsUsed: ['KHR_texture_transform', 'KHR_materials_unlit'],
  materials: [
    {
      name: 'all',
      doubleSided: true,
      alphaMode: 'MASK',
      alphaCutoff: 0.3,
      emissiveFactor: [0.1, 0.2, 0.3],
      normalTexture: { index: 2, scale: 0.7 },
      occlusionTexture: { index: 3, strength: 0.6, texCoord: 1 },
      emissiveTexture: { index: 0, extensions: transform },
      pbrMetallicRoughness: {
        baseColorFactor: [0.2, 0.4, 0.6, 0.8],
        baseColorTexture: { index: 1, extensions: { KHR_texture_transform: { offset: [0.5, 0], texCoord: 1 } } },
        metallicFactor: 0.3,
        roughnessFactor: 0.4,
        metallicRoughnessTexture: { index: 2 },
      },
      extras: { paint: 3 },
      extensions: {
        KHR_materials_clearcoat: {
          clearcoatFactor: 0.5,
          clearcoatRoughnessFactor: 0.4,
          clearcoatTexture: { index: 2 },
          clearcoatNormalTexture: { index: 3, scale: 2 },
        },
        KHR_materials_sheen: {
          sheenColorFactor: [0.1, 0.5, 0.9],
          sheenRoughnessFactor: 0.3,
          sheenColorTexture: { index: 0, extensions: transform },
        },
        KHR_materials_transmission: { transmissionFactor: 0.2, transmissionTexture: { index: 3 } },
        KHR_materials_volume: { thicknessFactor: 0.1, attenuationDistance: 4, attenuationColor: [1, 0.5, 0.2] },
        KHR_materials_ior: { ior: 1.3 },
        KHR_materials_specular: { specularFactor: 0.9, specularColorFactor: [0.9, 0.8, 0.7], specularColorTexture: { index: 0 } },
        KHR_materials_iridescence: {
          iridescenceFactor: 0.4,
          iridescenceIor: 1.6,
          iridescenceThicknessMinimum: 50,
          iridescenceThicknessMaximum: 350,
        },
        KHR_materials_anisotropy: { anisotropyStrength: 0.6, anisotropyRotation: 1.1 },
        KHR_materials_dispersion: { dispersion: 0.1 },
        KHR_materials_emissive_strength: { emissiveStrength: 5 },
      },
    },
    { name: 'blend', alphaMode: 'BLEND', pbrMetallicRoughness: { baseColorFactor: [1, 0, 0, 0.5] } },
    { name: 'unlit', extensions: { KHR_materials_unlit: {} }, pbrMetallicRoughness: { baseColorTexture: { index: 1 } } },
  ],
};

/** What matters of a property of a material. Factors of a bendy file are 32-bit floats. */
function essence(value) {
  if (typeof value === 'number') return Math.fround(value);
  if (Array.isArray(value)) return value.map(essence);
  if (value?.isColor || value?.isVector2) return essence(value.toArray());
  if (value?.isMatrix3) return value.elements.map((x) => Math.round(1e6 * x) / 1e6);
  if (!value?.isTexture) return value;
  value.updateMatrix();
  const { channel, colorSpace, flipY, generateMipmaps, magFilter, minFilter, wrapS, wrapT, offset, repeat, rotation } = value;
  const matrix = new THREE.Matrix3().copy(value.matrix);
  return Object.fromEntries(
    Object.entries({
      channel,
      colorSpace,
      flipY,
      generateMipmaps,
      magFilter,
      minFilter,
      wrapS,
      wrapT,
      offset,
      repeat,
      rotation,
      matrix,
    })
      .map(([name, part]) => [name, essence(part)])
      .concat([
        ['image', value.image.bytes.toString('base64')],
        ['isUploaded', value.version > 0],
      ]),
  );
}

function materialOf({ material }) {
  const properties = {};
  for (const name of Object.keys(material))
    if (!['uuid', 'version', '_listeners'].includes(name)) properties[name] = essence(material[name]);
  if (!material.isMeshStandardMaterial) delete properties.flatShading; // GLTFLoader sets it for lines, which have none
  return { type: material.type, ...properties };
}

/** What matters of an object, and its triangles in any order: the values of all attributes at the three corners. */
function objectOf({ type, name, geometry, morphTargetInfluences, morphTargetDictionary }) {
  const attributes = Object.keys(geometry.attributes)
    .filter((attribute) => !attribute.startsWith('skin'))
    .sort();
  const cornerAt = (vertex) =>
    attributes.flatMap((name) => {
      const attribute = geometry.attributes[name];
      return Array.from({ length: attribute.itemSize }, (_, k) => Math.fround(attribute.getComponent(vertex, k)));
    });
  const indices = geometry.index?.array ?? Array.from({ length: geometry.attributes.position.count }, (_, k) => k);
  const corners = Array.from(indices, cornerAt);
  const size = { Points: 1, LineSegments: 2 }[type] ?? 3;
  const triangles = corners.flatMap((_, k) => (k % size === 0 ? [corners.slice(k, k + size).join(' ')] : [])).sort();
  return { type, name, attributes, triangles, influences: essence(morphTargetInfluences), dictionary: morphTargetDictionary };
}

const drawn = (scene) => {
  const objects = [];
  scene.traverse((object) => object.geometry && objects.push(object));
  return objects;
};

describe('materials and geometry', { skip }, () => {
  const files = [
    'models/fox.glb',
    'models/texture_transform_test/TextureTransformTest.gltf',
    'models/cesium_man.gltf',
    'models/box_textured_embedded.gltf',
    'models/uri_spaces/CubeImageUriSpaces.gltf',
    'models/robot.glb',
    'generated/attributes_zoo.glb',
    'generated/texture_transform.glb',
    'generated/external_buffers/external_buffers.gltf',
    'generated/names_unicode.glb',
    'generated/morph_and_skin.glb',
    'models/morph_stress_test.gltf',
    'every extension',
  ];
  for (const file of files) {
    it(file, async () => {
      const source = file === 'every extension' ? writeGltf('every_extension.gltf', everyExtension) : file;
      const made = file === 'every extension' ? `${address}every_extension.gltf` : url(source);
      const gltf = await new GLTFLoader().loadAsync(made);
      const character = await loadBendy(source);
      const [expected, actual] = [drawn(gltf.scene), drawn(character.scene)];
      assert.equal(actual.length, expected.length);
      for (const [k, object] of actual.entries()) {
        assert.deepEqual(materialOf(object), materialOf(expected[k]));
        assert.deepEqual(objectOf(object), objectOf(expected[k]));
      }
      const named = ({ scene }) => {
        const all = [];
        scene.traverse(({ type, name, userData }) => all.push({ type, name, userData }));
        return all;
      };
      assert.deepEqual(named(character), named(gltf));
      assert.deepEqual([character.userData, character.asset], [gltf.userData, gltf.asset]);
    });
  }
});

/** Three joints of one triangle each, with these names; each clip moves one of them up by 2. */
const namedNodes = (names) => ({
  scenes: [{ nodes: names.map((_, node) => node) }],
  nodes: names.map((name, node) => ({ name, mesh: 0, translation: [node, 0, 0] })),
  animations: names.map((_, node) => ({
    channels: [{ sampler: 0, target: { node, path: 'translation' } }],
    samplers: [{ input: 1, output: 2 }],
  })),
});

test('every object gets a name of its own, and clips move the right one', { skip }, async () => {
  const lists = [['Bone', 'Bone', 'Bone_1'], ['Bone_1', 'Bone', 'Bone'], ['Bone', 'Bone', 'Bone_1', 'Bone_1', 'Bone'], ['a b', 'a_b', 'a.b', 'ab']];
  for (const [k, names] of lists.entries()) {
    const character = await loadBendy(writeGltf(`names_${k}.gltf`, namedNodes(names)));
    const given = character.joints.map(({ name }) => name);
    assert.equal(new Set(given).size, names.length, given.join());
    names.forEach((name, joint) => assert.equal(character.joints[joint].userData.name, name));
    for (const [moved, clip] of character.animations.entries()) {
      const stop = mix(character.scene, clip, 1);
      character.joints.forEach(({ position }, joint) => assert.equal(position.y, joint === moved ? 2 : 0, `${given[joint]} in clip ${moved}`));
      stop();
    }
  }
});

test('every morph target gets a name of its own', { skip }, async () => {
  const targets = ['Smile', '', '1', 'Smile', ''];
  const mesh = { primitives: [{ attributes: { POSITION: 0 }, targets: targets.map(() => ({ POSITION: 0 })) }], extras: { targetNames: targets } };
  const { parts } = await loadBendy(writeGltf('target_names.gltf', { nodes: [{ mesh: 0 }], meshes: [mesh] }));
  assert.deepEqual(parts[0].object.morphTargetDictionary, { Smile: 0, '1_1': 1, 1: 2, Smile_1: 3, 4: 4 });
});

test('errors are BendyErrors', async () => {
  const fails = (kind) => (error) => error instanceof BendyError && error.kind === kind;
  await assert.rejects(new BendyLoader().loadAsync(`${address}nothing.bendy`), fails('io'));
  await assert.rejects(
    new BendyLoader().parseAsync(new TextEncoder().encode('This is no bendy file at all, only text.')),
    fails('malformed'),
  );
  const manager = new THREE.LoadingManager();
  const events = [];
  manager.onLoad = () => events.push('load');
  manager.onError = () => events.push('error');
  await new Promise((resolve) => new BendyLoader(manager).load(`${address}nothing.bendy`, assert.fail, undefined, resolve));
  await new Promise((resolve) => setTimeout(resolve));
  assert.ok(events.includes('error') && events.includes('load'));
});

test('an animator plays the clips of another human, and its own again', async () => {
  const file = path.join(folder, 'dancer.bendy');
  execFileSync(program, ['convert', '-q', path.join(repository, 'examples/mannequin.glb'), '-o', file]);
  const other = path.join(folder, 'knight.bendy');
  execFileSync(program, ['edit', '-q', file, '-o', other, '--strip', 'clip:Walk', '--rename-joint', 'mixamorig:*=b_*']);
  const [dancer, knight] = [fs.readFileSync(file), fs.readFileSync(other)];
  const character = await new BendyLoader().parseAsync(knight);
  const animator = new BendyAnimator(character).play('Idle');
  const source = await Model.open(dancer);
  assert.equal(animator.borrow(source).borrow(source), animator);
  assert.deepEqual(animator.clips.map(({ name }) => name), ['Idle', 'Walk']);
  animator.play('Walk').update(0.3);
  const expected = character.model.pose();
  new Retarget(source, character.model).apply(expected, source.sample('Walk', 0.3), new RetargetState(source.runtime));
  assert.deepEqual(animator.pose.locals, expected.locals);
  assert.deepEqual(character.joints[5].quaternion.toArray().map(Math.fround), expected.local(5).rotation);

  const bare = await Model.open(execFileSync(program, ['edit', '-q', file, '-o', '-', '--strip', 'roles'], { maxBuffer: 1 << 26 }));
  assert.throws(() => animator.borrow(bare), { code: 'BAD_ARGUMENT', message: /the source does not say what its joints are/ });
  assert.equal(animator.clips.length, 2, 'nothing has changed');
  assert.equal(bare.clips.length, 2);

  assert.deepEqual(animator.borrow(null).clips.map(({ name }) => name), ['Idle']);
  assert.throws(() => source.pose(), { code: 'DISPOSED' });
  animator.play('Idle').update(0.2);
  assert.deepEqual(animator.pose.locals, character.model.sample('Idle', 0.2).locals);
  animator.stop().update(0.2);
  assert.deepEqual(animator.pose.locals, character.model.pose().locals);
  animator.borrow(await Model.open(dancer)).dispose();
});

test('a chain that reaches within update remembers what it did', async () => {
  const file = path.join(folder, 'reaching.bendy');
  execFileSync(program, ['convert', '-q', path.join(repository, 'examples/mannequin.glb'), '-o', file]);
  const character = await new BendyLoader().parseAsync(fs.readFileSync(file));
  const { model } = character;
  const animator = new BendyAnimator(character).play('Idle');
  const [state, pose, clock] = [new ReachState(model), model.pose(), new CrossFade(model).play('Idle')];
  const [target, options] = [[-0.2, 1.5, 0.3], { space: 'model' }];
  for (let frame = 0; frame < 60; ++frame) {
    animator.update(1 / 60, () => animator.reach('IK_LeftArm', target, options));
    clock.advance(1 / 60).sample(pose);
    pose.reach('IK_LeftArm', target, { state, seconds: 1 / 60 });
    assert.deepEqual(animator.pose.locals, pose.locals, `frame ${frame}`);
  }
  const alone = model.sample('Idle', 0.7);
  const expected = alone.reach('IK_LeftArm', target);
  assert.deepEqual(animator.sample('Idle', 0.7).reach('IK_LeftArm', target, options), expected);
  assert.deepEqual(animator.pose.locals, alone.locals);
  animator.dispose();
});

test('images stay undecoded without a browser', { skip }, async () => {
  const { createImageBitmap } = globalThis;
  delete globalThis.createImageBitmap;
  try {
    const { parts } = await loadBendy('models/fox.glb');
    assert.equal(parts[0].object.material.map.userData.mimeType, 'image/png');
    assert.equal(parts[0].object.material.map.image, null);
  } finally {
    globalThis.createImageBitmap = createImageBitmap;
  }
});

test('SkeletonHelper takes the scene', { skip }, async () => {
  const { scene, model } = await loadBendy('models/fox.glb');
  assert.equal(new THREE.SkeletonHelper(scene).bones.length, model.meshes[0].boneCount);
});
