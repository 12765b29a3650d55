// A headless Chromium that draws in software, and a server for what its pages load.
import { existsSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import puppeteer from 'puppeteer-core';

const chromium = process.env.CHROMIUM ?? '/usr/bin/chromium';
const types = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.png': 'image/png' };

/** For the option of a test: why it is skipped, or false. */
export const skip = existsSync(chromium) ? false : `${chromium} is not there`;

export function launch() {
  const args = ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-gl=angle', '--use-angle=swiftshader'];
  return puppeteer.launch({ executablePath: chromium, args, protocolTimeout: 300_000 });
}

/** Serves folders by the first step of a path, and files and texts by their whole path: { 'a': folder, 'b.html': text or bytes }. */
export async function serve(roots) {
  const requests = [];
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://x').pathname).slice(1);
    requests.push(path);
    const [first, ...rest] = path.split('/');
    let content = roots[path];
    if (content === undefined && rest.length > 0 && typeof roots[first] === 'string') {
      const file = join(roots[first], ...rest.filter((step) => step !== '..'));
      if (existsSync(file)) content = readFileSync(file);
    }
    if (content === undefined) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': types[extname(path)] ?? 'application/octet-stream' }).end(content);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, roots, requests, close: () => server.close() };
}

/** A tab whose errors are kept in `problems`. */
export async function openTab(browser) {
  const tab = await browser.newPage();
  const problems = [];
  tab.on('pageerror', (error) => problems.push(error.stack ?? error.message));
  tab.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  return { tab, problems };
}
