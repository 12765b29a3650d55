// Packed tracks: chunks/PACK.md. The layout of a payload, and the numbers in it.

/** Numbers of a track of each list. */
export const kNumbers = [3, 3, 3, 3, 1, 1, 3, 3];

/** What a track of each list animates, as TRAK's path. */
export const kPaths = [1, 1, 0, 0, 2, 2, 2, 2];

/** First and last frame of each segment. */
export function segments_of(record, is_animated) {
    if (!is_animated) return [];
    if (record.segmentFrames === 0) return [[0, record.frames - 1]];
    const count = Math.floor((record.frames - 2) / record.segmentFrames) + 1;
    return Array.from({ length: count }, (_, s) => [
        s * record.segmentFrames,
        s + 1 === count ? record.frames - 1 : (s + 1) * record.segmentFrames,
    ]);
}

/** Joints of a list, from its bits; null if bits past the joints are set. */
export function joints_of(bits, joints) {
    const list = [];
    for (let j = 0; j < bits.length * 8; ++j) {
        if (!((bits[j >> 3] >> (j & 7)) & 1)) continue;
        if (j >= joints) return null;
        list.push(j);
    }
    return list;
}
