// Ways to load the module.
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
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
});

/** Answers requests for files in memory, as the type that their names say. */
async function serve(files, use) {
  const server = createServer(({ url }, response) => {
    const bytes = files[url.slice(1)];
    const type = url.endsWith('.wasm') ? 'application/wasm' : 'application/octet-stream';
    response.writeHead(bytes === undefined ? 404 : 200, { connection: 'close', 'content-type': type }).end(bytes);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  try {
    return await use(`http://127.0.0.1:${server.address().port}/`);
  } finally {
    server.close();
  }
}

test('an address, of a file and of a module', async () => {
  const { default: text } = await import('../dist/generated/plain.js');
  const module = decodeModule(text);
  await serve({ 'a.bendy': read(file), 'a.wasm': module, 'a.bin': module, 'broken.bendy': module }, async (address) => {
    for (const name of ['a.wasm', 'a.bin']) assert.equal((await loadRuntime({ wasm: address + name, simd: false })).kernel, 'plain');
    for (const source of [`${address}a.bendy`, new URL('a.bendy', address)]) assert.equal((await Model.open(source)).clips.length, 2);
    await assert.rejects(Model.open(`${address}broken.bendy`), { name: 'BendyError', kind: 'malformed' });
    await assert.rejects(Model.open(`${address}none.bendy`), { name: 'BendyError', kind: 'io', message: /none\.bendy: 404 Not Found/ });
  });
});

test('whatever cannot be loaded is a BendyError of kind io', async () => {
  const empty = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]); // a module without exports
  const asking = new Uint8Array([...empty, 2, 8, 1, 1, 97, 1, 98, 3, 127, 0]); // one that imports a.b
  for (const [source, words] of [
    ['fox.bendy', /^fox\.bendy cannot be fetched \(this engine fetches no files of a disk/],
    [new URL('file:///nowhere/fox.bendy'), /no files of a disk/],
    ['http://127.0.0.1:1/fox.bendy', /^http:\/\/127\.0\.0\.1:1\/fox\.bendy cannot be fetched: /],
  ]) {
    await assert.rejects(Model.open(source), { name: 'BendyError', kind: 'io', message: words });
    await assert.rejects(loadRuntime({ wasm: source }), { name: 'BendyError', kind: 'io', message: words });
  }
  for (const [wasm, words] of [
    [new Uint8Array(8), /^the WebAssembly module cannot be compiled: /],
    ['data:application/wasm;base64,AAAA', /^the WebAssembly module data:.* cannot be compiled: /],
    [asking, /is not one of this package/],
    [empty, /is not one of this package/],
  ]) {
    await assert.rejects(loadRuntime({ wasm }), { name: 'BendyError', kind: 'io', message: words });
  }
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
