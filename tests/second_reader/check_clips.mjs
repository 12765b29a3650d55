// Rules of clips: CINF, TRAK, TIME, KEYV, PACK, PLAY, MARK and CURV.

import { all_finite, all_zero, is_unit, is_utf8, kNone } from './numbers.mjs';
import { joints_of, kNumbers, kPaths, segments_of } from './packed.mjs';

const kCubic = 2;
const kRotation = 1;
const kWeights = 3;
/** CINF.md: of a frame; and of a clip's length. */
const kFrameTolerance = 1e-3;
const kLengthTolerance = 1e-6;

/** The numbers of TIME or KEYV; empty if there are none, null if they cannot be read. */
function read_floats(file, chunk) {
    if (!chunk) return [];
    const payload = file.payload(chunk);
    if (!payload) return null;
    if (payload.length % 4 !== 0) {
        file.add('RECORD_SIZE', chunk);
        return null;
    }
    const { values } = file.body(chunk);
    if (!all_finite(values)) file.add('NOT_FINITE', chunk);
    return values;
}

function read_info(file, clip) {
    const chunk = file.child(clip, 'CINF');
    const record = file.record(chunk, 'ClipRecord', 16);
    if (!record) return null;
    if (record.loop > 1) file.add('ENUM_RANGE', chunk);
    if (!all_zero(record.reserved)) file.add('RESERVED_FIELD', chunk);
    if (!all_finite([record.start, record.end, record.frameRate])) file.add('NOT_FINITE', chunk);
    if (!(record.end >= record.start && record.frameRate >= 0)) file.add('CLIP_LENGTH', chunk);
    return record;
}

/** The times of a track's keys; null if its keys are not there. Adds the track's faults at `chunk`. */
function times_of(file, chunk, track, info, times) {
    const out = [];
    if (track.firstTime === kNone) {
        if (!info) return null;
        if (!(info.frameRate > 0)) {
            file.add('KEY_RANGE', chunk);
            return null;
        }
        const spare = track.keys - 1 - (info.end - info.start) * info.frameRate;
        return { first: info.start, last: spare <= kFrameTolerance ? info.end : Infinity };
    }
    if (!times) return null;
    if (track.firstTime + track.keys > times.length) {
        file.add('KEY_RANGE', chunk);
        return null;
    }
    for (let k = 0; k < track.keys; ++k) out.push(times[track.firstTime + k]);
    if (out.some((time, k) => k > 0 && !(time > out[k - 1]))) file.add('KEY_ORDER', chunk);
    return { first: out[0], last: out[out.length - 1] };
}

function check_values(file, chunk, track, values) {
    const each = track.components * (track.interpolation === kCubic ? 3 : 1);
    const size = track.keys * each;
    if (!values) return null;
    if (track.firstValue + size > values.length) {
        file.add('KEY_RANGE', chunk);
        return null;
    }
    const own = values.slice(track.firstValue, track.firstValue + size);
    if (track.path === kRotation && track.interpolation !== kCubic) {
        for (let k = 0; k < own.length; k += 4)
            if (!is_unit(own.slice(k, k + 4))) {
                file.add('ROTATION_NOT_UNIT', chunk);
                break;
            }
    }
    return [track.firstValue, track.firstValue + size];
}

function check_overlap(file, chunk, ranges) {
    const sorted = ranges.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    let before = null;
    for (const range of sorted) {
        if (before && range[0] < before[1] && (range[0] !== before[0] || range[1] !== before[1])) file.add('KEY_OVERLAP', chunk);
        if (!before || range[1] > before[1]) before = range;
    }
}

/** Tracks of TRAK. Gives what they animate, with the chunk that says so. */
function check_tracks(file, clip, info, rig, meshes) {
    const chunk = file.child(clip, 'TRAK');
    const times = read_floats(file, file.child(clip, 'TIME'));
    const values = read_floats(file, file.child(clip, 'KEYV'));
    const animated = new Map();
    const payload = chunk && file.payload(chunk);
    if (!payload) return animated;
    if (payload.length % 24 !== 0) {
        file.add('RECORD_SIZE', chunk);
        return animated;
    }
    const ranges = [];
    for (const track of file.body(chunk).tracks) {
        if (track.path > 3 || track.interpolation > 2) {
            file.add('ENUM_RANGE', chunk);
            continue;
        }
        const is_weights = track.path === kWeights;
        if (track.target >= (is_weights ? meshes.length : rig.joints.length)) {
            file.add(is_weights ? 'MESH_RANGE' : 'JOINT_RANGE', chunk);
            continue;
        }
        const needed = is_weights ? meshes[track.target].targets : [3, 4, 3][track.path];
        const key = `${track.path} ${track.target}`;
        if (animated.has(key)) file.add('TRACK_REPEATED', chunk);
        animated.set(key, chunk);
        if (needed !== null && (track.components !== needed || needed === 0)) {
            file.add('TRACK_COMPONENTS', chunk);
            continue;
        }
        if (track.keys === 0) {
            file.add('KEY_RANGE', chunk);
            continue;
        }
        const span = times_of(file, chunk, track, info, times);
        const range = check_values(file, chunk, track, values);
        if (range) ranges.push(range);
        if (span && info && !(span.first >= info.start && span.last <= info.end)) file.add('CLIP_LENGTH', file.child(clip, 'CINF'));
    }
    check_overlap(file, chunk, ranges);
    return animated;
}

/** PLAY.md. */
function check_plays(file, clip, info, meshes, animated) {
    const chunk = file.child(clip, 'PLAY');
    const payload = chunk && file.payload(chunk);
    if (!payload || !info) return;
    if (payload.length % 16 !== 0) {
        file.add('RECORD_SIZE', chunk);
        return;
    }
    const played = new Set();
    for (const play of file.body(chunk).plays) {
        if (!all_zero(play.reserved)) file.add('RESERVED_FIELD', chunk);
        if (play.closed > 1) {
            file.add('ENUM_RANGE', chunk);
            continue;
        }
        if (play.mesh >= meshes.length) {
            file.add('MESH_RANGE', chunk);
            continue;
        }
        const { frames } = meshes[play.mesh];
        if (frames === null) continue;
        if (play.frames === 0 || play.first + play.frames > frames || !(info.frameRate > 0)) {
            file.add('FRAME_RANGE', chunk);
            continue;
        }
        if (played.has(play.mesh) || animated.has(`${kWeights} ${play.mesh}`)) file.add('TRACK_REPEATED', chunk);
        played.add(play.mesh);
        const spare = play.frames - 1 + play.closed - (info.end - info.start) * info.frameRate;
        if (!(spare <= kFrameTolerance)) file.add('CLIP_LENGTH', file.child(clip, 'CINF'));
    }
}

/** The code of what is wrong with a PACK's layout, or { record, joints } of good ones. */
export function read_packed(payload, record) {
    const view = new DataView(payload.buffer, payload.byteOffset, payload.length);
    let at = 20;
    const left = () => payload.length - at;
    const masks = [];
    for (let list = 0; list < 8; ++list) {
        const bytes = (record.lists >> list) & 1 ? (record.joints + 7) >> 3 : 0;
        if (bytes > left()) return { code: 'RECORD_SIZE' };
        masks.push(payload.subarray(at, at + bytes));
        at += bytes;
    }
    const joints = masks.map((mask) => joints_of(mask, record.joints));
    if (joints.some((list) => list === null)) return { code: 'JOINT_RANGE' };
    const numbers = joints.map((list, k) => list.length * kNumbers[k]);
    const base = (list) => ((record.wide >> list) & 1 ? 4 : 2);
    const is_animated = [1, 3, 5, 7].some((list) => numbers[list] > 0);
    if (record.frames < (is_animated ? 2 : 1)) return { code: 'KEY_RANGE' };
    at += numbers.reduce((sum, count) => sum + count, 0);
    at += [0, 2, 4, 6].reduce((sum, list) => sum + numbers[list] * base(list), 0);
    if (left() < 0) return { code: 'RECORD_SIZE' };
    let times = null;
    if (record.frameRate === 0) {
        if (4 * record.frames > left()) return { code: 'RECORD_SIZE' };
        times = Array.from({ length: record.frames }, (_, k) => view.getFloat32(at + 4 * k, true));
        at += 4 * record.frames;
    }
    const components = [1, 3, 5, 7].reduce((sum, list) => sum + numbers[list], 0);
    if (is_animated) {
        const count = record.segmentFrames === 0 ? 1 : Math.floor((record.frames - 2) / record.segmentFrames) + 1;
        if (count > left()) return { code: 'RECORD_SIZE' };
        const segments = segments_of(record, true);
        const table = at;
        if (count > 1) at += 4 * count;
        for (let s = 0; s < count; ++s) {
            if (count > 1 && (left() < 0 || view.getUint32(table + 4 * s, true) !== at)) return { code: 'COUNT_MISMATCH' };
            let bits = 0;
            if (components > left()) return { code: 'RECORD_SIZE' };
            for (const list of [1, 3, 5, 7]) {
                const each = kNumbers[list], n = joints[list].length;
                if (numbers[list] + numbers[list] * base(list) > left()) return { code: 'RECORD_SIZE' };
                for (let t = 0; t < n; ++t) {
                    let track_bits = 0;
                    for (let k = 0; k < each; ++k) {
                        const width = payload[at + k * n + t];
                        if (width > 24) return { code: 'ENUM_RANGE' };
                        track_bits += width;
                    }
                    if (track_bits === 0) return { code: 'ENUM_RANGE' };
                    bits += track_bits;
                }
                at += numbers[list] * (1 + base(list));
            }
            at += Math.ceil(bits / 8) * (segments[s][1] - segments[s][0] + 1);
            if (left() < 0) return { code: 'RECORD_SIZE' };
        }
    }
    if (left() !== 4) return { code: 'RECORD_SIZE' };
    if (!all_zero(payload.subarray(at))) return { code: 'RESERVED_FIELD' };
    return { joints, times };
}

function check_packed(file, clip, info, rig, animated) {
    const chunk = file.child(clip, 'PACK');
    const record = file.record(chunk, 'PackRecord', 20);
    if (!record) return;
    const add = (code) => file.add(code, chunk);
    if (record.joints > rig.joints.length) return add('JOINT_RANGE');
    if (!all_zero(record.reserved) || (record.wide & ~record.lists) !== 0) return add('RESERVED_FIELD');
    const packed = read_packed(file.payload(chunk), record);
    if (packed.code) return add(packed.code);
    if (!all_finite([record.start, record.frameRate])) add('NOT_FINITE');
    if (record.frameRate < 0) add('BELOW_ZERO');
    let last = record.start + (record.frames - 1) / record.frameRate;
    if (packed.times) {
        const { times } = packed;
        if (!all_finite(times)) add('NOT_FINITE');
        else if (times[0] !== record.start || times.some((time, k) => k > 0 && !(time > times[k - 1]))) add('KEY_ORDER');
        last = times[times.length - 1];
    }
    const length = info ? Math.max(info.end - info.start, Math.abs(info.end), 1e-3) : 0;
    if (info && !(record.start >= info.start && last <= info.end + kLengthTolerance * length)) file.add('CLIP_LENGTH', file.child(clip, 'CINF'));
    packed.joints.forEach((joints, list) => {
        for (const joint of joints) {
            const key = `${kPaths[list]} ${joint}`;
            if (animated.has(key)) file.add('TRACK_REPEATED', animated.get(key));
            animated.set(key, chunk);
        }
    });
}

/** MARK.md: names fill what is behind the records, one behind the other. */
function check_markers(file, clip, info) {
    const chunk = file.child(clip, 'MARK');
    const record = file.record(chunk, 'MarkersRecord', 8);
    if (!record) return;
    const add = (code) => file.add(code, chunk);
    if (record.reserved !== 0) add('RESERVED_FIELD');
    const payload = file.payload(chunk);
    const names_at = 8 + 8 * record.markers;
    if (names_at > payload.length) return add('RECORD_SIZE');
    const view = new DataView(payload.buffer, payload.byteOffset, payload.length);
    const markers = Array.from({ length: record.markers }, (_, k) => ({
        seconds: view.getFloat32(8 + 8 * k, true), end: names_at + view.getUint32(12 + 8 * k, true),
    }));
    const begin = (k) => (k === 0 ? names_at : markers[k - 1].end);
    if (markers.some(({ end }, k) => end < begin(k) || end > payload.length)) return add('MARKER_NAME');
    if (begin(markers.length) !== payload.length) return add('RECORD_SIZE');
    if (markers.some(({ end }, k) => !is_utf8(payload.subarray(begin(k), end)))) return add('NOT_UTF8');
    if (!all_finite(markers.map(({ seconds }) => seconds))) add('NOT_FINITE');
    if (markers.some(({ seconds }, k) => k > 0 && !(seconds >= markers[k - 1].seconds))) add('MARKER_ORDER');
    if (info && markers.some(({ seconds }) => !(seconds >= info.start && seconds <= info.end))) add('MARKER_OUTSIDE');
}

/** CURV.md: a curve's faults; gives what it animates, if it can be read and has a path. */
function check_curve(file, chunk, clip, info, rig, meshes) {
    const record = file.record(chunk, 'CurveRecord', 32);
    if (!record) return null;
    const add = (code) => file.add(code, chunk);
    if (record.reserved !== 0) add('RESERVED_FIELD');
    if (record.interpolation > 2 || record.packed > 1 || record.kind > 4) return add('ENUM_RANGE');
    const is_cubic = record.interpolation === kCubic;
    const values = record.keys * record.components * (is_cubic ? 3 : 1);
    const has_shape = record.keys > 0 && record.components >= 1 && record.components <= 4 && record.values === values;
    if (!has_shape || (is_cubic && record.packed === 1)) return add('CURVE_SHAPE');
    const box = record.packed === 1 ? 8 * record.components : 0;
    const size = 32 + box + 4 * record.keys + (record.packed === 1 ? 2 : 4) * values + record.pathSize + record.nameSize;
    if (file.payload(chunk).length !== size) return add('RECORD_SIZE');
    const count = [0, rig.joints.length, file.children(file.head, 'MATE').length, meshes.length, file.counts.textures][record.kind];
    const none = record.kind === 0 && record.target === kNone;
    if (!none && record.target >= count)
        return add(['INDEX_RANGE', 'JOINT_RANGE', 'MATERIAL_RANGE', 'MESH_RANGE', 'TEXTURE_RANGE'][record.kind]);
    const payload = file.payload(chunk);
    const name_at = size - record.nameSize;
    const path = payload.subarray(name_at - record.pathSize, name_at);
    if (!is_utf8(path) || !is_utf8(payload.subarray(name_at))) return add('NOT_UTF8');
    const body = file.body(chunk);
    const numbers = [record.maxError, ...(body.box ?? []), ...body.times, ...(record.packed === 1 ? [] : body.keyValues)];
    if (!all_finite(numbers)) add('NOT_FINITE');
    if (record.maxError < 0) add('BELOW_ZERO');
    if (body.times.some((time, k) => k > 0 && !(time > body.times[k - 1]))) add('CURVE_ORDER');
    const last = body.times[body.times.length - 1];
    if (info && !(body.times[0] >= info.start && last <= info.end)) file.add('CLIP_LENGTH', file.child(clip, 'CINF'));
    return path.length > 0 ? `${record.kind} ${record.target} ${body.path}` : null;
}

function check_curves(file, clip, info, rig, meshes) {
    const animated = new Set();
    for (const chunk of file.children(clip, 'CURV')) {
        const what = check_curve(file, chunk, clip, info, rig, meshes);
        if (what && animated.has(what)) file.add('CURVE_REPEATED', chunk);
        if (what) animated.add(what);
    }
}

export function check_clip(file, clip, rig, meshes) {
    const info = read_info(file, clip);
    const animated = check_tracks(file, clip, info, rig, meshes);
    check_plays(file, clip, info, meshes, animated);
    check_packed(file, clip, info, rig, animated);
    check_markers(file, clip, info);
    check_curves(file, clip, info, rig, meshes);
}
