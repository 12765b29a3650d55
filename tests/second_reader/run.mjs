// Installs what package-lock.json names into the build folder, once, and runs the comparison there.
//   node run.mjs --npm NPM --bendy PROGRAM --source DIR --work DIR [--corpus DIR]
// Exit status 77 (skipped) where the packages cannot be had.

import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const kSkipped = 77;
const here = path.dirname(fileURLToPath(import.meta.url));
const { values: options } = parseArgs({
    options: {
        npm: { type: 'string' }, bendy: { type: 'string' }, source: { type: 'string' }, work: { type: 'string' },
        corpus: { type: 'string' },
    },
});

/** True if the packages of this lock file are there. */
function install() {
    const lock = fs.readFileSync(path.join(here, 'package-lock.json'));
    const stamp = path.join(options.work, 'node_modules', 'installed.json');
    if (fs.existsSync(stamp) && fs.readFileSync(stamp).equals(lock)) return true;
    const result = spawnSync(options.npm, ['ci', '--no-audit', '--no-fund', '--ignore-scripts'], { cwd: options.work, encoding: 'utf8' });
    if (result.status !== 0) {
        console.log(result.stderr || result.error);
        return false;
    }
    fs.writeFileSync(stamp, lock);
    return true;
}

// `npm ci` and this script empty folders there: as scripts/own_folder.py has it.
const isBuilt = (folder) => fs.existsSync(path.join(folder, 'CMakeCache.txt')) || (folder !== path.dirname(folder) && isBuilt(path.dirname(folder)));
if (fs.existsSync(options.work) && fs.readdirSync(options.work).length > 0 && !isBuilt(path.dirname(path.resolve(options.work)))) {
    console.error(`${options.work} may have files of others: name a new folder, or one in a build folder`);
    process.exit(2);
}
fs.mkdirSync(options.work, { recursive: true });
for (const name of fs.readdirSync(here))
    if (name.endsWith('.mjs') || name.endsWith('.json')) fs.copyFileSync(path.join(here, name), path.join(options.work, name));
if (!install()) {
    console.log('npm ci failed: the second reader was not run');
    process.exit(kSkipped);
}
const files = path.join(options.work, 'files');
fs.rmSync(files, { recursive: true, force: true });
const rest = ['--bendy', options.bendy, '--source', options.source, '--work', files, '--corpus', options.corpus ?? ''];
const result = spawnSync(process.execPath, [path.join(options.work, 'compare_readers.mjs'), ...rest], { stdio: 'inherit' });
process.exit(result.status ?? 1);
