// Made by make.py from BENDY_MORPH of skinning.glsl. glslangValidator compiles it; it has not been run.
static const uint3 gl_WorkGroupSize = uint3(64u, 1u, 1u);

cbuffer Morph : register(b0)
{
    uint morph_elements : packoffset(c0);
    uint morph_index_bytes : packoffset(c0.y);
    uint morph_components : packoffset(c0.z);
    float morph_weight : packoffset(c0.w);
};

ByteAddressBuffer displaced : register(t1);
RWByteAddressBuffer sums : register(u3);
ByteAddressBuffer displacements : register(t2);

static uint3 gl_GlobalInvocationID;
struct SPIRV_Cross_Input
{
    uint3 gl_GlobalInvocationID : SV_DispatchThreadID;
};

void comp_main()
{
    uint element = gl_GlobalInvocationID.x;
    if (element >= morph_elements)
    {
        return;
    }
    uint vertex = element;
    if (morph_index_bytes == 4u)
    {
        vertex = displaced.Load(element * 4 + 0);
    }
    if (morph_index_bytes == 2u)
    {
        vertex = (displaced.Load((element / 2u) * 4 + 0) >> (16u * (element & 1u))) & 65535u;
    }
    uint at = morph_components * vertex;
    for (uint c = 0u; c < 3u; c++)
    {
        uint _86 = at + c;
        sums.Store(_86 * 4 + 0, asuint(asfloat(sums.Load(_86 * 4 + 0)) + (morph_weight * asfloat(displacements.Load(((3u * element) + c) * 4 + 0)))));
    }
}

[numthreads(64, 1, 1)]
void main(SPIRV_Cross_Input stage_input)
{
    gl_GlobalInvocationID = stage_input.gl_GlobalInvocationID;
    comp_main();
}
