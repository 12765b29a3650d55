// Writes a WebAssembly module into a TypeScript module, and prints what that takes on the wire: embed.mjs WASM TS MOST-BYTES-BY-BROTLI
// Each byte becomes one character, of a code that is higher by 35: no quote, no control character, and frequent bytes stay one byte
// in UTF-8. By brotli that is 1 % larger than the module itself; base64 is 34 % larger.
import { readFileSync, writeFileSync } from 'node:fs';
import { basename } from 'node:path';
import { brotliCompressSync } from 'node:zlib';

const shift = 35; // as in src/load.ts
const [wasm, output, most] = process.argv.slice(2);
const bytes = readFileSync(wasm);
const text = Array.from(bytes, (byte) => String.fromCharCode(byte + shift)).join('').replaceAll('\\', '\\\\');
const module = `const text: string = "${text}";\nexport default text;\n`;
writeFileSync(output, module);
const compressed = brotliCompressSync(module).length;
console.log(`${basename(output, '.ts')}: ${bytes.length} bytes of WebAssembly, ${compressed} of JavaScript by brotli, at most ${most}`);
process.exitCode = compressed <= Number(most) ? 0 : 1;
