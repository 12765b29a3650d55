// Made by make.py from BENDY_MORPH of skinning.glsl. It has been neither compiled nor run.
#include <metal_stdlib>
#include <simd/simd.h>

using namespace metal;

struct Morph
{
    uint elements;
    uint index_bytes;
    uint components;
    float weight;
};

struct Displaced
{
    uint words[1];
};

struct Sums
{
    float floats[1];
};

struct Displacements
{
    float floats[1];
};

constant uint3 gl_WorkGroupSize [[maybe_unused]] = uint3(64u, 1u, 1u);

kernel void main0(constant Morph& morph [[buffer(0)]], const device Displaced& displaced [[buffer(1)]], const device Displacements& displacements [[buffer(2)]], device Sums& sums [[buffer(3)]], uint3 gl_GlobalInvocationID [[thread_position_in_grid]])
{
    uint element = gl_GlobalInvocationID.x;
    if (element >= morph.elements)
    {
        return;
    }
    uint vertex0 = element;
    if (morph.index_bytes == 4u)
    {
        vertex0 = displaced.words[element];
    }
    if (morph.index_bytes == 2u)
    {
        vertex0 = (displaced.words[element / 2u] >> (16u * (element & 1u))) & 65535u;
    }
    uint at = morph.components * vertex0;
    for (uint c = 0u; c < 3u; c++)
    {
        uint _86 = at + c;
        sums.floats[_86] += (morph.weight * displacements.floats[(3u * element) + c]);
    }
}

