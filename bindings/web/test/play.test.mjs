// Clocks, cross-fades, root motion, bounds, bindings, crowds, curves.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import {
  Binding,
  Bounds,
  composeMotions,
  CrossFade,
  Crowd,
  ease,
  Fade,
  init,
  LevelOfDetail,
  Model,
  motionMatrix,
  Playback,
  Pose,
  Retarget,
  RetargetState,
  RootPath,
} from '../dist/index.js';
import { difference, example, plain, read, repository, simd } from './helpers.mjs';

const mannequin = read(example('mannequin'));
const everyChunk = read(join(repository, 'spec/examples/every_chunk.bendy'));
await init();

test('a clock repeats, stops, turns and counts', () => {
  const model = Model.openSync(mannequin, { runtime: simd });
  const { start, end } = model.clips.get('Walk');
  const playback = new Playback(model, 'Walk');
  assert.equal(playback.seconds, start);
  playback.mode = 'repeat';
  playback.advance(2.25 * (end - start));
  assert.equal(playback.passes, 2);
  assert.ok(Math.abs(playback.share - 0.25) < 1e-6);
  assert.ok(Math.abs(playback.seconds - (start + 0.25 * (end - start))) < 1e-5);
  playback.mode = 'once';
  playback.speed = 2;
  assert.equal(playback.speed, 2);
  assert.ok(playback.advance(end - start).isDone);
  assert.equal(playback.seconds, end);
  assert.equal(playback.seekShare(0.5).share, 0.5);
  assert.throws(() => playback.advance(Number.NaN), { code: 'BAD_ARGUMENT' });
  assert.throws(() => (playback.mode = 'sometimes'), { code: 'BAD_ARGUMENT' });
  model.dispose();
  playback.advance(0.1); // keeps what it needs
  playback.dispose();
});

test('markers are reported once per pass', () => {
  const model = Model.openSync(everyChunk, { runtime: simd });
  const clip = model.clips.get('wave');
  assert.equal(clip.markers.length, 2);
  const playback = new Playback(model, clip);
  playback.mode = 'repeat';
  const seen = [];
  for (let step = 0; step < 40; ++step) seen.push(...playback.advance(clip.seconds / 20).markers());
  assert.equal(seen.length, 2 * clip.markers.length);
  model.dispose();
});

test('a cross-fade goes from one clip to another', () => {
  const model = Model.openSync(mannequin, { runtime: plain });
  const fade = new CrossFade(model);
  const pose = model.pose();
  assert.throws(() => fade.sample(pose), { code: 'BAD_ARGUMENT' });
  fade.play('Idle').advance(0.2).play('Walk', { fade: 0.4, easing: 'linear' }).advance(0.1);
  const [idle, walk] = fade.playing;
  assert.equal(idle.clip.name, 'Idle');
  assert.ok(Math.abs(walk.share - 0.25) < 1e-6 && Math.abs(idle.share - 0.75) < 1e-6);
  fade.sample(pose);
  const expected = model.sample('Idle', idle.seconds).blend(model.sample('Walk', walk.seconds), 0.25);
  assert.ok(difference(pose.skin().positions.slice(), expected.skin().positions) < 1e-6);
  const playback = fade.getPlayback(new Playback(model, 'Walk'));
  playback.speed = 0.5;
  fade.setPlayback(playback).advance(0.4);
  assert.equal(fade.playing.length, 1);
  assert.ok(Math.abs(fade.playing[0].seconds - model.clips.get('Walk').start - 0.3) < 1e-5);
  assert.deepEqual(fade.markers(), []);
  model.dispose();
});

test('a weight fades', () => {
  const fade = new Fade(simd, 0).to(1, 2, 'linear').advance(0.5);
  assert.equal(fade.weight, 0.25);
  assert.ok(!fade.isDone && fade.advance(2).isDone);
  assert.equal(fade.weight, 1);
  fade.dispose();
});

test('root motion: played in steps or at once, and taken out of the pose', () => {
  const model = Model.openSync(mannequin, { runtime: simd });
  const path = new RootPath(model, 'mixamorig:Hips', { y: true });
  const { start, end } = model.clips.get('Walk');
  const whole = path.between('Walk', start, end);
  const playback = new Playback(model, 'Walk');
  playback.mode = 'once';
  let place = { translation: [0, 0, 0], rotation: [0, 0, 0, 1] };
  for (let step = 0; step < 10; ++step) place = composeMotions(place, path.over(playback.advance((end - start) / 9)));
  assert.ok(difference(place.translation, whole.translation) < 1e-5);
  assert.equal(motionMatrix(whole)[12], whole.translation[0]);
  const pose = model.sample('Walk', 0.3);
  const before = pose.modelMatrices().slice();
  const motion = path.extract(pose);
  assert.ok(difference(motion.translation, path.at('Walk', 0.3).translation) < 1e-5);
  assert.ok(difference(before, pose.modelMatrices()) > 1e-4);
  const fade = new CrossFade(model).play('Walk').advance(0.2);
  const { start: from } = model.clips.get('Walk');
  assert.ok(difference(path.over(fade).translation, path.between('Walk', from, from + 0.2).translation) < 1e-5);
  model.dispose();
});

test('bounds contain the vertices', () => {
  const model = Model.openSync(mannequin, { runtime: simd });
  const pose = model.sample('Walk', 0.3);
  const { minimum, maximum } = new Bounds(model).ofPose(pose);
  const { positions } = pose.skin();
  for (let k = 0; k < positions.length; ++k) {
    assert.ok(positions[k] >= minimum[k % 3] - 1e-5 && positions[k] <= maximum[k % 3] + 1e-5);
  }
  assert.ok(maximum[1] - minimum[1] < 3);
  const head = new Bounds(model).ofJoint('mixamorig:Head', pose);
  assert.ok(head.minimum[1] > minimum[1]);
  model.dispose();
});

test('clips of another model', () => {
  const model = Model.openSync(mannequin, { runtime: simd });
  const other = Model.openSync(mannequin, { runtime: simd });
  const binding = new Binding(other, model);
  assert.deepEqual(Array.from(binding.joints), model.joints.map((joint) => joint.number));
  assert.deepEqual(binding.unmatchedJoints, []);
  assert.deepEqual(Array.from(binding.targets), model.morphTargets.map((target) => target.number));
  assert.deepEqual(binding.unmatchedTargets, []);
  const bound = model.pose().sampleBound(binding, 'Walk', 0.3);
  assert.deepEqual(bound.skin().positions.slice(), model.sample('Walk', 0.3).skin().positions);
  assert.throws(() => new Binding(other, Model.openSync(mannequin, { runtime: plain })), { code: 'BAD_ARGUMENT' });
  model.dispose();
});

test('joints have roles', () => {
  const model = Model.openSync(mannequin, { runtime: simd });
  const { role, rolePlace } = model.joints.get('mixamorig:LeftForeArm');
  assert.deepEqual([role, rolePlace], ['left_lower_arm', 0]);
  assert.equal(model.joints.filter((joint) => joint.role !== 'none').length, 54);
  model.dispose();
});

test('poses of another model of the same build are the same to the last bit', () => {
  for (const runtime of [simd, plain]) {
    const source = Model.openSync(mannequin, { runtime });
    const target = Model.openSync(mannequin, { runtime });
    const retarget = new Retarget(source, target);
    assert.equal(retarget.scale, 1);
    assert.deepEqual(Array.from(retarget.joints), source.joints.map((joint) => joint.number));
    assert.deepEqual(Array.from(retarget.morphTargets), source.morphTargets.map((morph) => morph.number));
    const [from, to, state] = [source.sample('Walk', 0.3), target.pose(), new RetargetState(runtime)];
    const { contacts, turned, missedJoint } = retarget.apply(to, from, state);
    assert.equal(contacts.length, 14);
    assert.ok(contacts.some((weight) => weight > 0.5) && contacts.every((weight) => weight >= 0 && weight <= 1), String(contacts));
    assert.equal(turned, 0);
    assert.ok(missedJoint === null || target.joints[missedJoint] !== undefined);
    assert.deepEqual(to.locals, from.locals);
    assert.deepEqual(to.morphWeights, from.morphWeights);
    assert.deepEqual(retarget.apply(to, from, state.reset(), [1, 1, 0, 0.25, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]).contacts, [1, 1, 0, 0.25, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    source.dispose();
    target.dispose();
    retarget.apply(to, from, state); // keeps what it needs
    for (const one of [retarget, from, to, state]) one.dispose();
    assert.throws(() => retarget.scale, { code: 'DISPOSED' });
  }
});

test('retargeting says that there are no roles, and refuses poses of other models', () => {
  const source = Model.openSync(mannequin, { runtime: simd });
  const bare = Model.openSync(read(join(repository, 'spec/examples/one_joint.bendy')), { runtime: simd });
  const isMissing = { code: 'BAD_ARGUMENT', message: /^the target does not say what its joints are.*"roles" in its rig file$/ };
  assert.throws(() => new Retarget(source, bare), isMissing);
  assert.throws(() => new Retarget(source, Model.openSync(mannequin, { runtime: plain })), { code: 'BAD_ARGUMENT' });
  assert.throws(() => new Retarget(source, source, { restPoses: 'other' }), { code: 'BAD_ARGUMENT' });
  const retarget = new Retarget(source, source, { restPoses: 'alike', limits: 'off', plantsFeet: false });
  const [pose, other, state] = [source.pose(), source.sample('Walk', 0.3), new RetargetState(simd)];
  retarget.apply(pose, other, state);
  for (const wrong of [
    () => retarget.apply(bare.pose(), other, state),
    () => retarget.apply(pose, bare.pose(), state),
    () => retarget.apply(pose, pose, state),
    () => retarget.apply(pose, other, new RetargetState(plain)),
    () => retarget.apply(pose, other, state, [1, 2, 3]),
    () => retarget.apply(pose, other, state, [1, Number.NaN, 0, 0]),
  ]) {
    assert.throws(wrong, { code: 'BAD_ARGUMENT' }, String(wrong));
  }
  source.dispose();
  bare.dispose();
});

test('weights are eased', () => {
  assert.equal(ease('linear', 0.25), 0.25);
  assert.equal(ease('smooth', 0.25), 0.15625);
  assert.throws(() => ease('sudden', 0), { code: 'BAD_ARGUMENT' });
});

/** A model, and one of everything that is made from it. */
function partsOf(bytes, runtime) {
  const model = Model.openSync(bytes, { runtime });
  const fade = new CrossFade(model).play(0);
  const parts = { model, fade, pose: model.pose(), lod: new LevelOfDetail(model), bounds: new Bounds(model), clock: new Playback(model, 0) };
  return { ...parts, crowd: new Crowd(model, 2), path: new RootPath(model, 0), binding: new Binding(model, model) };
}

test('parts of another model are refused: of the same file, of another one, of another runtime', () => {
  const mine = partsOf(everyChunk, simd);
  const { model, pose } = mine;
  for (const other of [partsOf(everyChunk, simd), partsOf(mannequin, simd), partsOf(everyChunk, plain)]) {
    const clip = other.model.clips[0];
    const chain = other.model.chains[0];
    const joint = other.model.joints[0];
    const mesh = other.model.meshes[0];
    const calls = {
      sample: () => pose.sample(clip, 0),
      modelSample: () => model.sample(clip, 0),
      sampleBound: () => pose.sampleBound(other.binding, 0, 0),
      sampleBoundClip: () => pose.sampleBound(mine.binding, clip, 0),
      copy: () => new Pose(model, other.pose),
      blend: () => pose.blend(other.pose, 0.5),
      makeAdditive: () => pose.makeAdditive(other.pose),
      add: () => pose.add(other.pose),
      reach: () => pose.reach(chain, [0, 1, 0]),
      local: () => pose.local(joint),
      setLocal: () => pose.setLocal(joint, { translation: [7, 7, 7] }),
      palette: () => pose.palette(mesh),
      skin: () => pose.skin({ mesh }),
      skinLevel: () => pose.skin({ lod: other.lod }),
      socket: () => pose.socket(joint),
      maskBelow: () => model.maskBelow(joint),
      playback: () => new Playback(model, clip),
      play: () => mine.fade.play(clip),
      fadeSample: () => mine.fade.sample(other.pose),
      boundsOfPose: () => mine.bounds.ofPose(other.pose),
      boundsOfJoint: () => mine.bounds.ofJoint(joint),
      boundsOfJointInPose: () => mine.bounds.ofJoint(0, other.pose),
      rootPath: () => new RootPath(model, joint),
      rootAt: () => mine.path.at(clip, 0),
      rootBetween: () => mine.path.between(clip, 0, 1),
      rootOverClock: () => mine.path.over(other.clock),
      rootOverFade: () => mine.path.over(other.fade),
      rootExtract: () => mine.path.extract(other.pose),
      bindingRoot: () => new Binding(model, model, { rootOnly: true, root: joint }),
      lodVertices: () => mine.lod.vertices(mesh),
      lodIndices: () => mine.lod.indices(mesh),
      crowdSet: () => mine.crowd.set(0, clip, 0),
      crowdSetLevel: () => mine.crowd.set(0, 0, 0, other.lod),
      crowdFirstMatrix: () => mine.crowd.firstMatrix(mesh),
    };
    if (other.model.runtime !== simd) {
      calls.playClock = () => mine.fade.play(0, { playback: other.clock });
      calls.getPlayback = () => mine.fade.getPlayback(other.clock);
      calls.setPlayback = () => mine.fade.setPlayback(other.clock);
    }
    if (other.model.constraints.length > 0) calls.clampRotation = () => model.clampRotation(other.model.constraints[0], [0, 0, 0, 1]);
    const before = pose.reset().locals.slice();
    for (const [name, call] of Object.entries(calls)) assert.throws(call, { code: 'BAD_ARGUMENT' }, name);
    assert.deepEqual(pose.locals, before);
    other.model.dispose();
  }
  assert.equal(model.morphTargets.number(model.meshes[0].morphTargets[0] ?? 0), 0);
  model.dispose();
});

test('numbers that a model does not have are refused', () => {
  const { model, pose, lod, crowd } = partsOf(everyChunk, simd);
  for (const number of [-1, 0.5, 1000, 2 ** 31, 2 ** 32, Number.NaN, Number.POSITIVE_INFINITY, null, undefined]) {
    const calls = [
      () => model.clips.get(number),
      () => pose.sample(number, 0),
      () => pose.reach(number, [0, 1, 0]),
      () => pose.local(number),
      () => pose.skin({ mesh: number ?? -1 }),
      () => lod.submesh(number),
      () => crowd.set(number, 0, 0),
      () => model.clampRotation(number, [0, 0, 0, 1]),
      () => pose.setMorphWeights([1], number ?? -1),
      () => Model.openSync(everyChunk, { runtime: simd, object: number ?? -1 }),
    ];
    for (const call of calls) assert.throws(call, (error) => error.name === 'BendyError', `${number}: ${call}`);
  }
  model.dispose();
});

test('a crowd refuses levels that were disposed', () => {
  const { model, lod, crowd } = partsOf(everyChunk, simd);
  crowd.set(1, 0, 0, lod).play();
  lod.dispose();
  assert.throws(() => crowd.play(), { code: 'DISPOSED' });
  crowd.set(1, 0, 0).play();
  model.dispose();
});

test('a crowd has the palettes and vertices of its members', () => {
  const model = Model.openSync(mannequin, { runtime: simd });
  const crowd = new Crowd(model, 5, { positions: true });
  for (let member = 1; member < 5; ++member) crowd.set(member, 'Walk', 0.2 * member);
  crowd.play();
  for (let member = 0; member < 5; ++member) {
    const pose = member === 0 ? model.pose() : model.sample('Walk', Math.fround(0.2 * member));
    for (const mesh of model.meshes) {
      const first = 16 * (member * crowd.matrixCount + crowd.firstMatrix(mesh));
      assert.deepEqual(crowd.palettes.slice(first, first + 16 * mesh.boneCount), pose.palette(mesh).slice());
    }
    const positions = pose.skin().positions.slice();
    assert.deepEqual(crowd.positions.slice(member * positions.length, (member + 1) * positions.length), positions);
    pose.dispose();
  }
  assert.throws(() => crowd.set(5, 'Walk', 0), { code: 'BAD_ARGUMENT' });
  assert.throws(() => crowd.set(0, 'Walk', Number.NaN).play(), { code: 'BAD_ARGUMENT' });
  crowd.dispose();
  assert.throws(() => crowd.palettes, { code: 'DISPOSED' });
  model.dispose();
});

test('curves', () => {
  const model = Model.openSync(everyChunk, { runtime: simd });
  const [curve] = model.clips.flatMap((clip) => clip.curves);
  assert.ok(curve.components >= 1);
  const first = curve.sample(curve.start);
  const values = curve.interpolation === 'cubic' ? curve.values.subarray(curve.components) : curve.values;
  assert.ok(difference(first, values.subarray(0, curve.components)) < 1e-6);
  assert.throws(() => curve.sample(Number.NaN), { code: 'BAD_ARGUMENT' });
  model.dispose();
});
