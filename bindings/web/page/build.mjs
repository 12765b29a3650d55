// Makes dist/page.html, one file that needs no server: node page/build.mjs EXAMPLE.bendy
import { readFile, writeFile } from 'node:fs/promises';
import { build } from 'esbuild';

const here = (name) => new URL(name, import.meta.url);

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

const example = await readFile(process.argv[2], 'base64');
const worker = JSON.stringify(await bundle('worker.ts')).replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
const parts = {
  '@css@': await readFile(here('page.css'), 'utf8'),
  '@data@': `const bendyExample = "${example}"; const bendyWorker = ${worker};`,
  '@js@': await bundle('main.ts'),
};
let page = await readFile(here('index.html'), 'utf8');
for (const [mark, text] of Object.entries(parts)) page = page.replace(mark, () => text);
await writeFile(here('../dist/page.html'), page);
