// Made by make.py from BENDY_MOTIONS of skinning.glsl. glslangValidator compiles it; it has not been run.
static const uint3 gl_WorkGroupSize = uint3(64u, 1u, 1u);

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

ByteAddressBuffer places : register(t2);
RWByteAddressBuffer motions : register(u3);

static uint3 gl_GlobalInvocationID;
struct SPIRV_Cross_Input
{
    uint3 gl_GlobalInvocationID : SV_DispatchThreadID;
};

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

float3x3 linear_part(float3x4 rows)
{
    return transpose(float3x3(float3(rows[0].xyz), float3(rows[1].xyz), float3(rows[2].xyz)));
}

float largest(float3x3 m)
{
    float3 most = max(abs(m[0]), max(abs(m[1]), abs(m[2])));
    return max(most.x, max(most.y, most.z));
}

float scale_of(float3x3 m)
{
    float volume = determinant(m);
    float scale = sign(volume) * pow(abs(volume), 0.3333333432674407958984375f);
    float3x3 param = m;
    if (!(abs(scale) > (9.9999997473787516355514526367188e-05f * largest(param))))
    {
        return 1.0f;
    }
    return scale - ((((scale * scale) * scale) - volume) / ((3.0f * scale) * scale));
}

float3 perpendicular(float3 v)
{
    bool3 _187 = ((v.x * v.x) > (0.5f * dot(v, v))).xxx;
    return normalize(cross(v, float3(_187.x ? float3(0.0f, 1.0f, 0.0f).x : float3(1.0f, 0.0f, 0.0f).x, _187.y ? float3(0.0f, 1.0f, 0.0f).y : float3(1.0f, 0.0f, 0.0f).y, _187.z ? float3(0.0f, 1.0f, 0.0f).z : float3(1.0f, 0.0f, 0.0f).z)));
}

float3 unit_unless_short(float3 v, float limit, float3 otherwise)
{
    float size = length(v);
    float3 _199;
    if (size > limit)
    {
        _199 = v / size.xxx;
    }
    else
    {
        float3 param = otherwise;
        _199 = perpendicular(param);
    }
    return _199;
}

float3x3 rigid_axes(float3x3 m)
{
    float limit = 9.9999999747524270787835121154785e-07f * max(length(m[0]), max(length(m[1]), length(m[2])));
    if (limit == 0.0f)
    {
        return float3x3(float3(1.0f, 0.0f, 0.0f), float3(0.0f, 1.0f, 0.0f), float3(0.0f, 0.0f, 1.0f));
    }
    float3 x = m[0];
    float3 y = m[1];
    if (length(x) > limit)
    {
        x = normalize(x);
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

float3x3 nearest_rotation(float3x3 m)
{
    float3x3 param = m;
    float size = largest(param);
    if (size == 0.0f)
    {
        return float3x3(float3(1.0f, 0.0f, 0.0f), float3(0.0f, 1.0f, 0.0f), float3(0.0f, 0.0f, 1.0f));
    }
    float3x3 at = m * (1.0f / size);
    float volume = determinant(at);
    if (!(volume > 9.9999999747524270787835121154785e-07f))
    {
        float3x3 param_1 = m;
        return rigid_axes(param_1);
    }
    at = at * (1.0f / pow(volume, 0.3333333432674407958984375f));
    for (int _step = 0; _step < 30; _step++)
    {
        float3x3 cofactors = float3x3(float3(cross(at[1], at[2])), float3(cross(at[2], at[0])), float3(cross(at[0], at[1])));
        float3x3 _380 = cofactors * (1.0f / dot(at[0], cofactors[0]));
        float3x3 next = float3x3(at[0] + _380[0], at[1] + _380[1], at[2] + _380[2]) * 0.5f;
        float3x3 param_2 = float3x3(next[0] - at[0], next[1] - at[1], next[2] - at[2]);
        float change = largest(param_2);
        at = next;
        if (change < 9.9999997473787516355514526367188e-05f)
        {
            break;
        }
    }
    return at;
}

float4 quaternion_of(float3x3 m)
{
    float3 d = float3(m[0].x, m[1].y, m[2].z);
    float4 squares = 1.0f.xxxx + float4((d.x - d.y) - d.z, (d.y - d.x) - d.z, (d.z - d.x) - d.y, (d.x + d.y) + d.z);
    float3 differences = float3(m[1].z - m[2].y, m[2].x - m[0].z, m[0].y - m[1].x);
    float3 sums = float3(m[1].z + m[2].y, m[2].x + m[0].z, m[0].y + m[1].x);
    float most = max(max(squares.x, squares.y), max(squares.z, squares.w));
    if (squares.w == most)
    {
        return normalize(float4(differences, squares.w));
    }
    if (squares.x == most)
    {
        return normalize(float4(squares.x, sums.z, sums.y, differences.x));
    }
    if (squares.y == most)
    {
        return normalize(float4(sums.z, squares.y, sums.x, differences.y));
    }
    return normalize(float4(sums.y, sums.x, squares.z, differences.z));
}

void comp_main()
{
    uint bone = gl_GlobalInvocationID.x;
    if (bone >= mesh_bones_used)
    {
        return;
    }
    uint first = (gl_GlobalInvocationID.y * mesh_entries) + mesh_first_entry;
    uint param = first + mesh_topmost;
    float3x4 param_1 = palette_rows(param);
    float3x3 param_2 = linear_part(param_1);
    float scale = scale_of(param_2);
    uint param_3 = first + bone;
    float3x4 rows = palette_rows(param_3);
    float3x4 param_4 = rows;
    float3x3 _linear = linear_part(param_4) * (1.0f / scale);
    float3 translation = float3(rows[0].w, rows[1].w, rows[2].w) / scale.xxx;
    float3 place = float3(asfloat(places.Load((3u * bone) * 4 + 0)), asfloat(places.Load(((3u * bone) + 1u) * 4 + 0)), asfloat(places.Load(((3u * bone) + 2u) * 4 + 0)));
    float3x3 _720;
    if (determinant(_linear) < 0.0f)
    {
        _720 = float3x3(-_linear[0], -_linear[1], -_linear[2]);
    }
    else
    {
        _720 = _linear;
    }
    float3x3 param_5 = _720;
    float3x3 turn = nearest_rotation(param_5);
    float3x3 stretch = mul(_linear, transpose(turn));
    float3x3 param_6 = turn;
    float4 real = quaternion_of(param_6);
    float3 shift = (mul(place, _linear) + translation) - mul(place, turn);
    float3x4 stretch_rows = transpose(float4x3(float3(stretch[0]), float3(stretch[1]), float3(stretch[2]), float3(place - mul(place, stretch)))) * scale;
    uint at = 5u * (first + bone);
    motions.Store4(at * 16 + 0, asuint(real));
    motions.Store4((at + 1u) * 16 + 0, asuint(float4((shift * real.w) + cross(shift, real.xyz), -dot(shift, real.xyz)) * (0.5f * scale)));
    for (int row = 0; row < 3; row++)
    {
        motions.Store4(((at + 2u) + uint(row)) * 16 + 0, asuint(stretch_rows[row]));
    }
}

[numthreads(64, 1, 1)]
void main(SPIRV_Cross_Input stage_input)
{
    gl_GlobalInvocationID = stage_input.gl_GlobalInvocationID;
    comp_main();
}
