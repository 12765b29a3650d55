// f32 arithmetic and what numbers may be.

export const kNone = 0xffffffff;
export const kLocal = 0x80000000;
export const kUnitTolerance = 1e-4;
export const kWeightTolerance = 1e-5;
export const f32 = Math.fround;

export function all_finite(numbers) {
    for (const number of numbers) if (!Number.isFinite(number)) return false;
    return true;
}

/** Minimum and step of each component, as a box has them one behind the other. */
export function sides_of(box) {
    return Array.from({ length: box.length / 2 }, (_, k) => ({ minimum: box[2 * k], step: box[2 * k + 1] }));
}

export function is_unit(q) {
    return Math.abs(Math.sqrt(q.reduce((sum, x) => sum + x * x, 0)) - 1) <= kUnitTolerance;
}

export function all_zero(bytes) {
    return bytes.every((byte) => byte === 0);
}

export function is_utf8(bytes) {
    try {
        new TextDecoder('utf-8', { fatal: true, ignoreBOM: true }).decode(bytes);
        return true;
    } catch {
        return false;
    }
}
