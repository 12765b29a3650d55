// Skinning on the graphics processor, straight from the streams of an exact bendy file: docs/embedding.md has the setup.
// Four passes; put the line #version 430 and the #define of one of them before this text:
//
//   BENDY_MORPH    compute: adds a morph target to a copy of the positions, normals or tangents
//   BENDY_MOTIONS  compute, for dual quaternions only: palette -> motions
//   BENDY_SKIN     compute: writes skinned vertices
//   BENDY_DRAW     vertex shader: skins each vertex that it draws; an instance is a character
//
// skinning.wgsl is the same for WebGPU. `make.py` makes hlsl/ and metal/ from this file.

#ifdef BENDY_MORPH

layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform Morph {
    uint elements;     // vertices that the target displaces
    uint index_bytes;  // 2 or 4: of each number in `displaced`; 0: the target displaces all vertices, in order
    uint components;   // of `sums`: 3, or 4 for tangents
    float weight;
} morph;
// The target's list of vertices; x y z for each of them; and what is added to: the mesh's own numbers at first.
layout(std430, binding = 1) readonly buffer Displaced { uint words[]; } displaced;
layout(std430, binding = 2) readonly buffer Displacements { float floats[]; } displacements;
layout(std430, binding = 3) buffer Sums { float floats[]; } sums;

void main() {
    uint element = gl_GlobalInvocationID.x;
    if (element >= morph.elements) return;
    uint vertex = element;
    if (morph.index_bytes == 4u) vertex = displaced.words[element];
    if (morph.index_bytes == 2u) vertex = (displaced.words[element / 2u] >> (16u * (element & 1u))) & 0xffffu;
    uint at = morph.components * vertex;
    for (uint c = 0u; c < 3u; ++c) sums.floats[at + c] += morph.weight * displacements.floats[3u * element + c];
}

#else

layout(std140, binding = 0) uniform Skinning {
    mat4 view_projection;  // for BENDY_DRAW only
    uint vertices;         // of the mesh
    uint influences;       // of a vertex: the components of `bones`; 0: palette entry first_entry moves all vertices
    uint bone_bytes;       // 1, 2 or 4: of each bone
    uint weight_bytes;     // of each weight: 4 for floats, 2 or 1 for normalised integers; 0: every weight is 1
    uint first_entry;      // of the mesh in the palette of a character
    uint entries;          // of the palette of one character; the next character's follows
    uint bones_used;       // of the mesh: entries in its palette
    uint topmost;          // for dual quaternions: the mesh's bone whose joint has the smallest number
    uint by_columns;       // 0: matrices as Pose::palette and Crowd have them; 1: 16 floats, column by column
    uint dual;             // 0: linear, from the palette; 1: dual quaternions, from the motions
    uint has_normals;      // 0 or 1
    uint has_tangents;     // 0 or 1
} mesh;
// An entry of a palette is four of these: three rows and a gap, or four columns. A motion is five: the rotation and the
// dual part as quaternions x y z w, and three rows of what stretches the vertex before.
layout(std430, binding = 1) readonly buffer Transforms { vec4 rows[]; } transforms;

// Rows of a 3x4 matrix.
mat3x4 palette_rows(uint entry) {
    uint at = 4u * entry;
    mat3x4 rows = mat3x4(transforms.rows[at], transforms.rows[at + 1u], transforms.rows[at + 2u]);
    if (mesh.by_columns == 0u) return rows;
    return transpose(mat4x3(rows[0].xyz, rows[1].xyz, rows[2].xyz, transforms.rows[at + 3u].xyz));
}

#ifdef BENDY_MOTIONS

layout(local_size_x = 64) in;
layout(std430, binding = 2) readonly buffer Places { float floats[]; } places;  // x y z of each bone in the mesh at bind time
layout(std430, binding = 3) writeonly buffer Motions { vec4 rows[]; } motions;

float largest(mat3 m) {
    vec3 most = max(abs(m[0]), max(abs(m[1]), abs(m[2])));
    return max(most.x, max(most.y, most.z));
}

vec3 perpendicular(vec3 v) {
    return normalize(cross(v, v.x * v.x > 0.5 * dot(v, v) ? vec3(0, 1, 0) : vec3(1, 0, 0)));
}

vec3 unit_unless_short(vec3 v, float limit, vec3 otherwise) {
    float size = length(v);
    return size > limit ? v / size : perpendicular(otherwise);
}

// The axes of a flat matrix made orthonormal and right-handed, x first; an axis without length is replaced.
mat3 rigid_axes(mat3 m) {
    float limit = 1e-6 * max(length(m[0]), max(length(m[1]), length(m[2])));
    if (limit == 0.0) return mat3(1.0);
    vec3 x = m[0];
    vec3 y = m[1];
    if (length(x) > limit) {
        x = normalize(x);
        y = unit_unless_short(y - dot(x, y) * x, limit, x);
    } else {
        y = unit_unless_short(y, limit, m[2]);
        x = unit_unless_short(cross(y, m[2]), limit, y);
    }
    return mat3(x, y, cross(x, y));
}

// The rotation nearest to a matrix that does not mirror, by Newton's iteration (Higham 1986).
mat3 nearest_rotation(mat3 m) {
    float size = largest(m);
    if (size == 0.0) return mat3(1.0);
    mat3 at = m / size;
    float volume = determinant(at);
    if (!(volume > 1e-6)) return rigid_axes(m);
    at /= pow(volume, 1.0 / 3.0);
    for (int step = 0; step < 30; ++step) {
        mat3 cofactors = mat3(cross(at[1], at[2]), cross(at[2], at[0]), cross(at[0], at[1]));
        mat3 next = 0.5 * (at + cofactors / dot(at[0], cofactors[0]));
        float change = largest(next - at);
        at = next;
        if (change < 1e-4) break;  // which leaves an error of its square
    }
    return at;
}

vec4 quaternion_of(mat3 m) {
    vec3 d = vec3(m[0].x, m[1].y, m[2].z);
    vec4 squares = 1.0 + vec4(d.x - d.y - d.z, d.y - d.x - d.z, d.z - d.x - d.y, d.x + d.y + d.z);
    vec3 differences = vec3(m[1].z - m[2].y, m[2].x - m[0].z, m[0].y - m[1].x);
    vec3 sums = vec3(m[1].z + m[2].y, m[2].x + m[0].z, m[0].y + m[1].x);
    float most = max(max(squares.x, squares.y), max(squares.z, squares.w));
    if (squares.w == most) return normalize(vec4(differences, squares.w));
    if (squares.x == most) return normalize(vec4(squares.x, sums.z, sums.y, differences.x));
    if (squares.y == most) return normalize(vec4(sums.z, squares.y, sums.x, differences.y));
    return normalize(vec4(sums.y, sums.x, squares.z, differences.z));
}

// The uniform scale of a mesh; 1 if it is flat.
float scale_of(mat3 m) {
    float volume = determinant(m);
    float scale = sign(volume) * pow(abs(volume), 1.0 / 3.0);
    if (!(abs(scale) > 1e-4 * largest(m))) return 1.0;
    return scale - (scale * scale * scale - volume) / (3.0 * scale * scale);  // pow is not exact
}

mat3 linear_part(mat3x4 rows) {
    return transpose(mat3(rows[0].xyz, rows[1].xyz, rows[2].xyz));
}

// x: the bone of the mesh; y: the character.
void main() {
    uint bone = gl_GlobalInvocationID.x;
    if (bone >= mesh.bones_used) return;
    uint first = gl_GlobalInvocationID.y * mesh.entries + mesh.first_entry;
    float scale = scale_of(linear_part(palette_rows(first + mesh.topmost)));
    mat3x4 rows = palette_rows(first + bone);
    mat3 linear = linear_part(rows) / scale;
    vec3 translation = vec3(rows[0].w, rows[1].w, rows[2].w) / scale;
    vec3 place = vec3(places.floats[3u * bone], places.floats[3u * bone + 1u], places.floats[3u * bone + 2u]);
    // A bone that mirrors is a rotation with a negative stretch.
    mat3 turn = nearest_rotation(determinant(linear) < 0.0 ? -linear : linear);
    mat3 stretch = transpose(turn) * linear;
    vec4 real = quaternion_of(turn);
    vec3 shift = linear * place + translation - turn * place;
    // The scale goes into the dual part and the stretch.
    mat3x4 stretch_rows = scale * transpose(mat4x3(stretch[0], stretch[1], stretch[2], place - stretch * place));
    uint at = 5u * (first + bone);
    motions.rows[at] = real;
    motions.rows[at + 1u] = 0.5 * scale * vec4(real.w * shift + cross(shift, real.xyz), -dot(shift, real.xyz));
    for (int row = 0; row < 3; ++row) motions.rows[at + 2u + uint(row)] = stretch_rows[row];
}

#else

layout(std430, binding = 2) readonly buffer Positions { float floats[]; } positions;  // x y z
layout(std430, binding = 3) readonly buffer Normals { float floats[]; } normals;      // x y z; any buffer if there are none
layout(std430, binding = 4) readonly buffer Tangents { float floats[]; } tangents;    // x y z, handedness; likewise
layout(std430, binding = 5) readonly buffer Bones { uint words[]; } bones;            // as many per vertex as influences
layout(std430, binding = 6) readonly buffer Weights { uint words[]; } weights;        // likewise

struct Vertex {
    vec3 position;
    vec3 normal;   // zero if the mesh has none
    vec4 tangent;  // likewise
};

// Number `at` of those that lie in words without gaps, `bytes` each; `word` is the one that it is in.
uint number_in(uint word, uint at, uint bytes) {
    return bytes == 4u ? word : (word >> (8u * (at * bytes & 3u))) & ((1u << (8u * bytes)) - 1u);
}

uint bone_at(uint at) {
    return number_in(bones.words[at * mesh.bone_bytes / 4u], at, mesh.bone_bytes);
}

float weight_at(uint at) {
    if (mesh.weight_bytes == 0u) return 1.0;
    uint stored = number_in(weights.words[at * mesh.weight_bytes / 4u], at, mesh.weight_bytes);
    if (mesh.weight_bytes == 4u) return uintBitsToFloat(stored);
    return float(stored) / (mesh.weight_bytes == 2u ? 65535.0 : 255.0);
}

// The sum of weight * matrix of a vertex.
mat3x4 blend_linear(uint vertex, uint first) {
    if (mesh.influences == 0u) return palette_rows(first);
    mat3x4 sum = mat3x4(0.0);
    for (uint at = vertex * mesh.influences; at < (vertex + 1u) * mesh.influences; ++at) {
        float weight = weight_at(at);
        if (weight != 0.0) sum += weight * palette_rows(first + bone_at(at));
    }
    return sum;
}

vec3 turned(vec4 rotation, vec3 v) {
    return v + 2.0 * cross(rotation.xyz, cross(rotation.xyz, v) + rotation.w * v);
}

// The same by dual quaternions: Kavan, Collins, Zara, O'Sullivan, Skinning with Dual Quaternions, 2007. A quaternion and
// its negative are one rotation: each is taken with the sign of the heaviest one.
mat3x4 blend_dual(uint vertex, uint first) {
    uint end = (vertex + 1u) * mesh.influences;
    uint heaviest = vertex * mesh.influences;
    for (uint at = heaviest + 1u; at < end; ++at) {
        if (weight_at(at) > weight_at(heaviest)) heaviest = at;
    }
    if (mesh.influences == 0u || !(weight_at(heaviest) > 0.0)) return mat3x4(0.0);
    vec4 pivot = transforms.rows[5u * (first + bone_at(heaviest))];
    vec4 real = vec4(0.0);
    vec4 dual_part = vec4(0.0);
    mat3x4 stretch = mat3x4(0.0);
    float all = 0.0;
    for (uint at = vertex * mesh.influences; at < end; ++at) {
        float weight = weight_at(at);
        if (weight == 0.0) continue;
        uint motion = 5u * (first + bone_at(at));
        float side = dot(transforms.rows[motion], pivot) < 0.0 ? -weight : weight;
        real += side * transforms.rows[motion];
        dual_part += side * transforms.rows[motion + 1u];
        stretch += weight * mat3x4(transforms.rows[motion + 2u], transforms.rows[motion + 3u], transforms.rows[motion + 4u]);
        all += weight;
    }
    float size = length(real);
    real /= size;
    dual_part /= size;
    mat4x3 columns = transpose(stretch) / all;
    vec3 shift = 2.0 * (real.w * dual_part.xyz - dual_part.w * real.xyz + cross(real.xyz, dual_part.xyz));
    for (int c = 0; c < 4; ++c) columns[c] = turned(real, columns[c]);
    columns[3] += shift;
    return transpose(columns);
}

vec3 unit_or_zero(vec3 v) {
    float size = length(v);
    return size > 0.0 ? v / size : vec3(0.0);
}

Vertex skin_vertex(uint vertex, uint character) {
    uint first = character * mesh.entries + mesh.first_entry;
    mat3x4 rows = mesh.dual != 0u ? blend_dual(vertex, first) : blend_linear(vertex, first);
    vec3 x = rows[0].xyz;
    vec3 y = rows[1].xyz;
    vec3 z = rows[2].xyz;
    mat3 cofactors = mat3(cross(y, z), cross(z, x), cross(x, y));  // rows of the inverse transpose times the determinant
    float side = dot(x, cofactors[0]) < 0.0 ? -1.0 : 1.0;           // mirrored: the bitangent flips
    uint at = 3u * vertex;
    vec3 position = vec3(positions.floats[at], positions.floats[at + 1u], positions.floats[at + 2u]);
    Vertex result = Vertex(vec4(position, 1.0) * rows, vec3(0.0), vec4(0.0));
    if (mesh.has_normals != 0u) {
        vec3 normal = vec3(normals.floats[at], normals.floats[at + 1u], normals.floats[at + 2u]);
        result.normal = side * unit_or_zero(normal * cofactors);
    }
    if (mesh.has_tangents != 0u) {
        at = 4u * vertex;
        vec3 tangent = vec3(tangents.floats[at], tangents.floats[at + 1u], tangents.floats[at + 2u]);
        result.tangent = vec4(unit_or_zero(tangent * mat3(x, y, z)), side * tangents.floats[at + 3u]);
    }
    return result;
}

#ifdef BENDY_SKIN

layout(local_size_x = 64) in;
layout(std430, binding = 7) writeonly buffer Skinned { float floats[]; } skinned;  // position, normal, tangent: 10 floats

// x: the vertex; y: the character.
void main() {
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= mesh.vertices) return;
    Vertex result = skin_vertex(vertex, gl_GlobalInvocationID.y);
    uint at = 10u * (gl_GlobalInvocationID.y * mesh.vertices + vertex);
    for (int c = 0; c < 3; ++c) {
        skinned.floats[at + uint(c)] = result.position[c];
        skinned.floats[at + 3u + uint(c)] = result.normal[c];
    }
    for (int c = 0; c < 4; ++c) skinned.floats[at + 6u + uint(c)] = result.tangent[c];
}

#else  // BENDY_DRAW: indexed by the mesh's own index stream

#ifdef VULKAN
#define gl_VertexID gl_VertexIndex
#define gl_InstanceID gl_InstanceIndex
#endif

layout(location = 0) in vec2 texture_coords;
layout(location = 0) out vec2 coords;
layout(location = 1) out vec3 position;  // in model space, as the next two
layout(location = 2) out vec3 normal;
layout(location = 3) out vec4 tangent;

void main() {
    Vertex result = skin_vertex(uint(gl_VertexID), uint(gl_InstanceID));
    coords = texture_coords;
    position = result.position;
    normal = result.normal;
    tangent = result.tangent;
    gl_Position = mesh.view_projection * vec4(position, 1.0);
}

#endif
#endif
#endif
