// The element <bendy-viewer> in a page without a bundler: a folder with the bundle, a character and nothing else.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, beforeEach, test } from 'node:test';
import axe from 'axe-core';
import { launch, openTab, serve, skip } from './browser.mjs';
import { bendy, example, folder, linking, repository } from './helpers.mjs';

const bundle = readFileSync(new URL('../dist/bundle/bendy-viewer.js', import.meta.url));
const poster = readFileSync(`${repository}/docs/pictures/mannequin.png`);
const page = `<!doctype html><html lang="en"><meta charset="utf-8"><title>Viewer</title><link rel="icon" href="data:,">
<meta http-equiv="content-security-policy" content="default-src 'self' data: blob:; script-src 'self' 'wasm-unsafe-eval' 'unsafe-inline'; style-src 'self'">
<script type="module" src="bendy-viewer.js"></script><body></body></html>`;
let browser, server, tab, problems;

before(async () => {
  if (skip) return;
  const [mannequin, other] = [example('mannequin'), `${folder}/other.bendy`];
  bendy(['edit', mannequin, '-o', other, '--strip', 'clips', '--rename-joint', 'mixamorig:*=b_*']);
  const files = { 'mannequin.bendy': readFileSync(mannequin), 'other.bendy': readFileSync(other), 'tentacle.bendy': readFileSync(example('tentacle')) };
  server = await serve({ 'index.html': page, 'bendy-viewer.js': bundle, 'poster.png': poster, 'broken.bendy': 'this is no character', ...files });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  server?.close();
});
beforeEach(async () => {
  if (skip) return;
  await tab?.close();
  ({ tab, problems } = await openTab(browser));
  await tab.goto(`${server.address}index.html`, { timeout: 120_000 });
  server.requests.length = 0;
});

/** Adds a viewer with these attributes, and returns its first load or error. */
const show = (attributes) =>
  tab.evaluate(async (given) => {
    await customElements.whenDefined('bendy-viewer');
    const viewer = document.createElement('bendy-viewer');
    globalThis.seen = [];
    for (const type of ['load', 'error', 'progress']) viewer.addEventListener(type, (event) => seen.push([type, event.detail]));
    for (const [name, value] of Object.entries(given)) viewer.setAttribute(name, value);
    document.body.append(viewer);
    globalThis.viewer = viewer;
    await new Promise((resolve) => ['load', 'error'].forEach((type) => viewer.addEventListener(type, resolve, { once: true })));
    const [type, detail] = seen.at(-1);
    return type === 'load' ? { type } : { type, name: detail.name, kind: detail.kind, code: detail.code, message: detail.message };
  }, attributes);

test('a file from somebody else asks the server for files in its folder only', { skip }, async () => {
  const { roots } = server;
  const links = ['.\t./.\n./private/x.png', ' /private/x.png', '..?logout=1', '%2e%2e/private/x.png', '?logout=1', '//private/x.png', '\\private\\x.png', 'wood.png'];
  Object.assign(roots, { 'their/fox.bendy': linking(links), 'their/wood.png': poster, 'private/x.png': poster });
  assert.deepEqual(await show({ src: 'their/fox.bendy' }), { type: 'load' });
  assert.deepEqual(server.requests.sort(), ['their/fox.bendy', 'their/wood.png']);
  assert.equal(await tab.evaluate(() => viewer.character.warnings.length), links.length - 1);
});

const frames = (count) =>
  tab.evaluate((left) => new Promise((resolve) => (function next() { left-- > 0 ? requestAnimationFrame(next) : resolve(); })()), count);

/** How many of the picture's pixels are drawn. */
const drawn = () =>
  tab.evaluate(() => {
    const canvas = viewer.shadowRoot.querySelector('canvas');
    return new Promise((resolve) =>
      requestAnimationFrame(() => {
        viewer.animator?.apply();
        const copy = Object.assign(document.createElement('canvas'), { width: 100, height: 100 });
        const context = copy.getContext('2d');
        viewer.clip = viewer.clip; // draws in the next frame
        requestAnimationFrame(() => {
          context.drawImage(canvas, 0, 0, 100, 100);
          const { data } = context.getImageData(0, 0, 100, 100);
          resolve(data.filter((_, k) => k % 4 === 3).reduce((sum, alpha) => sum + (alpha > 128 ? 1 : 0), 0));
        });
      }),
    );
  });

test('it shows a character from one file of script, which plays', { skip }, async () => {
  assert.deepEqual(await show({ src: 'mannequin.bendy', clip: 'Walk', alt: 'A mannequin that walks', poster: 'poster.png' }), { type: 'load' });
  assert.deepEqual(server.requests.toSorted(), ['mannequin.bendy', 'poster.png']);
  assert.ok((await drawn()) > 300);
  const hand = () => tab.evaluate(() => viewer.character.scene.getObjectByName('mixamorigLeftArm').quaternion.toArray().join());
  const first = await hand();
  await frames(5);
  assert.notEqual(await hand(), first);
  await tab.evaluate(() => viewer.pause());
  await frames(2);
  const still = await hand();
  await frames(5);
  assert.equal(await hand(), still);
  assert.deepEqual(await tab.evaluate(() => [viewer.clips, viewer.paused, viewer.hasAttribute('paused'), viewer.src, viewer.alt]), [
    ['Idle', 'Walk'], true, true, 'mannequin.bendy', 'A mannequin that walks',
  ]);
  const progress = await tab.evaluate(() => seen.filter(([type]) => type === 'progress').map(([, detail]) => detail.loaded));
  assert.ok(progress.at(-1) > 10000);
  assert.ok(await tab.evaluate(() => viewer.shadowRoot.querySelector('img').hidden), 'the poster has gone');
  assert.deepEqual(problems, []);
});

test('it can be read, and moved by keys', { skip }, async () => {
  await show({ src: 'mannequin.bendy', alt: 'A mannequin', paused: '' });
  const image = async () => (await tab.accessibility.snapshot()).children?.find(({ role }) => role === 'image' || role === 'img');
  assert.equal((await image()).name, 'A mannequin');
  const angles = () => tab.evaluate(() => viewer.cameraAngles);
  const before = await angles();
  const press = async (...keys) => {
    await tab.evaluate(() => viewer.shadowRoot.querySelector('canvas').focus());
    for (const key of keys) await tab.keyboard.press(key);
  };
  await press('ArrowLeft');
  assert.deepEqual(await angles(), before, 'without camera-controls nothing turns');
  await tab.evaluate(() => (viewer.cameraControls = true));
  await press('ArrowLeft', 'ArrowLeft', 'ArrowUp');
  const turned = await angles();
  assert.ok(turned.theta < before.theta && turned.phi < before.phi);
  for (let k = 0; k < 40; ++k) await tab.keyboard.press('ArrowDown');
  assert.ok((await angles()).phi < Math.PI, 'it does not turn over');
  await tab.mouse.move(150, 150);
  await tab.mouse.down();
  await tab.mouse.move(90, 150, { steps: 3 });
  await tab.mouse.up();
  assert.ok((await angles()).theta > turned.theta);
  assert.equal(await tab.evaluate(() => viewer.shadowRoot.querySelector('canvas').getAttribute('aria-keyshortcuts') !== null), true);
  assert.deepEqual(problems, []);
});

test('axe finds nothing: before, while and after it loads, with and without controls, in both colour schemes', { skip }, async () => {
  await tab.evaluate(axe.source);
  const check = async (when) => {
    const { violations, passes } = await tab.evaluate(() => globalThis.axe.run('bendy-viewer', { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] }));
    assert.deepEqual(violations.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target}: ${failureSummary}`)), [], when);
    assert.ok(passes.length > 0, `${when}: axe has seen it`);
  };
  const canvas = (name) => tab.evaluate((wanted) => viewer.shadowRoot.querySelector('canvas').getAttribute(wanted), name);
  await tab.evaluate(() => {
    globalThis.viewer = document.createElement('bendy-viewer');
    document.body.append(viewer);
  });
  await check('empty');
  assert.equal(await canvas('aria-busy'), null);
  await tab.evaluate(() => {
    globalThis.loaded = new Promise((resolve) => viewer.addEventListener('load', resolve, { once: true }));
    globalThis.busy = new Promise((resolve) => viewer.addEventListener('progress', () => resolve(viewer.shadowRoot.querySelector('canvas').ariaBusy), { once: true }));
    Object.assign(viewer, { src: 'mannequin.bendy', poster: 'poster.png', alt: 'A mannequin' });
  });
  assert.equal(await tab.evaluate(() => busy), 'true');
  await tab.evaluate(() => loaded);
  assert.deepEqual([await canvas('aria-busy'), await canvas('role')], [null, 'img']);
  await check('shown');
  await tab.evaluate(() => (viewer.cameraControls = true));
  assert.deepEqual([await canvas('role'), await canvas('aria-roledescription'), await canvas('tabindex')], ['application', '3D view', '0']);
  for (const value of ['light', 'dark']) {
    await tab.emulateMediaFeatures([{ name: 'prefers-color-scheme', value }]);
    await check(`with controls, ${value}`);
  }
  await tab.evaluate(() => {
    globalThis.failed = new Promise((resolve) => viewer.addEventListener('error', resolve, { once: true }));
    viewer.src = 'none.bendy';
  });
  await tab.evaluate(() => failed);
  assert.equal(await canvas('aria-busy'), null);
  await check('after a failure');
});

test('attributes change what is shown', { skip }, async () => {
  await show({ src: 'mannequin.bendy', paused: '' });
  const loaded = tab.evaluate(() => new Promise((resolve) => viewer.addEventListener('load', () => resolve(viewer.clips.length), { once: true })));
  await tab.evaluate(() => (viewer.src = 'tentacle.bendy'));
  await loaded;
  const joints = await tab.evaluate(() => viewer.character.joints.length);
  assert.ok(joints < 65);
  await tab.evaluate(() => {
    viewer.addEventListener('error', (event) => event.preventDefault(), { once: true });
    viewer.clip = 'no such clip';
  });
  const [type, kind] = await tab.evaluate(() => [seen.at(-1)[0], seen.at(-1)[1].kind]);
  assert.deepEqual([type, kind], ['error', 'not_found']);
  await tab.evaluate(() => (viewer.clip = ''));
  await frames(2);
  assert.ok((await drawn()) > 100, 'at rest');
  assert.deepEqual(problems, []);
});

test('it plays the clips of another file, and its own again', { skip }, async () => {
  const hand = () => tab.evaluate(() => viewer.character.scene.getObjectByName('b_LeftArm').quaternion.toArray().join());
  assert.deepEqual(await show({ src: 'other.bendy', motions: 'mannequin.bendy', clip: 'Walk' }), { type: 'load' });
  assert.deepEqual(server.requests.toSorted(), ['mannequin.bendy', 'other.bendy']);
  assert.deepEqual(await tab.evaluate(() => viewer.clips), ['Idle', 'Walk']);
  const first = await hand();
  await frames(5);
  assert.notEqual(await hand(), first);
  const changed = (change) => tab.evaluate(async (text) => {
    const names = () => viewer.clips.join();
    const before = names();
    Object.assign(viewer, JSON.parse(text));
    while (names() === before) await new Promise((resolve) => setTimeout(resolve, 10));
    return names();
  }, JSON.stringify(change));
  assert.equal(await changed({ clip: null, motions: null }), '', 'it has none of its own');
  assert.equal(await changed({ motions: 'mannequin.bendy' }), 'Idle,Walk');
  await tab.evaluate(() => (viewer.clip = ''));
  await frames(2);
  const still = await hand();
  await frames(3);
  assert.equal(await hand(), still, 'at rest');
  assert.deepEqual(await tab.evaluate(() => seen.filter(([type]) => type === 'error').length), 0);
  assert.deepEqual(problems, []);

  const failing = async (motions) => {
    await tab.evaluate((address) => {
      globalThis.failed = new Promise((resolve) => viewer.addEventListener('error', (event) => resolve(event.detail.kind), { once: true }));
      viewer.motions = address;
    }, motions);
    return tab.evaluate(async () => [await failed, viewer.clips.length]);
  };
  assert.deepEqual(await failing('tentacle.bendy'), ['bad_argument', 0]);
  assert.deepEqual(await failing('broken.bendy'), ['malformed', 0]);
});

test('what fails is an event with a BendyError', { skip }, async () => {
  const none = await show({ src: 'none.bendy', poster: 'poster.png' });
  assert.deepEqual([none.type, none.name, none.kind], ['error', 'BendyError', 'io']);
  assert.equal(await tab.evaluate(() => viewer.shadowRoot.querySelector('img').hidden), false, 'the poster stays');
  const broken = await show({ src: 'broken.bendy' });
  assert.deepEqual([broken.type, broken.name, broken.kind], ['error', 'BendyError', 'malformed']);
  const inConsole = () => problems.filter((text) => text.includes('BendyError'));
  assert.equal(inConsole().length, 2, problems.join('\n'));
  assert.match(inConsole()[1], /convert\(\) of bendy\/tools/);
  await tab.evaluate(() => {
    viewer.addEventListener('error', (event) => event.preventDefault());
    globalThis.failed = new Promise((resolve) => viewer.addEventListener('error', resolve));
    viewer.src = 'none.bendy';
  });
  await tab.evaluate(() => failed);
  assert.equal(inConsole().length, 2, 'a listener has dealt with it');
});

test('it loads when it comes into view, and starts paused for readers who prefer reduced motion', { skip }, async () => {
  await tab.emulateMediaFeatures([{ name: 'prefers-reduced-motion', value: 'reduce' }]);
  await tab.evaluate(() => {
    const space = document.createElement('div');
    document.body.append(space);
    space.style.height = '5000px';
    const viewer = document.createElement('bendy-viewer');
    Object.assign(viewer, { src: 'mannequin.bendy', poster: 'poster.png' });
    document.body.append(viewer);
    globalThis.viewer = viewer;
    globalThis.loads = 0;
    viewer.addEventListener('load', () => ++loads);
  });
  await frames(10);
  assert.deepEqual(server.requests.filter((name) => name === 'mannequin.bendy'), []);
  await tab.evaluate(() => viewer.scrollIntoView());
  await tab.waitForFunction(() => loads === 1);
  assert.equal(await tab.evaluate(() => viewer.paused), true);
  await tab.evaluate(() => viewer.play());
  assert.equal(await tab.evaluate(() => viewer.paused), false);
  assert.deepEqual(problems, []);
});

test('more viewers that come and go than a browser has contexts, and one that moves', { skip }, async () => {
  for (let k = 0; k < 20; ++k) {
    await show({ src: 'tentacle.bendy' });
    await tab.evaluate(() => viewer.remove());
  }
  await frames(2);
  await show({ src: 'tentacle.bendy' });
  await tab.evaluate(() => document.body.prepend(viewer));
  await frames(3);
  assert.notEqual(await tab.evaluate(() => viewer.character), null, 'a move keeps what is shown');
  assert.equal((await show({ src: 'tentacle.bendy' })).type, 'load');
  await tab.evaluate(() => { viewer.remove(); });
  await frames(2);
  await tab.evaluate(() => document.body.append(viewer));
  await tab.waitForFunction(() => viewer.character !== null);
  assert.ok((await drawn()) > 100);
  assert.deepEqual(problems, []);
});
