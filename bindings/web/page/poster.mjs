// Makes page/poster.webp, which the page shows until its first picture is drawn, of dist/page.html: node page/poster.mjs
import { writeFile } from 'node:fs/promises';
import puppeteer from 'puppeteer-core';

const size = { width: 420, height: 600 }; // narrow: the character is as high as in pictures of any other shape
const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-gl=angle', '--use-angle=swiftshader'],
  protocolTimeout: 300_000,
});
const tab = await browser.newPage();
await tab.emulateMediaFeatures([{ name: 'prefers-reduced-motion', value: 'reduce' }]);
await tab.setViewport({ ...size, width: 1400 });
await tab.goto(new URL('../dist/page.html', import.meta.url).href, { timeout: 120_000 });
await tab.waitForFunction(() => performance.getEntriesByName('first-picture').length !== 0, { timeout: 120_000 });
const address = await tab.evaluate(async ({ width, height }) => {
  Object.assign(document.getElementById('stage').style, { position: 'fixed', inset: '0', width: `${width}px`, height: `${height}px` });
  const frames = (count) => new Promise((resolve) => (function next() { count-- > 0 ? requestAnimationFrame(next) : resolve(); })());
  await frames(3);
  bendyPage.stage.setBackdrop('Transparent', '');
  bendyPage.stage.resetView();
  await frames(3);
  return document.getElementById('view').toDataURL('image/webp', 0.8);
}, size);
await browser.close();
const bytes = Buffer.from(address.slice(address.indexOf(',') + 1), 'base64');
await writeFile(new URL('poster.webp', import.meta.url), bytes);
console.log(`poster.webp: ${bytes.length} bytes`);
