// Posing beside three.js, by turns in one process: node bench/three.mjs FILE.bendy... prints microseconds for each character and frame.
// three.js: AnimationMixer.update, updateMatrixWorld and Skeleton.update. Bendy: Pose.sample, and Pose.palette of every
// skinned mesh, with Pose.modelMatrices if there are others; for several characters, Crowd.
import { readFile } from 'node:fs/promises';
import { performance } from 'node:perf_hooks';
import { AnimationMixer } from 'three';
import { Crowd } from '../dist/index.js';
import { BendyLoader, cloneCharacter } from '../dist/three/index.js';

const rounds = 21;
const frames = 240;
const step = 1 / 60;

const median = (numbers) => numbers.sort((a, b) => a - b)[numbers.length >> 1];

/** Microseconds for each character and frame. */
function time(count, work) {
  const some = Math.max(4, Math.round(frames / count));
  const start = performance.now();
  for (let frame = 0; frame < some; ++frame) work(frame);
  return (1000 * (performance.now() - start)) / some / count;
}

console.log('| character | characters | three.js, µs | bendy, µs | bendy / three.js |\n|---|---|---|---|---|');
for (const file of process.argv.slice(2)) {
  const character = await new BendyLoader().parseAsync(await readFile(file));
  const { model } = character;
  const clip = model.clips[0];
  const skinned = model.meshes.filter((mesh) => !mesh.isRigid);
  for (const count of [1, 100, 1000]) {
    const copies = Array.from({ length: count }, () => cloneCharacter(character));
    const skeletons = copies.map((copy) => copy.parts.flatMap(({ object }) => (object.skeleton ? [object.skeleton] : [])));
    const mixers = copies.map((copy, k) => {
      const mixer = new AnimationMixer(copy.scene);
      mixer.clipAction(copy.animations[0]).play();
      mixer.update(k * 0.013);
      return mixer;
    });
    const pose = model.pose();
    const byThree = () => {
      for (let k = 0; k < count; ++k) {
        mixers[k].update(step);
        copies[k].scene.updateMatrixWorld(true);
        for (const skeleton of new Set(skeletons[k])) skeleton.update();
      }
    };
    const crowd = new Crowd(model, count);
    const seconds = (frame, k) => clip.start + ((frame * step + k * 0.013) % (clip.end - clip.start));
    const byBendy = (frame) => {
      if (count === 1) {
        pose.sample(clip, seconds(frame, 0));
        for (const mesh of skinned) pose.palette(mesh);
        if (skinned.length < model.meshes.length) pose.modelMatrices(); // for rigid meshes
      } else {
        for (let k = 0; k < count; ++k) crowd.set(k, clip, seconds(frame, k));
        crowd.play();
      }
    };
    for (let warm = 0; warm < 3; ++warm) {
      time(count, byThree);
      time(count, byBendy);
    }
    const theirs = [], ours = [], ratios = [];
    for (let round = 0; round < (count === 1000 ? 5 : rounds); ++round) {
      theirs.push(time(count, byThree));
      ours.push(time(count, byBendy));
      ratios.push(ours.at(-1) / theirs.at(-1));
    }
    console.log(`| ${file.replace(/.*\/|\.bendy$/g, '')} | ${count} | ${median(theirs).toFixed(1)} | ${median(ours).toFixed(1)} | ${median(ratios).toFixed(2)} |`);
    pose.dispose();
    crowd.dispose();
  }
  model.dispose();
}
