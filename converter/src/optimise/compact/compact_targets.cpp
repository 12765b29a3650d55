#include "optimise/compact/compact_targets.h"

#include "optimise/compact/quantise.h"

#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace bendy::converter {
namespace {

using Weights = std::span<const float>;

double sum_of(Weights weights) {
    double sum = 0.0;
    for (const float weight : weights) sum += std::abs(double{weight});
    return sum;
}

/// The targets' weights at every key of the clips.
std::vector<Weights> keyed_weights(const Scene& scene, std::uint32_t number) {
    std::vector<Weights> keys;
    for (const Clip& clip : scene.clips) {
        for (const Track& track : clip.tracks) {
            if (track.path != TrackPath::weights || track.target != number || track.components == 0) continue;
            const bool is_cubic = track.interpolation == Interpolation::cubic;
            const std::size_t width = track.components;
            const std::size_t row = is_cubic ? 3 * width : width;
            for (std::size_t at = is_cubic ? width : 0; at + width <= track.values.size(); at += row)
                keys.push_back(Weights(track.values).subspan(at, width));
        }
    }
    return keys;
}

/// The weights that the targets have at rest and in the file's clips.
struct Demand {
    std::vector<Weights> some;  ///< an even choice of the keys, the rest weights, and the heaviest key
    double largest_sum = 1.0;   ///< of the absolute weights of any key, at least 1
    std::vector<double> peaks;  ///< per target, of its absolute weight at any key, at least 1
};

Demand demand_of(const std::vector<Weights>& keys, Weights rest) {
    constexpr std::size_t kMostKeys = 64;
    Demand demand;
    demand.some.push_back(rest);
    demand.largest_sum = std::max(1.0, sum_of(rest));
    for (const float weight : rest) demand.peaks.push_back(std::max(1.0, std::abs(double{weight})));
    const Weights* heaviest = nullptr;
    const std::size_t stride = keys.size() / kMostKeys + 1;
    for (std::size_t k = 0; k < keys.size(); ++k) {
        if (k % stride == 0) demand.some.push_back(keys[k]);
        for (std::size_t t = 0; t < std::min(keys[k].size(), demand.peaks.size()); ++t)
            demand.peaks[t] = std::max(demand.peaks[t], std::abs(double{keys[k][t]}));
        const double sum = sum_of(keys[k]);
        if (!(sum > demand.largest_sum)) continue;
        demand.largest_sum = sum;
        heaviest = &keys[k];
    }
    if (heaviest != nullptr) demand.some.push_back(*heaviest);
    return demand;
}

/// The factor by which the errors of all targets together may exceed those of one, even if all errors of a vertex point
/// the same way. Only the targets that move a vertex count for it.
double worst_factor(const Mesh& mesh, const Demand& demand) {
    std::vector<double> sums(mesh.positions.size());
    for (std::size_t t = 0; t < mesh.targets.size(); ++t) {
        const MorphTarget& target = mesh.targets[t];
        for (std::size_t v = 0; !target.is_frame && v < target.positions.size(); ++v)
            sums[v] += target.positions[v] == glm::vec3(0.0f) ? 0.0 : demand.peaks[t];
    }
    const auto largest = std::max_element(sums.begin(), sums.end());
    return std::min(demand.largest_sum, largest == sums.end() ? 1.0 : std::max(1.0, *largest));
}

/// A vertex, and by how much a target's integers move it off.
struct VertexError {
    std::uint32_t vertex = 0;
    glm::dvec3 metres{0.0};
};

struct Attempt {
    std::vector<std::optional<StoredStream>> streams;  // per target; absent: exact
    std::vector<std::vector<VertexError>> errors;      // per target
};

Attempt quantise_targets(const Mesh& mesh, double most_error) {
    Attempt attempt;
    std::vector<glm::vec3> decoded;
    for (const MorphTarget& target : mesh.targets) {
        auto& errors = attempt.errors.emplace_back();
        auto& stream = attempt.streams.emplace_back();
        if (target.is_frame) continue;  // its mesh has its numbers
        stream = quantise_shifts(target.positions, most_error);
        if (!stream) continue;
        decoded.resize(target.positions.size());
        stream->view().decode(std::span(decoded));
        for (std::size_t v = 0; v < decoded.size(); ++v) {
            if (decoded[v] == target.positions[v]) continue;
            errors.push_back({static_cast<std::uint32_t>(v), glm::dvec3(decoded[v]) - glm::dvec3(target.positions[v])});
        }
    }
    return attempt;
}

/// The farthest that a vertex is off at any of the chosen weights.
double largest_effect(const Mesh& mesh, const Attempt& attempt, const std::vector<Weights>& some) {
    double largest = 0.0;
    std::vector<glm::dvec3> off(mesh.positions.size());
    for (const Weights weights : some) {
        std::fill(off.begin(), off.end(), glm::dvec3(0.0));
        for (std::size_t t = 0; t < std::min(weights.size(), attempt.errors.size()); ++t) {
            if (weights[t] == 0.0f) continue;
            for (const VertexError& error : attempt.errors[t]) off[error.vertex] += double{weights[t]} * error.metres;
        }
        for (const glm::dvec3& by : off) largest = std::max(largest, glm::dot(by, by));
    }
    return std::sqrt(largest);
}

}  // namespace

void compact_targets(Scene& scene, std::uint32_t number, CompactMesh& compact, double most_error) {
    constexpr double kBetweenKeys = 1.25;  // allowance: other weights may be slightly worse than the chosen ones
    constexpr int kAttempts = 4;
    Mesh& mesh = scene.meshes[number];
    std::vector<float> rest;
    for (const MorphTarget& target : mesh.targets) rest.push_back(target.rest_weight);
    const Demand demand = demand_of(keyed_weights(scene, number), rest);
    const double surely = most_error / worst_factor(mesh, demand);
    double step = most_error;
    Attempt attempt = quantise_targets(mesh, step);
    for (int k = 1; k < kAttempts && step > surely; ++k) {
        const double effect = kBetweenKeys * largest_effect(mesh, attempt, demand.some);
        if (effect <= most_error) break;
        const double next = k + 1 < kAttempts ? 0.99 * step * most_error / effect : surely;
        step = std::isfinite(next) ? std::max(next, surely) : surely;
        attempt = quantise_targets(mesh, step);
    }
    for (std::size_t t = 0; t < mesh.targets.size(); ++t) {
        compact.targets[t].positions = std::move(attempt.streams[t]);
        if (compact.targets[t].positions)
            compact.targets[t].positions->view().decode(std::span(mesh.targets[t].positions));
    }
}

}  // namespace bendy::converter
