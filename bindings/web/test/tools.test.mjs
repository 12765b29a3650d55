// The tools give what the native program gives, to the byte.
// BENDY_WHOLE_CORPUS=1 also converts every file of the corpus with --compact, --lod and --auto-rig.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join, relative } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import * as tools from '../dist/tools/index.js';
import { memorySize } from '../dist/tools/module.js';

const repository = fileURLToPath(new URL('../../..', import.meta.url));
const program = process.env.BENDY_PROGRAM ?? join(repository, 'build/release/cli/bendy');
const corpus = join(repository, '../shared/corpus/visible');
const folder = mkdtempSync(join(tmpdir(), 'bendy-tools-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));

// Bounds depend on the arithmetic of poses: the module has the plain one.
process.env.BENDY_KERNEL = 'plain';

const read = (file) => new Uint8Array(readFileSync(file));
const native = (...args) => execFileSync(program, args, { cwd: folder, stdio: ['ignore', 'pipe', 'pipe'], maxBuffer: 2 ** 28 });
const nativeJson = (...args) => {
  const { stdout } = spawnSync(program, args, { cwd: folder, maxBuffer: 2 ** 28 });
  return JSON.parse(stdout);
};

function assertSameBytes(actual, expected, what = '') {
  assert.ok(Buffer.compare(actual, expected) === 0, `${what}: ${actual.length} bytes, the program's are ${expected.length}, or others`);
}

let made = 0;
/** Runs the program with an output: its bytes. */
function nativeBytes(suffix, ...args) {
  const output = join(folder, `${made++}${suffix}`);
  native(...args, '-o', output);
  return read(output);
}

/** All files below a folder, by their relative paths. */
function filesIn(root) {
  const files = {};
  for (const name of readdirSync(root, { recursive: true })) {
    if (statSync(join(root, name)).isFile()) files[name] = read(join(root, name));
  }
  return files;
}

/** What a source can refer to: the files beside it and below, and for models of one file only itself. */
function sourceOf(file) {
  const root = dirname(file);
  const name = basename(file);
  if (readdirSync(root).length > 12) return { source: { [name]: read(file) }, root, name };
  return { source: filesIn(root), root, name };
}

/** Converts a file here and natively, and compares the bytes or the messages. */
async function compare(file, options, args) {
  const { source, root, name } = sourceOf(file);
  const output = join(folder, `${made++}.bendy`);
  const { status, stdout } = spawnSync(program, ['convert', name, '-o', output, '--json', ...args], { cwd: root, maxBuffer: 2 ** 28 });
  const what = `${relative(corpus, file)} ${args.join(' ')}`;
  const expected = inJavaScript(JSON.parse(stdout));
  if (status === 0) {
    const conversion = await tools.convert(source, { main: name, ...options });
    assertSameBytes(conversion.bytes, read(output), what);
    const { status: _status, input: _input, output: _output, ...report } = expected;
    assert.deepEqual(conversion.report, report, what);
    rmSync(output);
    return true;
  }
  const { file: blamed, message } = expected.error;
  await assert.rejects(tools.convert(source, { main: name, ...options }), (error) => {
    assert.ok(error instanceof tools.BendyError, String(error));
    assert.equal(error.code, 'CONVERSION');
    assert.equal(error.message, blamed === name ? message : `${blamed}: ${message}`, what);
    return true;
  });
  return false;
}

/** What the program says, with options named as JavaScript has them. */
function inJavaScript(said) {
  if (typeof said === 'string') return said.replace(/(?<=[ (])--([a-z]+(?:-[a-z]+)*)/g, (_, name) => name.replace(/-(\w)/g, (_, letter) => letter.toUpperCase()));
  if (Array.isArray(said)) return said.map(inJavaScript);
  return said !== null && typeof said === 'object' ? Object.fromEntries(Object.entries(said).map(([key, value]) => [key, inJavaScript(value)])) : said;
}

const ways = [
  [{ compact: true }, ['--compact']],
  [{ lod: true }, ['--lod']],
  [{ autoRig: true }, ['--auto-rig']],
];

test('the corpus converts to the same bytes', { skip: !existsSync(corpus) && `there is no ${corpus}` }, async (context) => {
  const files = JSON.parse(readFileSync(join(corpus, 'manifest.json'))).files.map(({ file }) => join(corpus, file));
  let converted = 0;
  for (const file of files) {
    if (await compare(file, {}, [])) ++converted;
  }
  context.diagnostic(`${converted} files converted, ${files.length - converted} refused with the same message`);
  assert.ok(converted > 70);
  const is_whole = process.env.BENDY_WHOLE_CORPUS === '1';
  const some = files.filter((file) => is_whole || /fox\.glb|robot\.glb|morph_and_skin|cesium_man|BoxDraco/.test(file));
  for (const file of some) {
    for (const [options, args] of ways) await compare(file, options, args);
  }
});

const examples = ['mannequin', 'tentacle'].map((name) => join(repository, 'examples', `${name}.glb`));

for (const file of examples) {
  const name = basename(file, '.glb');
  const exact = join(folder, `${name}.bendy`);
  native('convert', '-q', file, '-o', exact);
  const bytes = read(exact);

  test(`${name} converts to the same bytes`, async () => {
    for (const [options, args] of [
      [{}, []],
      ...ways,
      [{ keepOrder: true }, ['--keep-order']],
      [{ compact: '0.1mm', lod: true }, ['--max-error', '0.1mm', '--lod']],
      [{ mergeClips: true }, ['--merge-clips']],
      [{ dropUnused: true }, ['--drop-unused']],
    ]) {
      assertSameBytes((await tools.convert(read(file), options)).bytes, nativeBytes('.bendy', 'convert', '-q', file, ...args), args.join(' '));
    }
    assertSameBytes((await tools.convert(bytes)).bytes, bytes);
    const rig = native('rig', exact).toString();
    writeFileSync(join(folder, 'rig.json'), rig);
    const expected = nativeBytes('.bendy', 'convert', '-q', file, '--rig', 'rig.json');
    assertSameBytes((await tools.convert(read(file), { rig })).bytes, expected, 'rig');
    assertSameBytes((await tools.convert(read(file), { rig: JSON.parse(rig) })).bytes, expected, 'rig');
  });

  test(`${name}: inspect and summary are the program's`, async () => {
    const report = nativeJson('inspect', '--json', exact);
    assert.deepEqual(await tools.summary(bytes), report.summary, 'summary');
    const list = [];
    const walk = (chunk, parent) => {
      const { children, path, fields, ...entry } = chunk;
      assert.ok(path.startsWith('HEAD'));
      list.push({ ...entry, parent, ...(Object.keys(fields).length === 0 ? {} : { fields }) });
      for (const child of children) walk(child, chunk.number);
    };
    walk(await tools.inspect(bytes), null);
    assert.deepEqual(list, report.chunks);
    const page = await tools.inspectPage(bytes, `${name}.bendy`);
    const data = (html) => JSON.parse(html.match(/<script[^>]*type="application\/json"[^>]*>(.*?)<\/script>/s)[1]);
    native('inspect', exact, '--html', `${name}.html`);
    const { pictures: _a, ...expected } = data(readFileSync(join(folder, `${name}.html`), 'utf8'));
    const { pictures: _b, ...actual } = data(page);
    assert.deepEqual(actual, expected);
  });

  test(`${name}: dump and assemble are the program's`, async () => {
    const text = await tools.dump(bytes);
    assert.equal(text, native('dump', exact).toString());
    assertSameBytes(await tools.assemble(text), bytes);
    const compact = nativeBytes('.bendy', 'convert', '-q', file, '--compact');
    const compactFile = join(folder, `${name}_compact.bendy`);
    writeFileSync(compactFile, compact);
    assert.equal(await tools.dump(compact, { decode: true }), native('dump', '--decode', compactFile).toString());
    assertSameBytes(await tools.assemble(await tools.dump(compact)), compact);
  });

  test(`${name}: exports are the program's`, async () => {
    const lod = join(folder, `${name}_lod.bendy`);
    native('convert', '-q', file, '--lod', '-o', lod);
    for (const [format, options, args, input] of [
      ['glb', {}, [], exact],
      ['gltf', {}, [], exact],
      ['x', {}, [], exact],
      ['glb', { lod: 0.5 }, ['--lod', '0.5'], lod],
    ]) {
      const root = mkdtempSync(join(folder, 'export-'));
      native('export', '-q', input, '-o', join(root, `${name}.${format}`), ...args);
      const { main, files } = await tools.exportModel(read(input), format, { name, ...options });
      assert.equal(main, `${name}.${format}`);
      const expected = filesIn(root);
      assert.deepEqual(Object.keys(files).sort(), Object.keys(expected).sort());
      for (const one of Object.keys(expected)) assertSameBytes(files[one], expected[one], one);
      const again = await tools.convert(files, { main });
      native('convert', '-q', join(root, main), '-o', join(root, 'again.bendy'));
      assertSameBytes(again.bytes, read(join(root, 'again.bendy')), `${main} again`);
    }
  });

  test(`${name}: edits are the program's`, async () => {
    const joint = (await tools.summary(bytes)).joints[1].name;
    const edits = [
      [await tools.strip(bytes, 'clips'), ['--strip', 'clips']],
      [await tools.strip(bytes, 'materials'), ['--strip', 'materials']],
      [await tools.rename(bytes, 'joint', { [joint]: 'New' }), ['--rename-joint', `${joint}=New`]],
      [await tools.extract(bytes, joint), ['--extract', joint]],
      [await tools.changeClips(bytes, 'resample', '*@12'), ['--resample', '*@12']],
      [await tools.changeClips(bytes, 'keep-clip', ['#0']), ['--keep-clip', '#0']],
      [await tools.setRole(bytes, 'tail:2', joint), ['--role', `tail:2=${joint}`]],
      [await tools.setRole(bytes, 'hips', null), ['--role', 'hips=']],
      [await tools.setMaterial(bytes, '*', 'base_colour', [1, 0.5, 0, 1]), ['--set', 'material:*.base_colour=1,0.5,0,1']],
      [await tools.limitInfluences(bytes, 2), ['--influences', '2']],
      [await tools.mergeClips(bytes, bytes, { sameName: 'number' }), ['--same-name', 'number', '--merge', exact]],
    ];
    for (const [{ bytes: actual, done }, args] of edits) {
      assertSameBytes(actual, nativeBytes('.bendy', 'edit', '-q', exact, ...args), args.join(' '));
      assert.ok(Array.isArray(done));
    }
    await assert.rejects(tools.mergeClips(bytes, bytes), { kind: 'edit', code: 'EDIT' });
    await assert.rejects(tools.strip(bytes, 'hats'), { kind: 'bad_argument' });
    await assert.rejects(tools.changeClips(bytes, 'trim', 'Run'), { kind: 'bad_argument' });
    await assert.rejects(tools.setRole(bytes, 'nose', joint), { kind: 'bad_argument' });
    await assert.rejects(tools.setMaterial(bytes, '*', 'shine', 1), /roughness/);
  });

  test(`${name}: differences are the program's`, async () => {
    const stripped = (await tools.strip(bytes, 'clips')).bytes;
    const other = join(folder, `${name}_stripped.bendy`);
    writeFileSync(other, stripped);
    const compact = join(folder, `${name}_compared.bendy`);
    native('convert', '-q', file, '--compact', '-o', compact);
    for (const [b, options, args] of [
      [other, {}, []],
      [exact, {}, []],
      [compact, {}, []],
      [compact, { tolerance: '0.01%' }, ['--tolerance', '0.01%']],
      [other, { tolerance: '0.1mm' }, ['--tolerance', '0.1mm']],
    ]) {
      const { a: _a, b: _b, ...expected } = nativeJson('diff', '--json', exact, b, ...args);
      const { notCompared: _c, ...actual } = await tools.diff(bytes, read(b), options);
      assert.deepEqual(actual, expected, args.join(' '));
    }
  });
}

/** Lengthens the shins of a text form. */
function lengthen(parts) {
  for (const [id, content] of parts.flatMap(Object.entries)) {
    if (id === 'SKIN' && /(Left|Right)Foot$/.test(content[0].NAME ?? '')) {
      const { REST } = content.find((part) => 'PIVO' in part).PIVO[0];
      REST.translation = REST.translation.map((number) => 1.3 * number);
    }
    if (['HEAD', 'OBJE', 'SKIN'].includes(id)) lengthen(content);
  }
}

test('clips are retargeted as by the program', async () => {
  const exact = join(folder, 'source.bendy');
  native('convert', '-q', join(repository, 'examples/mannequin.glb'), '-o', exact);
  const source = read(exact);
  const text = JSON.parse(await tools.dump(source));
  lengthen(text.HEAD);
  const { bytes } = await tools.strip(await tools.assemble(JSON.stringify(text)), 'clip:Walk');
  const tall = join(folder, 'tall.bendy');
  writeFileSync(tall, bytes);
  for (const [options, args] of [
    [{ clip: 'Wal*' }, ['--retarget', `${exact}:Wal*`]],
    [{ sameName: 'number' }, ['--retarget', exact, '--same-name', 'number']],
    [{ clip: 1, limits: 'off', plantsFeet: false }, ['--retarget', `${exact}:1`, '--limits', 'off', '--free-feet']],
    [{ clip: 'Walk', restPoses: 'alike' }, ['--retarget', `${exact}:Walk`, '--rests-alike']],
  ]) {
    const edited = await tools.retargetClips(bytes, source, options);
    assertSameBytes(edited.bytes, nativeBytes('.bendy', 'edit', '-q', tall, ...args), args.join(' '));
    assert.ok(edited.done.some((line) => line.startsWith('retargeted clip "Walk"') && line.includes('off by')), edited.done.join());
  }
  for (const [{ bytes: told, done }, args] of [
    [await tools.stand(source, 'Walk', 0.35), ['--stand', 'Walk@0.35']],
    [await tools.stand(source, 1, 0), ['--stand', '1@0']],
    [await tools.standAs(source, bytes), ['--stand-as', tall]],
  ]) {
    assertSameBytes(told, nativeBytes('.bendy', 'edit', '-q', exact, ...args), args.join(' '));
    assert.match(done.join(), /stands as told/);
    assertSameBytes((await tools.strip(told, 'standing-pose')).bytes, source);
  }
  await assert.rejects(tools.stand(source, 'Walk', 9), { kind: 'edit', message: /is from 0/ });
  await assert.rejects(tools.stand(source, 'Walk'), { kind: 'bad_argument', message: /seconds/ });
  await assert.rejects(tools.standAs(bytes, read(join(repository, 'examples/mannequin.glb'))), { kind: 'malformed' });
  await assert.rejects(tools.retargetClips(bytes, source), { kind: 'edit', message: /"Idle"/ });
  await assert.rejects(tools.retargetClips(bytes, source, { plantsfeet: false }), { message: /did you mean plantsFeet/ });
  await assert.rejects(tools.retargetClips(bytes, source, { clip: 'Wlak' }), { kind: 'edit', message: /Wlak/ });
  for (const wrong of [{ restPoses: 'magic' }, { sameName: 'magic' }, { plantsFeet: 'no' }]) {
    await assert.rejects(tools.retargetClips(bytes, source, { clip: 'Walk', ...wrong }), { kind: 'bad_argument' });
  }
  await assert.rejects(tools.retargetClips(bytes, read(join(repository, 'examples/mannequin.glb'))), { kind: 'malformed' });
  const { bytes: tentacle } = await tools.convert(read(join(repository, 'examples/tentacle.glb')));
  await assert.rejects(tools.retargetClips(bytes, tentacle), { message: /the source does not say what its joints are/ });
});

test('broken files have the faults that they are to have', async (context) => {
  const conformance = join(repository, 'tests/conformance');
  let count = 0;
  for (const family of readdirSync(conformance).filter((name) => name.endsWith('.json'))) {
    for (const { name, faults, bytes } of JSON.parse(readFileSync(join(conformance, family))).cases) {
      const file = new Uint8Array(Buffer.from(bytes, 'hex'));
      const keys = (list) => [...new Set(list.map((fault) => `${fault.code} ${fault.path} ${fault.offset} ${fault.kind ?? fault.class}`))].sort();
      const found = await tools.validate(file).then(
        (report) => report.faults,
        (error) => [{ code: error.code, path: error.path, offset: error.offset, kind: error.kind }],
      );
      assert.deepEqual(keys(found), keys(faults), name);
      // Nothing traps: every tool gives a result or an error of ours.
      for (const tool of [tools.summary, tools.inspect, (file) => tools.convert(file), (file) => tools.exportModel(file, 'glb')]) {
        await tool(file).catch((error) => assert.ok(error instanceof tools.BendyError && error.kind !== 'stopped', `${name}: ${error}`));
      }
      ++count;
    }
  }
  context.diagnostic(`${count} files`);
});

test('damaged files have the same faults and messages', async () => {
  const seeds = join(repository, 'tests/seeds');
  const damaged = [];
  for (const name of readdirSync(seeds).filter((name) => name.endsWith('.bendy'))) {
    const bytes = read(join(seeds, name));
    for (let way = 0; way < 6; ++way) {
      const copy = way === 0 ? bytes.slice(0, bytes.length - 40) : bytes.slice();
      if (way > 0) copy[Math.floor((copy.length * way) / 6)] ^= 0x55;
      damaged.push({ bytes: copy, file: join(folder, `${way}_${name}`) });
    }
  }
  for (const { bytes, file } of damaged) writeFileSync(file, bytes);
  const reports = nativeJson('validate', '--json', ...damaged.map(({ file }) => file));
  for (const [number, { bytes }] of damaged.entries()) {
    const expected = reports[number].faults.map(({ class: kind, ...fault }) => ({ kind, ...fault }));
    assert.deepEqual((await tools.validate(bytes)).faults, expected, damaged[number].file);
  }
});

test('what is no bendy file is refused by name', async () => {
  await assert.rejects(tools.validate(read(examples[0])), { kind: 'malformed', code: 'NOT_A_BENDY_FILE' });
  await assert.rejects(tools.convert(new Uint8Array(0)), { kind: 'conversion' });
  const refused = (options, message) => assert.rejects(tools.convert(read(examples[0]), options), { kind: 'bad_argument', message });
  await refused({ autorig: true }, /no option "autorig"; did you mean autoRig\?/);
  await refused({ 'auto-rig': true }, /did you mean autoRig\?/);
  await refused({ maxError: '1mm' }, /no option "maxError"; did you mean compact: '1mm'\?/);
  await refused({ shrink: true }, /no option "shrink"; it has /);
  await refused({ compact: [1] }, /compact is an object of type Array, not true or the largest error/);
  await assert.rejects(tools.convert({ '../a.glb': new Uint8Array(4) }), { kind: 'bad_argument' });
  await assert.rejects(tools.convert({}), { kind: 'conversion' });
  await assert.rejects(tools.assemble('{"bendy": '), { kind: 'malformed', code: 'TEXT', path: /^\d+:\d+$/ });
});

test('options that do not exist are refused', async () => {
  const { bytes } = await tools.convert(read(join(repository, 'examples/tentacle.glb')));
  for (const [call, message] of [
    [() => tools.dump(bytes, { decoded: true }), /^dump has no option "decoded"; did you mean decode\?$/],
    [() => tools.assemble('', { allow_invalid: true }), /did you mean allowInvalid\?$/],
    [() => tools.rename(bytes, 'joint', {}, { mustMatch: true }), /^rename has no option "mustMatch"; it has allMustMatch$/],
    [() => tools.mergeClips(bytes, bytes, { samename: 'number' }), /did you mean sameName\?$/],
    [() => tools.retargetClips(bytes, bytes, { clips: 'Walk' }), /^retargetClips has no option "clips"; did you mean clip\?$/],
    [() => tools.exportModel(bytes, 'glb', { names: 'fox' }), /^exportModel has no option "names"; did you mean name\?$/],
    [() => tools.diff(bytes, bytes, { tolerances: '1mm' }), /did you mean tolerance\?$/],
  ]) {
    await assert.rejects(call(), { kind: 'bad_argument', message });
  }
});

test('a wrong word of an option is refused', async () => {
  const source = read(join(repository, 'examples/tentacle.glb'));
  await assert.rejects(tools.convert(source, { images: 'embd' }), { code: 'BAD_ARGUMENT', message: 'images must be embed or link' });
});

test('progress is told, and what it throws comes out', async () => {
  const shares = [];
  await tools.convert(read(examples[0]), { compact: true, progress: (share) => shares.push(share) });
  assert.ok(shares.length > 2 && shares.every((share) => share >= 0 && share <= 1));
  const stop = new Error('stop');
  await assert.rejects(tools.convert(read(examples[0]), { compact: true, progress: () => { throw stop; } }), stop);
});

test('memory does not grow over 100 conversions', async () => {
  const bytes = read(examples[0]);
  let size = 0;
  for (let round = 0; round < 100; ++round) {
    await tools.convert(bytes);
    await tools.convert(bytes.subarray(0, bytes.length - round - 1)).catch(() => {});
    if (round === 2) size = await memorySize();
  }
  assert.equal(await memorySize(), size);
});

test('the module is usable after the memory did not suffice', async () => {
  const count = 300_000_000;
  const gltf = {
    asset: { version: '2.0' },
    buffers: [{ byteLength: 4 }],
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    accessors: [{ componentType: 5126, count, type: 'VEC3', min: [0, 0, 0], max: [0, 0, 0] }],
  };
  const source = new TextEncoder().encode(JSON.stringify(gltf));
  await assert.rejects(tools.convert({ 'a.gltf': source }), (error) => error instanceof tools.BendyError);
  const { bytes } = await tools.convert(read(examples[1]));
  assert.equal((await tools.validate(bytes)).faults.length, 0);
});
