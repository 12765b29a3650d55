// Characters in Babylon.js and PlayCanvas, without a GPU: what these engines compute is compared with the runtime's vertices.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { Logger } from '@babylonjs/core/Misc/logger.js';
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { NullEngine } from '@babylonjs/core/Engines/nullEngine.js';
import { Matrix, Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Scene } from '@babylonjs/core/scene.js';
import * as pc from 'playcanvas';
import * as babylon from '../dist/engines/babylon.js';
import * as playcanvas from '../dist/engines/playcanvas.js';
import { bendy, corpusFile, convert, difference, example, exampleWithClipExtras, extent, folder, plain, read, simd } from './helpers.mjs';

Logger.LogLevels = Logger.ErrorLogLevel;
const mannequin = read(example('mannequin'));
/** Files whose meshes are skinned in different ways: by the engine, by the runtime (morph targets, rigid). */
const files = [
  ['the mannequin', mannequin],
  ...['generated/joints8.glb', 'generated/morph_and_skin.glb', 'models/robot.glb', 'models/box_textured_embedded.gltf']
    .filter((name) => corpusFile(name) !== undefined)
    .map((name) => [name, read(convert(corpusFile(name)))]),
];

function babylonScene(isRightHanded) {
  const scene = new Scene(new NullEngine());
  scene.useRightHandedSystem = isRightHanded;
  new FreeCamera('camera', new Vector3(0, 1, -5), scene);
  return scene;
}

/** An application that draws nothing. */
function playCanvasApp() {
  const device = new pc.NullGraphicsDevice({ width: 8, height: 8, addEventListener() {}, removeEventListener() {} });
  const app = new pc.AppBase({ id: 'none', addEventListener() {}, removeEventListener() {} });
  const options = new pc.AppOptions();
  Object.assign(options, { graphicsDevice: device, componentSystems: [pc.RenderComponentSystem, pc.CameraComponentSystem] });
  app.init(options);
  return app;
}

/** Sets the first clip, if there is one, to a time, and applies it. */
function pose(character, seconds) {
  if (character.model.clips.length > 0) character.pose.sample(0, seconds);
  character.apply();
}

/** The vertices of a mesh by another runtime's palette or, without one, as they are. */
function byPalette(mesh, palette) {
  const { bones, weights, positions, influenceCount } = mesh;
  const result = new Float32Array(3 * mesh.vertexCount);
  bones.forEach((bone, k) => {
    const vertex = Math.floor(k / influenceCount);
    const [x, y, z] = positions.subarray(3 * vertex, 3 * vertex + 3);
    for (let row = 0; row < 3; ++row) {
      const at = 16 * bone + row;
      result[3 * vertex + row] += weights[k] * (palette[at] * x + palette[at + 4] * y + palette[at + 8] * z + palette[at + 12]);
    }
  });
  return result;
}

test('what is no option, and use after dispose, are refused', async () => {
  const scene = babylonScene(true);
  const bad = (message) => ({ code: 'BAD_ARGUMENT', message });
  await assert.rejects(babylon.loadBendy(mannequin, scene, { skins: 'wasm' }), bad(/^loadBendy has no option "skins"; did you mean skin\?$/));
  const character = await babylon.loadBendy(mannequin, scene);
  assert.throws(() => character.play('Walk', { loops: false }), bad(/^play has no option "loops"; did you mean loop\?$/));
  assert.throws(() => character.play('Walk', { speed: '2' }), bad(/^speed is a text, "2", not a number$/));
  assert.throws(() => character.update(), bad(/^seconds is missing/));
  character.dispose();
  for (const use of [() => character.update(0), () => character.play('Walk')]) assert.throws(use, { kind: 'disposed', message: 'this character has been disposed' });
});

for (const [name, bytes] of files) {
  test(`Babylon.js: ${name}`, async () => {
    const scene = babylonScene(true);
    const character = await babylon.loadBendy(bytes, scene);
    assert.ok(character.parts.length > 0);
    for (const seconds of [0.1, 0.35]) {
      pose(character, seconds);
      scene.render(); // the engine computes its matrices once per frame
      for (const { mesh, object, skeleton } of character.parts) {
        assert.equal(skeleton === null, mesh.isRigid || mesh.morphTargets.length > 0 || mesh.influenceCount > 8);
        const expected = character.pose.skin({ mesh }).positions;
        const tolerance = 2e-6 * extent(expected);
        assert.ok(difference(object.getPositionData(true, false), expected) <= tolerance, mesh.name);
        if (skeleton === null) continue;
        const palette = character.pose.palette(mesh);
        assert.ok(difference(skeleton.getTransformMatrices(object).subarray(0, palette.length), palette) === 0);
      }
    }
    character.dispose();
    assert.equal(scene.meshes.length + scene.skeletons.length + scene.transformNodes.length + scene.materials.length, 0);
    assert.ok(character.model.disposed);
  });

  test(`PlayCanvas: ${name}`, async () => {
    const app = playCanvasApp();
    const character = await playcanvas.loadBendy(bytes, app);
    app.root.addChild(character.entity);
    assert.ok(character.parts.length > 0);
    for (const seconds of [0.1, 0.35]) {
      pose(character, seconds);
      for (const { mesh, instances, skin } of character.parts) {
        assert.equal(skin === null, mesh.isRigid || mesh.morphTargets.length > 0 || mesh.influenceCount > 4);
        assert.ok(instances.length > 0);
        const expected = character.pose.skin({ mesh }).positions.slice();
        if (skin === null) {
          const positions = [];
          instances[0].mesh.getPositions(positions);
          assert.equal(difference(positions, expected), 0, mesh.name);
          continue;
        }
        skin.updateMatrixPalette(character.entity, 1);
        const rows = skin.matrixPalette;
        const palette = Float32Array.from({ length: 16 * mesh.boneCount }, (_, k) => (k % 4 === 3 ? (k % 16 === 15 ? 1 : 0) : rows[12 * (k >> 4) + 4 * (k % 4) + ((k >> 2) % 4)]));
        assert.ok(difference(byPalette(mesh, palette), expected) <= 2e-6 * extent(expected), mesh.name);
        for (const instance of instances) assert.equal(instance.skinInstance, skin);
      }
    }
    character.dispose();
    assert.ok(character.model.disposed);
    app.destroy();
  });
}

/** Two triangles of one mesh, at z = 0 and z = 2, each with a material of its own. */
function twoMaterials(modes, { doubleSided = false, how = 'rigid', extraLine = false } = {}) {
  const buffers = [];
  const bufferViews = [];
  const accessors = [];
  const put = (array, type) => {
    const width = { SCALAR: 1, VEC3: 3, VEC4: 4, MAT4: 16 }[type];
    const componentType = array instanceof Uint8Array ? 5121 : 5126;
    bufferViews.push({ buffer: buffers.length, byteLength: array.byteLength });
    buffers.push({ byteLength: array.byteLength, uri: `data:;base64,${Buffer.from(array.buffer).toString('base64')}` });
    const bounds = type === 'VEC3' ? { min: [0, 0, 0], max: [1, 1, 2] } : {};
    return accessors.push({ bufferView: bufferViews.length - 1, componentType, count: array.length / width, type, ...bounds }) - 1;
  };
  const attributes = { POSITION: put(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, 1, 0, 2, 0, 1, 2]), 'VEC3') };
  if (how === 'skinned') {
    Object.assign(attributes, { JOINTS_0: put(new Uint8Array(24), 'VEC4'), WEIGHTS_0: put(Float32Array.from({ length: 24 }, (_, k) => (k % 4 === 0 ? 1 : 0)), 'VEC4') });
  }
  const targets = how === 'morphed' ? { targets: [{ POSITION: put(new Float32Array(18).fill(0.1), 'VEC3') }] } : {};
  const primitives = [[0, 1, 2], [3, 4, 5]].map((triangle, material) => ({ attributes, material, indices: put(Uint8Array.from(triangle), 'SCALAR'), ...targets }));
  if (extraLine) primitives.push({ attributes, material: 0, mode: 1, indices: put(Uint8Array.from([0, 1]), 'SCALAR'), ...targets });
  const gltf = {
    asset: { version: '2.0' },
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, ...(how === 'skinned' ? { skin: 0 } : {}) }],
    ...(how === 'skinned' ? { skins: [{ joints: [0] }] } : {}),
    meshes: [{ primitives }],
    materials: modes.map((alphaMode) => ({ alphaMode, doubleSided, pbrMetallicRoughness: { baseColorFactor: [1, 0, 0, 0.5] } })),
    accessors, bufferViews, buffers,
  };
  writeFileSync(join(folder, 'two.gltf'), JSON.stringify(gltf));
  return read(convert(join(folder, 'two.gltf'), '--quiet'));
}

const drawnCases = [['BLEND', 'OPAQUE'], ['OPAQUE', 'BLEND'], ['BLEND', 'BLEND'], ['MASK', 'BLEND'], ['BLEND', 'MASK'], ['OPAQUE', 'OPAQUE']].flatMap((modes) =>
  [{}, { how: 'skinned' }, { how: 'morphed' }, { doubleSided: true }, { extraLine: true }].map((more) => [modes, more]),
);

test('Babylon.js: meshes of two materials are drawn, whichever blends', async () => {
  for (const [modes, more] of drawnCases) {
    const bytes = twoMaterials(modes, more);
    for (const [isRightHanded, skin] of [[true, 'gpu'], [false, 'wasm']]) {
      const what = `${modes} ${JSON.stringify(more)} ${skin}`;
      const scene = babylonScene(isRightHanded);
      const character = await babylon.loadBendy(bytes, scene, { skin });
      await scene.whenReadyAsync();
      for (let frame = 0; frame < 3; ++frame) {
        character.update(0.1);
        scene.render();
        assert.equal(scene.getActiveIndices(), 6, what);
      }
      const [{ object }] = character.parts;
      const depths = object.subMeshes.map((one) => Math.abs(one.getBoundingInfo().boundingSphere.centerWorld.z));
      assert.deepEqual(depths.map(Math.round), [0, 2], what); // by which those that blend are sorted
      character.dispose();
      scene.render();
    }
  }
});

test('PlayCanvas: meshes of two materials are drawn, whichever blends', async () => {
  for (const [modes, more] of drawnCases) {
    const bytes = twoMaterials(modes, more);
    for (const skin of ['gpu', 'wasm']) {
      const what = `${modes} ${JSON.stringify(more)} ${skin}`;
      const app = playCanvasApp();
      const camera = new pc.Entity();
      camera.addComponent('camera');
      camera.setPosition(0, 0, 9);
      app.root.addChild(camera);
      const character = await playcanvas.loadBendy(bytes, app, { skin });
      app.root.addChild(character.entity);
      const [{ instances }] = character.parts;
      for (let frame = 0; frame < 3; ++frame) {
        character.update(0.1);
        app.render();
        assert.deepEqual(instances.map(({ aabb }) => Math.round(aabb.center.z)), [0, 2], what);
        assert.deepEqual(instances.map(({ transparent }) => transparent), modes.map((mode) => mode === 'BLEND'), what);
        assert.equal(app.stats.frame.triangles ?? 2, 2, what);
      }
      character.dispose();
      app.destroy();
    }
  }
});

test('Babylon.js: a left-handed scene shows the mirror image of model space, as of a glTF file', async () => {
  const scene = babylonScene(false);
  const character = await babylon.loadBendy(mannequin, scene);
  pose(character, 0.35);
  scene.render();
  const hand = character.attach('mixamorig:LeftHand');
  character.apply();
  hand.computeWorldMatrix(true);
  const [x, y, z] = character.pose.socket('mixamorig:LeftHand').slice(12);
  const world = hand.getAbsolutePosition();
  assert.ok(difference([world.x, world.y, world.z], [-x, y, z]) < 1e-6);
  assert.ok(character.parts[0].object.getWorldMatrix().determinant() < 0);
});

test('Babylon.js: the product in the other order is 2.77 off, as the comment in babylon.ts says', async () => {
  const scene = babylonScene(true);
  const character = await babylon.loadBendy(mannequin, scene);
  const { mesh } = character.parts[0];
  const joints = character.pose.sample('Idle', 0).modelMatrices().slice();
  const palette = character.pose.palette(mesh).slice();
  const off = (multiply) => {
    const made = new Float32Array(16 * mesh.boneCount);
    mesh.boneJoints.forEach((joint, bone) => {
      multiply(Matrix.FromArray(mesh.inverseBind, 16 * bone), Matrix.FromArray(joints, 16 * joint)).copyToArray(made, 16 * bone);
    });
    return difference(made, palette);
  };
  assert.ok(off((inverseBind, joint) => inverseBind.multiply(joint)) < 1e-6);
  assert.equal(off((inverseBind, joint) => joint.multiply(inverseBind)).toFixed(2), '2.77');
});

for (const [name, load, place] of [
  ['Babylon.js', async (source, options) => babylon.loadBendy(source, babylonScene(true), options), (node) => node.position.asArray()],
  ['PlayCanvas', async (source, options) => playcanvas.loadBendy(source, playCanvasApp(), options), (node) => [...Object.values(node.getLocalPosition())]],
]) {
  test(`${name}: clips play and fade, and something follows a joint`, async () => {
    const character = await load(mannequin);
    const hand = character.attach('mixamorig:LeftHand');
    assert.equal(character.attach('mixamorig:LeftHand'), hand);
    character.play('Idle').play('Walk', { fade: 0.2, speed: 2 }).update(0.3, (now) => now.reach('IK_LeftArm', [0.3, 1.2, 0.4]));
    const expected = character.model.sample('Walk', 0.6);
    expected.reach('IK_LeftArm', [0.3, 1.2, 0.4]);
    assert.ok(difference(character.pose.locals, expected.locals) < 1e-5);
    assert.ok(difference(place(hand).slice(0, 3), expected.socket('mixamorig:LeftHand').slice(12, 15)) < 1e-5);
    assert.throws(() => character.attach('tail'), { name: 'BendyError', code: 'NOT_FOUND' });
    character.dispose();
  });

  test(`${name}: a clip repeats unless it is told not to, by play or by its extras`, async () => {
    for (const [extras, options, isRepeated] of [
      [undefined, {}, true],
      [undefined, { loop: false }, false],
      [{ loop: false }, {}, false],
      [{ loop: false }, { loop: true }, true],
      [{ loop: 0 }, {}, false],
    ]) {
      const character = await load(read(exampleWithClipExtras('mannequin', extras)));
      assert.equal(character.model.clips.get('Walk').loops, false);
      const { model, pose } = character;
      const { start, end } = model.clips.get('Walk');
      character.play('Walk', options).update(end - start + 0.1);
      assert.ok(difference(pose.locals, model.sample('Walk', isRepeated ? start + 0.1 : end).locals) < 1e-5);
      character.dispose();
    }
  });

  test(`${name}: the runtime skins when it is asked to, in an instance of its own`, async () => {
    const character = await load(mannequin, { skin: 'wasm', runtime: plain });
    assert.equal(character.model.runtime, plain);
    for (const part of character.parts) assert.equal(part.skin ?? part.skeleton ?? null, null);
    character.dispose();
    await assert.rejects(load(new Uint8Array(7), { runtime: simd }), { name: 'BendyError', kind: 'malformed' });
  });
}
