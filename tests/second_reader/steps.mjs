// In what order faults are looked for, and what two readers have to agree on: the steps of diagnostics.md.

import fs from 'node:fs';

/** The sets of codes of the page's table, one step after another; sums, which stand apart, left out. */
export function read_steps(page) {
    const rows = [...fs.readFileSync(page, 'utf8').matchAll(/^\| (grammar|tree|records|references|values) \| (.*) \|$/gm)];
    return rows.map(([, , codes]) => new Set(codes.match(/[A-Z_0-9]+/g)));
}

const key_of = (fault) => `${fault.code} ${fault.path} @${fault.offset}`;

/** A report as a set: each fault once, in order. */
export function keys_of(faults) {
    return [...new Set(faults.map(key_of))].sort();
}

/** The faults that no other one can have led to: wrong sums, and those of the first step that has any. */
export function root_faults(faults, steps) {
    const sums = faults.filter((fault) => fault.code === 'SUM_MISMATCH');
    for (const step of steps) {
        const found = faults.filter((fault) => step.has(fault.code));
        if (found.length > 0) return keys_of([...sums, ...found]);
    }
    return keys_of(sums);
}
