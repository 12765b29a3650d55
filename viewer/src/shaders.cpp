#include "shaders.h"

namespace bendy::viewer {

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
uniform samplerBuffer target_weights;
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
        float weight = texelFetch(target_weights, int(first.w)).x;
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
uniform vec3 key_light;  // unit, towards it
uniform vec4 base_colour;
uniform vec3 emissive;
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

vec2 coords(int use) {
    int set = uv_set[use];
    vec2 uv = set == 0 ? uv01.xy : set == 1 ? uv01.zw : set == 2 ? uv23.xy : uv23.zw;
    return (uv_matrix[use] * vec3(uv, 1.0)).xy;
}

vec3 shading_normal(bool is_front) {
    vec3 across = dFdx(world);
    vec3 up = dFdy(world);
    vec3 n = world_normal;
    // Without normals: flat. The derivatives' cross product looks at the viewer.
    if (dot(n, n) < 0.25) n = cross(across, up) * (is_front ? 1.0 : -1.0);
    n = normalize(n);
    if (has_normal_map) {
        vec2 uv = coords(2);
        vec3 m = texture(normal_map, uv).xyz * 2.0 - 1.0;
        m.xy *= normal_scale;
        vec3 t = world_tangent.xyz;
        vec3 b;
        if (dot(t, t) > 0.0) {
            t = normalize(t - n * dot(n, t));
            b = cross(n, t) * world_tangent.w;
        } else {
            // The tangents from the derivatives of the coordinates: Schueler, "Normal mapping without precomputed
            // tangents", ShaderX 5. The map's green points up, the coordinates' v down.
            vec2 du = dFdx(uv);
            vec2 dv = dFdy(uv);
            vec3 c1 = cross(up, n);
            vec3 c2 = cross(n, across);
            t = c1 * du.x + c2 * dv.x;
            b = c1 * du.y + c2 * dv.y;
            float longest = max(dot(t, t), dot(b, b));
            float shrink = longest > 0.0 ? inversesqrt(longest) : 0.0;
            t *= shrink;
            b *= -shrink;
        }
        vec3 bent = t * m.x + b * m.y + n * m.z;
        if (dot(bent, bent) > 0.0) n = normalize(bent);
    }
    return is_front ? n : -n;
}

/// A sky, brighter above, with a soft window behind the key light; the rougher the surface, the softer.
vec3 sky(vec3 direction, float rough) {
    float height = direction.y;
    float edge = mix(0.15, 1.0, rough);
    vec3 colour = mix(vec3(0.20, 0.19, 0.18), vec3(0.62, 0.66, 0.72), smoothstep(-edge, edge, height));
    float towards = max(dot(direction, key_light), 0.0);
    return colour + vec3(0.5, 0.48, 0.44) * pow(towards, mix(24.0, 2.0, rough)) * mix(1.5, 0.3, rough);
}

vec3 shade(vec3 albedo, float metal, float rough, vec3 n, vec3 v, float occlusion) {
    vec3 f0 = mix(vec3(0.04), albedo, metal);
    vec3 diffuse = albedo * (1.0 - metal);
    float nv = max(dot(n, v), 1e-3);
    vec3 h = normalize(key_light + v);
    float nl = max(dot(n, key_light), 0.0);
    float nh = max(dot(n, h), 0.0);
    float vh = max(dot(v, h), 0.0);
    float a = max(rough * rough, 2e-3);
    float a2 = a * a;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float distribution = a2 / (kPi * d * d);
    float visibility = 0.5 / max(nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2), 1e-5);
    vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - vh, 5.0);
    vec3 lit = nl * 2.2 * ((1.0 - fresnel) * diffuse / kPi * 1.6 + fresnel * distribution * visibility);
    // The sky: Karis, "Physically based shading on mobile", 2014, for the share that is mirrored.
    vec4 r = rough * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    vec2 share = vec2(-1.04, 1.04) * a004 + r.zw;
    lit += occlusion * (diffuse * sky(n, 1.0) * 0.75 + (f0 * share.x + share.y) * sky(reflect(-v, n), rough));
    return lit;
}

/// Bright colours run softly into white instead of being cut: Khronos' PBR neutral tone mapper, 2024.
vec3 tone_mapped(vec3 colour) {
    const float start = 0.8 - 0.04;
    const float desaturation = 0.15;
    float x = min(colour.r, min(colour.g, colour.b));
    float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
    colour -= offset;
    float peak = max(colour.r, max(colour.g, colour.b));
    if (peak < start) return colour;
    float d = 1.0 - start;
    float new_peak = 1.0 - d * d / (peak + d - start);
    colour *= new_peak / peak;
    float g = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(colour, vec3(new_peak), g);
}

void main() {
    bool is_front = !has_faces || (gl_FrontFacing == (mirrored > 0.0));
    if (!is_front && !double_sided) discard;
    if (which_faces == 1 && !is_front) discard;
    if (which_faces == 2 && is_front) discard;
    vec4 base = base_colour * vertex_colour * texture(base_colour_map, coords(0));
    if (alpha_mode == 1 && base.a < alpha_cutoff) discard;
    float alpha = alpha_mode == 2 ? base.a : 1.0;
    if (unlit || (!has_faces && dot(world_normal, world_normal) < 0.25)) {
        result = vec4(base.rgb, alpha);
        return;
    }
    vec2 metallic_roughness = texture(metallic_roughness_map, coords(1)).bg * vec2(metallic, roughness);
    float occlusion = 1.0 + occlusion_strength * (texture(occlusion_map, coords(3)).r - 1.0);
    vec3 n = shading_normal(is_front);
    vec3 v = normalize(eye - world);
    vec3 lit = shade(base.rgb, clamp(metallic_roughness.x, 0.0, 1.0), clamp(metallic_roughness.y, 0.0, 1.0), n, v, occlusion);
    lit += emissive * texture(emissive_map, coords(4)).rgb;
    result = vec4(tone_mapped(lit), alpha);
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
