// Makes dist/page.html, one file that needs no server: node page/build.mjs EXAMPLE.bendy
import { readFile, writeFile } from 'node:fs/promises';
import { execFileSync } from 'node:child_process';
import { gzipSync } from 'node:zlib';
import { build } from 'esbuild';

const here = (name) => new URL(name, import.meta.url);
const text = (name) => readFile(here(name), 'utf8');

/** A module with all that it imports, as the text of a classic script. */
async function bundle(name) {
  const { outputFiles } = await build({
    entryPoints: [here(name).pathname],
    bundle: true,
    minify: true,
    charset: 'utf8',
    format: 'iife',
    target: 'es2022',
    write: false,
    legalComments: 'none',
    external: ['node:*', 'module', 'fs', 'path', 'url'],
    logLevel: 'warning',
  });
  // Neither may end the element that it stands in.
  return outputFiles[0].text.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
}

const parts = {
  '@css@': await text('page.css'),
  '@icons@': await text('icons.svg'),
  '@poster@': `data:image/webp;base64,${await readFile(here('poster.webp'), 'base64')}`,
  '@example@': await readFile(process.argv[2], 'base64'),
  '@main@': await bundle('main.ts'),
  '@worker@': gzipSync(await bundle('worker.ts'), { level: 9 }).toString('base64'), // the browser reads all of the page, but seldom needs it
};
let page = await text('index.html');
for (const [mark, part] of Object.entries(parts)) page = page.replace(mark, () => part);
// Whoever copies the page copies the licences of what is in it.
const notices = execFileSync('python3', ['-B', here('../../../scripts/notices.py').pathname, 'page'], { encoding: 'utf8' });
const licences = `${await readFile(here('../../../LICENSE'), 'utf8')}\n${notices}`;
const end = page.lastIndexOf('</body>');
page = `${page.slice(0, end)}<script type="text/plain" id="licences">\n${licences.replaceAll('</script', '<\\/script')}</script>\n${page.slice(end)}`;
await writeFile(here('../dist/page.html'), page);
