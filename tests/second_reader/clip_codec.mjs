// Codec 6: codecs.md, "6: clip". The plain form of a PACK's numbers, and the payload that follows from it.

import { joints_of, kNumbers, segments_of } from './packed.mjs';

const kMostPlain = 128;
const kMostBits = 24;

function unzigzag(z) {
    return (z >>> 1) ^ -(z & 1);
}

/** The number x[k] that the predictor expects, modulo 2^32 as all arithmetic here. */
function prediction(predictor, x, k) {
    if (k === 1 || predictor === 0) return x[k - 1];
    const d = (x[k - 1] - x[k - 2]) | 0;
    if (predictor === 3) return (x[k - 1] + (d >> 1)) | 0;
    if (predictor === 1 || k < 3) return (x[k - 1] + d) | 0;
    return (x[k - 1] + 2 * d - ((x[k - 2] - x[k - 3]) | 0)) | 0;
}

/** Puts numbers of some bits each into bytes, lowest bit first. */
class BitWriter {
    constructor(out) {
        this.out = out;
        this.held = 0;
        this.count = 0;
    }
    bits(value, width) {
        this.held += value * 2 ** this.count;
        for (this.count += width; this.count >= 8; this.count -= 8) {
            this.out.push(this.held % 256);
            this.held = Math.floor(this.held / 256);
        }
    }
    end_of_frame() {
        if (this.count > 0) this.bits(0, 8 - this.count);
    }
}

function push_number(out, value, is_wide) {
    out.push(value & 0xff, (value >> 8) & 0xff);
    if (is_wide) out.push((value >> 16) & 0xff, (value >> 24) & 0xff);
}

/** The payload of a PACK from the body of codec 6. */
export function decode_clip(start, body, unzstd, refuse_unless) {
    refuse_unless(body.length >= 4, 'short body');
    const plain_size = new DataView(body.buffer, body.byteOffset).getUint32(0, true);
    refuse_unless(plain_size <= kMostPlain * body.length, 'ratio');
    const plain = unzstd(Uint8Array.from([0x28, 0xb5, 0x2f, 0xfd, ...body.subarray(4)]), plain_size);
    const view = new DataView(plain.buffer, plain.byteOffset, plain.length);
    let at = 0;
    const take = (count) => {
        refuse_unless(count <= plain.length - at, 'the plain form is short');
        at += count;
        return plain.subarray(at - count, at);
    };
    const table = (count) => {
        const planes = take(1)[0];
        refuse_unless(planes <= 4, 'planes of a table');
        const bytes = take(planes * count);
        return Array.from({ length: count }, (_, k) => {
            let z = 0;
            for (let p = 0; p < planes; ++p) z |= bytes[p * count + k] << (8 * p);
            return unzigzag(z >>> 0);
        });
    };
    const head = take(20);
    const record = {
        frames: view.getUint32(0, true), frameRate: view.getFloat32(8, true), joints: view.getUint16(12, true),
        segmentFrames: view.getUint16(14, true), lists: plain[16], wide: plain[17],
    };
    refuse_unless(record.frames >= 1, 'no frames');
    const masks = kNumbers.map((_, list) =>
        (record.lists >> list) & 1 ? take((record.joints + 7) >> 3) : new Uint8Array(0));
    const joints = masks.map((mask) => joints_of(mask, record.joints));
    refuse_unless(joints.every((list) => list !== null), 'bits of no joint');
    const numbers = (list) => joints[list].length * kNumbers[list];
    const is_animated = [1, 3, 5, 7].some((list) => joints[list].length > 0);
    refuse_unless(!is_animated || record.frames >= 2, 'one frame');
    const times = record.frameRate === 0 ? take(4 * record.frames) : new Uint8Array(0);
    const before = [160, 160, 160];
    const steps = kNumbers.map((each, list) => {
        const path = list < 2 ? 0 : list < 4 ? 1 : 2;
        return Array.from(take(numbers(list)), (step) => (before[path] = (before[path] + step) & 0xff));
    });
    const split = (all, lists) => {
        let from = 0;
        return Object.fromEntries(lists.map((list) => [list, all.slice(from, (from += numbers(list)))]));
    };
    const total = (lists) => lists.reduce((sum, list) => sum + numbers(list), 0);
    const constants = split(table(total([0, 2, 4, 6])), [0, 2, 4, 6]);
    const components = total([1, 3, 5, 7]);
    const firsts = table(components);
    const heads = take(components);
    refuse_unless(heads.every((byte) => byte >> 2 >= 1 && byte >> 2 <= 4), 'planes of a component');
    const residuals = Array.from({ length: components }, () => new Uint32Array(is_animated ? record.frames - 1 : 0));
    for (let p = 0; p < 4; ++p)
        for (let c = 0; c < components; ++c) {
            if (heads[c] >> 2 <= p) continue;
            const plane = take(record.frames - 1);
            for (let k = 0; k < plane.length; ++k) residuals[c][k] |= plane[k] << (8 * p);
        }
    refuse_unless(at === plain.length, 'bytes behind the planes');
    const samples = split(firsts.map((first, c) => {
        const x = new Int32Array(record.frames);
        x[0] = first;
        for (let k = 1; k < record.frames; ++k)
            x[k] = unzigzag(residuals[c][k - 1]) + prediction(heads[c] & 3, x, k);
        return x;
    }), [1, 3, 5, 7]);

    const out = [...head];
    for (const mask of masks) out.push(...mask);
    const by_number = (list, visit) => {
        for (let n = 0; n < kNumbers[list]; ++n)
            for (let t = 0; t < joints[list].length; ++t) visit(t * kNumbers[list] + n);
    };
    for (let list = 0; list < 8; ++list) by_number(list, (k) => out.push(steps[list][k]));
    refuse_unless(view.getUint16(18, true) === 0, 'reserved bytes of the record');
    refuse_unless(joints.every((list, k) => (list.length > 0) === (((record.lists >> k) & 1) === 1)), 'a list without joints');
    const is_wide = (list) => ((record.wide >> list) & 1) === 1;
    let wide = 0; // as the bases need it
    const note_base = (list, base) => (wide |= base !== (base << 16) >> 16 ? 1 << list : 0);
    for (const list of [0, 2, 4, 6]) for (const number of constants[list]) note_base(list, number);
    for (const list of [0, 2, 4, 6]) by_number(list, (k) => push_number(out, constants[list][k], is_wide(list)));
    for (const byte of times) out.push(byte);
    const segments = segments_of(record, is_animated);
    let table_at = out.length;
    if (segments.length > 1) for (let k = 0; k < 4 * segments.length; ++k) out.push(0);
    for (const [first, last] of segments) {
        if (segments.length > 1) {
            for (let b = 0; b < 4; ++b) out[table_at + b] = (out.length >>> (8 * b)) & 0xff;
            table_at += 4;
        }
        write_segment(out, { joints, samples, by_number, is_wide, note_base, refuse_unless }, first, last);
        refuse_unless(out.length <= start.size, 'the payload is longer than it should be');
    }
    refuse_unless(wide === record.wide, 'wide is not what the bases need');
    out.push(0, 0, 0, 0);
    refuse_unless(out.length === start.size, 'the payload has another size');
    return Uint8Array.from(out);
}

function write_segment(out, clip, first, last) {
    const { joints, samples, by_number, is_wide, note_base, refuse_unless } = clip;
    const packed = {};
    for (const list of [1, 3, 5, 7]) {
        const bases = [], widths = [];
        samples[list].forEach((x, c) => {
            let low = x[first], high = x[first];
            for (let k = first; k <= last; ++k) {
                low = Math.min(low, x[k]);
                high = Math.max(high, x[k]);
            }
            bases[c] = low;
            note_base(list, low);
            widths[c] = high === low ? 0 : 32 - Math.clz32(high - low);
        });
        const each = kNumbers[list];
        for (let t = 0; t < joints[list].length; ++t)
            if (widths.slice(t * each, (t + 1) * each).every((width) => width === 0)) widths[t * each] = 1;
        refuse_unless(widths.every((width) => width <= kMostBits), 'a width');
        packed[list] = { bases, widths };
        by_number(list, (c) => out.push(widths[c]));
        by_number(list, (c) => push_number(out, bases[c], is_wide(list)));
    }
    const frame = new BitWriter(out);
    for (let k = first; k <= last; ++k) {
        for (const list of [1, 3, 5, 7]) {
            const each = kNumbers[list];
            for (let t = 0; t < joints[list].length; t += 8)
                for (let n = 0; n < each; ++n)
                    for (let i = t; i < Math.min(t + 8, joints[list].length); ++i) {
                        const c = i * each + n;
                        frame.bits(samples[list][c][k] - packed[list].bases[c], packed[list].widths[c]);
                    }
        }
        frame.end_of_frame();
    }
}
