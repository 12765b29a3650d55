// Lets headless Chromium draw characters by BendyLoader and by GLTFLoader, and compares the pictures. Settings: see three.test.mjs.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const web = fileURLToPath(new URL('../', import.meta.url));
const program = process.env.BENDY_PROGRAM ?? path.join(web, '../../build/release/cli/bendy');
const corpus = process.env.BENDY_CORPUS ?? path.join(web, '../../../shared/corpus/visible');
const chromium = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find((file) => fs.existsSync(file));
const missing = [program, corpus, chromium ?? 'Chromium'].filter((file) => !fs.existsSync(file));
const types = { '.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript', '.json': 'application/json' };

/**
 * For each file the clip and time to draw; null: rest. Without GLTFLoader, the picture of `skin: 'wasm'` is the reference, and of a crowd
 * that of as many characters.
 */
const jobs = [
  { file: 'models/fox.glb', clip: 1, time: 0.3 },
  { file: 'models/cesium_man.gltf', clip: 0, time: 0.7 },
  { file: 'models/robot.glb', clip: 0, time: 1.1 },
  { file: 'models/texture_transform_test/TextureTransformTest.gltf', clip: null },
  { file: 'models/box_textured_embedded.gltf', clip: null },
  { file: 'generated/morph_and_skin.glb', clip: 0, time: 0.5 },
  { file: 'generated/attributes_zoo.glb', clip: 0, time: 0.5 },
  { file: 'generated/joints8.glb', clip: 0, time: 0.5, hasReference: false },
  { file: 'models/fox.glb', clip: 1, isCrowd: true },
  { file: 'models/robot.glb', clip: 0, isCrowd: true },
  { file: 'generated/joints8.glb', clip: 0, isCrowd: true },
  { file: 'generated/morph_and_skin.glb', clip: 0, isCrowd: true },
  { file: 'generated/rigid_attachments.glb', clip: 0, isCrowd: true },
  { file: 'models/box_animated.gltf', clip: 0, isCrowd: true },
];

test('pictures', { skip: missing.length > 0 && `needs ${missing.join(', ')}`, timeout: 300_000 }, async (context) => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'bendy-three-'));
  const roots = { dist: path.join(web, 'dist'), three: path.join(web, 'node_modules/three'), corpus, made: folder };
  for (const [k, { file }] of jobs.entries()) {
    execFileSync(program, ['convert', path.join(corpus, file), '-q', '-o', path.join(folder, `${k}.bendy`)]);
  }
  const listed = jobs.map(({ file, hasReference, ...rest }, k) => ({
    ...rest,
    bendy: `/made/${k}.bendy`,
    gltf: hasReference === false ? null : `/corpus/${file}`,
  }));
  fs.writeFileSync(path.join(folder, 'jobs.json'), JSON.stringify(listed));
  let finish;
  const result = new Promise((resolve) => (finish = resolve));
  const server = http.createServer(async (request, response) => {
    if (request.method === 'POST') {
      finish(JSON.parse(Buffer.concat(await request.toArray()).toString()));
      return response.end();
    }
    const [, root, ...rest] = decodeURIComponent(request.url).split('/');
    const file =
      root === 'jobs.json'
        ? path.join(folder, root)
        : rest.length === 0
          ? path.join(web, 'test', root)
          : path.join(roots[root] ?? folder, ...rest);
    if (!fs.existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': types[path.extname(file)] ?? 'application/octet-stream' });
    return response.end(fs.readFileSync(file));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const browser = spawn(
    chromium,
    [
      '--headless',
      '--no-sandbox',
      '--use-gl=angle',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--ignore-gpu-blocklist',
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
      '--no-proxy-server',
      `--user-data-dir=${path.join(folder, 'profile')}`,
      `http://127.0.0.1:${server.address().port}/three_browser.html`,
    ],
    { stdio: 'ignore' },
  );
  try {
    for (const [k, { failed, drawn, different }] of (await result).entries()) {
      assert.equal(failed, undefined, `${jobs[k].file}: ${failed}`);
      context.diagnostic(`${jobs[k].file}: ${drawn} pixels, different: ${JSON.stringify(different)}`);
      assert.ok(drawn > 1000, jobs[k].file);
      for (const count of Object.values(different)) assert.ok(count <= 0.002 * drawn, jobs[k].file);
    }
  } finally {
    browser.kill();
    await new Promise((resolve) => browser.once('exit', resolve));
    server.close();
    server.closeAllConnections();
    fs.rmSync(folder, { recursive: true, maxRetries: 5 });
  }
});
