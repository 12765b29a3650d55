// Made by make.py from BENDY_DRAW of skinning.glsl. glslangValidator compiles it; it has not been run.
struct Vertex
{
    float3 position;
    float3 normal;
    float4 tangent;
};

ByteAddressBuffer transforms : register(t1);
cbuffer Skinning : register(b0)
{
    row_major float4x4 mesh_view_projection : packoffset(c0);
    uint mesh_vertices : packoffset(c4);
    uint mesh_influences : packoffset(c4.y);
    uint mesh_bone_bytes : packoffset(c4.z);
    uint mesh_weight_bytes : packoffset(c4.w);
    uint mesh_first_entry : packoffset(c5);
    uint mesh_entries : packoffset(c5.y);
    uint mesh_bones_used : packoffset(c5.z);
    uint mesh_topmost : packoffset(c5.w);
    uint mesh_by_columns : packoffset(c6);
    uint mesh_dual : packoffset(c6.y);
    uint mesh_has_normals : packoffset(c6.z);
    uint mesh_has_tangents : packoffset(c6.w);
};

ByteAddressBuffer bones : register(t5);
ByteAddressBuffer weights : register(t6);
ByteAddressBuffer positions : register(t2);
ByteAddressBuffer normals : register(t3);
ByteAddressBuffer tangents : register(t4);

static float4 gl_Position;
static int gl_VertexIndex;
static int gl_InstanceIndex;
static float2 coords;
static float2 texture_coords;
static float3 position;
static float3 normal;
static float4 tangent;

struct SPIRV_Cross_Input
{
    float2 texture_coords : TEXCOORD0;
    uint gl_VertexIndex : SV_VertexID;
    uint gl_InstanceIndex : SV_InstanceID;
};

struct SPIRV_Cross_Output
{
    float2 coords : TEXCOORD0;
    float3 position : TEXCOORD1;
    float3 normal : TEXCOORD2;
    float4 tangent : TEXCOORD3;
    float4 gl_Position : SV_Position;
};

uint number_in(uint word, uint at, uint bytes)
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

float weight_at(uint at)
{
    if (mesh_weight_bytes == 0u)
    {
        return 1.0f;
    }
    uint param = weights.Load(((at * mesh_weight_bytes) / 4u) * 4 + 0);
    uint param_1 = at;
    uint param_2 = mesh_weight_bytes;
    uint stored = number_in(param, param_1, param_2);
    if (mesh_weight_bytes == 4u)
    {
        return asfloat(stored);
    }
    return float(stored) / ((mesh_weight_bytes == 2u) ? 65535.0f : 255.0f);
}

uint bone_at(uint at)
{
    uint param = bones.Load(((at * mesh_bone_bytes) / 4u) * 4 + 0);
    uint param_1 = at;
    uint param_2 = mesh_bone_bytes;
    return number_in(param, param_1, param_2);
}

float3 turned(float4 rotation, float3 v)
{
    return v + (cross(rotation.xyz, cross(rotation.xyz, v) + (v * rotation.w)) * 2.0f);
}

float3x4 blend_dual(uint vertex, uint first)
{
    uint end = (vertex + 1u) * mesh_influences;
    uint heaviest = vertex * mesh_influences;
    uint _336 = heaviest + 1u;
    for (uint at = _336; at < end; at++)
    {
        uint param = at;
        uint param_1 = heaviest;
        if (weight_at(param) > weight_at(param_1))
        {
            heaviest = at;
        }
    }
    bool _359 = mesh_influences == 0u;
    bool _368;
    if (!_359)
    {
        uint param_2 = heaviest;
        _368 = !(weight_at(param_2) > 0.0f);
    }
    else
    {
        _368 = _359;
    }
    if (_368)
    {
        return float3x4(0.0f.xxxx, 0.0f.xxxx, 0.0f.xxxx);
    }
    uint param_3 = heaviest;
    float4 pivot = asfloat(transforms.Load4((5u * (first + bone_at(param_3))) * 16 + 0));
    float4 real = 0.0f.xxxx;
    float4 dual_part = 0.0f.xxxx;
    float3x4 stretch = float3x4(0.0f.xxxx, 0.0f.xxxx, 0.0f.xxxx);
    float _all = 0.0f;
    uint _390 = vertex * mesh_influences;
    float _422;
    for (uint at_1 = _390; at_1 < end; at_1++)
    {
        uint param_4 = at_1;
        float weight = weight_at(param_4);
        if (weight == 0.0f)
        {
            continue;
        }
        uint param_5 = at_1;
        uint motion = 5u * (first + bone_at(param_5));
        if (dot(asfloat(transforms.Load4(motion * 16 + 0)), pivot) < 0.0f)
        {
            _422 = -weight;
        }
        else
        {
            _422 = weight;
        }
        float side = _422;
        real += (asfloat(transforms.Load4(motion * 16 + 0)) * side);
        dual_part += (asfloat(transforms.Load4((motion + 1u) * 16 + 0)) * side);
        float3x4 _474 = float3x4(float4(asfloat(transforms.Load4((motion + 2u) * 16 + 0))), float4(asfloat(transforms.Load4((motion + 3u) * 16 + 0))), float4(asfloat(transforms.Load4((motion + 4u) * 16 + 0)))) * weight;
        stretch = float3x4(stretch[0] + _474[0], stretch[1] + _474[1], stretch[2] + _474[2]);
        _all += weight;
    }
    float size = length(real);
    real /= size.xxxx;
    dual_part /= size.xxxx;
    float4x3 columns = transpose(stretch) * (1.0f / _all);
    float3 shift = (((dual_part.xyz * real.w) - (real.xyz * dual_part.w)) + cross(real.xyz, dual_part.xyz)) * 2.0f;
    for (int c = 0; c < 4; c++)
    {
        float4 param_6 = real;
        float3 param_7 = columns[c];
        columns[c] = turned(param_6, param_7);
    }
    columns[3] += shift;
    return transpose(columns);
}

float3x4 palette_rows(uint entry)
{
    uint at = 4u * entry;
    float3x4 rows = float3x4(float4(asfloat(transforms.Load4(at * 16 + 0))), float4(asfloat(transforms.Load4((at + 1u) * 16 + 0))), float4(asfloat(transforms.Load4((at + 2u) * 16 + 0))));
    if (mesh_by_columns == 0u)
    {
        return rows;
    }
    return transpose(float4x3(float3(rows[0].xyz), float3(rows[1].xyz), float3(rows[2].xyz), float3(asfloat(transforms.Load4((at + 3u) * 16 + 0)).xyz)));
}

float3x4 blend_linear(uint vertex, uint first)
{
    if (mesh_influences == 0u)
    {
        uint param = first;
        return palette_rows(param);
    }
    float3x4 sum = float3x4(0.0f.xxxx, 0.0f.xxxx, 0.0f.xxxx);
    uint _258 = vertex * mesh_influences;
    for (uint at = _258; at < ((vertex + 1u) * mesh_influences); at++)
    {
        uint param_1 = at;
        float weight = weight_at(param_1);
        if (weight != 0.0f)
        {
            uint param_2 = at;
            uint param_3 = first + bone_at(param_2);
            float3x4 _288 = palette_rows(param_3) * weight;
            sum = float3x4(sum[0] + _288[0], sum[1] + _288[1], sum[2] + _288[2]);
        }
    }
    return sum;
}

float3 unit_or_zero(float3 v)
{
    float size = length(v);
    float3 _562;
    if (size > 0.0f)
    {
        _562 = v / size.xxx;
    }
    else
    {
        _562 = 0.0f.xxx;
    }
    return _562;
}

Vertex skin_vertex(uint vertex, uint character)
{
    uint first = (character * mesh_entries) + mesh_first_entry;
    float3x4 _589;
    if (mesh_dual != 0u)
    {
        uint param = vertex;
        uint param_1 = first;
        _589 = blend_dual(param, param_1);
    }
    else
    {
        uint param_2 = vertex;
        uint param_3 = first;
        _589 = blend_linear(param_2, param_3);
    }
    float3x4 rows = _589;
    float3 x = rows[0].xyz;
    float3 y = rows[1].xyz;
    float3 z = rows[2].xyz;
    float3x3 cofactors = float3x3(float3(cross(y, z)), float3(cross(z, x)), float3(cross(x, y)));
    float side = (dot(x, cofactors[0]) < 0.0f) ? (-1.0f) : 1.0f;
    uint at = 3u * vertex;
    float3 position_1 = float3(asfloat(positions.Load(at * 4 + 0)), asfloat(positions.Load((at + 1u) * 4 + 0)), asfloat(positions.Load((at + 2u) * 4 + 0)));
    Vertex _679 = { mul(rows, float4(position_1, 1.0f)), 0.0f.xxx, 0.0f.xxxx };
    Vertex result = _679;
    if (mesh_has_normals != 0u)
    {
        float3 normal_1 = float3(asfloat(normals.Load(at * 4 + 0)), asfloat(normals.Load((at + 1u) * 4 + 0)), asfloat(normals.Load((at + 2u) * 4 + 0)));
        float3 param_4 = mul(cofactors, normal_1);
        result.normal = unit_or_zero(param_4) * side;
    }
    if (mesh_has_tangents != 0u)
    {
        at = 4u * vertex;
        float3 tangent_1 = float3(asfloat(tangents.Load(at * 4 + 0)), asfloat(tangents.Load((at + 1u) * 4 + 0)), asfloat(tangents.Load((at + 2u) * 4 + 0)));
        float3 param_5 = mul(float3x3(float3(x), float3(y), float3(z)), tangent_1);
        result.tangent = float4(unit_or_zero(param_5), side * asfloat(tangents.Load((at + 3u) * 4 + 0)));
    }
    return result;
}

void vert_main()
{
    uint param = uint(gl_VertexIndex);
    uint param_1 = uint(gl_InstanceIndex);
    Vertex result = skin_vertex(param, param_1);
    coords = texture_coords;
    position = result.position;
    normal = result.normal;
    tangent = result.tangent;
    gl_Position = mul(float4(position, 1.0f), mesh_view_projection);
}

SPIRV_Cross_Output main(SPIRV_Cross_Input stage_input)
{
    gl_VertexIndex = int(stage_input.gl_VertexIndex);
    gl_InstanceIndex = int(stage_input.gl_InstanceIndex);
    texture_coords = stage_input.texture_coords;
    vert_main();
    SPIRV_Cross_Output stage_output;
    stage_output.gl_Position = gl_Position;
    stage_output.coords = coords;
    stage_output.position = position;
    stage_output.normal = normal;
    stage_output.tangent = tangent;
    return stage_output;
}
