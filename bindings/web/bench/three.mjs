// Posing beside three.js, by turns in one process: node bench/three.mjs FILE.bendy... prints microseconds for each character and frame.
// three.js: AnimationMixer.update, updateMatrixWorld and Skeleton.update. Bendy: for one character BendyAnimator.update and the same
// two, with the objects of all joints and with those that are needed; for several, BendyCrowd.update. Nothing is drawn.
import { readFile } from 'node:fs/promises';
import { performance } from 'node:perf_hooks';
import { AnimationMixer } from 'three';
import { BendyAnimator, BendyCrowd, BendyLoader, cloneCharacter } from '../dist/three/index.js';

const rounds = 21;
const frames = 240;
const step = 1 / 60;

const median = (numbers) => numbers.sort((a, b) => a - b)[numbers.length >> 1];

/** Microseconds for each character and frame. */
function time(count, work) {
  const some = Math.max(4, Math.round(frames / count));
  const start = performance.now();
  for (let frame = 0; frame < some; ++frame) work();
  return (1000 * (performance.now() - start)) / some / count;
}

/** Updates what the renderer would update before it draws a character. */
function prepare(character) {
  const skeletons = new Set(character.parts.flatMap(({ object }) => object.skeleton ?? []));
  return () => {
    character.scene.updateMatrixWorld();
    for (const skeleton of skeletons) skeleton.update();
  };
}

function byMixers(character, count) {
  const copies = Array.from({ length: count }, (_, k) => {
    const copy = cloneCharacter(character);
    const mixer = new AnimationMixer(copy.scene);
    mixer.clipAction(copy.animations[0]).play();
    mixer.update(k * 0.013);
    return { mixer, show: prepare(copy) };
  });
  return () => {
    for (const { mixer, show } of copies) {
      mixer.update(step);
      show();
    }
  };
}

function byAnimator(character, joints) {
  const copy = cloneCharacter(character);
  const animator = new BendyAnimator(copy, { joints }).play(0, { loop: true });
  const show = prepare(copy);
  return () => {
    animator.update(step);
    show();
  };
}

function byCrowd(character, count) {
  const crowd = new BendyCrowd(character, count);
  for (let k = 0; k < count; ++k) crowd.play(k, 0, { offset: k * 0.013 });
  return () => crowd.update(step);
}

console.log('| character | characters | three.js, µs | by | bendy, µs | bendy / three.js |\n|---|---|---|---|---|---|');
for (const file of process.argv.slice(2)) {
  const character = await new BendyLoader().parseAsync(await readFile(file));
  for (const count of [1, 100, 1000]) {
    const forms = { 'three.js': byMixers(character, count) };
    if (count === 1) for (const joints of ['all', 'needed']) forms[`animator, ${joints} joints`] = byAnimator(character, joints);
    else forms.crowd = byCrowd(character, count);
    const taken = new Map(Object.keys(forms).map((name) => [name, []]));
    for (let round = -3; round < (count === 1000 ? 5 : rounds); ++round) {
      for (const [name, work] of Object.entries(forms)) {
        const one = time(count, work);
        if (round >= 0) taken.get(name).push(one);
      }
    }
    const [theirs, ...ours] = taken.values();
    for (const [k, times] of ours.entries()) {
      const ratio = median(times.map((one, round) => one / theirs[round]));
      const cells = [median([...theirs]).toFixed(1), Object.keys(forms)[k + 1], median([...times]).toFixed(1), ratio.toFixed(2)];
      console.log(`| ${file.replace(/.*\/|\.bendy$/g, '')} | ${count} | ${cells.join(' | ')} |`);
    }
  }
}
