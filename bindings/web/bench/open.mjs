// Opening beside GLTFLoader, by turns in one page of headless Chromium: node bench/open.mjs [--peers FOLDER] FILE.glb...
// The same character as glTF (as it is, by gltfpack -cc for meshopt, by gltf-transform draco) and as a bendy file (exact, compact):
// bytes, bytes after brotli, and milliseconds from the bytes to the first frame on the GPU, of clips that AnimationMixer plays or, of
// bendy files, BendyAnimator. FOLDER has the npm packages gltfpack
// and @gltf-transform/cli.
import { execFileSync } from 'node:child_process';
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { basename, extname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync } from 'node:zlib';
import puppeteer from 'puppeteer-core';

const web = fileURLToPath(new URL('../', import.meta.url));
const program = process.env.BENDY_PROGRAM ?? join(web, '../../build/release/cli/bendy');
const sources = process.argv.slice(2);
const peers = sources[0] === '--peers' ? sources.splice(0, 2)[1] : web;
const folder = mkdtempSync(join(tmpdir(), 'bendy-open-'));
const run = (command, ...args) => execFileSync(command, args, { stdio: ['ignore', 'pipe', 'inherit'], cwd: folder });
const peer = (name) => join(peers, 'node_modules/.bin', name);

const forms = [
  ['glTF', 'plain.glb', (source, output) => cpSync(source, output)],
  ['meshopt', 'meshopt.glb', (source, output) => run(peer('gltfpack'), '-cc', '-i', source, '-o', output)],
  ['Draco', 'draco.glb', (source, output) => run(peer('gltf-transform'), 'draco', source, output)],
  ['bendy', 'exact.bendy', (source, output) => run(program, 'convert', '-q', source, '-o', output)],
  ['bendy, compact', 'compact.bendy', (source, output) => run(program, 'convert', '-q', '--compact', source, '-o', output)],
];

const page = `<!doctype html><meta charset="utf-8">
<script type="importmap">{"imports": {"three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { init } from '/dist/index.js';
import { BendyAnimator, BendyLoader } from '/dist/three/index.js';

const renderer = new THREE.WebGLRenderer();
renderer.setSize(256, 256);
const target = new THREE.WebGLRenderTarget(1, 1);
const camera = new THREE.PerspectiveCamera(40, 1, 0.01, 1000);
camera.position.set(0, 1, 5);
const draco = new DRACOLoader().setDecoderPath('/three/examples/jsm/libs/draco/gltf/');
const gltf = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).setDRACOLoader(draco);
const bendy = new BendyLoader();
const [, decoder] = location.search.split('?');
if (decoder === 'draco') draco.preload();
if (decoder === 'bendy') init({ wasm: '/dist/bendy.wasm' });

/** Milliseconds until the GPU has drawn the first frame. */
globalThis.measure = async (name) => {
  const bytes = await (await fetch('/made/' + name)).arrayBuffer();
  const start = performance.now();
  const loaded = await (name.endsWith('.bendy') ? bendy : gltf).parseAsync(bytes, '');
  const scene = new THREE.Scene().add(loaded.scene, new THREE.DirectionalLight(), new THREE.AmbientLight());
  loaded.scene.traverse((object) => (object.frustumCulled = false));
  if (name.endsWith('.bendy')) {
    const animator = new BendyAnimator(loaded);
    if (loaded.model.clips.length !== 0) animator.play(0);
    animator.update(0.1);
  } else if (loaded.animations.length !== 0) {
    const mixer = new THREE.AnimationMixer(loaded.scene);
    mixer.clipAction(loaded.animations[0]).play();
    mixer.update(0.1);
  }
  renderer.render(scene, camera);
  renderer.readRenderTargetPixels(target, 0, 0, 1, 1, new Uint8Array(4)); // waits for the GPU
  const taken = performance.now() - start;
  loaded.scene.traverse(({ geometry, material, skeleton }) => {
    geometry?.dispose();
    skeleton?.dispose();
    for (const one of [material ?? []].flat()) {
      for (const value of Object.values(one)) if (value?.isTexture) value.dispose();
      one.dispose();
    }
  });
  loaded.model?.dispose();
  return taken;
};
globalThis.isReady = true;
</script>`;

const types = { '.js': 'text/javascript', '.wasm': 'application/wasm' };
const roots = { dist: join(web, 'dist'), three: join(web, 'node_modules/three'), made: folder };
const server = createServer((request, response) => {
  const [, root, ...rest] = request.url.split('/');
  if (/^\?|^$/.test(root)) return response.writeHead(200, { 'content-type': 'text/html' }).end(page);
  const file = root in roots && join(roots[root], ...rest);
  if (!file || !existsSync(file)) return response.writeHead(404).end();
  response.writeHead(200, { 'content-type': types[extname(file)] ?? 'application/octet-stream' }).end(readFileSync(file));
});
await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-gl=angle', '--use-angle=swiftshader'],
  protocolTimeout: 600_000,
});

/** Opens the page. `name`: the file that it will measure, for which it preloads the decoder. */
async function openPage(name) {
  const tab = await browser.newPage();
  tab.on('pageerror', (error) => console.error(error.message));
  await tab.goto(`http://127.0.0.1:${server.address().port}/?${name?.endsWith('.bendy') ? 'bendy' : name?.startsWith('draco') ? 'draco' : ''}`);
  await tab.waitForFunction(() => globalThis.isReady === true);
  return tab;
}

const median = (numbers) => numbers.sort((a, b) => a - b)[numbers.length >> 1];
console.log('| character | form | bytes | by brotli | first in a page, ms | later, ms |\n|---|---|---|---|---|---|');
for (const source of sources) {
  for (const [, output, make] of forms) make(resolve(source), join(folder, output));
  const first = forms.map(() => []);
  const later = forms.map(() => []);
  for (let round = 0; round < 7; ++round) {
    for (const [k, [, output]] of forms.entries()) {
      const tab = await openPage(output);
      first[k].push(await tab.evaluate((name) => measure(name), output));
      await tab.close();
    }
  }
  const tab = await openPage();
  for (let round = 0; round < 21; ++round) {
    for (const [k, [, output]] of forms.entries()) {
      const taken = await tab.evaluate((name) => measure(name), output);
      if (round > 1) later[k].push(taken);
    }
  }
  await tab.close();
  for (const [k, [name, output]] of forms.entries()) {
    const bytes = readFileSync(join(folder, output));
    const sizes = [bytes.length, brotliCompressSync(bytes).length].map((size) => size.toLocaleString('en'));
    console.log(`| ${basename(source, extname(source))} | ${name} | ${sizes.join(' | ')} | ${median(first[k]).toFixed(1)} | ${median(later[k]).toFixed(1)} |`);
  }
}
await browser.close();
server.close();
rmSync(folder, { recursive: true });
