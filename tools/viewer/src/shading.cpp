#include "shading.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace bendy::viewer {
namespace {

glm::vec3 towards(float yaw, float height) {
    return glm::normalize(glm::vec3(std::sin(yaw), height, std::cos(yaw)));
}

constexpr unsigned kSamples = 512;

/// Mirrors the bits of a number at the binary point: a low-discrepancy sequence in 0 to 1.
float radical_inverse(unsigned number) {
    float value = 0.0f;
    for (float digit = 0.5f; number != 0; number >>= 1u, digit *= 0.5f) {
        if ((number & 1u) != 0) value += digit;
    }
    return value;
}

}  // namespace

Lighting lighting_for(const Camera& camera) {
    Lighting lighting;
    lighting.directions = {towards(camera.yaw() - 0.7f, 0.85f), towards(camera.yaw() + 2.4f, 0.6f)};
    lighting.irradiance = {2.4f, 1.2f};
    return lighting;
}

std::vector<float> reflectance_table(unsigned side) {
    std::vector<float> table;
    table.reserve(std::size_t{2} * side * side);
    for (unsigned row = 0; row < side; ++row) {
        const float nv = (static_cast<float>(row) + 0.5f) / static_cast<float>(side);
        const float across = std::sqrt(1.0f - nv * nv);  // the view is (across, 0, nv), the normal Z
        for (unsigned column = 0; column < side; ++column) {
            const float roughness = (static_cast<float>(column) + 0.5f) / static_cast<float>(side);
            const float a2 = roughness * roughness * roughness * roughness;
            float scale = 0.0f;
            float bias = 0.0f;
            for (unsigned k = 0; k < kSamples; ++k) {
                // Half vectors with the distribution of GGX.
                const float turn = 6.2831853f * (static_cast<float>(k) + 0.5f) / kSamples;
                const float u = radical_inverse(k);
                const float nh = std::sqrt((1.0f - u) / (1.0f + (a2 - 1.0f) * u));
                const float vh = across * std::sqrt(std::max(0.0f, 1.0f - nh * nh)) * std::cos(turn) + nv * nh;
                const float nl = 2.0f * vh * nh - nv;
                if (nl <= 0.0f || vh <= 0.0f) continue;
                const float smith =
                    nl * std::sqrt(nv * nv * (1.0f - a2) + a2) + nv * std::sqrt(nl * nl * (1.0f - a2) + a2);
                const float share = 2.0f * nl * vh / (nh * smith);
                const float fresnel = std::pow(1.0f - vh, 5.0f);
                scale += (1.0f - fresnel) * share;
                bias += fresnel * share;
            }
            table.insert(table.end(), {scale / kSamples, bias / kSamples});
        }
    }
    return table;
}

const char* const kSkinShader = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec4 coords01;
layout(location = 4) in vec4 coords23;
layout(location = 5) in vec4 colour;
layout(location = 6) in uvec2 influences;     // first, count
layout(location = 7) in uvec2 displacements;  // first, count

uniform samplerBuffer palette;         // three rows of each matrix
uniform usamplerBuffer influence_list; // palette entry, bits of the weight
uniform samplerBuffer displacement_list;  // position and target, normal, tangent
uniform samplerBuffer morph_weights;
uniform mat4 view_projection;

out vec3 world;
out vec3 world_normal;
out vec4 world_tangent;
out vec4 uv01;
out vec4 uv23;
out vec4 vertex_colour;
flat out float mirrored;
flat out int number;

vec3 transformed(mat3x4 rows, vec4 v) { return v * rows; }

void main() {
    vec3 p = position;
    vec3 n = normal;
    vec3 t = tangent.xyz;
    for (uint k = 0u; k < displacements.y; ++k) {
        int at = 3 * int(displacements.x + k);
        vec4 first = texelFetch(displacement_list, at);
        float weight = texelFetch(morph_weights, int(first.w)).x;
        if (weight == 0.0) continue;
        p += weight * first.xyz;
        n += weight * texelFetch(displacement_list, at + 1).xyz;
        t += weight * texelFetch(displacement_list, at + 2).xyz;
    }
    mat3x4 rows = mat3x4(0.0);
    for (uint k = 0u; k < influences.y; ++k) {
        uvec2 influence = texelFetch(influence_list, int(influences.x + k)).xy;
        int at = 3 * int(influence.x);
        rows += uintBitsToFloat(influence.y) *
            mat3x4(texelFetch(palette, at), texelFetch(palette, at + 1), texelFetch(palette, at + 2));
    }
    mat3 linear = transpose(mat3(rows[0].xyz, rows[1].xyz, rows[2].xyz));
    float determinant_sign = dot(linear[0], cross(linear[1], linear[2])) < 0.0 ? -1.0 : 1.0;
    // Inverse transpose times the determinant's size, defined without an inverse too.
    mat3 cofactors = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
    world = transformed(rows, vec4(p, 1.0));
    world_normal = determinant_sign * (cofactors * n);
    float long_enough = dot(world_normal, world_normal);
    if (long_enough > 0.0) world_normal *= inversesqrt(long_enough);
    world_tangent = vec4(linear * t, determinant_sign * tangent.w);
    uv01 = coords01;
    uv23 = coords23;
    vertex_colour = colour;
    mirrored = determinant_sign;
    number = gl_VertexID;
    gl_Position = view_projection * vec4(world, 1.0);
}
)";

const char* const kSurfaceShader = R"(#version 330 core
in vec3 world;
in vec3 world_normal;
in vec4 world_tangent;
in vec4 uv01;
in vec4 uv23;
in vec4 vertex_colour;
flat in float mirrored;

uniform vec3 eye;
uniform mat3 to_view;
uniform vec3 light_direction[2];  // unit, towards them
uniform vec2 light_irradiance;
uniform float sky;          // irradiance from above,
uniform float ground;       // and from below
uniform float environment;  // radiance from everywhere
uniform sampler2D reflectance;  // by roughness and the cosine between normal and view
uniform vec4 base_colour;
uniform vec3 emissive;
uniform vec3 dielectric;  // reflectance of a non-metal at normal incidence,
uniform float dielectric_at_grazing;  // and at grazing incidence
uniform float metallic;
uniform float roughness;
uniform float normal_scale;
uniform float occlusion_strength;
uniform float alpha_cutoff;
uniform int alpha_mode;  // 0 opaque, 1 mask, 2 blend
uniform bool double_sided;
uniform bool unlit;
uniform bool has_normal_map;
uniform bool has_faces;  // false: lines and points
uniform int which_faces;  // 0 both, 1 only front, 2 only back
uniform sampler2D base_colour_map;
uniform sampler2D metallic_roughness_map;
uniform sampler2D normal_map;
uniform sampler2D occlusion_map;
uniform sampler2D emissive_map;
uniform int uv_set[5];
uniform mat3 uv_matrix[5];

out vec4 result;

const float kPi = 3.14159265;
const float kSmoothest = 0.045;  // minimal roughness: a perfect mirror shows no highlight of a directional light

vec2 coords(int use) {
    int set = uv_set[use];
    vec2 uv = set == 0 ? uv01.xy : set == 1 ? uv01.zw : set == 2 ? uv23.xy : uv23.zw;
    return (uv_matrix[use] * vec3(uv, 1.0)).xy;
}

/// The normal on the viewer's side; flat if the mesh has no normals.
vec3 smooth_normal(bool is_front) {
    if (dot(world_normal, world_normal) < 0.25) return normalize(cross(dFdx(world), dFdy(world)));
    return normalize(world_normal) * (is_front ? 1.0 : -1.0);
}

/// The normal after normal mapping. On back faces tangent and bitangent are reversed together with the normal.
vec3 bent_normal(vec3 n, bool is_front) {
    if (!has_normal_map) return n;
    float side = is_front ? 1.0 : -1.0;
    vec2 uv = coords(2);
    vec3 m = texture(normal_map, uv).xyz * 2.0 - 1.0;
    m.xy *= normal_scale;
    vec3 t = world_tangent.xyz;
    vec3 b;
    if (dot(t, t) > 0.0) {
        t = normalize(t) * side;
        b = cross(n, t) * (side * world_tangent.w);
        b *= inversesqrt(max(dot(b, b), 1e-20));
    } else {
        // Tangents from the derivatives of the coordinates: Schueler, "Normal mapping without precomputed tangents",
        // ShaderX 5. The map's green axis points up, the coordinates' v axis down.
        vec2 du = dFdx(uv);
        vec2 dv = dFdy(uv);
        vec3 c1 = cross(dFdy(world), n);
        vec3 c2 = cross(n, dFdx(world));
        t = c1 * du.x + c2 * dv.x;
        b = c1 * du.y + c2 * dv.y;
        float longest = max(dot(t, t), dot(b, b));
        float shrink = longest > 0.0 ? inversesqrt(longest) : 0.0;
        t *= side * shrink;
        b *= -side * shrink;
    }
    vec3 bent = t * m.x + b * m.y + n * m.z;
    return dot(bent, bent) > 0.0 ? normalize(bent) : n;
}

/// Schlick's approximation in the form of Karis, "Real shading in Unreal Engine 4", 2013.
vec3 fresnel(vec3 f0, float f90, float vh) {
    float f = exp2((-5.55473 * vh - 6.98316) * vh);
    return f0 * (1.0 - f) + f90 * f;
}

/// Single and multiple scattering: Fdez-Aguera, "A multiple-scattering microfacet model for real-time image-based
/// lighting", 2019. `even`: the reflectance of this roughness under uniform light.
void scattering(vec2 even, vec3 f0, float f90, out vec3 once, out vec3 often) {
    once = f0 * even.x + f90 * even.y;
    float rest = 1.0 - even.x - even.y;
    vec3 average = f0 + (1.0 - f0) / 21.0;
    often = once * average / (1.0 - rest * average) * rest;
}

/// glTF 2.0, appendix B: a dielectric over a diffuse base, mixed with a metal. Energy lost to multiple scattering is
/// restored as in three.js (for the directional lights: Turquin, "Practical multiple scattering compensation", 2019),
/// so that the picture matches other programs' pictures of a glTF file.
vec3 shade(vec3 albedo, float metal, float rough, vec3 n, vec3 v, float occlusion) {
    vec3 f0 = mix(dielectric, albedo, metal);
    float f90 = mix(dielectric_at_grazing, 1.0, metal);
    vec3 diffuse = albedo * (1.0 - metal);
    float nv = clamp(dot(n, v), 0.0, 1.0);
    vec2 even = texture(reflectance, vec2(rough, nv)).xy;
    vec3 compensation = 1.0 + f0 * (1.0 / (even.x + even.y) - 1.0);
    float a2 = rough * rough * rough * rough;
    vec3 lit = vec3(0.0);
    for (int k = 0; k < 2; ++k) {
        vec3 l = light_direction[k];
        vec3 h = normalize(l + v);
        float nl = clamp(dot(n, l), 0.0, 1.0);
        float nh = clamp(dot(n, h), 0.0, 1.0);
        float vh = clamp(dot(v, h), 0.0, 1.0);
        float d = nh * nh * (a2 - 1.0) + 1.0;
        float distribution = a2 / (kPi * d * d);
        float visibility = 0.5 / max(nl * sqrt(a2 + (1.0 - a2) * nv * nv) + nv * sqrt(a2 + (1.0 - a2) * nl * nl), 1e-6);
        vec3 mirrored_share = fresnel(f0, f90, vh) * distribution * visibility * compensation;
        lit += nl * light_irradiance[k] * (mirrored_share + (1.0 - fresnel(dielectric, f90, vh)) * diffuse / kPi);
    }
    vec3 once;
    vec3 often;
    scattering(even, dielectric, f90, once, often);
    vec3 base = diffuse * (1.0 - once - often);
    vec3 metal_once;
    vec3 metal_often;
    scattering(even, albedo, f90, metal_once, metal_often);
    vec3 around = mix(once + often, metal_once + metal_often, metal);
    float hemisphere = mix(ground, sky, 0.5 * n.y + 0.5);
    // Lagarde and de Rousiers, "Moving Frostbite to physically based rendering", 2014: reflections are occluded less.
    float mirrored_occlusion = clamp(pow(nv + occlusion, exp2(-16.0 * rough - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
    return lit + occlusion * base * (hemisphere / kPi + environment) + mirrored_occlusion * around * environment;
}

void main() {
    bool is_front = !has_faces || (gl_FrontFacing == (mirrored > 0.0));
    if (!is_front && !double_sided) discard;
    if (which_faces == 1 && !is_front) discard;
    if (which_faces == 2 && is_front) discard;
    vec4 base = base_colour * vertex_colour * texture(base_colour_map, coords(0));
    if (alpha_mode == 1 && base.a < alpha_cutoff) discard;
    float alpha = alpha_mode == 2 ? base.a : 1.0;
    if (unlit || !has_faces) {  // lines and points have no side to light
        result = vec4(base.rgb, alpha);
        return;
    }
    vec2 metallic_roughness = texture(metallic_roughness_map, coords(1)).bg * vec2(metallic, roughness);
    float occlusion = 1.0 + occlusion_strength * (texture(occlusion_map, coords(3)).r - 1.0);
    vec3 n = smooth_normal(is_front);
    // If the normal varies within a pixel, the roughness is raised, so that highlights do not flicker.
    vec3 seen = to_view * n;
    vec3 change = max(abs(dFdx(seen)), abs(dFdy(seen)));
    float rough = max(clamp(metallic_roughness.y, 0.0, 1.0), kSmoothest);
    rough = min(rough + max(max(change.x, change.y), change.z), 1.0);
    vec3 lit = shade(base.rgb, clamp(metallic_roughness.x, 0.0, 1.0), rough, bent_normal(n, is_front), normalize(eye - world),
                     occlusion);
    lit += emissive * texture(emissive_map, coords(4)).rgb;
    result = vec4(lit, alpha);
}
)";

const char* const kFlatShader = R"(#version 330 core
uniform vec4 flat_colour;
out vec4 result;
void main() { result = flat_colour; }
)";

const char* const kNumberShader = R"(#version 330 core
flat in int number;
uniform bool depth_only;
out vec4 result;
void main() {
    result = vec4(vec3(number & 255, (number >> 8) & 255, (number >> 16) & 255) / 255.0, depth_only ? 0.0 : 1.0);
    if (depth_only) result = vec4(0.0);
}
)";

const char* const kOverlayVertexShader = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 other;  // a line's other end; the position itself in a triangle
layout(location = 2) in vec4 colour;
layout(location = 3) in float side;  // pixels from the middle to the edge; sign by corner

uniform mat4 view_projection;
uniform vec2 size;  // pixels

out vec4 overlay_colour;

void main() {
    overlay_colour = colour;
    vec4 here = view_projection * vec4(position, 1.0);
    if (side != 0.0) {
        vec4 there = view_projection * vec4(other, 1.0);
        const float near = 1e-4;
        // An end behind the eye is drawn back to just before it.
        vec4 from = here;
        if (here.w < near && there.w > near) from = mix(here, there, (near - here.w) / (there.w - here.w));
        if (there.w < near && here.w > near) there = mix(there, here, (near - there.w) / (here.w - there.w));
        vec2 along = (there.xy / there.w - from.xy / from.w) * size;
        float far = length(along);
        vec2 across = far > 1e-6 ? vec2(-along.y, along.x) / far : vec2(1.0, 0.0);
        from.xy += across * side * 2.0 / size * from.w;
        here = from;
    }
    gl_Position = here;
}
)";

const char* const kOverlayShader = R"(#version 330 core
in vec4 overlay_colour;
out vec4 result;
void main() { result = overlay_colour; }
)";

}  // namespace bendy::viewer
