// Opens each page of a gallery, and the page that shows characters, in Chromium: node gallery.mjs FOLDER PAGE. Prints what is wrong, or
// the number of pages. BENDY_PICTURES names a folder for a picture of each.
import { readdirSync, readFileSync } from 'node:fs';
import { extname, join } from 'node:path';
import { launch, openTab, serve } from '../../bindings/web/test/browser.mjs';

const [folder, page] = process.argv.slice(2);
const names = readdirSync(folder).filter((name) => extname(name) === '.html' && name !== 'index.html');
// What shows that a page is alive: frames that were drawn, or a viewer that has loaded.
const alive = `+(document.documentElement.dataset.frames ?? 0) > 2 || document.querySelector('bendy-viewer')?.clips?.length > 0`;
const wrong = [];

const server = await serve({ gallery: folder, 'page.html': readFileSync(page) });
const browser = await launch();
async function open(address, condition) { // in a small picture: Chromium draws in software
  const { tab, problems } = await openTab(browser);
  await tab.setViewport({ width: 480, height: 480 });
  await tab.goto(server.address + address, { timeout: 120_000 });
  const isAlive = tab.waitForFunction(condition, { timeout: 240_000, polling: 200 }).catch((error) => problems.push(error.message));
  const isWrong = new Promise((resolve) => tab.on('pageerror', resolve).on('console', (said) => said.type() === 'error' && resolve()));
  await Promise.race([isAlive, isWrong]);
  if (process.env.BENDY_PICTURES) await tab.screenshot({ fullPage: true, path: join(process.env.BENDY_PICTURES, `${address.replaceAll('/', '_')}.png`) });
  wrong.push(...problems.map((problem) => `${address}: ${problem}`));
  await tab.close();
}
for (const name of names) await open(`gallery/${name}`, alive);
await open('page.html', `document.querySelector('canvas') !== null`);
await browser.close();
server.close();
console.log(wrong.join('\n') || `${names.length} good`);
process.exitCode = wrong.length === 0 ? 0 : 1;
