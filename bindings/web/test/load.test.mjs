// Ways to load the module.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Worker } from 'node:worker_threads';
import { hasSimd, init, loadRuntime, Model } from '../dist/index.js';
import { decodeModule } from '../dist/load.js';
import { example, read } from './helpers.mjs';

const file = example('mannequin');

test('the default module is the one with SIMD, where there is SIMD', async () => {
  await assert.rejects(async () => Model.openSync(read(file)), { code: 'BAD_ARGUMENT', message: /init/ });
  const model = await Model.open(read(file));
  assert.equal(model.runtime, await init());
  assert.equal(model.runtime.simd, hasSimd());
  assert.equal(model.runtime.kernel, hasSimd() ? 'wasm' : 'plain');
  await assert.rejects(init({ simd: false }), { code: 'BAD_ARGUMENT' });
  assert.equal(Model.openSync(read(file)).joints.length, model.joints.length);
});

test('a module of the user', async () => {
  const { default: text } = await import('../dist/generated/plain.js');
  const bytes = Buffer.from(decodeModule(text));
  const compiled = await WebAssembly.compile(bytes);
  for (const wasm of [bytes, compiled, `data:application/wasm;base64,${bytes.toString('base64')}`]) {
    const runtime = await loadRuntime({ wasm, simd: false });
    assert.equal(runtime.kernel, 'plain');
    const model = await Model.open(read(file), { runtime });
    assert.equal(model.clips.length, 2);
  }
  await assert.rejects(loadRuntime({ wasm: new Uint8Array(8) }), WebAssembly.CompileError);
});

test('an ArrayBuffer, and bytes within one', async () => {
  const bytes = read(file);
  const inside = new Uint8Array(bytes.length + 5);
  inside.set(bytes, 3);
  for (const source of [bytes.slice().buffer, inside.subarray(3, 3 + bytes.length)]) {
    assert.equal((await Model.open(source)).clips.length, 2);
  }
});

test('in a worker', async () => {
  const source = `
    import { parentPort, workerData } from 'node:worker_threads';
    import { Model } from ${JSON.stringify(new URL('../dist/index.js', import.meta.url).href)};
    const model = await Model.open(workerData);
    const { positions } = model.sample('Walk', 0.3).skin();
    parentPort.postMessage(positions.slice());`;
  const worker = new Worker(new URL(`data:text/javascript,${encodeURIComponent(source)}`), { workerData: read(file) });
  const positions = await new Promise((resolve, reject) => worker.once('message', resolve).once('error', reject));
  const model = await Model.open(read(file));
  assert.deepEqual(positions, model.sample('Walk', 0.3).skin().positions.slice());
});
