// Rules of meshes, palettes, targets, polygons and the collapse sequence.

import { check_sets, check_weights, read_stream } from './check_streams.mjs';
import { all_finite, all_zero, f32, is_utf8, kLocal, kNone, sides_of } from './numbers.mjs';

function check_palette(file, chunk, joints) {
    const record = file.record(chunk, 'PaletteRecord', 16);
    if (!record) return null;
    if (record.reserved.some((word) => word !== 0)) file.add('RESERVED_FIELD', chunk);
    if (record.derived > 1) {
        file.add('ENUM_RANGE', chunk);
        return null;
    }
    const matrices = record.derived === 1 ? 1 : record.entries;
    if (file.payload(chunk).length !== 16 + Math.ceil(record.entries / 4) * 16 + 64 * matrices) {
        file.add('RECORD_SIZE', chunk);
        return null;
    }
    if (record.derived === 1) {
        const most = 128 * file.bytes.length;
        if (file.derived_bytes <= most && file.derived_bytes + 64 * record.entries > most) file.add('CODEC_RATIO', chunk);
        file.derived_bytes += 64 * record.entries;
    }
    const palette = file.body(chunk);
    if (!all_zero(palette.jointsZeros)) file.add('RESERVED_FIELD', chunk);
    if (palette.joints.some((joint) => joint >= joints)) file.add('JOINT_RANGE', chunk);
    if (!all_finite(palette.matrices)) file.add('NOT_FINITE', chunk);
    return palette;
}

function check_target(file, target, vertices) {
    const info = file.child(target, 'TINF');
    const record = file.record(info, 'MorphTargetRecord', 4);
    if (record && !Number.isFinite(record.restWeight)) file.add('NOT_FINITE', info);
    const list = file.child(target, 'INDX');
    let touched = vertices;
    if (list) {
        const indices = read_stream(file, list, null);
        if (!indices) return;  // how many vertices the streams are for is unknown
        touched = indices.record.elements;
        if (indices.values.some((v) => v >= vertices)) file.add('INDEX_RANGE', list);
        if (indices.values.some((v, k) => k > 0 && v <= indices.values[k - 1])) file.add('TARGET_ORDER', list);
    }
    for (const id of ['POSI', 'NORM', 'TANG']) read_stream(file, file.child(target, id), touched);
}

/** NLST: how many normals there are; none without it, null where they cannot be read. */
function count_normals(file, mesh) {
    if (!file.has(mesh, 'NLST')) return 0;
    const chunk = file.child(mesh, 'NLST');
    const payload = chunk && file.payload(chunk);
    if (!payload) return null;
    if (payload.length % 12 !== 0) {
        file.add('RECORD_SIZE', chunk);
        return null;
    }
    if (!all_finite(file.body(chunk).values)) file.add('NOT_FINITE', chunk);
    return payload.length / 12;
}

/** FRMS.md: the number of frames; null where they cannot be read. */
function count_frames(file, block, vertices, normals) {
    for (const id of ['INDX', 'POSI']) if (!file.has(block, id)) file.add('CHUNK_MISSING', block);
    const chunk = file.child(block, 'GRID');
    const grid = chunk && file.payload(chunk);
    let count = null;
    if (grid && grid.length % 24 !== 0) file.add('RECORD_SIZE', chunk);
    else if (grid && grid.length === 0) file.add('RECORD_TOO_SHORT', chunk);
    else if (grid) count = grid.length / 24;
    const place_chunk = file.child(block, 'INDX');
    const places = read_stream(file, place_chunk, vertices);
    const positions = read_stream(file, file.child(block, 'POSI'), null);
    if (count === null || !places || !positions) return null;
    const { elements } = positions.record;
    if (elements % count !== 0) {
        file.add('STREAM_COUNT', file.child(block, 'POSI'));
        return null;
    }
    if (file.has(block, 'NORM') && !read_stream(file, file.child(block, 'NORM'), elements, normals)) return null;
    let is_good = true;
    if (places.values.some((place) => place >= elements / count)) {
        file.add('INDEX_RANGE', place_chunk);
        is_good = false;
    }
    const name_chunk = file.child(block, 'FNAM');
    const text = name_chunk && file.payload(name_chunk);
    if (name_chunk && !text) is_good = false;
    if (text && !is_utf8(text)) {
        file.add('NOT_UTF8', name_chunk);
        is_good = false;
    } else if (text && (text.filter((byte) => byte === 0).length !== count || text[text.length - 1] !== 0)) {
        file.add('COUNT_MISMATCH', name_chunk);
        is_good = false;
    }
    const ends = sides_of(file.body(chunk).values).flatMap((s) => [s.minimum, s.step, f32(s.minimum + f32(65536 * s.step))]);
    if (!all_finite(ends)) file.add('NOT_FINITE', chunk);
    return is_good ? count : null;
}

/** A mesh: { vertices, indices, is_skinned, targets }; what cannot be read is null. */
export function check_mesh(file, mesh, joints) {
    const info = file.child(mesh, 'VINF');
    const record = file.record(info, 'MeshRecord', 8);
    if (!record) return { vertices: null, indices: null, is_skinned: false, targets: null, frames: null };
    const { vertices } = record;
    file.counts.vertices += vertices;
    if (record.joint !== kNone && record.joint >= joints) file.add('JOINT_RANGE', info);
    if (vertices > 0 && !file.has(mesh, 'POSI')) file.add('CHUNK_MISSING', mesh);
    const palette_chunk = file.child(mesh, 'PALT');
    const palette = check_palette(file, palette_chunk, joints);
    const normals = count_normals(file, mesh);
    for (const id of ['POSI', 'NORM', 'TANG']) read_stream(file, file.child(mesh, id), vertices, normals);
    for (const id of ['TEXC', 'COLR']) {
        const chunks = file.children(mesh, id);
        check_sets(file, chunks, chunks.map((chunk) => read_stream(file, chunk, vertices)));
    }
    const bone_chunk = file.child(mesh, 'BONE');
    const weight_chunk = file.child(mesh, 'WGHT');
    const bones = read_stream(file, bone_chunk, vertices);
    const weights = read_stream(file, weight_chunk, vertices);
    const there = ['BONE', 'WGHT', 'PALT'].filter((id) => file.has(mesh, id)).length;
    if (there === 1 || there === 2) file.add('STREAM_INCOMPLETE', mesh);
    else if (bones && weights && bones.record.components !== weights.record.components) file.add('STREAM_INCOMPLETE', mesh);
    if (bones && palette && bones.values.some((bone) => bone >= palette.record.entries)) file.add('BONE_RANGE', bone_chunk);
    if (weights) check_weights(file, weight_chunk, weights);
    for (const user of file.children(mesh, 'USER')) read_stream(file, file.child(user, 'VALS'), vertices);
    const targets = file.children(mesh, 'TARG');
    for (const target of targets) check_target(file, target, vertices);
    const block = file.child(mesh, 'FRMS');
    const frames = block ? count_frames(file, block, vertices, normals) : 0;
    const list = file.child(mesh, 'INDX');
    const indices = read_stream(file, list, null);
    if (indices && indices.values.some((v) => v >= vertices)) file.add('INDEX_RANGE', list);
    return {
        vertices, frames: frames === null ? null : frames + 1,
        targets: frames === null ? null : targets.length + frames, is_skinned: there > 0,
        indices: list ? (indices ? indices.values : null) : [],
    };
}

/** All ranges of an object's meshes, those of POLY and those of JNTS, as far as they are good. */
export function check_submeshes(file, rig, meshes) {
    const ranges = [];
    const check = (chunk, range, joint) => {
        if (!all_zero(range.reserved)) file.add('RESERVED_FIELD', chunk);
        if (range.topology > 2) file.add('ENUM_RANGE', chunk);
        else if (range.count % (3 - range.topology) !== 0) file.add('POLYGON_CUT', chunk);
        if (range.mesh >= meshes.length) {
            file.add('MESH_RANGE', chunk);
            return;
        }
        if (range.material !== kNone) {
            const is_local = range.material >= kLocal;
            const count = is_local ? file.children(joint.chunk, 'MATE').length : file.children(file.head, 'MATE').length;
            if (range.material % kLocal >= count) file.add('MATERIAL_RANGE', chunk);
        }
        const { indices } = meshes[range.mesh];
        if (!indices) return;
        if (range.first + range.count > indices.length) file.add('INDEX_RANGE', chunk);
        else ranges.push({ chunk, mesh: range.mesh, first: range.first, end: range.first + range.count, joint: joint.number });
    };
    for (const joint of rig.joints)
        for (const chunk of file.children(joint.chunk, 'POLY')) {
            const range = file.record(chunk, 'SubmeshRecord', 20);
            if (range) check(chunk, range, joint);
        }
    if (rig.table)
        for (const range of rig.table.table.ranges) {
            if (range.joint >= rig.joints.length) file.add('JOINT_RANGE', rig.table.chunk);
            else check(rig.table.chunk, range, rig.joints[range.joint]);
        }
    return ranges;
}

/** Ranges do not overlap, and in a rigid mesh no two joints use a vertex. For files whose references hold. */
export function check_ranges(file, ranges, meshes) {
    const sorted = ranges.filter((range) => range.end > range.first);
    sorted.sort((a, b) => a.mesh - b.mesh || a.first - b.first);
    const late = sorted.find((range, k) => k > 0 && sorted[k - 1].mesh === range.mesh && range.first < sorted[k - 1].end);
    if (late) {
        file.add('SUBMESH_OVERLAP', late.chunk);
        return;
    }
    meshes.forEach((mesh, number) => {
        if (mesh.is_skinned) return;
        const movers = new Map();
        for (const range of sorted) {
            if (range.mesh !== number) continue;
            for (let k = range.first; k < range.end; ++k) {
                const mover = movers.get(mesh.indices[k]) ?? range.joint;
                if (mover !== range.joint) {
                    file.add('RIGID_SHARED', range.chunk);
                    return;
                }
                movers.set(mesh.indices[k], mover);
            }
        }
    });
}

export function check_collapse(file, object, meshes) {
    const chunk = file.child(object, 'LODD');
    const record = file.record(chunk, 'CollapseRecord', 16);
    if (!record) return;
    const payload = file.payload(chunk);
    if (record.reserved.some((word) => word !== 0)) file.add('RESERVED_FIELD', chunk);
    const rows = 16 + 16 * record.meshes;
    const levels = record.levels * (record.meshes + 1) * 4;
    if (rows + levels + ((16 - (levels % 16)) % 16) > payload.length) {
        file.add('RECORD_SIZE', chunk);
        return null;
    }
    const body = file.body(chunk);
    let good = true;
    let at = rows + levels + ((16 - (levels % 16)) % 16);
    body.meshes.forEach((row, k) => {
        const add = (code) => {
            file.add(code, chunk);
            good = false;
        };
        if (!all_zero(row.reserved)) file.add('RESERVED_FIELD', chunk);
        if (k > 0 && row.mesh <= body.meshes[k - 1].mesh) add('COLLAPSE_MESH');
        if (row.mesh >= meshes.length) add('MESH_RANGE');
        else if (meshes[row.mesh].vertices === null) good = false;
        else if (row.base > meshes[row.mesh].vertices) add('INDEX_RANGE');
        if (row.targetType !== 2 && row.targetType !== 4) add('STREAM_TYPE');
        if (!good) return;
        const count = meshes[row.mesh].vertices - row.base;
        at += Math.ceil((count * row.targetType) / 16) * 16 + Math.ceil(Math.ceil(count / 8) / 16) * 16;
    });
    if (!good) return null;
    if (at !== payload.length) {
        file.add('RECORD_SIZE', chunk);
        return null;
    }
    if (!all_zero(body.zeros)) file.add('RESERVED_FIELD', chunk);
    check_levels(file, chunk, body, meshes);
    let rest = body.rest;
    chunk.collapses = body.meshes.map((row) => {
        const count = meshes[row.mesh].vertices - row.base;
        const { value, bytes } = file.read.collapses(rest, count, row.targetType);
        rest = rest.subarray(bytes);
        if (!all_zero(value.targetsZeros) || !all_zero(value.joinedZeros) || value.joined[0]
            || !last_bits_are_zero(value, count, body.rest, rest)) file.add('RESERVED_FIELD', chunk);
        if (value.targets.some((target, k) => target >= row.base + k)) file.add('COLLAPSE_TARGET', chunk);
        return value;
    });
}

/** The bits past the last vertex, in the last byte of the joined bits. */
function last_bits_are_zero(value, count, all, rest) {
    if (count % 8 === 0) return true;
    const last = all.length - rest.length - value.joinedZeros.length - 1;
    return all[last] >> (count % 8) === 0;
}

function check_levels(file, chunk, body, meshes) {
    const is_bad = body.levels.some((level, k) => {
        const before = body.levels[k - 1];
        if (!(level.error >= 0 && level.error < Infinity) || (before && level.error < before.error)) return true;
        return level.alive.some((alive, p) => {
            const row = body.meshes[p];
            return alive < row.base || alive > meshes[row.mesh].vertices || (before && alive > before.alive[p]);
        });
    });
    if (is_bad) file.add('COLLAPSE_LEVEL', chunk);
}
