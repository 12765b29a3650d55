// Made by make.py from BENDY_MOTIONS of skinning.glsl. It has been neither compiled nor run.
#pragma clang diagnostic ignored "-Wmissing-prototypes"

#include <metal_stdlib>
#include <simd/simd.h>

using namespace metal;

struct Transforms
{
    float4 rows[1];
};

struct Skinning
{
    float4x4 view_projection;
    uint vertices;
    uint influences;
    uint bone_bytes;
    uint weight_bytes;
    uint first_entry;
    uint entries;
    uint bones_used;
    uint topmost;
    uint by_columns;
    uint dual;
    uint has_normals;
    uint has_tangents;
};

struct Places
{
    float floats[1];
};

struct Motions
{
    float4 rows[1];
};

constant uint3 gl_WorkGroupSize [[maybe_unused]] = uint3(64u, 1u, 1u);

static inline __attribute__((always_inline))
float3x4 palette_rows(thread const uint& entry, const device Transforms& transforms, constant Skinning& mesh)
{
    uint at = 4u * entry;
    float3x4 rows = float3x4(float4(transforms.rows[at]), float4(transforms.rows[at + 1u]), float4(transforms.rows[at + 2u]));
    if (mesh.by_columns == 0u)
    {
        return rows;
    }
    return transpose(float4x3(float3(rows[0].xyz), float3(rows[1].xyz), float3(rows[2].xyz), float3(transforms.rows[at + 3u].xyz)));
}

static inline __attribute__((always_inline))
float3x3 linear_part(thread const float3x4& rows)
{
    return transpose(float3x3(float3(rows[0].xyz), float3(rows[1].xyz), float3(rows[2].xyz)));
}

static inline __attribute__((always_inline))
float largest(thread const float3x3& m)
{
    float3 most = fast::max(abs(m[0]), fast::max(abs(m[1]), abs(m[2])));
    return fast::max(most.x, fast::max(most.y, most.z));
}

static inline __attribute__((always_inline))
float scale_of(thread const float3x3& m)
{
    float volume = determinant(m);
    float scale = sign(volume) * pow(abs(volume), 0.3333333432674407958984375);
    float3x3 param = m;
    if (!(abs(scale) > (9.9999997473787516355514526367188e-05 * largest(param))))
    {
        return 1.0;
    }
    return scale - ((((scale * scale) * scale) - volume) / ((3.0 * scale) * scale));
}

static inline __attribute__((always_inline))
float3 perpendicular(thread const float3& v)
{
    return fast::normalize(cross(v, select(float3(1.0, 0.0, 0.0), float3(0.0, 1.0, 0.0), bool3((v.x * v.x) > (0.5 * dot(v, v))))));
}

static inline __attribute__((always_inline))
float3 unit_unless_short(thread const float3& v, thread const float& limit, thread const float3& otherwise)
{
    float size = length(v);
    float3 _199;
    if (size > limit)
    {
        _199 = v / float3(size);
    }
    else
    {
        float3 param = otherwise;
        _199 = perpendicular(param);
    }
    return _199;
}

static inline __attribute__((always_inline))
float3x3 rigid_axes(thread const float3x3& m)
{
    float limit = 9.9999999747524270787835121154785e-07 * fast::max(length(m[0]), fast::max(length(m[1]), length(m[2])));
    if (limit == 0.0)
    {
        return float3x3(float3(1.0, 0.0, 0.0), float3(0.0, 1.0, 0.0), float3(0.0, 0.0, 1.0));
    }
    float3 x = m[0];
    float3 y = m[1];
    if (length(x) > limit)
    {
        x = fast::normalize(x);
        float3 param = y - (x * dot(x, y));
        float param_1 = limit;
        float3 param_2 = x;
        y = unit_unless_short(param, param_1, param_2);
    }
    else
    {
        float3 param_3 = y;
        float param_4 = limit;
        float3 param_5 = m[2];
        y = unit_unless_short(param_3, param_4, param_5);
        float3 param_6 = cross(y, m[2]);
        float param_7 = limit;
        float3 param_8 = y;
        x = unit_unless_short(param_6, param_7, param_8);
    }
    return float3x3(float3(x), float3(y), float3(cross(x, y)));
}

static inline __attribute__((always_inline))
float3x3 nearest_rotation(thread const float3x3& m)
{
    float3x3 param = m;
    float size = largest(param);
    if (size == 0.0)
    {
        return float3x3(float3(1.0, 0.0, 0.0), float3(0.0, 1.0, 0.0), float3(0.0, 0.0, 1.0));
    }
    float3x3 at = m * (1.0 / size);
    float volume = determinant(at);
    if (!(volume > 9.9999999747524270787835121154785e-07))
    {
        float3x3 param_1 = m;
        return rigid_axes(param_1);
    }
    at = at * (1.0 / pow(volume, 0.3333333432674407958984375));
    for (int _step = 0; _step < 30; _step++)
    {
        float3x3 cofactors = float3x3(float3(cross(at[1], at[2])), float3(cross(at[2], at[0])), float3(cross(at[0], at[1])));
        float3x3 _380 = cofactors * (1.0 / dot(at[0], cofactors[0]));
        float3x3 next = float3x3(at[0] + _380[0], at[1] + _380[1], at[2] + _380[2]) * 0.5;
        float3x3 param_2 = float3x3(next[0] - at[0], next[1] - at[1], next[2] - at[2]);
        float change = largest(param_2);
        at = next;
        if (change < 9.9999997473787516355514526367188e-05)
        {
            break;
        }
    }
    return at;
}

static inline __attribute__((always_inline))
float4 quaternion_of(thread const float3x3& m)
{
    float3 d = float3(m[0].x, m[1].y, m[2].z);
    float4 squares = float4(1.0) + float4((d.x - d.y) - d.z, (d.y - d.x) - d.z, (d.z - d.x) - d.y, (d.x + d.y) + d.z);
    float3 differences = float3(m[1].z - m[2].y, m[2].x - m[0].z, m[0].y - m[1].x);
    float3 sums = float3(m[1].z + m[2].y, m[2].x + m[0].z, m[0].y + m[1].x);
    float most = fast::max(fast::max(squares.x, squares.y), fast::max(squares.z, squares.w));
    if (squares.w == most)
    {
        return fast::normalize(float4(differences, squares.w));
    }
    if (squares.x == most)
    {
        return fast::normalize(float4(squares.x, sums.z, sums.y, differences.x));
    }
    if (squares.y == most)
    {
        return fast::normalize(float4(sums.z, squares.y, sums.x, differences.y));
    }
    return fast::normalize(float4(sums.y, sums.x, squares.z, differences.z));
}

kernel void main0(constant Skinning& mesh [[buffer(0)]], const device Transforms& transforms [[buffer(1)]], const device Places& places [[buffer(2)]], device Motions& motions [[buffer(3)]], uint3 gl_GlobalInvocationID [[thread_position_in_grid]])
{
    uint bone = gl_GlobalInvocationID.x;
    if (bone >= mesh.bones_used)
    {
        return;
    }
    uint first = (gl_GlobalInvocationID.y * mesh.entries) + mesh.first_entry;
    uint param = first + mesh.topmost;
    float3x4 param_1 = palette_rows(param, transforms, mesh);
    float3x3 param_2 = linear_part(param_1);
    float scale = scale_of(param_2);
    uint param_3 = first + bone;
    float3x4 rows = palette_rows(param_3, transforms, mesh);
    float3x4 param_4 = rows;
    float3x3 linear = linear_part(param_4) * (1.0 / scale);
    float3 translation = float3(rows[0].w, rows[1].w, rows[2].w) / float3(scale);
    float3 place = float3(places.floats[3u * bone], places.floats[(3u * bone) + 1u], places.floats[(3u * bone) + 2u]);
    float3x3 _720;
    if (determinant(linear) < 0.0)
    {
        _720 = float3x3(-linear[0], -linear[1], -linear[2]);
    }
    else
    {
        _720 = linear;
    }
    float3x3 param_5 = _720;
    float3x3 turn = nearest_rotation(param_5);
    float3x3 stretch = transpose(turn) * linear;
    float3x3 param_6 = turn;
    float4 real = quaternion_of(param_6);
    float3 shift = ((linear * place) + translation) - (turn * place);
    float3x4 stretch_rows = transpose(float4x3(float3(stretch[0]), float3(stretch[1]), float3(stretch[2]), float3(place - (stretch * place)))) * scale;
    uint at = 5u * (first + bone);
    motions.rows[at] = real;
    motions.rows[at + 1u] = float4((shift * real.w) + cross(shift, real.xyz), -dot(shift, real.xyz)) * (0.5 * scale);
    for (int row = 0; row < 3; row++)
    {
        motions.rows[(at + 2u) + uint(row)] = stretch_rows[row];
    }
}

