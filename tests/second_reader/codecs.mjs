// Encoded leaves: codecs.md. zstd frames and meshoptimizer's index format are decoded by packages, the rest here.

import { MeshoptDecoder } from 'meshoptimizer';
import { ZSTDDecoder } from 'zstddec';
import { decode_clip } from './clip_codec.mjs';

const kLargestRatio = 128;
const zstd = new ZSTDDecoder();

export const ready = Promise.all([zstd.init(), MeshoptDecoder.ready]);

/** Thrown where a body cannot be decoded. */
export class Damaged extends Error {}

/** Damage that only the zstd decoder can see: some of its releases see more of it than others. */
class DamagedFrame extends Damaged {}

function refuse_unless(good, why) {
    if (!good) throw new Damaged(why);
}

/** Bytes of a zstd frame from its first to its last, by RFC 8878, 3.1.1; and the content's size if the header has it. */
function frame_extent(frame) {
    const view = new DataView(frame.buffer, frame.byteOffset, frame.length);
    refuse_unless(frame.length >= 6 && view.getUint32(0, true) === 0xfd2fb528, 'no frame');
    const descriptor = frame[4];
    const is_single = (descriptor >> 5) & 1;
    const size_bytes = [is_single, 2, 4, 8][descriptor >> 6];
    const dictionary_bytes = [0, 1, 2, 4][descriptor & 3];
    let at = 5 + (is_single ? 0 : 1) + dictionary_bytes;
    refuse_unless(at + size_bytes <= frame.length, 'short frame');
    let content = null;
    if (size_bytes === 1) content = frame[at];
    if (size_bytes === 2) content = view.getUint16(at, true) + 256;
    if (size_bytes === 4) content = view.getUint32(at, true);
    if (size_bytes === 8) content = Number(view.getBigUint64(at, true));
    at += size_bytes;
    for (let is_last = false; !is_last; ) {
        refuse_unless(at + 3 <= frame.length, 'short frame');
        const block = frame[at] | (frame[at + 1] << 8) | (frame[at + 2] << 16);
        is_last = (block & 1) === 1;
        at += 3 + (((block >> 1) & 3) === 1 ? 1 : block >> 3);
    }
    return { bytes: at + (descriptor & 4 ? 4 : 0), content };
}

/** The content of one frame that fills `frame`, and of `size` bytes. */
function unzstd(frame, size) {
    const extent = frame_extent(frame);
    refuse_unless(extent.bytes === frame.length, 'the frame does not end with the body');
    refuse_unless(extent.content === null || extent.content === size, 'another size');
    const content = zstd.decode(frame, size + 1);
    if (content.length !== size) throw new DamagedFrame('the frame is damaged, or of another size');
    return content;
}

/** The content of a frame that states its size, at most `most` bytes. */
function unzstd_stated(frame, most) {
    const { content } = frame_extent(frame);
    refuse_unless(content !== null && content <= most, 'the size is not stated, or too large');
    return unzstd(frame, content);
}

/** Numbers of `stride` bytes from their planes: all first bytes, all second bytes, ... */
export function from_planes(planes, stride) {
    if (stride < 2) return planes;
    const out = Uint8Array.from(planes);
    const count = Math.floor(planes.length / stride);
    for (let b = 0; b < stride; ++b)
        for (let k = 0; k < count; ++k) out[k * stride + b] = planes[b * count + k];
    return out;
}

function decode_vertices(start, body, is_packed) {
    const { size, head, stride } = start;
    refuse_unless(stride >= 1 && stride <= 256 && head <= size && head <= body.length, 'head or stride');
    refuse_unless((size - head) % stride === 0, 'no whole number of rows');
    const count = (size - head) / stride;
    const wide = (stride + 3) & ~3;
    let packed = body.subarray(head);
    if (is_packed) packed = unzstd_stated(packed, kLargestRatio * (body.length + 16));
    refuse_unless(packed[0] === 0xa0, 'another version');
    const rows = new Uint8Array(count * wide);
    try {
        MeshoptDecoder.decodeVertexBuffer(rows, count, wide, packed);
    } catch (error) {
        throw new Damaged(error.message);
    }
    const out = new Uint8Array(size);
    out.set(body.subarray(0, head));
    for (let k = 0; k < count; ++k) out.set(rows.subarray(k * wide, k * wide + stride), head + k * stride);
    return out;
}

function decode_indices(start, body, is_packed) {
    const { size, head, stride } = start;
    refuse_unless((stride === 2 || stride === 4) && head <= size && head <= body.length, 'head or stride');
    refuse_unless((size - head) % (3 * stride) === 0, 'no whole number of triangles');
    let packed = body.subarray(head);
    if (is_packed) packed = unzstd_stated(packed, kLargestRatio * (body.length + 16));
    refuse_unless(packed[0] === 0xe1, 'another version');
    const out = new Uint8Array(size);
    out.set(body.subarray(0, head));
    try {
        MeshoptDecoder.decodeIndexBuffer(out.subarray(head), (size - head) / stride, stride, packed);
    } catch (error) {
        throw new Damaged(error.message);
    }
    return out;
}

function decode_sums(start, body) {
    const { size, head, stride } = start;
    refuse_unless(head <= size && head <= body.length && stride >= 2 && stride % 2 === 0, 'head or stride');
    refuse_unless((size - head) % stride === 0, 'no whole number of rows');
    const rows = from_planes(unzstd(body.subarray(head), size - head), stride);
    const view = new DataView(rows.buffer, rows.byteOffset, rows.length);
    for (let row = 0; row < rows.length; row += stride) {
        let first = view.getUint16(row, true);
        for (let at = row + 2; at < row + stride; at += 2) first -= view.getUint16(at, true);
        view.setUint16(row, first & 0xffff, true);
    }
    const out = new Uint8Array(size);
    out.set(body.subarray(0, head));
    out.set(rows, head);
    return out;
}

const decoders = {
    1: (start, body) => from_planes(unzstd(body, start.size), start.stride),
    2: (start, body) => decode_vertices(start, body, false),
    3: (start, body) => decode_vertices(start, body, true),
    4: (start, body) => decode_indices(start, body, false),
    5: (start, body) => decode_indices(start, body, true),
    6: (start, body) => decode_clip(start, body, unzstd, refuse_unless),
    7: decode_sums,
};

/** The decoded payload of an encoded leaf: { payload } or { code }. */
export function decode(read, codec, stored) {
    if (!(codec in decoders)) return { code: 'UNSUPPORTED_CODEC' };
    if (stored.length < 16) return { code: 'RECORD_TOO_SHORT' };
    const start = read.encoded(stored);
    if (start.reserved !== 0) return { code: 'RESERVED_FIELD' };
    if (start.size > kLargestRatio * stored.length) return { code: 'CODEC_RATIO' };
    if ((codec === 1 || codec === 6) && start.head !== 0) return { code: 'CODEC_DATA' };
    if (codec === 6 && start.stride !== 0) return { code: 'CODEC_DATA' };
    try {
        return { payload: decoders[codec](start, start.body) };
    } catch (error) {
        if (error instanceof Damaged) return { code: 'CODEC_DATA', in_frame: error instanceof DamagedFrame };
        throw error;
    }
}
