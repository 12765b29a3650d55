// The second reader by itself: prints code, path and offset of each fault; exit 1 if there is one.
//   node read.mjs GRAMMAR FILE...       in a folder where `npm ci` has run; GRAMMAR is spec/bendy.ksy

import fs from 'node:fs';
import path from 'node:path';
import { ready } from './codecs.mjs';
import { compile_grammar, make_reader } from './kaitai_reader.mjs';
import { read_file } from './read_file.mjs';

const [grammar, ...files] = process.argv.slice(2);
await ready;
const folder = fs.mkdtempSync(path.join(path.dirname(new URL(import.meta.url).pathname), 'grammar-'));
const read = make_reader(await compile_grammar(grammar, folder));
for (const file of files)
    for (const { code, path: where, offset } of read_file(read, new Uint8Array(fs.readFileSync(file))).faults) {
        console.log(`${file}: ${code} (${where}, offset ${offset})`);
        process.exitCode = 1;
    }
fs.rmSync(folder, { recursive: true });
