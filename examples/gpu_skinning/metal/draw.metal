// Made by make.py from BENDY_DRAW of skinning.glsl. It has been neither compiled nor run.
#pragma clang diagnostic ignored "-Wmissing-prototypes"

#include <metal_stdlib>
#include <simd/simd.h>

using namespace metal;

struct Vertex
{
    float3 position;
    float3 normal;
    float4 tangent;
};

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

struct Bones
{
    uint words[1];
};

struct Weights
{
    uint words[1];
};

struct Positions
{
    float floats[1];
};

struct Normals
{
    float floats[1];
};

struct Tangents
{
    float floats[1];
};

struct main0_out
{
    float2 coords [[user(locn0)]];
    float3 position [[user(locn1)]];
    float3 normal [[user(locn2)]];
    float4 tangent [[user(locn3)]];
    float4 gl_Position [[position]];
};

struct main0_in
{
    float2 texture_coords [[attribute(0)]];
};

static inline __attribute__((always_inline))
uint number_in(thread const uint& word, thread const uint& at, thread const uint& bytes)
{
    uint _155;
    if (bytes == 4u)
    {
        _155 = word;
    }
    else
    {
        _155 = (word >> (8u * ((at * bytes) & 3u))) & ((1u << (8u * bytes)) - 1u);
    }
    return _155;
}

static inline __attribute__((always_inline))
float weight_at(thread const uint& at, constant Skinning& mesh, const device Weights& weights)
{
    if (mesh.weight_bytes == 0u)
    {
        return 1.0;
    }
    uint param = weights.words[(at * mesh.weight_bytes) / 4u];
    uint param_1 = at;
    uint param_2 = mesh.weight_bytes;
    uint stored = number_in(param, param_1, param_2);
    if (mesh.weight_bytes == 4u)
    {
        return as_type<float>(stored);
    }
    return float(stored) / ((mesh.weight_bytes == 2u) ? 65535.0 : 255.0);
}

static inline __attribute__((always_inline))
uint bone_at(thread const uint& at, constant Skinning& mesh, const device Bones& bones)
{
    uint param = bones.words[(at * mesh.bone_bytes) / 4u];
    uint param_1 = at;
    uint param_2 = mesh.bone_bytes;
    return number_in(param, param_1, param_2);
}

static inline __attribute__((always_inline))
float3 turned(thread const float4& rotation, thread const float3& v)
{
    return v + (cross(rotation.xyz, cross(rotation.xyz, v) + (v * rotation.w)) * 2.0);
}

static inline __attribute__((always_inline))
float3x4 blend_dual(thread const uint& vertex0, thread const uint& first, const device Transforms& transforms, constant Skinning& mesh, const device Bones& bones, const device Weights& weights)
{
    uint end = (vertex0 + 1u) * mesh.influences;
    uint heaviest = vertex0 * mesh.influences;
    uint _336 = heaviest + 1u;
    for (uint at = _336; at < end; at++)
    {
        uint param = at;
        uint param_1 = heaviest;
        if (weight_at(param, mesh, weights) > weight_at(param_1, mesh, weights))
        {
            heaviest = at;
        }
    }
    bool _359 = mesh.influences == 0u;
    bool _368;
    if (!_359)
    {
        uint param_2 = heaviest;
        _368 = !(weight_at(param_2, mesh, weights) > 0.0);
    }
    else
    {
        _368 = _359;
    }
    if (_368)
    {
        return float3x4(float4(0.0), float4(0.0), float4(0.0));
    }
    uint param_3 = heaviest;
    float4 pivot = transforms.rows[5u * (first + bone_at(param_3, mesh, bones))];
    float4 real = float4(0.0);
    float4 dual_part = float4(0.0);
    float3x4 stretch = float3x4(float4(0.0), float4(0.0), float4(0.0));
    float _all = 0.0;
    uint _390 = vertex0 * mesh.influences;
    float _422;
    for (uint at_1 = _390; at_1 < end; at_1++)
    {
        uint param_4 = at_1;
        float weight = weight_at(param_4, mesh, weights);
        if (weight == 0.0)
        {
            continue;
        }
        uint param_5 = at_1;
        uint motion = 5u * (first + bone_at(param_5, mesh, bones));
        if (dot(transforms.rows[motion], pivot) < 0.0)
        {
            _422 = -weight;
        }
        else
        {
            _422 = weight;
        }
        float side = _422;
        real += (transforms.rows[motion] * side);
        dual_part += (transforms.rows[motion + 1u] * side);
        float3x4 _474 = float3x4(float4(transforms.rows[motion + 2u]), float4(transforms.rows[motion + 3u]), float4(transforms.rows[motion + 4u])) * weight;
        stretch = float3x4(stretch[0] + _474[0], stretch[1] + _474[1], stretch[2] + _474[2]);
        _all += weight;
    }
    float size = length(real);
    real /= float4(size);
    dual_part /= float4(size);
    float4x3 columns = transpose(stretch) * (1.0 / _all);
    float3 shift = (((dual_part.xyz * real.w) - (real.xyz * dual_part.w)) + cross(real.xyz, dual_part.xyz)) * 2.0;
    for (int c = 0; c < 4; c++)
    {
        float4 param_6 = real;
        float3 param_7 = columns[c];
        columns[c] = turned(param_6, param_7);
    }
    columns[3] += shift;
    return transpose(columns);
}

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
float3x4 blend_linear(thread const uint& vertex0, thread const uint& first, const device Transforms& transforms, constant Skinning& mesh, const device Bones& bones, const device Weights& weights)
{
    if (mesh.influences == 0u)
    {
        uint param = first;
        return palette_rows(param, transforms, mesh);
    }
    float3x4 sum = float3x4(float4(0.0), float4(0.0), float4(0.0));
    uint _258 = vertex0 * mesh.influences;
    for (uint at = _258; at < ((vertex0 + 1u) * mesh.influences); at++)
    {
        uint param_1 = at;
        float weight = weight_at(param_1, mesh, weights);
        if (weight != 0.0)
        {
            uint param_2 = at;
            uint param_3 = first + bone_at(param_2, mesh, bones);
            float3x4 _288 = palette_rows(param_3, transforms, mesh) * weight;
            sum = float3x4(sum[0] + _288[0], sum[1] + _288[1], sum[2] + _288[2]);
        }
    }
    return sum;
}

static inline __attribute__((always_inline))
float3 unit_or_zero(thread const float3& v)
{
    float size = length(v);
    float3 _562;
    if (size > 0.0)
    {
        _562 = v / float3(size);
    }
    else
    {
        _562 = float3(0.0);
    }
    return _562;
}

static inline __attribute__((always_inline))
Vertex skin_vertex(thread const uint& vertex0, thread const uint& character, const device Transforms& transforms, constant Skinning& mesh, const device Bones& bones, const device Weights& weights, const device Positions& positions, const device Normals& normals, const device Tangents& tangents)
{
    uint first = (character * mesh.entries) + mesh.first_entry;
    float3x4 _589;
    if (mesh.dual != 0u)
    {
        uint param = vertex0;
        uint param_1 = first;
        _589 = blend_dual(param, param_1, transforms, mesh, bones, weights);
    }
    else
    {
        uint param_2 = vertex0;
        uint param_3 = first;
        _589 = blend_linear(param_2, param_3, transforms, mesh, bones, weights);
    }
    float3x4 rows = _589;
    float3 x = rows[0].xyz;
    float3 y = rows[1].xyz;
    float3 z = rows[2].xyz;
    float3x3 cofactors = float3x3(float3(cross(y, z)), float3(cross(z, x)), float3(cross(x, y)));
    float side = (dot(x, cofactors[0]) < 0.0) ? (-1.0) : 1.0;
    uint at = 3u * vertex0;
    float3 position = float3(positions.floats[at], positions.floats[at + 1u], positions.floats[at + 2u]);
    Vertex result = Vertex{ float4(position, 1.0) * rows, float3(0.0), float4(0.0) };
    if (mesh.has_normals != 0u)
    {
        float3 normal = float3(normals.floats[at], normals.floats[at + 1u], normals.floats[at + 2u]);
        float3 param_4 = normal * cofactors;
        result.normal = unit_or_zero(param_4) * side;
    }
    if (mesh.has_tangents != 0u)
    {
        at = 4u * vertex0;
        float3 tangent = float3(tangents.floats[at], tangents.floats[at + 1u], tangents.floats[at + 2u]);
        float3 param_5 = tangent * float3x3(float3(x), float3(y), float3(z));
        result.tangent = float4(unit_or_zero(param_5), side * tangents.floats[at + 3u]);
    }
    return result;
}

vertex main0_out main0(main0_in in [[stage_in]], constant Skinning& mesh [[buffer(0)]], const device Transforms& transforms [[buffer(1)]], const device Positions& positions [[buffer(2)]], const device Normals& normals [[buffer(3)]], const device Tangents& tangents [[buffer(4)]], const device Bones& bones [[buffer(5)]], const device Weights& weights [[buffer(6)]], uint gl_VertexIndex [[vertex_id]], uint gl_InstanceIndex [[instance_id]])
{
    main0_out out = {};
    uint param = uint(int(gl_VertexIndex));
    uint param_1 = uint(int(gl_InstanceIndex));
    Vertex result = skin_vertex(param, param_1, transforms, mesh, bones, weights, positions, normals, tangents);
    out.coords = in.texture_coords;
    out.position = result.position;
    out.normal = result.normal;
    out.tangent = result.tangent;
    out.gl_Position = mesh.view_projection * float4(out.position, 1.0);
    return out;
}

