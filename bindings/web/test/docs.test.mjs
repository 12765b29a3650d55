// Every JavaScript block of the guide, of docs/languages.md and of docs/retarget.md runs.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, renameSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { bendy, example, folder, repository } from './helpers.mjs';

renameSync(example('mannequin', '--lod'), join(folder, 'mannequin.bendy'));
copyFileSync(join(repository, 'examples/mannequin.glb'), join(folder, 'mannequin.glb'));
mkdirSync(join(folder, 'node_modules'));
symlinkSync(join(repository, 'bindings/web'), join(folder, 'node_modules/bendy'));
symlinkSync(join(repository, 'bindings/web/node_modules/three'), join(folder, 'node_modules/three'));

const blocksOf = (file) => {
  const page = readFileSync(join(repository, file), 'utf8');
  return [...page.matchAll(/^```js\n(.*?)^```$/gms)].map(([, code]) => code);
};

/** Runs a module; returns what it prints. */
function run(name, code) {
  const file = join(folder, name);
  writeFileSync(file, code);
  const { status, stdout, stderr } = spawnSync(process.execPath, [file], { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 26 });
  assert.equal(status, 0, stderr);
  return stdout;
}

const [first, withThree, ...others] = blocksOf('docs/languages.md');
const readBytes = `import { readFile } from 'node:fs/promises';\nconst bytes = await readFile('mannequin.bendy');\n`;

// As tests/docs/use_from_test.py does with the blocks for C++, C and Python.
test('the block of docs/languages.md for JavaScript gives the vertices of bendy pose to the last bit', () => {
  const usePlain = `import { init } from 'bendy';\nawait init({ simd: false });\n`;
  const printed = JSON.parse(run('languages.mjs', `${usePlain}${readBytes}${first}console.log(JSON.stringify([...skinned.positions]));`));
  bendy(['pose', 'mannequin.bendy', '--clip', 'Walk', '--time', '0.35', '--reach', 'IK_LeftArm=0.3,1.2,0.4', '-o', 'walk.json'], 'plain');
  const expected = JSON.parse(readFileSync(join(folder, 'walk.json'), 'utf8')).meshes.flatMap((mesh) => mesh.positions);
  assert.ok(expected.length > 10000);
  assert.deepEqual(printed.map(Math.fround), expected.map(Math.fround));
});

test('the block of docs/languages.md for three.js', () => {
  assert.equal(others.length, 0);
  const show = `const joint = scene.getObjectByName('mixamorigLeftArm');\nconsole.log(joint.quaternion.toArray().join());`;
  const poseAt = (seconds) => run('three.mjs', `${readBytes}${withThree.replace('0.35', seconds)}${show}`);
  assert.notEqual(poseAt('0.35'), poseAt('0'));
});

test('the sizes in docs/web.md are the limits of scripts/web.sh', () => {
  const script = readFileSync(join(repository, 'scripts/web.sh'), 'utf8');
  const limits = [...script.matchAll(/^node embed\.mjs .* (\d+)$/gm)].map(([, bytes]) => bytes / 1000);
  const page = readFileSync(join(repository, 'docs/web.md'), 'utf8');
  const sizes = [...page.matchAll(/([\d,]+) KB\b/g)].map(([, size]) => Number(size.replaceAll(',', '')));
  assert.deepEqual(new Set(sizes), new Set(limits));
});

for (const [page, fewest] of [['docs/web.md', 6], ['docs/retarget.md', 1]]) {
  const blocks = blocksOf(page);
  test(`${page} has blocks`, () => assert.ok(blocks.length >= fewest));
  blocks.forEach((code, number) => {
    test(`block ${number + 1} of ${page}`, () => run(`block${number}.mjs`, code));
  });
}
