// The page in a real browser: from a file, without a server or a network.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { after, before, test } from 'node:test';
import axe from 'axe-core';
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

/** How many pixels of a small copy of the canvas the character and its shadow take. */
const drawn = () =>
  tab.evaluate(() => {
    const { stage } = bendyPage;
    stage.setBackdrop('Transparent', '');
    stage.draw();
    const context = Object.assign(document.createElement('canvas'), { width: 200, height: 120 }).getContext('2d');
    context.drawImage(stage.canvas, 0, 0, 200, 120);
    stage.setBackdrop('Soft', '');
    const { data } = context.getImageData(0, 0, 200, 120);
    return data.filter((value, at) => at % 4 === 3 && value > 30).length;
  });

async function downloaded(name) {
  const file = join(folder, name);
  for (let tries = 0; tries < 600 && !(existsSync(file) && readFileSync(file).length !== 0); ++tries) await new Promise((resolve) => setTimeout(resolve, 100));
  const bytes = readFileSync(file);
  rmSync(file);
  return bytes;
}

/** What axe says against the page as it is, and what ARIA it is not sure about. */
async function axeSays() {
  const { violations, incomplete } = await tab.evaluate(() => globalThis.axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] }));
  const rules = [...violations, ...incomplete.filter(({ id }) => id.startsWith('aria'))];
  return rules.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target}: ${failureSummary}`));
}

/** Checks the page in both colour schemes and on a phone. */
async function checkByAxe() {
  await tab.evaluate(axe.source);
  for (const [value, width, height] of [['light', 1200, 760], ['dark', 1200, 760], ['light', 390, 844]]) {
    await tab.emulateMediaFeatures([{ name: 'prefers-color-scheme', value }]);
    await tab.setViewport({ width, height });
    await frames();
    assert.deepEqual(await axeSays(), [], `${value}, ${width} pixels`);
  }
  await tab.emulateMediaFeatures([]);
  await tab.setViewport({ width: 1200, height: 760 });
  await frames();
}

const native = (...args) => execFileSync(program, args, { stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1 << 30 });

test('a poster is shown until the first picture, which is like it; the tools are not loaded', { skip }, async () => {
  await picture('first');
  assert.ok((await drawn()) > 500, 'the character is drawn');
  assert.equal(await tab.$('#poster'), null);
  assert.equal(await tab.$eval('#open .icon', (icon) => getComputedStyle(icon).visibility), 'visible', 'icons come after it');
  assert.deepEqual(tab.workers(), []);
  // The poster's outline and that of the character, in a picture of the poster's shape.
  const [address] = readFileSync(page, 'latin1').match(/data:image\/webp;base64,[^"]*/);
  const share = await tab.evaluate(async (poster) => {
    const image = Object.assign(new Image(), { src: poster });
    await image.decode();
    const { width, height } = image;
    const alpha = (draw) => {
      const context = Object.assign(document.createElement('canvas'), { width, height }).getContext('2d');
      draw(context);
      return context.getImageData(0, 0, width, height).data;
    };
    const view = document.getElementById('view');
    bendyPage.stage.setBackdrop('Transparent', '');
    bendyPage.stage.draw();
    const wide = (view.height * width) / height;
    const shown = alpha((context) => context.drawImage(view, (view.width - wide) / 2, 0, wide, view.height, 0, 0, width, height));
    bendyPage.stage.setBackdrop('Soft', '');
    const before = alpha((context) => context.drawImage(image, 0, 0));
    let [both, either] = [0, 0];
    for (let at = 3; at < shown.length; at += 4) {
      const [a, b] = [shown[at] > 200, before[at] > 200];
      both += a && b ? 1 : 0;
      either += a || b ? 1 : 0;
    }
    return both / either;
  }, address);
  assert.ok(share > 0.75, `the outlines of poster and character share ${share}: run page/poster.mjs`);
});

test('axe finds nothing on the first view', { skip }, async () => checkByAxe());

test('the example idles, and looks at the pointer', { skip }, async () => {
  assert.match(await text('#name'), /mannequin\.bendy · [\d,]+ vertices, 65 joints, 2 clips/);
  assert.match(await text('#clips [aria-current=true]'), /^Idle/);
  const time = () => tab.$eval('#time', (range) => range.valueAsNumber);
  const first = await time();
  await frames(5);
  assert.notEqual(await time(), first, 'it moves');
  await tab.mouse.move(150, 200);
  await frames(3);
  assert.match(await tab.evaluate(() => [...bendyPage.character.results.values()].join()), /aimed|as near/);
});

test('keys play, step, change the clip and turn the picture, and a dialog lists them', { skip }, async () => {
  await tab.focus('#view');
  await tab.keyboard.press(' ');
  const label = () => tab.$eval('#play', (element) => element.getAttribute('aria-label'));
  assert.equal(await label(), 'Play');
  const seconds = () => tab.evaluate(() => bendyPage.character.seconds);
  await tab.evaluate(() => bendyPage.character.seek(0.5));  // a step from the end would lead to the start
  const before = await seconds();
  await tab.keyboard.press('.');
  await frames();
  const after = await seconds();
  assert.ok(Math.abs(after - before - 1 / 30) < 1e-3, `from ${before} to ${after}`);
  assert.ok(Math.abs((await tab.$eval('#time', (range) => range.valueAsNumber)) - (await tab.evaluate(() => bendyPage.character.share))) < 1e-3);
  await tab.keyboard.press(']');
  await frames();
  assert.match(await text('#clips [aria-current=true]'), /^Walk/);
  assert.equal(await label(), 'Pause');
  const camera = () => tab.evaluate(() => bendyPage.stage.camera.position.toArray());
  const [x, y, z] = await camera();
  await tab.keyboard.press('ArrowRight');
  await tab.keyboard.press('+');
  await frames();
  const [x2, , z2] = await camera();
  assert.ok(Math.abs(Math.atan2(x2, z2) - Math.atan2(x, z)) > 0.03, 'turned');
  assert.ok(Math.hypot(x2, z2) < Math.hypot(x, z), 'nearer');
  await tab.keyboard.press('0');
  await frames();
  assert.ok(Math.abs((await camera())[1] - y) < 0.05, 'the whole character again');
  await tab.keyboard.press('?');
  assert.equal(await tab.$eval('#keys', ({ open }) => open), true);
  assert.match(await text('#key-list'), /play or pause[^]*full screen[^]*let go of it/);
  await tab.keyboard.press('Escape');
  assert.equal(await tab.$eval('#keys', ({ open }) => open), false);
});

const chainNumber = (name) => tab.evaluate((wanted) => bendyPage.character.chains.find(({ name }) => name === wanted).number, name);
const hasTarget = (chain) => tab.evaluate((number) => bendyPage.character.targets.has(number), chain);

test('a dragged chain reaches inside its constraints', { skip }, async () => {
  const chain = await chainNumber('IK_LeftArm');
  assert.equal(await text('.invitation'), 'Drag my hand');
  const { x, y } = await tab.evaluate((number) => bendyPage.handlePlace(number), chain);
  await tab.mouse.move(x, y);
  await tab.mouse.down();
  await tab.mouse.move(x - 40, y + 60, { steps: 5 });
  await frames();
  await picture('reach');
  const result = await text(`#reached-${chain}`);
  await tab.mouse.up();
  assert.match(result, /reached|as near|too far/);
  assert.equal(await hasTarget(chain), true);
  assert.equal(await tab.$('.invitation'), null, 'it has been taken');
  await tab.evaluate((number) => document.getElementById(`reached-${number}`).nextElementSibling.click(), chain);
  await tab.waitForFunction((number) => document.getElementById(`reached-${number}`).textContent === '', {}, chain);
  assert.equal(await hasTarget(chain), false, 'let go');
});

test('keys move a handle, and let it go', { skip }, async () => {
  const chain = await chainNumber('IK_RightArm');
  const handle = await tab.evaluateHandle(() => [...document.querySelectorAll('.handle')].find((one) => /right arm/.test(one.getAttribute('aria-label'))));
  await handle.focus();
  const target = () => tab.evaluate((number) => bendyPage.character.targets.get(number)?.toArray(), chain);
  await tab.keyboard.press('ArrowUp');
  const first = await target();
  await tab.keyboard.press('ArrowUp');
  const second = await target();
  assert.ok(second[1] - first[1] > 0.01, `${first} to ${second}`);
  await frames();
  assert.match(await text(`#reached-${chain}`), /reached|as near|too far/);
  await tab.keyboard.press('Escape');
  assert.equal(await hasTarget(chain), false);
});

test('white does not wash out, and the exposure can be chosen', { skip }, async () => {
  const brightShare = () =>
    tab.evaluate(() => {
      const { stage, character } = bendyPage;
      character.object.traverse(({ material }) => material && Object.assign(material, { map: null, needsUpdate: true }) && material.color.set(1, 1, 1));
      stage.setBackdrop('Black', '');
      stage.draw();
      const { canvas } = stage;
      const context = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height }).getContext('2d');
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
      let [bright, all] = [0, 0];
      for (let at = 0; at < data.length; at += 4) {
        all += data[at] > 60 ? 1 : 0;
        bright += Math.min(data[at], data[at + 1], data[at + 2]) >= 252 ? 1 : 0;
      }
      stage.setBackdrop('Soft', '');
      return bright / all;
    });
  assert.ok((await brightShare()) < 0.01, `${await brightShare()} of a white character is pure white`);
  const expose = (stops) =>
    tab.$eval('#exposure', (range, value) => {
      range.value = value;
      range.dispatchEvent(new Event('input'));
    }, stops);
  await expose(2);
  assert.ok((await brightShare()) > 0.05);
  await expose(0);
});

test('looks: surroundings, background, skeleton', { skip }, async () => {
  await select('look');
  /** A corner of a saved picture, and what is below the canvas. */
  const backdrop = async (name) => {
    await tab.select('#backdrop', name);
    await tab.click('#picture');
    const png = (await downloaded('mannequin.png')).toString('base64');
    return tab.evaluate(async (address) => {
      const image = Object.assign(new Image(), { src: address });
      await image.decode();
      const context = Object.assign(document.createElement('canvas'), { width: 1, height: 1 }).getContext('2d');
      context.drawImage(image, 0, 0);
      const { backgroundColor, backgroundImage } = getComputedStyle(bendyPage.stage.canvas);
      return [[...context.getImageData(0, 0, 1, 1).data], backgroundColor, backgroundImage.replace(/\(.*/, '')];
    }, `data:image/png;base64,${png}`);
  };
  const clear = 'rgba(0, 0, 0, 0)';
  assert.deepEqual(await backdrop('White'), [[255, 255, 255, 255], 'rgb(255, 255, 255)', 'none']);
  assert.deepEqual(await backdrop('Transparent'), [[0, 0, 0, 0], clear, 'repeating-conic-gradient']);
  const [[, green, , alpha], ...below] = await backdrop('Soft');
  assert.ok(green > 150 && green < 250 && alpha === 255, 'the gradient is in the picture');
  assert.deepEqual(below, [clear, 'none']);
  await tab.select('#backdrop', 'Soft');
  for (const name of ['Overcast', 'Sunset', 'Night', 'Studio']) {
    await tab.select('#surroundings', name);
    await frames();
    assert.ok((await drawn()) > 300, name);
  }
  await select('move');
});

test('a picture and a turntable video are saved', { skip }, async () => {
  await tab.click('#picture');
  const png = await downloaded('mannequin.png');
  assert.equal(png.subarray(1, 4).toString('latin1'), 'PNG');
  assert.equal(png.readUInt32BE(16), await tab.$eval('#view', ({ width }) => width));
  await tab.click('#video');
  assert.equal(await tab.$eval('#video', (element) => element.getAttribute('aria-label')), 'Stop the video');
  await tab.waitForFunction(() => document.getElementById('status').textContent === 'The video is saved', { timeout: 240_000 });
  const [name] = readdirSync(folder).filter((one) => /^mannequin\.(webm|mp4)$/.test(one));
  const video = await downloaded(name);
  assert.ok(video.length > 10_000);
  const isWebm = video.readUInt32BE(0) === 0x1a45dfa3;
  assert.ok(isWebm || video.subarray(4, 8).toString('latin1') === 'ftyp');
});

test('with reduced motion, nothing moves until it is asked to', { skip }, async () => {
  const still = await browser.newPage();
  await still.emulateMediaFeatures([{ name: 'prefers-reduced-motion', value: 'reduce' }]);
  await still.goto(page.href, { waitUntil: 'domcontentloaded', timeout: 120_000 });
  await still.waitForFunction(() => document.getElementById('status').textContent === 'mannequin.bendy is shown', { timeout: 120_000 });
  assert.equal(await still.$eval('#play', (element) => element.getAttribute('aria-label')), 'Play');
  assert.equal(await still.$eval('.handle.inviting', (element) => getComputedStyle(element, '::before').animationName), 'none');
  await still.close();
});

test('without WebGL 2, the page says so below its poster', { skip }, async () => {
  const bare = await browser.newPage();
  await bare.evaluateOnNewDocument(() => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (type, ...rest) { return type.startsWith('webgl') ? null : getContext.call(this, type, ...rest); };
  });
  await bare.goto(page.href, { waitUntil: 'domcontentloaded', timeout: 120_000 });
  await bare.waitForFunction(() => /offers no WebGL 2/.test(document.getElementById('welcome').textContent), { timeout: 120_000 });
  assert.equal(await bare.$eval('#poster', ({ complete, naturalWidth }) => complete && naturalWidth > 0), true);
  await bare.close();
});

test('a source is converted, and what is saved has the bytes of the program', { skip }, async () => {
  const source = join(root, 'examples/tentacle.glb');
  await open(source);
  await shown('tentacle.glb');
  await picture('tentacle');
  assert.ok((await drawn()) > 300);
  await select('save');
  await tab.waitForFunction(() => !document.getElementById('download').disabled, { timeout: 120_000 });
  await tab.click('#save-bendy');
  const saved = await downloaded('tentacle.bendy');
  const expected = join(folder, 'expected.bendy');
  native('convert', source, '-o', expected);
  assert.ok(saved.equals(readFileSync(expected)), '.bendy');
  await tab.click('#save-compact');
  const compact = await downloaded('tentacle.compact.bendy');
  native('convert', expected, '--compact', '--max-error', '0.005%', '-o', join(folder, 'small.bendy'));
  assert.ok(compact.equals(readFileSync(join(folder, 'small.bendy'))), 'compact .bendy');
  assert.match(await text('#saving'), /^141 KB → 2[\d.]+ KB$/);
  assert.match(await text('#promise'), /^8\d % smaller\. No point of the skin is off by more than 0\.\d+ mm\.$/);
  await tab.click('#download');
  assert.ok((await downloaded('tentacle.bendy')).equals(compact), 'what the card saves');
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

test('axe finds nothing after a drop, in any panel', { skip }, async () => {
  await checkByAxe();
  for (const name of ['move', 'reach', 'look', 'save', 'inspect', 'messages']) {
    await select(name);
    await frames();
    assert.deepEqual(await axeSays(), [], name);
  }
});

test('the exact character stands beside the compact one, which is coloured by its error', { skip }, async () => {
  await tab.click('#compare');
  await tab.waitForFunction(() => bendyPage.comparison?.worst > 0, { timeout: 60_000 });
  await picture('compare');
  const { worst, bound } = await tab.evaluate(() => ({ worst: bendyPage.comparison.worst, bound: bendyPage.comparison.bound }));
  assert.ok(worst <= bound, `${worst} of ${bound}`);
  assert.match(await text('#legend'), /Exact.*compact.*now [\d.]+ mm/s);
  await tab.click('#end-compare');
  assert.equal(await tab.evaluate(() => bendyPage.comparison), undefined);
  assert.equal(await tab.$eval('#legend', ({ hidden }) => hidden), true);
});

test('the lines to copy play the character in three.js', { skip }, async () => {
  await select('save');
  const lines = (await text('#snippet')).split('\n');
  assert.equal(lines.length, 3);
  const server = createServer((request, response) => response.end(request.url === '/tentacle.bendy' ? readFileSync(join(folder, 'expected.bendy')) : ''));
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const script = lines
    .join('\n')
    .replace("'bendy/three'", JSON.stringify(new URL('../dist/three/index.js', import.meta.url).href))
    .replace("'tentacle.bendy'", `'http://127.0.0.1:${server.address().port}/tentacle.bendy'`);
  const file = join(import.meta.dirname, '..', 'dist', 'lines.mjs'); // beside the package's dependencies
  writeFileSync(file, `import { Scene } from 'three';\nconst scene = new Scene();\n${script}\nexport { animator, scene };\n`);
  globalThis.ProgressEvent ??= Event; // which three.js's loader needs, and node has not
  try {
    const { animator, scene } = await import(file);
    assert.equal(scene.children.length, 1);
    const first = animator.pose.locals.slice();
    animator.update(0.4);
    assert.notDeepEqual(animator.pose.locals, first);
  } finally {
    rmSync(file);
    server.close();
  }
  await select('move');
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
  await select('look');
  await tab.click('#bones');
  await frames();
  assert.ok(withBones > (await drawn()) + 30);
  await select('move');
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

test('images that are given later belong to the character that is shown', { skip }, async () => {
  await open(join(folder, 'red skin.png'));
  await shown('quad.bendy');
  assert.equal(await tab.evaluate(() => {
    let found = false;
    bendyPage.character.object.traverse(({ material }) => (found ||= Boolean(material?.map?.image)));
    return found;
  }), true);
});

/** A glTF file whose node moves in clips with these names and lengths. */
function moving(clips) {
  const floats = [...clips.flatMap(([, seconds]) => [0, seconds]), 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0];
  const at = 8 * clips.length;
  return JSON.stringify({
    asset: { version: '2.0' },
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    animations: clips.map(([name], k) => ({ name, channels: [{ sampler: 0, target: { node: 0, path: 'translation' } }], samplers: [{ input: 2 + k, output: 1 }] })),
    accessors: [
      { bufferView: 0, byteOffset: at + 24, componentType: 5126, count: 3, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 0] },
      { bufferView: 0, byteOffset: at, componentType: 5126, count: 2, type: 'VEC3' },
      ...clips.map(([, seconds], k) => ({ bufferView: 0, byteOffset: 8 * k, componentType: 5126, count: 2, type: 'SCALAR', min: [0], max: [seconds] })),
    ],
    bufferViews: [{ buffer: 0, byteLength: 4 * floats.length }],
    buffers: [{ byteLength: 4 * floats.length, uri: `data:;base64,${Buffer.from(new Float32Array(floats).buffer).toString('base64')}` }],
  });
}

test('clips: a sensible one first, lengths, a search, and the one that plays is in view', { skip }, async () => {
  const file = join(folder, 'clips.gltf');
  writeFileSync(file, moving([['T-Pose', 1], ['Idle frame', 0.01], ...Array.from({ length: 20 }, (_, k) => [`Attack ${k}`, 1]), ['Walk', 1.5]]));
  await open(file);
  await shown('clips.gltf');
  assert.equal(await text('#clips-title'), '23 clips');
  assert.equal(await text('#clips [aria-current=true]'), 'Walk1.50 s');
  const isInView = () => tab.evaluate(() => {
    const [list, item] = ['#clips', '#clips [aria-current=true]'].map((one) => document.querySelector(one).getBoundingClientRect());
    return item.top >= list.top - 1 && item.bottom <= list.bottom + 1;
  });
  assert.equal(await isInView(), true);
  await tab.type('#search', 'attack 1');
  assert.equal(await tab.$$eval('#clips li:not([hidden])', ({ length }) => length), 11);
  await tab.focus('#view');
  await tab.keyboard.press(']');
  assert.equal(await text('#clips [aria-current=true]'), 'T-Pose1.00 s');
});

/** Drops files and folders on the picture, as a person does: on its upper half, or its lower one. */
async function dropAt(y, files) {
  await tab.evaluate(() => (document.getElementById('status').textContent = ''));
  const session = await tab.createCDPSession();
  for (const type of ['dragEnter', 'dragOver', 'dragOver', 'drop']) {
    await session.send('Input.dispatchDragEvent', { type, x: 400, y, data: { items: [], files, dragOperationsMask: 1 } });
    if (type === 'dragOver') await tab.waitForFunction(() => !document.getElementById('drop').hidden);
  }
  await session.detach();
}
const drop = (...files) => dropAt(300, files);

test('a file, several files or a folder are dropped', { skip }, async () => {
  await drop(join(root, 'examples/tentacle.glb'));
  await shown('tentacle.glb');
  assert.equal(await tab.$eval('#drop', ({ hidden }) => hidden), true);
  await drop(join(root, 'examples/tentacle.glb'), join(root, 'examples/mannequin.glb'));
  await shown('tentacle.glb');
  assert.match(await text('#notices'), /2 characters were given/);
  const inner = join(folder, 'character', 'parts');
  mkdirSync(inner, { recursive: true });
  for (const name of ['parts.gltf', 'parts.bin']) copyFileSync(join(folder, name), join(inner, name));
  await drop(join(folder, 'character'));
  await shown('character/parts/parts.gltf');
  assert.equal(await tab.$eval('#others', ({ hidden }) => hidden), true);
});

test('the clips of another file move the character that is shown', { skip }, async () => {
  const [first, dancer, bare] = ['first.bendy', 'dancer.bendy', 'bare.bendy'].map((name) => join(folder, name));
  native('convert', join(root, 'examples/mannequin.glb'), '-o', dancer);
  native('edit', dancer, '--strip', 'clips', '-o', first);
  native('edit', dancer, '--strip', 'roles', '-o', bare);
  const borrowed = () => tab.$eval('#borrowed', ({ hidden, firstElementChild }) => (hidden ? '' : firstElementChild.textContent));
  const places = () => tab.evaluate(() => bendyPage.character.bones().join());
  const placesAtQuarter = async () => {
    await tab.click('#play'); // it pauses
    await tab.evaluate(() => bendyPage.character.seek(0.25));
    await frames();
    return places();
  };
  await open(first);
  await tab.waitForFunction(() => document.getElementById('name').textContent.startsWith('first.bendy'));
  await frames();
  assert.equal(await text('#noclips'), 'This character has no clips.');
  const atRest = await places();
  await dropAt(600, [dancer]);
  await tab.waitForFunction(() => !document.getElementById('borrowed').hidden);
  await frames();
  assert.equal(await text('#drop-clips'), 'Drop here to play its clips on first.bendy');
  assert.equal(await borrowed(), 'The clips are those of dancer.bendy.');
  assert.match(await text('#name'), /^first\.bendy/);
  assert.match(await text('#clips [aria-current=true]'), /^Idle/);
  await picture('borrowed');
  const moved = await placesAtQuarter();
  assert.notEqual(moved, atRest);
  await checkByAxe();
  await tab.click('#return');
  assert.deepEqual([await borrowed(), await tab.$eval('#transport', ({ hidden }) => hidden)], ['', true]);
  await frames();
  assert.equal(await places(), atRest);
  // One without roles moves nobody, and what moves the character goes on.
  await (await tab.$('#clip-files')).uploadFile(bare);
  await tab.waitForFunction(() => !document.getElementById('borrowed').hidden);
  assert.match(await borrowed(), /^bare\.bendy cannot move first\.bendy: the source does not say what its joints are: .*\.$/);
  assert.equal(await tab.$eval('#return', ({ hidden }) => hidden), true);
  await (await tab.$('#clip-files')).uploadFile(first);
  await tab.waitForFunction(() => document.getElementById('borrowed').textContent.includes('has no clips'));
  await (await tab.$('#clip-files')).uploadFile(dancer);
  await tab.waitForFunction(() => document.getElementById('borrowed').textContent.includes('are those of'));
  await tab.click('#show-instead');
  await tab.waitForFunction(() => document.getElementById('name').textContent.startsWith('dancer.bendy'));
  await frames();
  assert.equal(await borrowed(), '');
  assert.equal(await placesAtQuarter(), moved, 'the build is the same, and so is the pose');
});

test('of several characters the others can be chosen', { skip }, async () => {
  const files = ['one.gltf', 'two.gltf'].map((name) => join(folder, name));
  for (const file of files) writeFileSync(file, moving([['Idle', 1]]));
  await open(...files);
  await shown('one.gltf');
  assert.match(await text('#notices'), /2 characters were given/);
  await tab.select('#character', 'two.gltf');
  await shown('two.gltf');
  await open(files[0]);
  await shown('one.gltf');
  assert.equal(await tab.$eval('#others', ({ hidden }) => hidden), true);
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
