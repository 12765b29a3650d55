// Completes dist/, after tsc: the modules as files, bundles in one file, declarations for older TypeScript, and the licences.
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { execFileSync } from 'node:child_process';
import { build } from 'esbuild';
import { decodeModule } from './dist/load.js';

const root = import.meta.dirname;
const dist = join(root, 'dist');
const { version } = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));

// bendy.wasm, for servers that can send it as application/wasm and browsers that compile it while it arrives.
for (const [module, file] of [['simd', 'bendy.wasm'], ['plain', 'bendy-plain.wasm']]) {
  const { default: text } = await import(`./dist/generated/${module}.js`);
  writeFileSync(join(dist, file), decodeModule(text));
}

// One file for a page without a bundler. It holds the module with SIMD; the other one is beside it, for the engines that need it.
const plainIsBeside = {
  name: 'plain is beside',
  setup({ onLoad }) {
    onLoad({ filter: /generated[/\\]plain\.js$/ }, () => ({ contents: `export default new URL('../bendy-plain.wasm', import.meta.url);` }));
  },
};
const { metafile } = await build({
  entryPoints: { bendy: join(dist, 'index.js'), 'bendy-viewer': join(dist, 'viewer/index.js') },
  outdir: join(dist, 'bundle'),
  bundle: true,
  minify: true,
  keepNames: true, // messages name classes
  format: 'esm',
  target: 'es2022',
  charset: 'utf8', // the module as text would otherwise be twice as long
  legalComments: 'none',
  banner: { js: `/*! bendy ${version}, MIT License; the licences of what it contains: NOTICES.txt of the npm package bendy */` },
  plugins: [plainIsBeside],
  metafile: true,
  logLevel: 'warning',
});

// For scripts/notices.py: what of others is in them.
writeFileSync(join(dist, 'bundle/inputs.txt'), Object.keys(metafile.inputs).map((name) => join(root, name)).join('\n'));

// TypeScript before 5.7 has typed arrays without a parameter for their buffer.
const declarations = readdirSync(dist, { recursive: true }).filter((name) => name.endsWith('.d.ts') && !name.startsWith('ts5.6'));
for (const name of declarations) {
  const older = readFileSync(join(dist, name), 'utf8').replaceAll(/\b(\w+Array)<ArrayBuffer(Like)?>/g, '$1');
  mkdirSync(dirname(join(dist, 'ts5.6', name)), { recursive: true });
  writeFileSync(join(dist, 'ts5.6', name), older);
}

copyFileSync(join(root, '../../LICENSE'), join(root, 'LICENSE'));
writeFileSync(join(root, 'NOTICES.txt'), execFileSync('python3', ['-B', join(root, '../../scripts/notices.py'), 'npm']));
