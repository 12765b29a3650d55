#include "influences.h"

#include "failure.h"

#include <algorithm>
#include <cmath>

namespace bendy::converter {
namespace {

/// How far a sum of weights may be from 1 per weight that adds to it: float rounding of decoded or stored weights. The
/// same as the Khronos validator's.
constexpr double kRounding = 2e-7;

/// A weight below this is no rounding of zero.
constexpr float kNegative = -1e-3f;

}  // namespace

LargestBone normalise_influences(Influences& influences, const std::string& place, Report& report) {
    const std::size_t n = influences.per_vertex;
    const std::size_t vertices = influences.bones.size() / n;
    LargestBone largest;
    std::uint64_t unnormalised = 0;
    std::uint64_t weightless = 0;
    std::uint64_t negative = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        std::uint32_t* bones = influences.bones.data() + v * n;
        float* weights = influences.weights.data() + v * n;
        double sum = 0.0;
        int used = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (weights[i] < 0.0f) {
                if (weights[i] < kNegative) {
                    fail(place,
                         "vertex " + std::to_string(v) + ": weight " + std::to_string(weights[i]) + " is negative");
                }
                weights[i] = 0.0f;
                ++negative;
            }
            sum += static_cast<double>(weights[i]);
            if (weights[i] > 0.0f) ++used;
        }
        if (used == 0) {
            weights[0] = 1.0f;
            ++weightless;
        } else if (std::abs(sum - 1.0) > kRounding * used) {
            for (std::size_t i = 0; i < n; ++i) weights[i] = static_cast<float>(static_cast<double>(weights[i]) / sum);
            ++unnormalised;
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (!(weights[i] > 0.0f)) continue;
            bones[kept] = bones[i];
            weights[kept] = weights[i];
            if (bones[kept] > largest.bone) largest = {bones[kept], v};
            ++kept;
        }
        std::fill(bones + kept, bones + n, 0u);
        std::fill(weights + kept, weights + n, 0.0f);
    }
    if (unnormalised > 0) report.warn("weights of a vertex did not sum to 1, normalised", place, unnormalised);
    if (weightless > 0) report.warn("vertex without weights, bound to its first joint", place, weightless);
    if (negative > 0) report.warn("weight a little below zero set to zero", place, negative);
    return largest;
}

void trim_influences(Mesh& mesh) {
    const std::size_t n = mesh.influences;
    if (n == 0) return;
    std::size_t used = 1;
    const std::size_t vertices = mesh.positions.size();
    for (std::size_t v = 0; v < vertices; ++v) {
        while (used < n && mesh.weights[v * n + used] > 0.0f) ++used;
    }
    if (used == n) return;
    for (std::size_t v = 0; v < vertices; ++v) {
        for (std::size_t i = 0; i < used; ++i) {
            mesh.bones[v * used + i] = mesh.bones[v * n + i];
            mesh.weights[v * used + i] = mesh.weights[v * n + i];
        }
    }
    mesh.bones.resize(vertices * used);
    mesh.weights.resize(vertices * used);
    mesh.bones.shrink_to_fit();
    mesh.weights.shrink_to_fit();
    mesh.influences = static_cast<std::uint32_t>(used);
}

}  // namespace bendy::converter
