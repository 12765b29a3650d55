// The grammar: grammar.md, "The whole file in pseudo-code". No recursion: nesting is under the sender's control.

export const kMaxDepth = 65536;

/** A fault of the grammar: a code of diagnostics.md, its place, and the chunk that names its path. */
function fault(code, offset, chunk) {
    return { code, offset, path: chunk ? path_of(chunk) : '' };
}

/** The chunk whose header stands at `offset`; there are 16 bytes. `Header` is the grammar's type. */
function read_header(read, bytes, offset) {
    const header = read.header(bytes.subarray(offset, offset + 16));
    return {
        id: header.id, sum: header.sum, size: header.size, flags: header.flags, offset,
        is_container: header.isContainer, is_required: header.isRequired, codec: header.codec,
        reserved: header.reservedFlags, parent: null, children: [], same_before: 0,
    };
}

/** The fault of a header by itself, if it has one. */
function header_fault(chunk) {
    if (!/^[A-Z0-9]{4}$/.test(chunk.id)) return 'CHUNK_ID_NOT_LETTERS';
    if (chunk.reserved !== 0) return 'RESERVED_FLAGS';
    if (chunk.is_container && chunk.codec !== 0) return 'CONTAINER_CODEC';
    if (chunk.is_container && chunk.size % 16 !== 0) return 'CONTAINER_SIZE';
    return null;
}

function root_fault(bytes, head) {
    const own = header_fault(head);
    if (own) return fault(own, 0, head);
    if (!head.is_container) return fault('NOT_A_CONTAINER', 0, head);
    if (head.size > bytes.length - 16) return fault('TRUNCATED', 0, head);
    if (head.size < bytes.length - 16) return fault('TRAILING_BYTES', head.size + 16, null);
    return null;
}

/** All chunks in file order with their nesting, and the first fault of the grammar or null. */
export function walk(read, bytes) {
    const chunks = [];
    if (bytes.length < 16) return { chunks, fault: fault('NOT_A_BENDY_FILE', 0, null) };
    const head = read_header(read, bytes, 0);
    if (head.id !== 'HEAD') return { chunks, fault: fault('NOT_A_BENDY_FILE', 0, head) };
    chunks.push(head);
    const broken = root_fault(bytes, head);
    if (broken) return { chunks, fault: broken };
    const open = [{ chunk: head, end: 16 + head.size, ids: new Map() }];
    let at = 16;
    while (open.length > 0) {
        const here = open[open.length - 1];
        if (at === here.end) {
            open.pop();
            continue;
        }
        const chunk = read_header(read, bytes, at);
        chunk.parent = here.chunk;
        chunk.same_before = here.ids.get(chunk.id) ?? 0;
        here.ids.set(chunk.id, chunk.same_before + 1);
        here.chunk.children.push(chunk);
        chunks.push(chunk);
        const wrong = header_fault(chunk);
        if (wrong) return { chunks, fault: fault(wrong, at, chunk) };
        if (chunk.size > here.end - at - 16) return { chunks, fault: fault('CHUNK_TOO_LONG', at, chunk) };
        if (chunk.is_container) {
            if (open.length === kMaxDepth) return { chunks, fault: fault('TOO_DEEP', at, chunk) };
            open.push({ chunk, end: at + 16 + chunk.size, ids: new Map() });
            at += 16;
            continue;
        }
        const end = at + 16 + chunk.size;
        at = end + (16 - (chunk.size % 16)) % 16;
        if (bytes.subarray(end, at).some((byte) => byte !== 0))
            return { chunks, fault: fault('PADDING_NOT_ZERO', end, chunk) };
    }
    return { chunks, fault: null };
}

/** "HEAD/OBJE/SKIN[1]": [n] is the place among siblings of the same id, left out where it is 0. */
export function path_of(chunk) {
    const steps = [];
    for (let at = chunk; at; at = at.parent) {
        const id = at.id.replace(/[^!-~]/g, '?');
        steps.push(at.same_before ? `${id}[${at.same_before}]` : id);
    }
    return steps.reverse().join('/');
}
