// A whole file: grammar, sums, then all rules. What diagnostics.md promises to report, in its order.

import { decode } from './codecs.mjs';
import { sum_of, stored_payload } from './crc32c.mjs';
import { check_clip } from './check_clips.mjs';
import { check_bound, check_counts, check_material, check_texts, check_textures, check_version } from './check_file.mjs';
import { check_collapse, check_submeshes, check_mesh, check_ranges } from './check_meshes.mjs';
import { check_rig } from './check_rig.mjs';
import { check_tree } from './tree_rules.mjs';
import { path_of, walk } from './walk.mjs';

/** Codes of what is held against values alone, the last step of the checks. */
const kValueCodes = new Set(['COUNT_MISMATCH', 'LINK_CONTROL', 'NOT_FINITE', 'WEIGHT_RANGE', 'WEIGHT_SUM', 'FRACTION_RANGE', 'BELOW_ZERO',
    'LIMIT_ORDER', 'LIMIT_RANGE', 'REST_OUTSIDE', 'KEY_ORDER', 'KEY_OVERLAP', 'TRACK_REPEATED', 'ROTATION_NOT_UNIT',
    'CLIP_LENGTH', 'MARKER_ORDER', 'MARKER_OUTSIDE', 'CURVE_ORDER',
    'CURVE_REPEATED', 'COLLAPSE_TARGET', 'COLLAPSE_LEVEL']);

/** A file that is being checked: its chunks, its faults, and what has been counted. */
class CheckedFile {
    constructor(read, bytes, chunks, faults) {
        Object.assign(this, { read, bytes, chunks, faults, head: chunks[0], derived_bytes: 0 });
        this.counts = { objects: 0, joints: 0, meshes: 0, vertices: 0, clips: 0, materials: 0, textures: 0 };
        this.payloads = new Map();
        this.damaged_frames = []; // offsets of leaves
    }
    add(code, chunk) {
        this.faults.push({ code, path: path_of(chunk), offset: chunk.offset });
    }
    /** The children of this id that stand where they may. */
    children(chunk, id) {
        return chunk.children.filter((child) => child.meant && child.id === id);
    }
    child(chunk, id) {
        return chunk.children.find((child) => child.id === id && child.meant) ?? null;
    }
    /** A leaf's payload, decoded; null where it cannot be, which is reported once. */
    payload(chunk) {
        if (!chunk) return null;
        if (!this.payloads.has(chunk)) {
            let result = { payload: stored_payload(this.bytes, chunk) };
            if (chunk.codec !== 0) result = decode(this.read, chunk.codec, result.payload);
            if (result.code) this.add(result.code, chunk);
            if (result.in_frame) this.damaged_frames.push(chunk.offset);
            this.payloads.set(chunk, result.payload ?? null);
        }
        return this.payloads.get(chunk);
    }
    /** The record at a payload's start; null if there is no chunk or too few bytes, which is reported. */
    record(chunk, type, shortest, whole = shortest) {
        const payload = this.payload(chunk);
        if (!payload) return null;
        if (payload.length < shortest || (payload.length > shortest && payload.length < whole)) {
            this.add('RECORD_TOO_SHORT', chunk);
            return null;
        }
        return this.read.record(type, payload.subarray(0, payload.length < whole ? shortest : whole));
    }
    /** The same, reporting nothing. */
    peek(chunk, type, shortest, whole) {
        const payload = this.payload(chunk);
        if (!payload || payload.length < shortest || (payload.length > shortest && payload.length < whole)) return null;
        return this.read.record(type, payload.subarray(0, payload.length < whole ? shortest : whole));
    }
    /** True if the tree, a record or a reference is at fault. */
    has_fault_before_values() {
        return this.faults.some(({ code }) => !kValueCodes.has(code) && code !== 'SUM_MISMATCH');
    }
    /** True if there is a chunk of this id, readable or not: then it is not missing. */
    has(chunk, id) {
        return chunk.children.some((child) => child.id === id);
    }
    /** All that the payload holds, by the grammar. */
    body(chunk) {
        return this.read.payload(chunk.id, this.payload(chunk));
    }
}

function check_object(file, object) {
    const rig = check_rig(file, object);
    const meshes = file.children(object, 'VECT').map((mesh) => check_mesh(file, mesh, rig.joints.length));
    const ranges = check_submeshes(file, rig, meshes);
    check_collapse(file, object, meshes);
    const clips = file.children(object, 'CYCL');
    for (const clip of clips) check_clip(file, clip, rig, meshes);
    if (!file.has_fault_before_values()) check_ranges(file, ranges, meshes);
    file.counts.objects += 1;
    file.counts.meshes += meshes.length;
    file.counts.clips += clips.length;
}

/** { faults: [{ code, path, offset }], file, chunks }; file is null if the walk ended early. */
export function read_file(read, bytes) {
    const faults = [];
    const { chunks, fault } = walk(read, bytes);
    if (fault) {
        faults.push(fault);
        return { faults, file: null, chunks };
    }
    const file = new CheckedFile(read, bytes, chunks, faults);
    for (const chunk of chunks) if (chunk.sum !== sum_of(bytes, chunk)) file.add('SUM_MISMATCH', chunk);
    check_tree(chunks, (code, chunk) => file.add(code, chunk));
    check_version(file);
    check_bound(file);
    check_textures(file);
    check_texts(file);
    for (const material of file.children(file.head, 'MATE')) check_material(file, material);
    for (const object of file.children(file.head, 'OBJE')) check_object(file, object);
    check_counts(file);
    return { faults, file, chunks };
}
