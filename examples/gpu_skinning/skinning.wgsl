// Skinning by WebGPU, straight from the streams of an exact bendy file: the passes of skinning.glsl, which has the
// comments, with the same formulas and bindings. Entry points: add_morph_target, make_motions, skin (compute), draw.

struct Morph {
    elements: u32,
    index_bytes: u32,
    components: u32,
    weight: f32,
}
@group(0) @binding(0) var<uniform> morph: Morph;
@group(0) @binding(1) var<storage, read> displaced: array<u32>;
@group(0) @binding(2) var<storage, read> displacements: array<f32>;
@group(0) @binding(3) var<storage, read_write> sums: array<f32>;

@compute @workgroup_size(64)
fn add_morph_target(@builtin(global_invocation_id) id: vec3u) {
    let element = id.x;
    if (element >= morph.elements) { return; }
    var vertex = element;
    if (morph.index_bytes == 4u) { vertex = displaced[element]; }
    if (morph.index_bytes == 2u) { vertex = (displaced[element / 2u] >> (16u * (element & 1u))) & 0xffffu; }
    let at = morph.components * vertex;
    for (var c = 0u; c < 3u; c++) { sums[at + c] += morph.weight * displacements[3u * element + c]; }
}

struct Skinning {
    view_projection: mat4x4f,
    vertices: u32,
    influences: u32,
    bone_bytes: u32,
    weight_bytes: u32,
    first_entry: u32,
    entries: u32,
    bones_used: u32,
    topmost: u32,
    by_columns: u32,
    dual: u32,
    has_normals: u32,
    has_tangents: u32,
}
@group(0) @binding(0) var<uniform> mesh: Skinning;
@group(0) @binding(1) var<storage, read> transforms: array<vec4f>;

fn palette_rows(entry: u32) -> mat3x4f {
    let at = 4u * entry;
    let rows = mat3x4f(transforms[at], transforms[at + 1u], transforms[at + 2u]);
    if (mesh.by_columns == 0u) { return rows; }
    return transpose(mat4x3f(rows[0].xyz, rows[1].xyz, rows[2].xyz, transforms[at + 3u].xyz));
}

@group(0) @binding(2) var<storage, read> places: array<f32>;
@group(0) @binding(3) var<storage, read_write> motions: array<vec4f>;

fn largest(m: mat3x3f) -> f32 {
    let most = max(abs(m[0]), max(abs(m[1]), abs(m[2])));
    return max(most.x, max(most.y, most.z));
}

fn perpendicular(v: vec3f) -> vec3f {
    return normalize(cross(v, select(vec3f(1, 0, 0), vec3f(0, 1, 0), v.x * v.x > 0.5 * dot(v, v))));
}

fn unit_unless_short(v: vec3f, limit: f32, otherwise: vec3f) -> vec3f {
    let size = length(v);
    if (size > limit) { return v / size; }
    return perpendicular(otherwise);
}

fn rigid_axes(m: mat3x3f) -> mat3x3f {
    let limit = 1e-6 * max(length(m[0]), max(length(m[1]), length(m[2])));
    if (limit == 0.0) { return mat3x3f(1, 0, 0, 0, 1, 0, 0, 0, 1); }
    var x = m[0];
    var y = m[1];
    if (length(x) > limit) {
        x = normalize(x);
        y = unit_unless_short(y - dot(x, y) * x, limit, x);
    } else {
        y = unit_unless_short(y, limit, m[2]);
        x = unit_unless_short(cross(y, m[2]), limit, y);
    }
    return mat3x3f(x, y, cross(x, y));
}

fn nearest_rotation(m: mat3x3f) -> mat3x3f {
    let size = largest(m);
    if (size == 0.0) { return mat3x3f(1, 0, 0, 0, 1, 0, 0, 0, 1); }
    var at = m * (1.0 / size);
    let volume = determinant(at);
    if (!(volume > 1e-6)) { return rigid_axes(m); }
    at *= 1.0 / pow(volume, 1.0 / 3.0);
    for (var step = 0; step < 30; step++) {
        let cofactors = mat3x3f(cross(at[1], at[2]), cross(at[2], at[0]), cross(at[0], at[1]));
        let next = 0.5 * (at + cofactors * (1.0 / dot(at[0], cofactors[0])));
        let change = largest(next - at);
        at = next;
        if (change < 1e-4) { break; }
    }
    return at;
}

fn quaternion_of(m: mat3x3f) -> vec4f {
    let d = vec3f(m[0].x, m[1].y, m[2].z);
    let squares = 1.0 + vec4f(d.x - d.y - d.z, d.y - d.x - d.z, d.z - d.x - d.y, d.x + d.y + d.z);
    let differences = vec3f(m[1].z - m[2].y, m[2].x - m[0].z, m[0].y - m[1].x);
    let sides = vec3f(m[1].z + m[2].y, m[2].x + m[0].z, m[0].y + m[1].x);
    let most = max(max(squares.x, squares.y), max(squares.z, squares.w));
    if (squares.w == most) { return normalize(vec4f(differences, squares.w)); }
    if (squares.x == most) { return normalize(vec4f(squares.x, sides.z, sides.y, differences.x)); }
    if (squares.y == most) { return normalize(vec4f(sides.z, squares.y, sides.x, differences.y)); }
    return normalize(vec4f(sides.y, sides.x, squares.z, differences.z));
}

fn scale_of(m: mat3x3f) -> f32 {
    let volume = determinant(m);
    let scale = sign(volume) * pow(abs(volume), 1.0 / 3.0);
    if (!(abs(scale) > 1e-4 * largest(m))) { return 1.0; }
    return scale - (scale * scale * scale - volume) / (3.0 * scale * scale);
}

fn linear_part(rows: mat3x4f) -> mat3x3f {
    return transpose(mat3x3f(rows[0].xyz, rows[1].xyz, rows[2].xyz));
}

@compute @workgroup_size(64)
fn make_motions(@builtin(global_invocation_id) id: vec3u) {
    let bone = id.x;
    if (bone >= mesh.bones_used) { return; }
    let first = id.y * mesh.entries + mesh.first_entry;
    let scale = scale_of(linear_part(palette_rows(first + mesh.topmost)));
    let rows = palette_rows(first + bone);
    let linear = linear_part(rows) * (1.0 / scale);
    let translation = vec3f(rows[0].w, rows[1].w, rows[2].w) / scale;
    let place = vec3f(places[3u * bone], places[3u * bone + 1u], places[3u * bone + 2u]);
    let turn = nearest_rotation(linear * select(1.0, -1.0, determinant(linear) < 0.0));
    let stretch = transpose(turn) * linear;
    let real = quaternion_of(turn);
    let shift = linear * place + translation - turn * place;
    let stretch_rows = scale * transpose(mat4x3f(stretch[0], stretch[1], stretch[2], place - stretch * place));
    let at = 5u * (first + bone);
    motions[at] = real;
    motions[at + 1u] = 0.5 * scale * vec4f(real.w * shift + cross(shift, real.xyz), -dot(shift, real.xyz));
    motions[at + 2u] = stretch_rows[0];
    motions[at + 3u] = stretch_rows[1];
    motions[at + 4u] = stretch_rows[2];
}

@group(0) @binding(2) var<storage, read> positions: array<f32>;
@group(0) @binding(3) var<storage, read> normals: array<f32>;
@group(0) @binding(4) var<storage, read> tangents: array<f32>;
@group(0) @binding(5) var<storage, read> bones: array<u32>;
@group(0) @binding(6) var<storage, read> weights: array<u32>;

struct Vertex {
    position: vec3f,
    normal: vec3f,
    tangent: vec4f,
}

fn number_in(word: u32, at: u32, bytes: u32) -> u32 {
    if (bytes == 4u) { return word; }
    return (word >> (8u * ((at * bytes) & 3u))) & ((1u << (8u * bytes)) - 1u);
}

fn bone_at(at: u32) -> u32 {
    return number_in(bones[at * mesh.bone_bytes / 4u], at, mesh.bone_bytes);
}

fn weight_at(at: u32) -> f32 {
    if (mesh.weight_bytes == 0u) { return 1.0; }
    let stored = number_in(weights[at * mesh.weight_bytes / 4u], at, mesh.weight_bytes);
    if (mesh.weight_bytes == 4u) { return bitcast<f32>(stored); }
    return f32(stored) / select(255.0, 65535.0, mesh.weight_bytes == 2u);
}

fn blend_linear(vertex: u32, first: u32) -> mat3x4f {
    if (mesh.influences == 0u) { return palette_rows(first); }
    var sum = mat3x4f();
    for (var at = vertex * mesh.influences; at < (vertex + 1u) * mesh.influences; at++) {
        let weight = weight_at(at);
        if (weight != 0.0) { sum += weight * palette_rows(first + bone_at(at)); }
    }
    return sum;
}

fn turned(rotation: vec4f, v: vec3f) -> vec3f {
    return v + 2.0 * cross(rotation.xyz, cross(rotation.xyz, v) + rotation.w * v);
}

fn blend_dual(vertex: u32, first: u32) -> mat3x4f {
    let end = (vertex + 1u) * mesh.influences;
    var heaviest = vertex * mesh.influences;
    for (var at = heaviest + 1u; at < end; at++) {
        if (weight_at(at) > weight_at(heaviest)) { heaviest = at; }
    }
    if (mesh.influences == 0u || !(weight_at(heaviest) > 0.0)) { return mat3x4f(); }
    let pivot = transforms[5u * (first + bone_at(heaviest))];
    var real = vec4f();
    var dual_part = vec4f();
    var stretch = mat3x4f();
    var all = 0.0;
    for (var at = vertex * mesh.influences; at < end; at++) {
        let weight = weight_at(at);
        if (weight == 0.0) { continue; }
        let motion = 5u * (first + bone_at(at));
        let side = select(weight, -weight, dot(transforms[motion], pivot) < 0.0);
        real += side * transforms[motion];
        dual_part += side * transforms[motion + 1u];
        stretch += weight * mat3x4f(transforms[motion + 2u], transforms[motion + 3u], transforms[motion + 4u]);
        all += weight;
    }
    let size = length(real);
    real /= size;
    dual_part /= size;
    var columns = transpose(stretch) * (1.0 / all);
    let shift = 2.0 * (real.w * dual_part.xyz - dual_part.w * real.xyz + cross(real.xyz, dual_part.xyz));
    for (var c = 0; c < 4; c++) { columns[c] = turned(real, columns[c]); }
    columns[3] += shift;
    return transpose(columns);
}

fn unit_or_zero(v: vec3f) -> vec3f {
    let size = length(v);
    if (size > 0.0) { return v / size; }
    return vec3f();
}

fn skin_vertex(vertex: u32, character: u32) -> Vertex {
    let first = character * mesh.entries + mesh.first_entry;
    var rows: mat3x4f;
    if (mesh.dual != 0u) { rows = blend_dual(vertex, first); } else { rows = blend_linear(vertex, first); }
    let x = rows[0].xyz;
    let y = rows[1].xyz;
    let z = rows[2].xyz;
    let cofactors = mat3x3f(cross(y, z), cross(z, x), cross(x, y));
    let side = select(1.0, -1.0, dot(x, cofactors[0]) < 0.0);
    var at = 3u * vertex;
    let position = vec3f(positions[at], positions[at + 1u], positions[at + 2u]);
    var result = Vertex(vec4f(position, 1.0) * rows, vec3f(), vec4f());
    if (mesh.has_normals != 0u) {
        let normal = vec3f(normals[at], normals[at + 1u], normals[at + 2u]);
        result.normal = side * unit_or_zero(normal * cofactors);
    }
    if (mesh.has_tangents != 0u) {
        at = 4u * vertex;
        let tangent = vec3f(tangents[at], tangents[at + 1u], tangents[at + 2u]);
        result.tangent = vec4f(unit_or_zero(tangent * mat3x3f(x, y, z)), side * tangents[at + 3u]);
    }
    return result;
}

@group(0) @binding(7) var<storage, read_write> skinned: array<f32>;

@compute @workgroup_size(64)
fn skin(@builtin(global_invocation_id) id: vec3u) {
    if (id.x >= mesh.vertices) { return; }
    let result = skin_vertex(id.x, id.y);
    let at = 10u * (id.y * mesh.vertices + id.x);
    for (var c = 0u; c < 3u; c++) {
        skinned[at + c] = result.position[c];
        skinned[at + 3u + c] = result.normal[c];
    }
    for (var c = 0u; c < 4u; c++) { skinned[at + 6u + c] = result.tangent[c]; }
}

struct Drawn {
    @builtin(position) place: vec4f,
    @location(0) coords: vec2f,
    @location(1) position: vec3f,
    @location(2) normal: vec3f,
    @location(3) tangent: vec4f,
}

@vertex
fn draw(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32,
        @location(0) texture_coords: vec2f) -> Drawn {
    let result = skin_vertex(vertex, instance);
    let place = mesh.view_projection * vec4f(result.position, 1.0);
    return Drawn(place, texture_coords, result.position, result.normal, result.tangent);
}
