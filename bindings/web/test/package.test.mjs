// What package.json and README.md promise: files that are there, links that lead somewhere, types for old and new TypeScript.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import * as tools from '../dist/tools/index.js';
import { repository } from './helpers.mjs';

const web = join(repository, 'bindings/web');
const description = JSON.parse(readFileSync(join(web, 'package.json'), 'utf8'));
const packed = JSON.parse(execFileSync('npm', ['pack', '--dry-run', '--json', '--silent'], { cwd: web, encoding: 'utf8' }))[0].files.map(({ path }) => path);
const folder = mkdtempSync(join(tmpdir(), 'bendy-package-'));
after(() => rmSync(folder, { recursive: true }));

test('every export is in the package, and README.md lists it', () => {
  const readme = readFileSync(join(web, 'README.md'), 'utf8');
  for (const [name, target] of Object.entries(description.exports)) {
    for (const path of typeof target === 'string' ? [target] : Object.values(target)) {
      const pattern = new RegExp(`^${path.slice(2).replaceAll('.', '\\.').replace('*', '.+')}$`);
      assert.ok(packed.some((file) => pattern.test(file)), `${name}: ${path}`);
    }
    if (name !== './package.json' && !name.includes('*')) assert.ok(readme.includes(`\`bendy${name.slice(1)}\``), name);
  }
  assert.deepEqual([description.unpkg, description.jsdelivr].filter((path) => !packed.includes(path.slice(2))), []);
});

test('README.md has no link that leads out of the package, and none that is dead', () => {
  const dead = (text) => [...text.matchAll(/\]\(([^)#]+)[^)]*\)/g)].map(([, link]) => link).filter((link) => !packed.includes(link));
  assert.deepEqual(dead('[in it](LICENSE), [outside](../capi/README.md#calls)'), ['../capi/README.md']);
  assert.deepEqual(dead(readFileSync(join(web, 'README.md'), 'utf8')), []);
});

test('the package says whose it is, and has its licence and those of others', () => {
  for (const name of ['LICENSE', 'NOTICES.txt', 'README.md']) assert.ok(packed.includes(name), name);
  assert.equal(readFileSync(join(web, 'LICENSE'), 'utf8'), readFileSync(join(repository, 'LICENSE'), 'utf8'));
  const notices = readFileSync(join(web, 'NOTICES.txt'), 'utf8');
  for (const name of ['Zstandard', 'meshoptimizer', 'Draco', 'three.js']) assert.ok(notices.includes(`\n${name}\n`), name);
  // The project has no public address: packaging/README.md says where whoever publishes writes it.
  for (const field of ['homepage', 'repository', 'bugs']) assert.equal(description[field], undefined, field);
  for (const peer of Object.keys(description.peerDependencies)) {
    assert.ok(description.peerDependenciesMeta[peer].optional && description.devDependencies[peer], peer);
  }
  const page = join(web, 'dist/page.html');
  if (!existsSync(page)) return; // without the tools there is no page
  const [, licences] = readFileSync(page, 'utf8').match(/<script type="text\/plain" id="licences">\n([^]*?)<\/script>/);
  assert.equal(licences, `${readFileSync(join(repository, 'LICENSE'), 'utf8')}\n${execFileSync('python3', ['-B', join(repository, 'scripts/notices.py'), 'page'])}`);
});

test('a word in backquotes in a comment that is made from bendy.h is a name of the package, or a value', () => {
  const declarations = packed.filter((path) => path.endsWith('.d.ts') && !path.includes('ts5.6')).map((path) => readFileSync(join(web, path), 'utf8'));
  const names = new Set(declarations.flatMap((text) => text.replace(/\/\*[^]*?\*\//g, '').match(/\w+/g)));
  const unknown = (text) => [...text.matchAll(/\/\*[^]*?\*\//g)].flatMap(([comment]) => [...comment.matchAll(/`(\w+)`/g)]).map(([, word]) => word).filter((word) => !names.has(word));
  assert.deepEqual(unknown('/** Number of matrices for `for`, as `palette` needs them, in `seconds`. */'), ['for']);
  for (const name of ['bindings', 'classes']) assert.deepEqual(unknown(readFileSync(join(web, `dist/generated/${name}.d.ts`), 'utf8')), [], name);
});

/** Compiles modules of TypeScript with a compiler of test/compilers, libraries checked too; returns what it says. `more`: files by name. */
function compile(compiler, code, packages = [], more = {}) {
  const project = mkdtempSync(join(folder, 'types-'));
  mkdirSync(join(project, 'node_modules/@types'), { recursive: true });
  symlinkSync(web, join(project, 'node_modules/bendy'));
  for (const name of packages) symlinkSync(join(web, 'node_modules', name), join(project, 'node_modules', name));
  writeFileSync(join(project, 'package.json'), '{"type": "module"}');
  const files = { 'main.ts': code, ...more };
  for (const [name, text] of Object.entries(files)) writeFileSync(join(project, name), text);
  const options = { strict: true, target: 'es2022', lib: ['es2022', 'dom'], module: 'nodenext', skipLibCheck: false, noEmit: true, types: [], preserveSymlinks: true };
  writeFileSync(join(project, 'tsconfig.json'), JSON.stringify({ compilerOptions: options, files: Object.keys(files) }));
  const { stdout, status } = spawnSync(process.execPath, [join(web, 'test/compilers/node_modules', compiler, 'bin/tsc'), '-p', project], { encoding: 'utf8' });
  assert.equal(status === 0, stdout === '');
  return stdout.split('\n').filter((line) => line !== '');
}

const uses = `import { BendyError, type Clip, Model } from 'bendy';
  import { convert } from 'bendy/tools';
  const model: Model = await Model.open('fox.bendy');
  const clips: readonly Clip[] = model.clips;
  const positions: Float32Array = model.sample(clips[0]!, 0).skin().positions;
  const bytes: Uint8Array = (await convert(new Uint8Array(1))).bytes;
  const kind: BendyError['kind'] = 'malformed';
  new Blob([positions, bytes]);
  console.log(kind);
`;

const fileSystem = `declare module 'node:fs/promises' {
  export function readFile(name: string): Promise<Uint8Array>;
  export function writeFile(name: string, bytes: Uint8Array): Promise<void>;
}`;

/** The JavaScript blocks of docs/web.md as modules of TypeScript, by name. */
const guide = Object.fromEntries(
  [...readFileSync(join(repository, 'docs/web.md'), 'utf8').matchAll(/^```js\n(.*?)^```$/gms)].map(([, code], number) => [`block${number + 1}.ts`, code]),
);

/** A module in which what the tools tell of characters has its types: members that a type lacks, or that are missing, are errors. */
async function toldByTools() {
  const glb = readFileSync(join(repository, 'examples/mannequin.glb'));
  const rich = await tools.convert(glb, { compact: '0.1mm', autoRig: true, lod: true });
  const small = await tools.convert(readFileSync(join(repository, 'spec/examples/every_chunk.bendy')), { compact: true });
  const plain = await tools.convert(glb);
  const typed = (type, values) => values.map((value, k) => `export const ${type.toLowerCase()}${k}: ${type} = ${JSON.stringify(value)};\n`).join('');
  return `import type { ConversionReport, Summary } from 'bendy/tools';
    ${typed('ConversionReport', [rich.report, small.report, plain.report])}${typed('Summary', [await tools.summary(rich.bytes), await tools.summary(small.bytes)])}`;
}

test('what the tools tell of characters has its types, and docs/web.md is strict TypeScript', async () => {
  const told = await toldByTools();
  assert.deepEqual(compile('newest', told, [], { ...guide, 'node.d.ts': fileSystem }), []);
  assert.match(guide['block8.ts'] ?? '', /tools\.summary/);
  const wrong = told.replaceAll('"measuredError":', '"measured":').replaceAll('"repeats":', '"loops":');
  const said = compile('newest', wrong);
  for (const name of ['measured', 'loops']) assert.ok(said.some((line) => line.includes(`"${name}"`)), said.slice(0, 5).join('\n'));
  const [error] = compile('newest', `import * as tools from 'bendy/tools';
    const { report } = await tools.convert(new Uint8Array(1));
    console.log(report.compact.measuredError);\n`);
  assert.match(error, /TS18048/, 'compact may be absent');
});

for (const compiler of ['oldest', 'newest']) {
  const { version } = JSON.parse(readFileSync(join(web, 'test/compilers/node_modules', compiler, 'package.json'), 'utf8'));
  test(`types for TypeScript ${version}, libraries checked too`, () => {
    assert.deepEqual(compile(compiler, compiler === 'newest' ? uses.replaceAll(': Float32Array', '').replaceAll(': Uint8Array', '') : uses), []);
    const [wrong] = compile(compiler, `import { Model } from 'bendy';\nconst model: string = await Model.open(7);\n`);
    assert.match(wrong, /main\.ts.*TS2322/);
  });

  test(`types of viewer and adapters for TypeScript ${version}`, () => {
    // Babylon.js and PlayCanvas have types for later versions than the oldest.
    const engines = compiler === 'newest' ? ['babylon', 'playcanvas'] : [];
    const code = `import { BendyLoader } from 'bendy/three';
      import { BendyViewerElement } from 'bendy/viewer';
      import { BendyViewer } from 'bendy/react';
      import { Bendy } from 'bendy/react-three-fiber';
      ${engines.map((name) => `import * as ${name} from 'bendy/${name}';`).join('\n')}
      const viewer: BendyViewerElement = document.createElement('bendy-viewer');
      viewer.addEventListener('error', ({ detail }) => console.log(detail.kind));
      const wrong: string = BendyViewer;
      console.log(BendyLoader, Bendy, wrong, ${engines.join()});
    `;
    const said = compile(compiler, code, ['three', '@types/three', '@types/react', 'react', '@react-three', '@babylonjs', 'playcanvas']);
    // The declarations of engines have errors of their own.
    const ours = said.filter((line) => /main\.ts\(|bendy\/dist\//.test(line));
    assert.equal(ours.length, 1, ours.slice(0, 5).join('\n'));
    assert.match(ours[0], /main\.ts.*TS2322/);
  });
}
