// Poses and vertices equal the native program's.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { Binding, BodyReach, CrossFade, Crowd, LevelOfDetail, loadRuntime, Model, Pose, ReachState, Retarget, RootPath } from '../dist/index.js';
import { bendy, convert, corpusFile, difference, example, extent, folder, plain, read, simd } from './helpers.mjs';

// The kernels round differently: a vertex is a sum of up to eight products of floats with an error of 2^-24 each, and so are
// the matrices along a path of up to some twenty joints.
const floatTolerance = 20 * 2 ** -20;

const characters = {
  mannequin: () => example('mannequin'),
  'mannequin, compact': () => example('mannequin', '--compact', '--lod'),
  tentacle: () => example('tentacle'),
  'tentacle, compact': () => example('tentacle', '--compact'),
};
for (const name of ['fox.glb', 'robot.glb', 'left_hand_high.glb', 'cesium_man.gltf', 'simple_skin.gltf', 'morph_stress_test.gltf', 'box_animated.gltf',
  'rigged_simple.gltf', 'gltf_extras.glb']) {
  characters[name] = () => {
    const file = corpusFile(`models/${name}`);
    return file && convert(file, '--keep-order');
  };
}

/** What the program computes: `bendy pose` as JSON. */
function native(file, clip, seconds, kernel, ...options) {
  const output = join(folder, 'pose.json');
  const when = clip === undefined ? [] : ['--clip', String(clip), '--time', String(seconds)];
  bendy(['pose', file, ...when, ...options, '-o', output], kernel);
  // The program prints the shortest decimal numbers that are read as the same floats.
  return JSON.parse(readFileSync(output, 'utf8'), (_, value) => (typeof value === 'number' ? Math.fround(value) : value));
}

/** Compares a pose with the program's, each number within the tolerance relative to the character's size. */
function compare(pose, model, expected, tolerance) {
  const skinned = pose.skin({ normals: true });
  const matrices = pose.modelMatrices();
  expected.joints.forEach(({ world }, joint) => {
    assert.ok(difference(matrices.subarray(16 * joint, 16 * joint + 16), world) <= tolerance * extent(world), `joint ${joint}`);
  });
  expected.meshes.forEach((mesh, number) => {
    const { firstVertex, vertexCount } = model.meshes[number];
    const positions = mesh.positions;
    const part = skinned.positions.subarray(3 * firstVertex, 3 * (firstVertex + vertexCount));
    assert.ok(difference(part, positions) <= tolerance * extent(positions), `positions of ${mesh.name}: ${difference(part, positions)}`);
    if (!mesh.normals?.length) return;
    const normals = skinned.normals.subarray(3 * firstVertex, 3 * (firstVertex + vertexCount));
    assert.ok(difference(normals, mesh.normals) <= 10 * tolerance, `normals of ${mesh.name}`);
  });
}

for (const [name, make] of Object.entries(characters)) {
  test(`${name}: the poses of the program`, async (t) => {
    const file = make();
    if (file === undefined) return t.skip('the corpus is not there');
    const bytes = read(file);
    const models = { simd: await Model.open(bytes, { runtime: simd }), plain: await Model.open(bytes, { runtime: plain }) };
    const times = [[undefined, 0]];
    for (const { number, start, end } of models.simd.clips.slice(0, 3)) {
      times.push([number, start + 0.3 * (end - start)], [number, end]);
    }
    for (const [clip, seconds] of times) {
      const time = Math.fround(seconds);
      const poses = Object.values(models).map((model) => (clip === undefined ? model.pose() : model.sample(clip, time)));
      compare(poses[0], models.simd, native(file, clip, time, ''), floatTolerance);
      compare(poses[1], models.plain, native(file, clip, time, 'plain'), 0);
      for (const { number, isRigid } of models.simd.meshes) {
        if (isRigid) continue;
        const palette = poses[0].palette(number);
        assert.ok(difference(palette, poses[1].palette(number)) <= floatTolerance * extent(palette));
      }
      for (const pose of poses) pose.dispose();
    }
    for (const model of Object.values(models)) model.dispose();
  });
}

test('the modules are what they say', () => {
  assert.equal(simd.kernel, 'wasm');
  assert.equal(plain.kernel, 'plain');
});

test('one mesh is skinned where it is among all, and only that', async () => {
  const model = await Model.open(read(example('mannequin')), { runtime: simd });
  const pose = model.sample('Walk', 0.3);
  const all = pose.skin().positions.slice();
  pose.sample('Walk', 0.6);
  const head = model.meshes.get('Head');
  const { positions } = pose.skin({ mesh: 'Head' });
  const first = 3 * head.firstVertex;
  assert.equal(positions.length, 3 * head.vertexCount);
  assert.notDeepEqual(positions, all.subarray(first, first + positions.length));
  assert.deepEqual(pose.copy().skin().positions.subarray(first, first + positions.length), positions);
  const everything = new Float32Array(positions.buffer, positions.byteOffset - 4 * first, all.length);
  assert.deepEqual(everything.subarray(0, first), all.subarray(0, first));
  assert.throws(() => pose.skin({ mesh: 'Tail' }), { code: 'NOT_FOUND', message: /"Body", "Head"/ });
  model.dispose();
});

test('tangents, dual quaternions and levels of detail', async () => {
  const file = example('mannequin', '--lod');
  for (const runtime of [simd, plain]) {
    const model = await Model.open(read(file), { runtime });
    const pose = model.sample('Walk', 0.3);
    const linear = pose.skin({ normals: true, tangents: true }).positions.slice();
    assert.equal(pose.skin().tangents.length, 4 * model.vertexCount);
    const dual = pose.skin({ method: 'dual_quaternion' }).positions;
    assert.ok(difference(dual, linear) > 1e-4);
    assert.ok(difference(dual, linear) < 0.1);

    assert.ok(model.hasLevels);
    const lod = new LevelOfDetail(model, 0.3);
    assert.ok(lod.error > 0);
    const full = new LevelOfDetail(model);
    assert.ok(lod.triangles < 0.4 * full.triangles);
    pose.skin({ lod });
    const expected = native(file, 'Walk', Math.fround(0.3), runtime === simd ? '' : 'plain', '--lod', '0.3');
    expected.meshes.forEach((mesh, number) => {
      const used = lod.vertices(number);
      assert.equal(3 * used, mesh.positions.length);
      assert.deepEqual(Array.from(lod.indices(number)), mesh.indices);
    });
    assert.throws(() => pose.skin({ method: 'other' }), { code: 'BAD_ARGUMENT' });
    model.dispose();
  }
});

test('reach goes to the target within the constraints, as the program', async () => {
  const file = example('mannequin');
  for (const runtime of [simd, plain]) {
    const model = await Model.open(read(file), { runtime });
    const constrained = model.constraints.filter(({ scope }) => scope !== 'all_but_ik');
    assert.ok(constrained.length > 10);
    for (const target of [[0.3, 1.2, 0.4], [0.1, 1.5, 0.3], [0.4, 0.9, 0.2], [2, 1, 0]]) {
      const pose = model.sample('Walk', 0.3).constrain();
      const chain = model.chains.get('IK_LeftArm');
      const result = pose.reach('IK_LeftArm', target);
      for (const constraint of constrained) {
        if (!chain.links.includes(constraint.joint)) continue;
        const { violation } = model.clampRotation(constraint, pose.local(constraint.joint).rotation);
        // A local rotation is four floats: half an angle to 2^-24, and the solver's own tolerance.
        assert.ok(violation < 1e-5, `${model.joints[constraint.joint].name}: ${violation}`);
      }
      const expected = native(file, 'Walk', Math.fround(0.3), runtime === simd ? '' : 'plain', '--constrain', '--reach', `IK_LeftArm=${target}`);
      assert.equal(result.reached, expected.reaches[0].reached);
      assert.ok(Math.abs(result.distance - expected.reaches[0].distance) < 1e-5);
      compare(pose, model, expected, runtime === simd ? 1e-4 : 0);
      pose.dispose();
    }
    model.dispose();
  }
});

test('with a state, a chain that reaches while a clip plays does not jump, as in the program', async () => {
  const model = await Model.open(read(example('mannequin')), { runtime: plain });
  const [state, chain, target] = [new ReachState(model), 'IK_LeftArm', [-0.2, 1.5, 0.3]];
  const tip = model.chains.get(chain).links.at(-1);
  let before = null;
  for (let frame = 0; frame <= 60; ++frame) {
    const pose = model.sample('Idle', frame / 60);
    const { distance } = frame % 2 === 0
      ? pose.reach(chain, target, { state, seconds: 1 / 60 })
      : pose.reachChains([{ chain, position: target, options: { state, seconds: 1 / 60 } }])[0];
    const now = [...pose.modelMatrices().slice(16 * tip, 16 * tip + 12)];
    if (before !== null) {
      const cosine = [0, 1, 2, 4, 5, 6, 8, 9, 10].reduce((sum, k) => sum + before[k] * now[k], -1) / 2;
      assert.ok(Math.acos(Math.min(1, cosine)) < 0.1, `frame ${frame}`);
    }
    before = now;
    if (frame === 0) assert.equal(distance, model.sample('Idle', 0).reach(chain, target).distance);
  }
  state.forget(chain).reset();
  assert.equal(model.pose().reachAll(state, 0.1) instanceof Pose, true);
  const other = await Model.open(read(example('mannequin')), { runtime: plain });
  assert.throws(() => other.pose().reach(chain, target, { state }), { code: 'BAD_ARGUMENT', message: /state is of another model than pose/ });
  assert.throws(() => model.pose().reach(chain, target, { state: 3 }), { code: 'BAD_ARGUMENT' });
  state.dispose();
  assert.throws(() => model.pose().reach(chain, target, { state }), { code: 'DISPOSED' });
  other.dispose();
  model.dispose();
});

test('what a chain follows is carried by default', async () => {
  const model = await Model.open(read(example('mannequin')));
  const [chain, position] = [model.chains.get('IK_LeftArm'), [0.3, 1.2, 0.4]];
  const place = (pose) => Array.from(pose.socket(chain.target).slice(12, 15));
  const before = place(model.pose());
  for (const reach of [
    (pose, options) => pose.reach(chain, position, options),
    (pose, options) => pose.reachChains([{ chain, position, options }])[0],
  ]) {
    const pose = model.pose();
    assert.ok(reach(pose, { carryTarget: false }).reached);
    assert.deepEqual(place(pose), before);
    assert.ok(reach(pose).reached);
    assert.ok(difference(place(pose), position) < 1e-3);
  }
  model.dispose();
});

test('several chains reach as one after another', async () => {
  for (const runtime of [simd, plain]) {
    const model = await Model.open(read(example('mannequin')), { runtime });
    const requests = [
      { chain: 'IK_LeftArm', position: [0.3, 1.2, 0.4] },
      { chain: 'IK_RightArm', position: [-0.3, 1.3, 0.3], options: { influence: 0.5, obeyConstraints: false } },
      { chain: 2, position: [0.1, 0.3, 0.2], rotation: [0, 0, 0, 1] },
      { chain: 'IK_LeftArm', position: [2, 1, 0], options: { solver: 'ccd', iterations: 3 } },
    ];
    const together = model.sample('Walk', 0.3);
    const single = together.copy();
    const results = together.reachChains(requests);
    assert.deepEqual(
      results,
      requests.map(({ chain, position, rotation, options }) => single.reach(chain, position, { rotation, ...options })),
    );
    assert.ok(results[0].reached && !results[3].reached);
    assert.deepEqual(together.locals.slice(), single.locals);
    assert.deepEqual(together.reachChains([]), []);

    const wrong = [
      [{ chain: 'IK_Tail', position: [0, 0, 0] }, 'NOT_FOUND'],
      [{ chain: 0, position: [0, 0] }, 'BAD_ARGUMENT'],
      [{ chain: 0, position: [0, 0, Number.NaN] }, 'BAD_ARGUMENT'],
      [{ chain: 0, position: [0, 0, 0], options: { iterations: -1 } }, 'BAD_ARGUMENT'],
      [{ chain: 0, position: [0, 0, 0], options: { solver: 'guess' } }, 'BAD_ARGUMENT'],
    ];
    for (const [request, code] of wrong) {
      assert.throws(() => together.reachChains([requests[1], request]), { code });
      assert.deepEqual(together.locals.slice(), single.locals); // nothing has moved
    }
    model.dispose();
  }
});

test('both hands reach at the same time, and each option arrives', async () => {
  const effectors = [{ joint: 'mixamorig:LeftHand' }, { joint: 'mixamorig:RightHand' }];
  const targets = [{ position: [0.3, 1.3, 0.35] }, { position: [-0.25, 1.2, 0.4] }];
  const origin = (pose, joint) => {
    const at = 16 * pose.model.joints.number(joint) + 12;
    return pose.modelMatrices().slice(at, at + 3);
  };
  for (const runtime of [simd, plain]) {
    const model = await Model.open(read(example('mannequin')), { runtime });
    const body = new BodyReach(model, effectors);
    assert.equal(model.joints[body.root].name, 'mixamorig:Spine2');
    const pose = model.pose();
    const result = pose.reachBody(body, targets);
    assert.ok(result.reached && result.distance < 1e-3 && result.iterations > 0);
    effectors.forEach(({ joint }, k) => assert.ok(difference(origin(pose, joint), targets[k].position) < 1e-3));

    const reached = (options, wanted = targets, ends = effectors) => {
      const other = model.pose();
      return JSON.stringify([other.reachBody(new BodyReach(model, ends, options), wanted), ...other.locals]);
    };
    const far = [{ position: [1.5, 1.2, 0.5] }, { position: [-1.5, 1.2, 0.5] }];
    const root = 'mixamorig:Hips';
    for (const [before, after] of [
      [reached({}), reached({ root })],
      [reached({ root }, far), reached({ root, rootShift: [0.1, 0.1, 0.1] }, far)],
      [reached({ root }, far), reached({ root, rootTurn: 0.3 }, far)],
      [reached({}), reached({ iterations: 1, restarts: 0 })],
      [reached({}), reached({ tolerance: 0.1 })],
      [reached({}, far), reached({ restarts: 0 }, far)],
      [reached({}, far), reached({ obeyConstraints: false }, far)],
      [reached({}, far), reached({}, [far[0], { ...far[1], weight: 0.1 }])],
      [reached({}), reached({}, [targets[0], { ...targets[1], rotation: [0, 1, 0, 0] }])],
      [reached({}, [targets[0], { ...targets[1], rotation: [0, 1, 0, 0] }]), reached({}, [targets[0], { ...targets[1], rotation: [0, 1, 0, 0], rotationWeight: 0.1 }])],
      [reached({}), reached({}, targets, [effectors[0], { ...effectors[1], tipOffset: [0, 0.1, 0] }])],
    ]) assert.notEqual(before, after);

    const locals = pose.locals.slice();
    for (const [call, code] of [
      [() => new BodyReach(model, []), 'BAD_ARGUMENT'],
      [() => new BodyReach(model, [{ joint: 'Nose' }]), 'NOT_FOUND'],
      [() => new BodyReach(model, effectors, { root: 'mixamorig:LeftHand' }), 'BAD_ARGUMENT'],
      [() => new BodyReach(model, effectors, { rootTurn: Number.NaN }), 'BAD_ARGUMENT'],
      [() => pose.reachBody(body, []), 'BAD_ARGUMENT'],
      [() => pose.reachBody(body, targets.slice(1)), 'BAD_ARGUMENT'],
      [() => pose.reachBody(body, [targets[0], { position: [0, 1] }]), 'BAD_ARGUMENT'],
      [() => pose.reachBody(body, [targets[0], { position: [0, 1, Number.NaN] }]), 'BAD_ARGUMENT'],
      [() => pose.reachBody(body, [targets[0], { position: [0, 1, 0], weight: 2 }]), 'BAD_ARGUMENT'],
      [() => pose.reachBody(body, [targets[0], { position: [0, 1, 0], rotation: [0, 0, 0, 2] }]), 'BAD_ARGUMENT'],
    ]) assert.throws(call, { code }, String(call));
    assert.deepEqual(pose.locals.slice(), locals);
    body.dispose();
    assert.throws(() => pose.reachBody(body, targets), { code: 'DISPOSED' });
    model.dispose();
  }
});

test('each option of reach arrives', async () => {
  const model = await Model.open(read(example('mannequin')), { runtime: plain });
  const reached = (options) => {
    const pose = model.sample('Walk', 0.3).constrain();
    const { status, distance, iterations } = pose.reach('IK_LeftArm', [0.5, 1.3, 0.2], options);
    return JSON.stringify([status, distance, iterations, ...pose.locals]);
  };
  const pull = { solver: 'pull', iterations: 3 };
  const changes = [
    [{}, { solver: 'ccd' }],
    [{ solver: 'ccd' }, { solver: 'ccd', iterations: 1 }],
    [{ solver: 'ccd' }, { solver: 'ccd', tolerance: 0.5 }],
    [{}, { influence: 0.5 }],
    [{}, { obeyConstraints: false }],
    [{}, { rotation: [0, 1, 0, 0] }],
    [{ solver: 'two_bone', obeyConstraints: false }, { solver: 'two_bone', obeyConstraints: false, pole: [0, 5, 0] }],
    [{ solver: 'two_bone', obeyConstraints: false }, { solver: 'two_bone', obeyConstraints: false, softness: 0.5 }],
    [pull, { ...pull, gain: 0.1 }],
    [pull, { ...pull, stepLimit: 0.01 }],
  ];
  for (const [before, after] of changes) assert.ok(reached(before) !== reached(after), JSON.stringify(after));
  assert.ok(reached({}) === reached({ solver: 'any', iterations: 0, restarts: 4, tolerance: 0, influence: 1, obeyConstraints: true }));
  model.dispose();
});

test('blend, add, masks and local transforms', async () => {
  const model = await Model.open(read(example('mannequin')), { runtime: simd });
  const walk = model.sample('Walk', 0.3);
  const idle = model.sample('Idle', 0.5);
  const mask = model.maskBelow('mixamorig:Spine');
  const mixed = idle.copy().blend(walk, 1, mask);
  for (const { number } of model.joints) {
    const from = mask[number] === 1 ? walk : idle;
    assert.ok(difference(mixed.local(number).rotation, from.local(number).rotation) < 1e-6);
  }
  assert.ok(mask.includes(0) && mask.includes(1));
  const sum = idle.copy().add(walk.copy().makeAdditive(idle));
  assert.ok(difference(sum.skin().positions.slice(), walk.skin().positions) < 1e-5);

  const half = Math.SQRT1_2;
  sum.setLocal('mixamorig:Spine', { rotation: [0, half, 0, half] });
  assert.ok(difference(sum.local('mixamorig:Spine').rotation, [0, half, 0, half]) < 1e-6);
  const locals = sum.locals.slice();
  const before = walk.copy().setLocals(locals).skin().positions[0];
  locals[4] += 1; // the root's translation along x
  assert.ok(Math.abs(walk.copy().setLocals(locals).skin().positions[0] - before - 1) < 1e-5);

  assert.throws(() => sum.setLocal(0, { rotation: [1, 1, 1, 1] }), { code: 'BAD_ARGUMENT' });
  assert.throws(() => sum.setLocals([1]), { code: 'BAD_ARGUMENT' });
  assert.throws(() => idle.blend(walk, Number.NaN), { code: 'BAD_ARGUMENT' });
  assert.throws(() => idle.blend(walk, 1, [1]), { code: 'BAD_ARGUMENT' });
  assert.throws(() => idle.sample('Walk', Number.NaN), { code: 'BAD_ARGUMENT' });
  assert.throws(() => idle.sample(7, 0), { code: 'BAD_ARGUMENT', message: /there are 2/ });
  assert.throws(() => idle.reach('IK_LeftArm', [1, 2]), { code: 'BAD_ARGUMENT', message: /2 numbers/ });
  assert.throws(() => idle.reach('IK_LeftArm', [1, 2, 3], { solver: 'guess' }), { code: 'BAD_ARGUMENT' });
  const elsewhere = await Model.open(read(example('tentacle')), { runtime: plain });
  assert.throws(() => idle.blend(elsewhere.pose(), 1), { code: 'BAD_ARGUMENT', message: /another model/ });
  model.dispose();
  elsewhere.dispose();
});

test('morph weights', async (t) => {
  const file = corpusFile('models/morph_stress_test.gltf');
  if (file === undefined) return t.skip('the corpus is not there');
  const model = await Model.open(read(convert(file)), { runtime: simd });
  const count = model.morphTargets.length;
  assert.ok(count > 1);
  const pose = model.pose();
  const rest = pose.skin().positions.slice();
  assert.deepEqual(Array.from(pose.morphWeights), model.morphTargets.map((target) => target.restWeight));
  pose.setMorphWeights([1], 1);
  assert.equal(pose.morphWeights[1], 1);
  const moved = pose.skin().positions.slice();
  const target = model.morphTargets[1];
  const { vertices, positions } = target.displacements();
  assert.equal(vertices.length, target.vertexCount);
  const { firstVertex, isRigid } = model.meshes[target.mesh];
  const mover = model.meshes[target.mesh].mover;
  assert.ok(isRigid && mover !== null);
  const matrix = pose.modelMatrices().subarray(16 * mover, 16 * mover + 16);
  vertices.forEach((vertex, k) => {
    const [x, y, z] = positions.subarray(3 * k, 3 * k + 3);
    for (let axis = 0; axis < 3; ++axis) {
      const at = 3 * (firstVertex + vertex) + axis;
      const expected = matrix[axis] * x + matrix[4 + axis] * y + matrix[8 + axis] * z;
      assert.ok(Math.abs(moved[at] - rest[at] - expected) < 1e-5);
    }
  });
  assert.throws(() => pose.setMorphWeights([1, 1], count - 1), { code: 'BAD_ARGUMENT' });
  model.dispose();
});

test('a socket follows its joint', async () => {
  const model = await Model.open(read(example('mannequin')), { runtime: plain });
  const pose = model.sample('Walk', 0.3);
  const joint = model.joints.get('mixamorig:LeftHand');
  const matrix = pose.modelMatrices().slice(16 * joint.number, 16 * joint.number + 16);
  assert.ok(difference(pose.socket(joint, { keepsSize: false }), matrix) < 1e-6);
  const world = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1];
  assert.ok(Math.abs(pose.socket(joint, { world })[12] - matrix[12] - 5) < 1e-5);
  assert.deepEqual(Array.from(pose.socket(null)), Array.from(pose.socket(null, { offset: pose.socket(null) })));
  model.dispose();
});


/** Has the form of a vector of three.js: its length is a method. */
class Vector {
  constructor(x, y, z, w) {
    Object.assign(this, w === undefined ? { x, y, z } : { x, y, z, w });
  }

  length() {
    return 1;
  }
}
const mannequin = Model.openSync(read(example('mannequin')), { runtime: simd });
const bad = (message) => ({ name: 'BendyError', code: 'BAD_ARGUMENT', message });

test('points and rotations are arrays or objects with x, y, z and w', () => {
  const [place, turn] = [[0.3, 1.2, 0.4], [0, 0.6, 0, 0.8]];
  const both = (use) => {
    const [array, object] = [mannequin.pose(), mannequin.pose()];
    use(array, place, turn);
    use(object, new Vector(...place), new Vector(...turn));
    assert.notDeepEqual(array.locals, mannequin.pose().locals);
    assert.deepEqual(array.locals, object.locals);
  };
  both((pose, point, rotation) => pose.reach('IK_LeftArm', point, { rotation, pole: point }));
  both((pose, position, rotation) => pose.reachChains([{ chain: 'IK_LeftArm', position, rotation }]));
  both((pose, translation, rotation) => pose.setLocal('mixamorig:Head', { translation, rotation, scale: translation }));
  const hands = new BodyReach(mannequin, [{ joint: 'mixamorig:LeftHand', tipOffset: new Vector(0, 0.1, 0) }]);
  both((pose, position, rotation) => pose.reachBody(hands, [{ position, rotation }]));
  const [constraint] = mannequin.constraints;
  assert.deepEqual(mannequin.clampRotation(constraint, turn), mannequin.clampRotation(constraint, new Vector(...turn)));
});

test('what is no point, or no number, is named', () => {
  const pose = mannequin.pose();
  const before = pose.locals.slice();
  class Ball {
    position = new Vector(0, 1, 0);
  }
  for (const [target, message] of [
    [new Ball(), /^position is an object of type Ball, not \[x, y, z\] or an object with x, y, z; did you mean its position\?$/],
    ['123', /^position is a text, "123", not \[x, y, z\]/],
    [undefined, /^position is missing, not \[x, y, z\]/],
    [null, /^position is null, /],
    [[0, 1], /^position has 2 numbers, not \[x, y, z\]/],
    [['0.3', '1.2', '0.4'], /^position\[0\] is a text, "0\.3", not a number$/],
    [[0, , 1], /^position\[1\] is missing: a number is expected$/],
    [{ x: 0, y: '1', z: 0 }, /^position is an object of type Object, /],
    [{ x: 0, y: 1 }, /^position is an object of type Object, /],
    [Object.create(null), /^position is an object of type Object, /],
    [[0, NaN, 1], /finite/],
  ]) {
    assert.throws(() => pose.reach('IK_LeftArm', target), bad(message));
  }
  assert.throws(() => pose.reach('IK_LeftArm', [0, 1, 0], { influence: '0.5' }), bad(/^influence is a text, "0\.5", not a number$/));
  assert.throws(() => pose.reach('IK_LeftArm', [0, 1, 0], { iterations: '5' }), bad(/^iterations is a text, "5", not a whole number/));
  assert.throws(() => pose.reach('IK_LeftArm', [0, 1, 0], { rotation: new Vector(0, 0, 1) }), bad(/^rotation is an object of type Vector, not \[x, y, z, w\]/));
  assert.throws(() => pose.sample('Walk', '0.3'), bad(/^seconds is a text, "0\.3", not a number$/));
  assert.throws(() => pose.sample('Walk'), bad(/^seconds is missing/));
  assert.throws(() => pose.blend(mannequin.pose(), '1'), bad(/^weight is a text/));
  assert.throws(() => pose.blend(mannequin.pose(), 1, Array.from(mannequin.joints, () => '1')), bad(/^mask\[0\] is a text, "1"/));
  assert.throws(() => pose.setLocals(Array.from(before, String)), bad(/^locals\[0\] is a text/));
  assert.throws(() => pose.modelMatrices([1]), bad(/^world has 1 numbers, not an array of 16 numbers$/));
  assert.deepEqual(pose.locals, before);
});

test('options that do not exist are refused', async () => {
  const pose = mannequin.pose();
  const point = [0.3, 1.2, 0.4];
  const body = new BodyReach(mannequin, [{ joint: 'mixamorig:LeftHand' }]);
  for (const [use, message] of [
    [() => pose.reach('IK_LeftArm', point, { obeyConstraint: false }), /^reach has no option "obeyConstraint"; did you mean obeyConstraints\?$/],
    [() => pose.reach('IK_LeftArm', point, { obey_constraints: false }), /did you mean obeyConstraints\?$/],
    [() => pose.reach('IK_LeftArm', point, 0.5), /^the options of reach are 0\.5, not an object$/],
    [() => pose.reachChains([{ chain: 'IK_LeftArm', target: point }]), /^a request has no option "target"; it has chain, position, rotation, options$/],
    [() => pose.reachChains([{ chain: 'IK_LeftArm', position: point, options: { influences: 1 } }]), /^reachChains has no option "influences"; did you mean influence\?$/],
    [() => pose.reachBody(body, [{ position: point, weights: 1 }]), /^a target has no option "weights"; did you mean weight\?$/],
    [() => new BodyReach(mannequin, [{ joint: 0, offset: point }]), /^an effector has no option "offset"/],
    [() => new BodyReach(mannequin, [{ joint: 0 }], { roots: 0 }), /^BodyReach has no option "roots"; did you mean root\?$/],
    [() => pose.setLocal('mixamorig:Head', { position: point }), /^setLocal has no option "position"; did you mean translation\?$/],
    [() => pose.skin({ normal: true }), /^skin has no option "normal"; did you mean normals\?$/],
    [() => pose.socket('mixamorig:Head', { keepSize: true }), /^socket has no option "keepSize"; it has offset, keepsSize, world$/],
    [() => new Crowd(mannequin, 1, { position: true }), /^Crowd has no option "position"; did you mean positions\?$/],
    [() => new CrossFade(mannequin).play('Walk', { seconds: 1 }), /^play has no option "seconds"; it has fade, easing, playback$/],
    [() => new CrossFade(mannequin).play('Walk', { fade: '1' }), /^fade is a text, "1", not a number$/],
    [() => new RootPath(mannequin, 'mixamorig:Hips', { turns: true }), /^RootPath has no option "turns"; did you mean turn\?$/],
    [() => new Retarget(mannequin, mannequin, { plantFeet: true }), /^Retarget has no option "plantFeet"; it has /],
    [() => new Binding(mannequin, mannequin, { translations: 'all' }), /^Binding has no option "translations"; it has /],
    [() => Model.openSync(new Uint8Array(1), { checksums: false, runtime: simd }), /^Model\.openSync has no option "checksums"; did you mean checkSums\?$/],
  ]) {
    assert.throws(use, bad(message));
  }
  await assert.rejects(Model.open(new Uint8Array(1), { Runtime: simd }), bad(/^Model\.open has no option "Runtime"; did you mean runtime\?$/));
  await assert.rejects(loadRuntime({ simd: false, module: 1 }), bad(/^init has no option "module"; it has wasm, simd$/));
});
