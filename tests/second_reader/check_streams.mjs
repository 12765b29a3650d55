// Rules of streams.md, and of the chunks that are streams.

import { all_finite, all_zero, f32, kWeightTolerance, sides_of } from './numbers.mjs';

const kTypes = ['u8', 'i8', 'u16', 'i16', 'u32', 'f32'];
const kBytes = [1, 1, 2, 2, 4, 4];
const kBoxed = 2;
const kListed = 3;

/** "What each chunk may hold": parent, chunk, types, components, numbers (0 plain, 1 normalised, 2 boxed, 3 listed). */
const kForms = [
    ['VECT', 'POSI', 'f32', 3, 3, 0], ['VECT', 'POSI', 'u8 u16 u32', 3, 3, 2],
    ['VECT', 'NORM', 'f32', 3, 3, 0], ['VECT', 'NORM', 'i8 i16', 2, 2, 1], ['VECT', 'NORM', 'u8', 1, 1, 3],
    ['VECT', 'TANG', 'f32', 4, 4, 0], ['VECT', 'TANG', 'i8 i16', 3, 3, 1],
    ['VECT', 'TEXC', 'f32', 2, 2, 0], ['VECT', 'TEXC', 'u8 u16', 2, 2, 1], ['VECT', 'TEXC', 'u8 u16', 2, 2, 2],
    ['VECT', 'COLR', 'f32', 3, 4, 0], ['VECT', 'COLR', 'u8 u16', 3, 4, 1], ['VECT', 'COLR', 'u8 u16', 3, 4, 2],
    ['VECT', 'BONE', 'u8 u16', 1, 1024, 0],
    ['VECT', 'WGHT', 'f32', 1, 1024, 0], ['VECT', 'WGHT', 'u8 u16', 1, 1024, 1], ['VECT', 'WGHT', 'u8 u16', 1, 1024, 2],
    ['VECT', 'INDX', 'u16 u32', 1, 1, 0],
    ['USER', 'VALS', 'u8 i8 u16 i16 u32 f32', 1, 65535, 0], ['USER', 'VALS', 'u8 i8 u16 i16', 1, 65535, 1],
    ['TARG', 'INDX', 'u16 u32', 1, 1, 0],
    ['TARG', 'POSI', 'f32', 3, 3, 0], ['TARG', 'POSI', 'u8 i8 u16 i16', 3, 3, 2],
    ['TARG', 'NORM', 'f32', 3, 3, 0], ['TARG', 'NORM', 'u8 i8 u16 i16', 3, 3, 2],
    ['TARG', 'TANG', 'f32', 3, 3, 0], ['TARG', 'TANG', 'u8 i8 u16 i16', 3, 3, 2],
    ['FRMS', 'INDX', 'u8 u16 u32', 1, 1, 0], ['FRMS', 'POSI', 'u8 u16', 3, 3, 0], ['FRMS', 'NORM', 'u8', 1, 1, 3],
];

function form_fits(chunk, record) {
    return kForms.some(([parent, id, types, least, most, numbers]) =>
        parent === chunk.parent.id && id === chunk.id && types.split(' ').includes(kTypes[record.componentType])
        && record.components >= least && record.components <= most && record.normalised === numbers);
}

function check_box(file, chunk, stream) {
    if (!all_zero(stream.boxZeros)) file.add('RESERVED_FIELD', chunk);
    const largest = kTypes[stream.record.componentType] === 'u32' ? 2 ** 32 : 65536;
    const ends = sides_of(stream.box).flatMap((side) => [side.minimum, side.step, f32(side.minimum + f32(largest * side.step))]);
    if (!all_finite(ends)) file.add('NOT_FINITE', chunk);
}

/** A stream's record, box and values; null if it is not there or cannot be used. `list`: how many normals NLST has. */
export function read_stream(file, chunk, elements, list = null) {
    const record = file.record(chunk, 'StreamRecord', 16);
    if (!record) return null;
    if (record.componentType > 5 || record.normalised > 3) {
        file.add('ENUM_RANGE', chunk);
        return null;
    }
    if (record.reserved !== 0) file.add('RESERVED_FIELD', chunk);
    if (!form_fits(chunk, record)) {
        file.add('STREAM_TYPE', chunk);
        return null;
    }
    if (record.set !== 0 && chunk.id !== 'TEXC' && chunk.id !== 'COLR') {
        file.add('STREAM_SET', chunk);
        return null;
    }
    if (elements !== null && record.elements !== elements) {
        file.add('STREAM_COUNT', chunk);
        return null;
    }
    const box = record.normalised === kBoxed ? Math.ceil(record.components / 2) * 16 : 0;
    const size = 16 + box + record.elements * record.components * kBytes[record.componentType];
    if (file.payload(chunk).length !== size) {
        file.add('RECORD_SIZE', chunk);
        return null;
    }
    const stream = file.body(chunk);
    if (record.normalised === kListed) {
        if (list === null) return null;
        if (stream.values.some((number) => number >= list)) {
            file.add('INDEX_RANGE', chunk);
            return null;
        }
    }
    if (box) check_box(file, chunk, stream);
    if (kTypes[record.componentType] === 'f32' && !all_finite(stream.values)) file.add('NOT_FINITE', chunk);
    return stream;
}

/** Sets of TEXC or COLR: each once. */
export function check_sets(file, chunks, streams) {
    const sets = new Set();
    streams.forEach((stream, k) => {
        if (!stream) return;
        if (sets.has(stream.record.set)) file.add('STREAM_SET', chunks[k]);
        sets.add(stream.record.set);
    });
}

/** What the stream's integers stand for, in f32. */
function meaning_of(stream) {
    const { componentType, normalised, components } = stream.record;
    if (normalised === kBoxed) {
        const sides = sides_of(stream.box);
        return (number, at) => {
            const { minimum, step } = sides[at % components];
            return f32(minimum + f32(step * number));
        };
    }
    const largest = { 0: 255, 1: 127, 2: 65535, 3: 32767 }[componentType];
    if (normalised === 1 && largest) return (number) => f32(Math.max(number / largest, -1));
    return (number) => number;
}

/** The weights of a vertex are not below 0 and sum to 1. */
export function check_weights(file, chunk, stream) {
    const { components, elements } = stream.record;
    const meaning = meaning_of(stream);
    for (let v = 0; v < elements; ++v) {
        let sum = 0, is_below = false;
        for (let at = v * components; at < (v + 1) * components; ++at) {
            const weight = meaning(stream.values[at], at);
            is_below ||= weight < 0;
            sum += weight;
        }
        if (is_below) return file.add('WEIGHT_RANGE', chunk);
        if (!(Math.abs(sum - 1) <= kWeightTolerance)) return file.add('WEIGHT_SUM', chunk);
    }
}
