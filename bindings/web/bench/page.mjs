// How soon the page shows something, in headless Chromium that draws in software: node bench/page.mjs [--runs N] [PAGE.html]
// Each run starts a browser of its own, so nothing is cached; it draws a page of text, and then opens the page as a file.
// Milliseconds from the start of that navigation: until the poster is painted, until the live picture in its place is given to
// WebGL, and until it is drawn.
import { execFileSync } from 'node:child_process';
import { loadavg } from 'node:os';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { launch } from '../test/browser.mjs';

const { values, positionals } = parseArgs({ allowPositionals: true, options: { runs: { type: 'string', default: '7' } } });
const page = positionals.length > 0 ? pathToFileURL(positionals[0]) : new URL('../dist/page.html', import.meta.url);
const columns = { poster: 'poster painted', given: 'live picture given', drawn: 'live picture drawn' };

/** Collects the times, in the page. */
function watch() {
  globalThis.seenTimes = {};
  new MutationObserver((_, observer) => {
    const poster = document.getElementById('poster');
    if (!poster) return;
    poster.setAttribute('elementtiming', 'poster');
    observer.disconnect();
  }).observe(document, { childList: true, subtree: true });
  new PerformanceObserver((list) => (seenTimes.poster = list.getEntries()[0].renderTime)).observe({ type: 'element', buffered: true });
  const mark = performance.mark.bind(performance);
  performance.mark = (name, options) => {
    if (name === 'first-picture') {
      seenTimes.given = performance.now();
      const gl = document.getElementById('view').getContext('webgl2');
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for what was given before
      seenTimes.drawn = performance.now();
    }
    return mark(name, options);
  };
}

async function measure() {
  const browser = await launch();
  try {
    const tab = await browser.newPage();
    await tab.setViewport({ width: 1280, height: 800 });
    await tab.goto('data:text/html,<title>Before</title><p>Before');
    await tab.waitForFunction(() => performance.getEntriesByName('first-contentful-paint').length !== 0);
    await tab.evaluateOnNewDocument(watch);
    await tab.goto(page.href, { waitUntil: 'domcontentloaded', timeout: 120_000 });
    await tab.waitForFunction(() => seenTimes.drawn !== undefined && seenTimes.poster !== undefined, { timeout: 120_000, polling: 100 });
    return await tab.evaluate(() => seenTimes);
  } finally {
    await browser.close();
  }
}

const times = [];
const [before] = loadavg();
for (let run = 0; run < Number(values.runs); ++run) times.push(await measure());
const version = execFileSync(process.env.CHROMIUM ?? '/usr/bin/chromium', ['--version'], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }).trim();
console.log(`${version}, ${times.length} runs; load of the machine: ${before.toFixed(1)} before, ${loadavg()[0].toFixed(1)} after`);
for (const [key, name] of Object.entries(columns)) {
  const sorted = times.map((one) => one[key]).sort((a, b) => a - b);
  const [best, median, worst] = [sorted[0], sorted[Math.floor(sorted.length / 2)], sorted.at(-1)].map((time) => Math.round(time).toString().padStart(6));
  console.log(`${name.padEnd(20)} best ${best} ms  median ${median} ms  worst ${worst} ms`);
}
