// Changed copies of good files, always the same ones for a seed. Most have sums that hold, so that what lies beneath them
// is what the readers look at.

import { repair_sums } from './crc32c.mjs';
import { walk } from './walk.mjs';

/** Numbers from 0 to 2^32 - 1, the same ones for a seed (splitmix32). */
export function make_random(seed) {
    let state = seed >>> 0;
    const next = () => {
        state = (state + 0x9e3779b9) >>> 0;
        let z = state;
        z = Math.imul(z ^ (z >>> 16), 0x21f0aaad);
        z = Math.imul(z ^ (z >>> 15), 0x735a2d97);
        return (z ^ (z >>> 15)) >>> 0;
    };
    return { below: (count) => next() % count, pick: (list) => list[next() % list.length] };
}

const kWords = [0, 1, 2, 3, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe, 0x3f800000, 0xbf800000, 0x7f800000,
    0xff800000, 0x7fc00000, 0x3f000000, 0x00ff00ff, 0x40490fdb];

/** The file as a tree of { id, flags, payload or children }, and back. */
function to_tree(bytes, chunks) {
    const nodes = new Map();
    for (const chunk of chunks) {
        const node = { id: chunk.id, flags: chunk.flags };
        if (chunk.is_container) node.children = [];
        else node.payload = bytes.slice(chunk.offset + 16, chunk.offset + 16 + chunk.size);
        nodes.set(chunk, node);
        if (chunk.parent) nodes.get(chunk.parent).children.push(node);
    }
    return nodes.get(chunks[0]);
}

function to_bytes(node) {
    const parts = node.children ? node.children.map(to_bytes) : [node.payload];
    const size = parts.reduce((sum, part) => sum + part.length, 0);
    const bytes = new Uint8Array(16 + size + ((16 - (size % 16)) % 16));
    for (let k = 0; k < 4; ++k) bytes[k] = node.id.charCodeAt(k);
    const view = new DataView(bytes.buffer);
    view.setUint32(8, size, true);
    view.setUint16(14, node.flags, true);
    let at = 16;
    for (const part of parts) {
        bytes.set(part, at);
        at += part.length;
    }
    return bytes;
}

function all_nodes(node, list = []) {
    list.push(node);
    for (const child of node.children ?? []) all_nodes(child, list);
    return list;
}

const copy_of = (node) =>
    node.children ? { ...node, children: node.children.map(copy_of) } : { ...node, payload: node.payload.slice() };

/** Changes of the tree: each takes its root, its nodes and random numbers. */
const tree_changes = {
    drop(root, nodes, random) {
        const parent = random.pick(nodes.filter((node) => node.children?.length));
        parent.children.splice(random.below(parent.children.length), 1);
    },
    double(root, nodes, random) {
        const parent = random.pick(nodes.filter((node) => node.children?.length));
        const at = random.below(parent.children.length);
        parent.children.splice(at, 0, copy_of(parent.children[at]));
    },
    move(root, nodes, random) {
        const parent = random.pick(nodes.filter((node) => node.children));
        const chunk = copy_of(random.pick(nodes.slice(1)));
        if (all_nodes(chunk).length < 40) parent.children.splice(random.below(parent.children.length + 1), 0, chunk);
    },
    swap(root, nodes, random) {
        const parent = random.pick(nodes.filter((node) => node.children?.length > 1));
        const [a, b] = [random.below(parent.children.length), random.below(parent.children.length)];
        [parent.children[a], parent.children[b]] = [parent.children[b], parent.children[a]];
    },
    rename(root, nodes, random) {
        const node = random.pick(nodes.slice(1));
        node.id = random.pick(['X001', 'MARK', random.pick(nodes).id]);
    },
    flag(root, nodes, random) {
        random.pick(nodes.slice(1)).flags ^= random.pick([2, 2, 0x100, 0x200, 0x600, 0x900]);
    },
    grow(root, nodes, random) {
        const leaf = random.pick(nodes.filter((node) => node.payload));
        const grown = new Uint8Array(leaf.payload.length + random.pick([1, 2, 4, 8, 16]));
        grown.set(leaf.payload);
        leaf.payload = grown;
    },
    shorten(root, nodes, random) {
        const leaf = random.pick(nodes.filter((node) => node.payload?.length));
        leaf.payload = leaf.payload.slice(0, Math.max(0, leaf.payload.length - random.pick([1, 2, 4, 8, 12, 16, 1000])));
    },
    splice(root, nodes, random) {
        const leaf = random.pick(nodes.filter((node) => node.payload?.length));
        const other = random.pick(nodes.filter((node) => node.payload?.length && node.id === leaf.id));
        leaf.payload = other.payload.slice();
    },
    word(root, nodes, random) {
        const leaf = random.pick(nodes.filter((node) => node.payload?.length >= 4));
        const at = random.below(Math.min(leaf.payload.length, random.pick([16, 64, 1 << 20])) >> 2) * 4;
        new DataView(leaf.payload.buffer).setUint32(at, random.pick(kWords), true);
    },
    byte(root, nodes, random) {
        const leaf = random.pick(nodes.filter((node) => node.payload?.length));
        const at = random.below(Math.min(leaf.payload.length, random.pick([24, 64, 1 << 20])));
        leaf.payload[at] = random.pick([0, 1, 2, 3, 4, 5, 7, 8, 127, 128, 254, 255, leaf.payload[at] + 1, leaf.payload[at] - 1]);
    },
    bit(root, nodes, random) {
        const leaf = random.pick(nodes.filter((node) => node.payload?.length));
        leaf.payload[random.below(leaf.payload.length)] ^= 1 << random.below(8);
    },
};

/** Changes of the bytes as they lie: each gives the changed ones. */
const byte_changes = {
    flip(bytes, random) {
        bytes[random.below(bytes.length)] ^= 1 << random.below(8);
        return bytes;
    },
    truncate: (bytes, random) => bytes.slice(0, random.below(bytes.length)),
    trail: (bytes, random) => Uint8Array.from([...bytes, ...new Uint8Array(random.pick([1, 16, 48]))]),
    header(bytes, random, chunks) {
        const chunk = random.pick(chunks);
        const at = chunk.offset + random.pick([0, 3, 4, 8, 9, 10, 13, 14, 15]);
        bytes[at] = random.pick([0, 1, 2, 4, 16, 255, bytes[at] + 1, bytes[at] - 1, bytes[at] + 16]);
        return bytes;
    },
};

/** A changed copy of `bytes`, which conform; says how it was changed. */
export function mutate(read, bytes, random) {
    const { chunks } = walk(read, bytes);
    if (random.below(5) === 0) {
        const how = random.pick(Object.keys(byte_changes));
        const changed = byte_changes[how](bytes.slice(), random, chunks);
        const again = walk(read, changed);
        if (!again.fault && random.below(4) !== 0) repair_sums(changed, again.chunks);
        return { how, bytes: changed };
    }
    const root = to_tree(bytes, chunks);
    const hows = [];
    do {
        const how = random.pick(Object.keys(tree_changes));
        tree_changes[how](root, all_nodes(root), random);
        hows.push(how);
    } while (random.below(4) === 0);
    const changed = to_bytes(root);
    const again = walk(read, changed);
    if (!again.fault) repair_sums(changed, again.chunks);
    return { how: hows.join(' '), bytes: changed };
}
