// What `npm pack` makes, as a new user tries it, in an empty project: by node, in a page beside one file, and by Chromium after vite
// has bundled it, alone and with React.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, lstatSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { build, preview } from 'vite';
import { launch, openTab, serve, skip } from './browser.mjs';
import { example, read, repository } from './helpers.mjs';

const web = join(repository, 'bindings/web');
const project = mkdtempSync(join(tmpdir(), 'bendy-pack-'));
const run = (command, ...args) => execFileSync(command, args, { cwd: project, encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });

before(() => {
  writeFileSync(join(project, 'package.json'), '{"type": "module"}');
  // The lines of docs/web.md, with this folder's paths.
  for (const [, command, path] of readFileSync(join(repository, 'docs/web.md'), 'utf8').matchAll(/^npm (pack|install) (\S+)/gm)) {
    run('npm', command, '--silent', '--offline', '--no-audit', path.replace(/^\.\//, command === 'pack' ? `${repository}/` : './'));
  }
  for (const name of ['three', 'react', 'react-dom', '@react-three']) symlinkSync(join(web, 'node_modules', name), join(project, 'node_modules', name));
  mkdirSync(join(project, 'public'));
  copyFileSync(join(repository, 'examples/mannequin.glb'), join(project, 'public/mannequin.glb'));
  writeFileSync(join(project, 'public/mannequin.bendy'), read(example('mannequin')));
});
after(() => rmSync(project, { recursive: true }));

test('the package is no link to a folder, whose own three.js would be a second one', () => {
  const installed = join(project, 'node_modules/bendy');
  assert.ok(lstatSync(installed).isDirectory() && !readdirSync(installed).includes('node_modules'));
});

test('node converts and poses: the lines of README.md', () => {
  const blocks = [...readFileSync(join(project, 'node_modules/bendy/README.md'), 'utf8').matchAll(/^```js\n(.*?)^```$/gms)].map(([, code]) => code);
  copyFileSync(join(project, 'public/mannequin.glb'), join(project, 'fox.glb'));
  writeFileSync(join(project, 'convert.js'), blocks.find((code) => code.includes('convert(')));
  run('node', 'convert.js');
  const pose = blocks.find((code) => code.includes('Model.open(')).replace("'fox.bendy'", "(await import('node:fs')).readFileSync('fox.bendy')");
  writeFileSync(join(project, 'pose.js'), `${pose}console.log(skinned.positions.length / 3);`);
  const vertices = Number(run('node', 'pose.js'));
  assert.ok(vertices > 4000 && vertices <= 4504, `${vertices} of 4504 vertices: those alike are one`);
});

/** Opens a page in Chromium, and returns what it finally has as its title. `expected`: an error that it reports. */
async function titleOf(address, ...expected) {
  const browser = await launch();
  try {
    const { tab, problems } = await openTab(browser);
    await tab.goto(address, { timeout: 120_000 });
    await tab.waitForFunction(() => document.title !== '', { timeout: 240_000 }).catch((error) => problems.push(error.message));
    assert.deepEqual(problems, expected);
    return await tab.title();
  } finally {
    await browser.close();
  }
}

/** Bundles a module by vite, and returns the title of its page. */
async function bundled(source) {
  writeFileSync(join(project, 'index.html'), '<!doctype html><link rel="icon" href="data:,"><div id="root"></div><script type="module" src="/main.js"></script>');
  writeFileSync(join(project, 'main.js'), source);
  await build({ root: project, base: './', logLevel: 'error' });
  const server = await preview({ root: project, logLevel: 'error', preview: { port: 0, host: '127.0.0.1' } });
  try {
    return await titleOf(`http://127.0.0.1:${server.httpServer.address().port}/`);
  } finally {
    await server.close();
  }
}

test('a page beside bendy.js and nothing else', { skip }, async () => {
  const page = `<!doctype html><link rel="icon" href="data:,"><script type="module">
    import { BendyError, Model } from './bendy.js';
    const model = await Model.open('mannequin.bendy');
    const failure = await Model.open('none.bendy').catch((error) => error);
    document.title = [model.sample('Walk', 0.35).skin().positions.length / 3, failure instanceof BendyError, failure.kind].join();
  </script>`;
  const file = (name) => readFileSync(join(project, name));
  const server = await serve({
    'index.html': page,
    'bendy.js': file('node_modules/bendy/dist/bundle/bendy.js'),
    'mannequin.bendy': file('public/mannequin.bendy'),
  });
  const reported = 'Failed to load resource: the server responded with a status of 404 (Not Found)';
  assert.equal(await titleOf(`${server.address}index.html`, reported), '4504,true,io');
  assert.deepEqual(server.requests, ['index.html', 'bendy.js', 'mannequin.bendy', 'none.bendy']);
  server.close();
});

test('vite bundles it for browsers, with the module as a file', { skip }, async () => {
  const title = await bundled(`
    import { init } from 'bendy';
    import wasm from 'bendy/bendy.wasm?url';
    import { convert } from 'bendy/tools';
    import { BendyLoader } from 'bendy/three';
    await init({ wasm });
    const { bytes } = await convert(await (await fetch('mannequin.glb')).arrayBuffer());
    const { animations, model } = await new BendyLoader().parseAsync(bytes);
    document.title = animations.length + ' clips, ' + model.joints.length + ' joints, ' + model.runtime.kernel;`);
  assert.equal(title, '2 clips, 65 joints, wasm');
});

test('vite bundles react-three-fiber, whose vertices are those of the runtime, and the viewer for React', { skip }, async () => {
  const title = await bundled(`
    import { createElement as make, StrictMode, Suspense, useState } from 'react';
    import { createRoot } from 'react-dom/client';
    import { Canvas } from '@react-three/fiber';
    import { Vector3 } from 'three';
    import { Bendy } from 'bendy/react-three-fiber';
    import { BendyViewer } from 'bendy/react';

    const said = [];
    function say(what) {
      said.push(what);
      if (said.length === 3) document.title = said.sort().join(', ');
    }
    let frames = 0;
    /** The largest distance of a vertex that three.js skins from the runtime's, as a share of a metre. */
    function compare({ character, pose }) {
      const { model, parts, scene } = character;
      scene.updateWorldMatrix(true, true);
      let most = 0;
      for (const { object, mesh } of parts) {
        object.skeleton.update();
        const expected = pose.skin({ mesh }).positions;
        const at = new Vector3();
        for (let vertex = 0; vertex < model.meshes[mesh].vertexCount; ++vertex) {
          object.getVertexPosition(vertex, at);
          object.localToWorld(at);
          scene.worldToLocal(at);
          most = Math.max(most, at.distanceTo(new Vector3().fromArray(expected, 3 * vertex)));
        }
      }
      return most;
    }
    function onFrame(animator) {
      animator.apply();
      if (++frames === 3) say('fiber ' + (compare(animator) < 1e-5) + ' ' + (animator.pose.locals.some((x, k) => Math.abs(x - animator.character.model.pose().locals[k]) > 0.1)));
    }
    let others = 0;
    /** With joints: 'needed', the objects of joints stay at rest. */
    function onOther({ character, pose }) {
      if (++others !== 3) return;
      const rest = character.model.pose().locals;
      const isAt = ({ quaternion }, k) => quaternion.toArray().every((x, i) => Math.abs(x - rest[10 * k + i]) < 1e-6);
      say('joints at rest ' + (character.joints.every(isAt) && pose.locals.some((x, k) => Math.abs(x - rest[k]) > 0.1)));
    }
    const viewer = make(BendyViewer, { src: 'mannequin.bendy', clip: 'Walk', alt: 'A mannequin', cameraControls: true, onLoad: ({ model }) => say('viewer ' + model.clips.length), onError: (error) => say(String(error)) });
    const fiber = make(Canvas, { style: { width: 64, height: 64 } }, make(Suspense, { fallback: null },
      make(Bendy, { src: 'mannequin.bendy', clip: 'Walk', position: [0, -1, 0], onFrame }), make(Bendy, { src: 'mannequin.bendy', clip: 'Walk', joints: 'needed', onFrame: onOther })));
    createRoot(document.getElementById('root')).render(make(StrictMode, null, viewer, fiber));`);
  assert.equal(title, 'fiber true true, joints at rest true, viewer 2');
});
