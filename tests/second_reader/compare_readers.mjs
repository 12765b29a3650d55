// Runs `bendy` and the second reader over the same files; exit 1 if they differ.
//   node compare_readers.mjs --bendy PROGRAM --source DIR --work DIR [--corpus DIR]

import { execFile, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { parseArgs, promisify } from 'node:util';
import { isMainThread, Worker } from 'node:worker_threads';
import { ready } from './codecs.mjs';
import { convert_all, files_below, unpack_cases, write_mutated } from './collect_files.mjs';
import { compare_fields, compare_grammar } from './compare_fields.mjs';
import { compare_text_form } from './compare_text_form.mjs';
import { compile_grammar, make_reader } from './kaitai_reader.mjs';
import { read_file } from './read_file.mjs';
import { keys_of, read_steps, root_faults } from './steps.mjs';

const run = promisify(execFile);
/** Of the changed files: damage of a zstd frame that one release of the library sees and another does not. */
const kMostFrameDamage = 0.005;
const kLargestOutput = 1 << 28;

const { values: options } = parseArgs({
    options: { bendy: { type: 'string' }, source: { type: 'string' }, work: { type: 'string' }, corpus: { type: 'string' } },
});

class Comparison {
    constructor(steps) {
        this.steps = steps;
        this.counts = { files: 0, accepted: 0, 'equal reports': 0, fields: 0, numbers: 0, 'damaged zstd frames': 0 };
        this.failures = 0;
    }
    fail(file, what) {
        this.failures += 1;
        if (this.failures <= 40) console.log(`${path.relative(options.work, file)}: ${what}`);
    }
    /** Both reports of one file. Equal is what must be: acceptance, and the faults that no other one can have led to. */
    reports(file, theirs, ours, note) {
        this.counts.files += 1;
        const refused = new Set(theirs.faults.filter(({ code }) => code === 'CODEC_DATA').map(({ offset }) => offset));
        if (ours.file?.damaged_frames.some((offset) => !refused.has(offset))) {
            this.counts['damaged zstd frames'] += 1;
            return;
        }
        const [first, second] = [theirs, ours].map((report) => root_faults(report.faults, this.steps));
        if (first.join() !== second.join())
            this.fail(file, `${note}\n    bendy:  ${first.slice(0, 5).join('; ') || 'good'}\n    second: ${second.slice(0, 5).join('; ') || 'good'}`);
        if (keys_of(theirs.faults).join() === keys_of(ours.faults).join()) this.counts['equal reports'] += 1;
        if (ours.faults.length === 0) this.counts.accepted += 1;
    }
    /** A conformance file: the whole report is the expected one. */
    expected(file, faults, ours) {
        const want = keys_of(faults);
        const have = keys_of(ours.faults);
        if (want.join() !== have.join()) this.fail(file, `expected ${want.join('; ') || 'good'}\n    second:   ${have.join('; ') || 'good'}`);
    }
}

function validate(files) {
    const result = spawnSync(options.bendy, ['validate', '--json', ...files], { maxBuffer: kLargestOutput });
    if (result.signal) throw new Error(`bendy validate ended with ${result.signal}`);
    return JSON.parse(result.stdout);
}

/** Fields of conforming files; two programs at a time. */
async function compare_all_fields(comparison, files, read) {
    const jobs = [...files];
    const has_text_form = /^ +dump /m.test(spawnSync(options.bendy, ['--help'], { encoding: 'utf8' }).stdout);
    const work = async () => {
        for (let file = jobs.shift(); file; file = jobs.shift()) {
            const { stdout } = await run(options.bendy, ['inspect', '--json', '--all', file], { maxBuffer: kLargestOutput });
            const text_form = has_text_form && (await run(options.bendy, ['dump', '--decode', file], { maxBuffer: kLargestOutput }));
            const bytes = new Uint8Array(fs.readFileSync(file));
            const ours = read_file(read, bytes);
            try {
                compare_grammar(read, bytes, ours.chunks);
                for (const line of compare_fields(JSON.parse(stdout), ours.file, ours.chunks, comparison.counts)) comparison.fail(file, line);
                if (!text_form) continue;
                for (const line of compare_text_form(JSON.parse(text_form.stdout), ours.file, ours.chunks, comparison.counts)) comparison.fail(file, line);
            } catch (error) {
                comparison.fail(file, error.stack);
            }
        }
    };
    await Promise.all([work(), work()]);
}

async function main() {
    await ready;
    fs.mkdirSync(options.work, { recursive: true });
    const Bendy = await compile_grammar(path.join(options.source, 'spec', 'bendy.ksy'), options.work);
    const read = make_reader(Bendy);
    const began = Date.now();
    const seconds = () => `${((Date.now() - began) / 1000).toFixed(1)} s`;
    const comparison = new Comparison(read_steps(path.join(options.source, 'spec', 'diagnostics.md')));
    const examples = files_below(path.join(options.source, 'spec', 'examples'), '.bendy');
    const conformance = unpack_cases(path.join(options.source, 'tests', 'conformance'), path.join(options.work, 'conformance'));
    const converted = await convert_all(options.bendy, options.source, options.corpus ?? '', path.join(options.work, 'converted'));
    console.log(`${converted.length} files converted: ${seconds()}`);
    const mutated = write_mutated(read, options.source, converted, path.join(options.work, 'mutated'));
    console.log(`${mutated.length} files changed: ${seconds()}`);
    const notes = new Map(mutated.map(({ file, how }) => [file, how]));
    const files = [...examples, ...conformance.keys(), ...converted, ...notes.keys()];
    const reports = validate(files);
    console.log(`bendy validate: ${seconds()}`);
    const good = [];
    files.forEach((file, k) => {
        const ours = read_file(read, new Uint8Array(fs.readFileSync(file)));
        comparison.reports(file, reports[k], ours, notes.get(file) ?? '');
        if (conformance.has(file)) comparison.expected(file, conformance.get(file), ours);
        if (!notes.has(file) && ours.faults.length === 0) good.push(file);
    });
    console.log(`second reader: ${seconds()}`);
    for (const file of [...examples, ...converted]) if (!good.includes(file)) comparison.fail(file, 'should be accepted');
    if (comparison.counts['damaged zstd frames'] > kMostFrameDamage * mutated.length) comparison.fail(options.work, 'too many damaged frames');
    await compare_all_fields(comparison, good, read);
    console.log(`fields of ${good.length} files: ${seconds()}`);
    console.log(Object.entries(comparison.counts).map(([what, count]) => `${count} ${what}`).join(', '));
    console.log(comparison.failures === 0 ? 'the readers agree' : `${comparison.failures} differences`);
    process.exitCode = comparison.failures === 0 ? 0 : 1;
}

// Skeletons may be nested 65,000 deep, and Kaitai's readers recurse: a thread with a large stack.
if (isMainThread) {
    const worker = new Worker(new URL(import.meta.url), {
        argv: process.argv.slice(2), resourceLimits: { stackSizeMb: 900, maxOldGenerationSizeMb: 2000 },
    });
    worker.on('exit', (code) => (process.exitCode = code));
} else {
    await main();
}
