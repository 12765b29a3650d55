// Which chunk stands where: tree.md. ? at most once, * any number of times, no mark exactly once.

const kTree = `
HEAD: VERS BNDS? TEXT* MATE* OBJE* EXTR? EXTN? MORE?
TEXT: NAME? SAMP IMAG* LINK* SAME* EXTR? MORE?
MATE: NAME? SURF EXTN? EXTR? MORE?
OBJE: NAME? EXTR? MORE? SKIN* JNTS? JNAM? ROLE? STND? IKCH* VECT* LODD? CYCL*
SKIN: NAME? PIVO? MATE* POLY* EXTR? EXTN? MORE? SKIN*
PIVO: REST? LIMT* PULL*
IKCH: NAME? KINF EXTR?
VECT: NAME? VINF EXTR? MORE? PALT? NLST? POSI? NORM? TANG? TEXC* COLR* BONE? WGHT? USER* TARG* FRMS? INDX?
USER: NAME? VALS
TARG: NAME? TINF INDX? POSI? NORM? TANG?
FRMS: FNAM? GRID INDX? POSI? NORM?
CYCL: NAME? CINF EXTR? MORE? TRAK? PACK? PLAY? TIME? KEYV? MARK? CURV*`;

/** id -> id of child -> '' or '?' or '*' */
export const kChildren = new Map();
for (const line of kTree.trim().split('\n')) {
    const [id, children] = line.split(': ');
    kChildren.set(id, new Map(children.split(' ').map((child) => [child.slice(0, 4), child.slice(4)])));
}

/** Ids with a page. */
export const kKnown = new Set(['HEAD', ...[...kChildren.values()].flatMap((children) => [...children.keys()])]);

export const kStreams = new Set(['POSI', 'NORM', 'TANG', 'TEXC', 'COLR', 'BONE', 'WGHT', 'VALS', 'INDX']);
export const kTexts = new Set(['NAME', 'EXTR', 'EXTN', 'MORE', 'LINK']);

/**
 * Adds the tree's faults: those of all containers that no unknown one holds, misplaced ones too. Sets `meant` on each
 * chunk: true where nothing above it or of itself is at fault, so that it counts.
 */
export function check_tree(chunks, add) {
    const head = chunks[0];
    head.meant = head.is_known = true;
    for (const chunk of chunks) {
        if (!chunk.is_known || !chunk.is_container) continue;
        const rules = kChildren.get(chunk.id) ?? new Map();
        const counts = new Map();
        for (const child of chunk.children) {
            child.meant = false;
            child.is_known = kKnown.has(child.id);
            if (!child.is_known) {
                if (child.is_required) add('REQUIRED_CHUNK_UNKNOWN', child);
                continue;
            }
            const times = rules.get(child.id);
            const before = counts.get(child.id) ?? 0;
            counts.set(child.id, before + 1);
            const is_repeated = times !== undefined && times !== '*' && before > 0;
            const is_late = chunk.id === 'SKIN' && child.id === 'MATE' && counts.has('SKIN');
            const has_shape = child.is_container === kChildren.has(child.id);
            if (times === undefined || is_late) add('CHUNK_MISPLACED', child);
            if (is_repeated) add('CHUNK_REPEATED', child);
            if (!has_shape) add(child.is_container ? 'NOT_A_LEAF' : 'NOT_A_CONTAINER', child);
            child.meant = chunk.meant && times !== undefined && !is_late && !is_repeated && has_shape;
        }
        for (const [id, times] of rules)
            if (times === '' && !counts.has(id)) add('CHUNK_MISSING', chunk);
    }
}
