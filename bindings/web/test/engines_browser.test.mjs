// The outlines that Babylon.js and PlayCanvas draw in Chromium: handedness, the side of triangles, and skinning on the GPU.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';
import { launch, openTab, serve, skip } from './browser.mjs';
import { example, read } from './helpers.mjs';

test('outlines', { skip, timeout: 600_000 }, async (context) => {
  const entry = fileURLToPath(new URL('engines_browser.ts', import.meta.url));
  const { outputFiles } = await build({ entryPoints: [entry], bundle: true, format: 'esm', charset: 'utf8', target: 'es2022', write: false, logLevel: 'error' });
  const page = '<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><script type="module" src="main.js"></script><body></body>';
  const server = await serve({ 'index.html': page, 'main.js': outputFiles[0].contents, 'mannequin.bendy': read(example('mannequin')) });
  const browser = await launch();
  try {
    const { tab, problems } = await openTab(browser);
    await tab.goto(`${server.address}index.html`, { timeout: 120_000 });
    await tab.waitForFunction(() => globalThis.results !== undefined, { timeout: 240_000 }).catch(async (error) => problems.push(error.message, JSON.stringify(await tab.evaluate(() => partial))));
    assert.deepEqual(problems, []);
    const results = await tab.evaluate(() => results);
    assert.equal(Object.keys(results).length, 5);
    for (const [name, { failed, drawn, different }] of Object.entries(results)) {
      assert.equal(failed, undefined, name);
      context.diagnostic(`${name}: ${different} pixels off the outline differ, of ${drawn}`);
    }
    for (const [name, { drawn, different }] of Object.entries(results)) {
      assert.ok(drawn > 400, name);
      assert.ok(different <= 0.005 * drawn, `${name}: ${different} of ${drawn}`);
    }
  } finally {
    await browser.close();
    server.close();
  }
});
