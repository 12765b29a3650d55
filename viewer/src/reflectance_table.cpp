#include "reflectance_table.h"

#include <algorithm>
#include <cmath>

namespace bendy::viewer {
namespace {

constexpr unsigned kSamples = 512;

/// The bits of a number in reverse, after the binary point: evenly spread from 0 to 1.
float radical_inverse(unsigned number) {
    float value = 0.0f;
    for (float digit = 0.5f; number != 0; number >>= 1u, digit *= 0.5f) {
        if ((number & 1u) != 0) value += digit;
    }
    return value;
}

}  // namespace

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
                // Half vectors as often as GGX has them.
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

}  // namespace bendy::viewer
