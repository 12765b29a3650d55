// Writes a WebAssembly module into a TypeScript module, and prints its size: embed.mjs WASM TS MOST-BYTES-BY-BROTLI
import { readFileSync, writeFileSync } from 'node:fs';
import { basename } from 'node:path';
import { brotliCompressSync } from 'node:zlib';

const [wasm, output, most] = process.argv.slice(2);
const bytes = readFileSync(wasm);
writeFileSync(output, `const base64: string = '${bytes.toString('base64')}';\nexport default base64;\n`);
const compressed = brotliCompressSync(bytes).length;
console.log(`${basename(output, '.ts')}: ${bytes.length} bytes, ${compressed} by brotli, at most ${most}`);
process.exitCode = compressed <= Number(most) ? 0 : 1;
