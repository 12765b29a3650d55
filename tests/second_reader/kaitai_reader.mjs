// The reader that Kaitai Struct makes of spec/bendy.ksy, in the few calls that the rest needs.

import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';
import compiler from 'kaitai-struct-compiler';
import YAML from 'yaml';

const require = createRequire(import.meta.url);
const { KaitaiStream } = require('kaitai-struct');

/** Compiles the grammar to JavaScript in `folder` and gives its class. */
export async function compile_grammar(grammar, folder) {
    const files = await compiler.compile('javascript', YAML.parse(fs.readFileSync(grammar, 'utf8')), null, false);
    const target = path.join(folder, 'Bendy.cjs');
    fs.writeFileSync(target, files['Bendy.js']);
    return require(target).Bendy;
}

/** Calls on the grammar's types; all take bytes and give Kaitai's objects. */
export function make_reader(Bendy) {
    const stream = (bytes) => new KaitaiStream(bytes);
    return {
        file: (bytes) => new Bendy(stream(bytes)),
        header: (bytes) => new Bendy.Header(stream(bytes)),
        encoded: (bytes) => new Bendy.Encoded(stream(bytes)),
        /** What a leaf's decoded payload holds. */
        payload: (id, bytes) => new Bendy.Payload(stream(bytes), null, null, id).body,
        /** The record alone that a type of the grammar names. */
        record: (type, bytes) => new Bendy[type](stream(bytes)),
        /** Targets and joined bits of a mesh; says how many bytes they take. */
        collapses(bytes, count, target_type) {
            const io = stream(bytes);
            const value = new Bendy.Collapses(io, null, null, count, target_type);
            return { value, bytes: io.pos };
        },
    };
}
