// CRC-32C of RFC 3720, appendix B.4, a byte at a time; and the nested sums of grammar.md.

const table = new Uint32Array(256).map((_, byte) => {
    for (let bit = 0; bit < 8; ++bit) byte = (byte >>> 1) ^ (byte & 1 ? 0x82f63b78 : 0);
    return byte >>> 0;
});

/** The CRC of several pieces, one after another. */
export function crc32c(...pieces) {
    let crc = 0xffffffff;
    for (const piece of pieces)
        for (let k = 0; k < piece.length; ++k) crc = table[(crc ^ piece[k]) & 0xff] ^ (crc >>> 8);
    return (crc ^ 0xffffffff) >>> 0;
}

/** What the sum of a chunk of walk() should be, from the stored sums of its children. */
export function sum_of(bytes, chunk) {
    const head = [bytes.subarray(chunk.offset, chunk.offset + 4), bytes.subarray(chunk.offset + 8, chunk.offset + 16)];
    if (!chunk.is_container) return crc32c(...head, stored_payload(bytes, chunk));
    return crc32c(...head, ...chunk.children.map((child) => bytes.subarray(child.offset + 4, child.offset + 8)));
}

/** A leaf's payload as it lies in the file. */
export function stored_payload(bytes, chunk) {
    return bytes.subarray(chunk.offset + 16, chunk.offset + 16 + chunk.size);
}

/** Writes the sums that the bytes ask for, children first. */
export function repair_sums(bytes, chunks) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
    for (let k = chunks.length; k-- > 0; ) view.setUint32(chunks[k].offset + 4, sum_of(bytes, chunks[k]), true);
}
