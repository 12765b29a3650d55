// The page in a real browser: from a file, without a server or a network.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { after, before, test } from 'node:test';
import puppeteer from 'puppeteer-core';
import { program, repository as root } from './helpers.mjs';

const page = new URL('../dist/page.html', import.meta.url);
const chromium = process.env.CHROMIUM ?? '/usr/bin/chromium';
const pictures = process.env.BENDY_PICTURES; // a folder for screenshots, to be looked at
const skip = existsSync(chromium) ? false : `${chromium} is not there`;
let browser, tab, folder;
const requests = [], problems = [];

before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), 'bendy-page-'));
  browser = await puppeteer.launch({
    executablePath: chromium,
    args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-gl=angle', '--use-angle=swiftshader', '--js-flags=--expose-gc'],
    protocolTimeout: 300_000,
  });
  tab = await browser.newPage();
  await tab.setViewport({ width: 1200, height: 760 });
  tab.on('request', (request) => requests.push(request.url()));
  tab.on('pageerror', (error) => problems.push(error.message));
  tab.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  const session = await tab.createCDPSession();
  await session.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: folder, eventsEnabled: true });
  await tab.goto(page.href, { waitUntil: 'domcontentloaded', timeout: 120_000 });
  await shown('mannequin.bendy');
});

after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

const text = (selector) => tab.$eval(selector, (element) => element.textContent);
const select = (name) => tab.evaluate((id) => document.getElementById(id).click(), `tab-${name}`);
const frames = (count = 3) =>
  tab.evaluate((left) => new Promise((resolve) => (function next() { left-- > 0 ? requestAnimationFrame(next) : resolve(); })()), count);

async function shown(name, words = 'is shown') {
  await tab.waitForFunction((wanted) => document.getElementById('status').textContent === wanted, { timeout: 120_000 }, `${name} ${words}`);
  await frames();
}

/** Opens files as a person who picks them. */
async function open(...files) {
  await tab.evaluate(() => (document.getElementById('status').textContent = ''));
  await (await tab.$('#files')).uploadFile(...files);
}

async function picture(name) {
  if (pictures) await tab.screenshot({ path: join(pictures, `${name}.png`) });
}

/** How many pixels of the canvas differ from its first one. */
const drawn = () =>
  tab.evaluate(() => {
    const view = document.getElementById('view');
    const copy = Object.assign(document.createElement('canvas'), { width: 200, height: 120 });
    const context = copy.getContext('2d');
    context.drawImage(view, 0, 0, 200, 120);
    const { data } = context.getImageData(0, 0, 200, 120);
    let count = 0;
    for (let at = 0; at < data.length; at += 4) count += Math.abs(data[at] - data[0]) > 24 || Math.abs(data[at + 2] - data[2]) > 24 ? 1 : 0;
    return count;
  });

async function downloaded(name) {
  const file = join(folder, name);
  for (let tries = 0; tries < 600 && !(existsSync(file) && readFileSync(file).length !== 0); ++tries) await new Promise((resolve) => setTimeout(resolve, 100));
  const bytes = readFileSync(file);
  rmSync(file);
  return bytes;
}

const native = (...args) => execFileSync(program, args, { stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1 << 30 });

test('the example walks, and looks at the pointer', { skip }, async () => {
  await picture('first');
  assert.ok((await drawn()) > 500, 'the character is drawn');
  assert.match(await text('#name'), /mannequin\.bendy · [\d,]+ vertices, 65 joints, 2 clips/);
  const time = () => tab.$eval('#time', (range) => range.valueAsNumber);
  const first = await time();
  await frames(5);
  assert.notEqual(await time(), first, 'it moves');
  const head = async (x, y) => {
    await tab.mouse.move(x, y);
    await frames(3);
    return tab.evaluate(() => [...bendyPage.character.results.values()].join());
  };
  assert.match(await head(150, 200), /aimed|as near/);
});

test('keys play, step and change the clip', { skip }, async () => {
  await tab.focus('#view');
  await tab.keyboard.press(' ');
  assert.equal(await text('#play'), 'Play');
  const seconds = () => tab.evaluate(() => bendyPage.character.seconds);
  const before = await seconds();
  await tab.keyboard.press('ArrowRight');
  await frames();
  assert.ok(Math.abs((await seconds()) - before - 1 / 30) < 1e-3);
  assert.ok(Math.abs((await tab.$eval('#time', (range) => range.valueAsNumber)) - (await tab.evaluate(() => bendyPage.character.share))) < 1e-3);
  const clip = () => tab.$eval('#clips [aria-pressed=true]', (element) => element.textContent);
  const walked = await clip();
  await tab.keyboard.press(']');
  await frames();
  assert.notEqual(await clip(), walked);
});

test('a dragged chain reaches inside its constraints', { skip }, async () => {
  await select('reach');
  await frames();
  const chain = await tab.evaluate(() => bendyPage.character.chains.find(({ name }) => name === 'IK_LeftArm').number);
  const { x, y } = await tab.evaluate((number) => bendyPage.handlePlace(number), chain);
  await tab.mouse.move(x, y);
  await tab.mouse.down();
  await tab.mouse.move(x - 40, y + 60, { steps: 5 });
  await frames();
  await picture('reach');
  const result = await text(`#reached-${chain}`);
  await tab.mouse.up();
  assert.match(result, /reached|as near|too far/);
  assert.equal(await tab.evaluate((number) => bendyPage.character.targets.has(number), chain), true);
  await tab.evaluate((number) => document.getElementById(`reached-${number}`).nextElementSibling.click(), chain);
  await frames();
  assert.equal(await text(`#reached-${chain}`), '', 'let go');
  await select('move');
});

test('a source is converted, and what is saved has the bytes of the program', { skip }, async () => {
  const source = join(root, 'examples/tentacle.glb');
  await open(source);
  await shown('tentacle.glb');
  await picture('tentacle');
  assert.ok((await drawn()) > 300);
  await select('save');
  await tab.click('#save-bendy');
  const saved = await downloaded('tentacle.bendy');
  const expected = join(folder, 'expected.bendy');
  native('convert', source, '-o', expected);
  assert.ok(saved.equals(readFileSync(expected)), '.bendy');
  await tab.click('#save-compact');
  const compact = await downloaded('tentacle.compact.bendy');
  native('convert', expected, '--compact', '--max-error', '0.005%', '-o', join(folder, 'small.bendy'));
  assert.ok(compact.equals(readFileSync(join(folder, 'small.bendy'))), 'compact .bendy');
  await tab.click('#save-glb');
  const glb = await downloaded('tentacle.glb');
  native('export', expected, '-o', join(folder, 'back.glb'));
  assert.ok(glb.equals(readFileSync(join(folder, 'back.glb'))), '.glb');
  await picture('save');
  assert.match(await text('#sizes'), /compact/);
  await select('messages');
  assert.match(await text('#verdict'), /valid/);
  assert.match(await text('#warnings'), /influence is animated/);
});

test('the chunks are shown as bendy inspect shows them', { skip }, async () => {
  await select('inspect');
  const frame = await (await tab.$('#page')).contentFrame();
  await frame.waitForFunction(() => document.querySelector('#map .cell') !== null, { timeout: 60_000 });
  await frames();
  await picture('inspect');
  assert.match(await frame.$eval('h1', (element) => element.textContent), /tentacle/);
  await select('move');
});

test('a rig is proposed, or read from a file of its own', { skip }, async () => {
  const [rigged, bare, rig] = ['rigged.bendy', 'bare.bendy', 'bare.rig.json'].map((name) => join(folder, name));
  native('convert', '-q', join(root, 'examples/mannequin.glb'), '-o', rigged);
  native('edit', '-q', rigged, '--strip', 'constraints', '--strip', 'chains', '-o', bare);
  native('rig', rigged, '-o', rig);
  const chains = () => tab.evaluate(() => bendyPage.character.chains.map(({ name }) => name));
  await open(bare);
  await shown('bare.bendy');
  assert.deepEqual(await chains(), []);
  await open(rig); // for the character that is shown
  await shown('bare.bendy');
  assert.ok((await chains()).includes('IK_LeftArm'));
  await open(bare);
  await shown('bare.bendy');
  await select('reach');
  await tab.evaluate(() => (document.getElementById('status').textContent = ''));
  await tab.click('#guess');
  await shown('bare.bendy');
  assert.ok((await chains()).includes('LeftArm'));
  await select('move');
});

test('without a mesh, the skeleton is shown', { skip }, async () => {
  const bones = join(folder, 'bones.bendy');
  native('edit', '-q', join(folder, 'rigged.bendy'), '--strip', 'meshes', '-o', bones);
  await open(bones);
  await shown('bones.bendy');
  await picture('bones');
  assert.match(await text('#name'), / 0 vertices, 65 joints/);
  assert.equal(await tab.$eval('#bones', ({ checked }) => checked), true);
  const withBones = await drawn();
  await tab.click('#bones');
  await frames();
  assert.ok(withBones > (await drawn()) + 30);
});

test('files that belong together are read together', { skip }, async () => {
  const gltf = join(folder, 'parts.gltf');
  native('export', join(folder, 'expected.bendy'), '-o', gltf);
  await open(gltf);
  await shown('parts.gltf', 'cannot be shown');
  assert.match(await text('#faults'), /parts\.bin/);
  await open(gltf, join(folder, 'parts.bin'));
  await shown('parts.gltf');
});

test('images that a bendy file links to are drawn, or their absence is said', { skip }, async () => {
  const pixel = Buffer.from('iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC', 'base64');
  const quad = {
    asset: { version: '2.0' },
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, material: 0 }] }],
    materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }],
    textures: [{ source: 0 }],
    images: [{ uri: 'red%20skin.png' }],
    accessors: [
      { bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 0] },
      { bufferView: 1, componentType: 5126, count: 3, type: 'VEC2' },
    ],
    bufferViews: [{ buffer: 0, byteLength: 36 }, { buffer: 0, byteOffset: 36, byteLength: 24 }],
    buffers: [{ byteLength: 60, uri: `data:;base64,${Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1]).buffer).toString('base64')}` }],
  };
  const [source, linked, image] = ['quad.gltf', 'quad.bendy', 'red skin.png'].map((name) => join(folder, name));
  writeFileSync(source, JSON.stringify(quad));
  writeFileSync(image, pixel);
  native('convert', '-q', source, '--images', 'link', '-o', linked);
  const isTextured = () =>
    tab.evaluate(() => {
      let found = false;
      bendyPage.character.object.traverse(({ material }) => (found ||= Boolean(material?.map?.image)));
      return found;
    });
  await open(linked, image);
  await shown('quad.bendy');
  assert.equal(await isTextured(), true);
  assert.equal(await tab.$eval('#warned', (element) => element.hidden), true);
  await open(linked);
  await shown('quad.bendy');
  assert.equal(await isTextured(), false);
  assert.match(await text('#warnings'), /red%20skin\.png.*is not among the files/);
});

test('messages do not name options, which the page has none of', { skip }, async () => {
  const file = join(folder, 'many.gltf');
  writeFileSync(file, JSON.stringify({ asset: { version: '2.0' }, extensionsRequired: ['EXT_mesh_gpu_instancing'] }));
  await open(file);
  await shown('many.gltf', 'cannot be shown');
  assert.match(await text('#faults'), /EXT_mesh_gpu_instancing.*not supported/);
  assert.doesNotMatch(await text('#faults'), /unless instances/);
});

test('sixty broken files show their faults, and the page goes on', { skip }, async () => {
  const whole = readFileSync(join(folder, 'expected.bendy'));
  const glb = readFileSync(join(root, 'examples/tentacle.glb'));
  for (let k = 0; k < 60; ++k) {
    const source = k % 3 === 0 ? glb : whole;
    const bytes = Buffer.from(k % 2 === 0 ? source.subarray(0, Math.floor((source.length * (k + 1)) / 62)) : source);
    if (k % 2 === 1) for (let at = 13 * k; at < bytes.length; at += 997) bytes[at] ^= 0x5a;
    const file = join(folder, `broken-${k}${k % 3 === 0 ? '.glb' : '.bendy'}`);
    writeFileSync(file, bytes);
    await open(file);
    await shown(basename(file), 'cannot be shown');
    assert.equal(await tab.$eval('#messages', (panel) => panel.hidden), false);
    assert.ok((await text('#faults')).length > 10, `${file} has a fault with words`);
    if (k === 1) await picture('broken');
  }
  await open(join(folder, 'expected.bendy'));
  await shown('expected.bendy');
  assert.ok((await drawn()) > 300);
});

test('memory stays flat', { skip }, async () => {
  const used = async () => {
    await tab.evaluate(() => globalThis.gc?.());
    return (await tab.metrics()).JSHeapUsedSize;
  };
  const times = Number(process.env.BENDY_LOADS ?? 40);
  const load = async (count) => {
    for (let k = 0; k < count; ++k) {
      await open(join(folder, 'expected.bendy'));
      await shown('expected.bendy');
    }
    return used();
  };
  const few = await load(10);
  const many = await load(times);
  assert.ok(many - few < 8e6, `${few} bytes after 10 loads, ${many} after ${times} more`);
});

test('nothing is asked of a network, and nothing fails silently', { skip }, () => {
  assert.deepEqual(requests.filter((address) => !/^(file|blob|data|about):/.test(address)), []);
  assert.deepEqual(problems, []);
});
