// The files that both readers are run over.

import { execFile } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { promisify } from 'node:util';
import { make_random, mutate } from './mutate.mjs';

const run = promisify(execFile);
const kMutated = 2000;
/** Bytes of the largest models of the corpus that are converted with --compact too: it takes long. */
const kLargestCompact = 60_000;
const kSeed = 20260711;

/** All files below a folder that end so, in order; none if there is no such folder. */
export function files_below(folder, ...endings) {
    if (!fs.existsSync(folder)) return [];
    return fs.readdirSync(folder, { recursive: true }).map(String).sort()
        .filter((name) => endings.some((ending) => name.endsWith(ending))).map((name) => path.join(folder, name));
}

/** Writes the cases of the conformance manifests below a folder; gives the faults that each file's report states. */
export function unpack_cases(source, folder) {
    const expected = new Map();
    for (const manifest of files_below(source, '.json')) {
        const { family, cases } = JSON.parse(fs.readFileSync(manifest, 'utf8'));
        fs.mkdirSync(path.join(folder, family), { recursive: true });
        for (const { name, faults, bytes } of cases) {
            const file = path.join(folder, family, `${name}.bendy`);
            fs.writeFileSync(file, Buffer.from(bytes, 'hex'));
            expected.set(file, faults);
        }
    }
    return expected;
}

/** Models and the options they are converted with. */
function conversions(source, corpus) {
    const examples = files_below(path.join(source, 'examples'), '.glb').filter((file) => !file.includes('blender'));
    const models = files_below(path.join(corpus, 'visible'), '.glb', '.gltf');
    const jobs = [];
    for (const file of examples)
        for (const options of [[], ['--compact'], ['--lod'], ['--lod', '--compact']]) jobs.push({ file, options });
    for (const file of models) {
        jobs.push({ file, options: [] });
        if (fs.statSync(file).size <= kLargestCompact) jobs.push({ file, options: ['--compact'] });
    }
    return jobs;
}

/** Converts what can be converted; gives the files. Broken models, of which the corpus has some, give none. */
export async function convert_all(bendy, source, corpus, folder) {
    fs.mkdirSync(folder, { recursive: true });
    const jobs = conversions(source, corpus);
    const made = [];
    const work = async () => {
        for (let job = jobs.shift(); job; job = jobs.shift()) {
            const name = `${path.basename(path.dirname(job.file))}_${path.basename(job.file)}${job.options.join('')}.bendy`;
            const target = path.join(folder, name);
            made.push(target);
            await run(bendy, ['convert', ...job.options, job.file, '-o', target]).catch(() => {});
        }
    };
    await Promise.all([work(), work()]);
    return made.sort().filter((file) => fs.existsSync(file));
}

/** How often each seed file is changed; small files with every chunk more often than large ones. */
function seeds(source, converted) {
    const example = (name) => path.join(source, 'spec', 'examples', name);
    const made = (ending) => converted.filter((file) => /examples_tentacle\.glb/.test(file) && file.endsWith(ending));
    const every = example('every_chunk.bendy');
    return [every, every, every, every, every, example('one_joint.bendy'), example('unknown_chunks.bendy'),
        example('every_chunk.bendy'), ...made('glb--compact.bendy'), ...made('--lod--compact.bendy')];
}

/** Changed copies of good files: { file, how }. */
export function write_mutated(read, source, converted, folder) {
    fs.mkdirSync(folder, { recursive: true });
    const files = seeds(source, converted).map((file) => ({ file, bytes: new Uint8Array(fs.readFileSync(file)) }));
    const random = make_random(kSeed);
    return Array.from({ length: kMutated }, (_, k) => {
        const seed = files[k % files.length];
        const { how, bytes } = mutate(read, seed.bytes, random);
        const file = path.join(folder, `${k}.bendy`);
        fs.writeFileSync(file, bytes);
        return { file, how: `${how} of ${path.basename(seed.file)}` };
    });
}
