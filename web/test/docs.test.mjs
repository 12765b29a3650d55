// Every JavaScript block of the guide runs.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, renameSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { example, folder, repository } from './helpers.mjs';

renameSync(example('mannequin', '--lod'), join(folder, 'mannequin.bendy'));
copyFileSync(join(repository, 'examples/mannequin.glb'), join(folder, 'mannequin.glb'));
mkdirSync(join(folder, 'node_modules'));
symlinkSync(join(repository, 'web'), join(folder, 'node_modules/bendy'));

const page = readFileSync(join(repository, 'docs/web.md'), 'utf8');
const blocks = [...page.matchAll(/^```js\n(.*?)^```$/gms)].map(([, code], number) => ({
  code,
  number,
}));

const readme = readFileSync(join(repository, 'README.md'), 'utf8');
const [, first] = /^```js\n(.*?)^```$/ms.exec(readme);
test('the block of README.md', () => {
  const file = join(folder, 'readme.mjs');
  writeFileSync(file, `import { readFile } from 'node:fs/promises';\nconst bytes = await readFile('mannequin.bendy');\n${first}`);
  const { status, stderr } = spawnSync(process.execPath, [file], { cwd: folder, encoding: 'utf8' });
  assert.equal(status, 0, stderr);
});

test('the guide has blocks', () => assert.ok(blocks.length >= 6));
for (const { code, number } of blocks) {
  test(`block ${number + 1} of docs/web.md`, () => {
    const file = join(folder, `block${number}.mjs`);
    writeFileSync(file, code);
    const { status, stderr } = spawnSync(process.execPath, [file], { cwd: folder, encoding: 'utf8' });
    assert.equal(status, 0, stderr);
  });
}
