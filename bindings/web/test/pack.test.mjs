// What `npm pack` makes, in an empty project: by node, and by Chromium after vite has bundled it.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import puppeteer from 'puppeteer-core';
import { build, preview } from 'vite';
import { repository } from './helpers.mjs';

const chromium = process.env.CHROMIUM ?? '/usr/bin/chromium';
const skip = existsSync(chromium) ? false : `${chromium} is not there`;
const web = join(repository, 'bindings/web');
const project = mkdtempSync(join(tmpdir(), 'bendy-pack-'));
const run = (command, ...args) => execFileSync(command, args, { cwd: project, encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });

before(() => {
  execFileSync('npm', ['pack', '--silent', '--pack-destination', project], { cwd: web, stdio: 'ignore' });
  const [archive] = readdirSync(project);
  writeFileSync(join(project, 'package.json'), '{"type": "module"}');
  run('npm', 'install', '--silent', '--offline', '--no-audit', '--no-save', `./${archive}`);
  symlinkSync(join(web, 'node_modules/three'), join(project, 'node_modules/three'));
  mkdirSync(join(project, 'public'));
  copyFileSync(join(repository, 'examples/mannequin.glb'), join(project, 'public/mannequin.glb'));
});
after(() => rmSync(project, { recursive: true }));

test('node converts and poses', () => {
  writeFileSync(
    join(project, 'pose.js'),
    `import { readFile } from 'node:fs/promises';
     import { Model } from 'bendy';
     import { convert } from 'bendy/tools';
     const model = await Model.open((await convert(await readFile('public/mannequin.glb'))).bytes);
     console.log(model.sample('Walk', 0.35).skin().positions.length / 3);`,
  );
  assert.equal(run('node', 'pose.js').trim(), '4504');
});

test('vite bundles it for browsers', { skip }, async () => {
  writeFileSync(join(project, 'index.html'), '<!doctype html><link rel="icon" href="data:,"><script type="module" src="/main.js"></script>');
  writeFileSync(
    join(project, 'main.js'),
    `import { convert } from 'bendy/tools';
     import { BendyLoader } from 'bendy/three';
     const { bytes } = await convert(await (await fetch('mannequin.glb')).arrayBuffer());
     const { animations, model } = await new BendyLoader().parseAsync(bytes);
     document.title = animations.length + ' clips, ' + model.joints.length + ' joints';`,
  );
  await build({ root: project, base: './', logLevel: 'error' });
  const server = await preview({ root: project, logLevel: 'error', preview: { port: 0, host: '127.0.0.1' } });
  const browser = await puppeteer.launch({ executablePath: chromium, args: ['--no-sandbox'] });
  try {
    const tab = await browser.newPage();
    const problems = [];
    tab.on('pageerror', (error) => problems.push(error.message));
    tab.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
    await tab.goto(`http://127.0.0.1:${server.httpServer.address().port}/`, { timeout: 120_000 });
    await tab.waitForFunction(() => document.title !== '', { timeout: 120_000 });
    assert.equal(await tab.title(), '2 clips, 65 joints');
    assert.deepEqual(problems, []);
  } finally {
    await browser.close();
    await server.close();
  }
});
