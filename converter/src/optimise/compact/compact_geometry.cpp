#include "optimise/compact/compact_geometry.h"

#include "optimise/compact/compact_targets.h"
#include "optimise/compact/quantise.h"
#include "optimise/passes/level_order.h"
#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "scene/rest_frames.h"
#include "scene/source/image_bytes.h"

#include <bendy/format/bind_palette.h>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double2.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace bendy::converter {
namespace {

/// The largest factor by which the matrix lengthens a vector.
double largest_stretch(const glm::dmat4& matrix) {
    // Power iteration on M^T M from three starts; each gives a lower bound that quickly becomes tight.
    const glm::dmat3 linear(matrix);
    const glm::dmat3 square = glm::transpose(linear) * linear;
    double largest = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 v(0.3, 0.4, 0.5);
        v[axis] = 1.0;
        double length = 0.0;
        for (int turn = 0; turn < 24; ++turn) {
            v /= std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
            v = square * v;
            length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
            if (!(length > 0.0) || !std::isfinite(length)) break;
        }
        largest = std::max(largest, length);
    }
    constexpr double kSpare = 1.001;
    return std::sqrt(largest) * kSpare;
}

constexpr unsigned kDirectionBits = 8;
constexpr double kCoordSteps = 4096.0;  // over the larger side of a set's range
constexpr double kPaletteShare = 0.1;
constexpr double kWeightShare = 0.4;      // largest share of the error budget for weights
constexpr double kBetweenSamples = 1.25;  // allowance: poses between the sampled ones may be slightly worse

constexpr std::size_t kMostPoses = 48;

using Poses = std::vector<EvaluatedPose>;

/// Matrices from a mesh's space to model space, per pose: one per palette entry, or a single one for a rigid mesh.
using SkinMatrices = std::vector<std::vector<glm::dmat4>>;
SkinMatrices skin_matrices(const Mesh& mesh, const Poses& poses) {
    SkinMatrices matrices;
    for (const EvaluatedPose& pose : poses) {
        auto& palette = matrices.emplace_back();
        if (mesh.influences == 0) {
            palette.push_back(mesh.joint == kNone ? glm::dmat4(1.0) : pose.joints[mesh.joint]);
            continue;
        }
        for (std::size_t entry = 0; entry < mesh.palette.joints.size(); ++entry)
            palette.push_back(pose.joints[mesh.palette.joints[entry]] * glm::dmat4(mesh.palette.inverse_bind[entry]));
    }
    return matrices;
}

/// The largest factor by which any pose lengthens a displacement in the mesh's space; 1 if unknown.
double stretch_of(const SkinMatrices& matrices) {
    double largest = 0.0;
    for (const auto& palette : matrices) {
        for (const glm::dmat4& matrix : palette) largest = std::max(largest, largest_stretch(matrix));
    }
    return largest > 1e-30 && std::isfinite(largest) ? largest : 1.0;
}

// --- weights

/// Sorts influences by weight, heaviest first; unweighted ones go last as bone 0; unused columns are removed.
void sort_influences(Mesh& mesh) {
    const std::size_t width = mesh.influences;
    std::uint32_t used = 1;
    std::vector<std::size_t> order(width);
    for (std::size_t first = 0; first + width <= mesh.weights.size(); first += width) {
        const std::vector<float> weights(mesh.weights.begin() + static_cast<std::ptrdiff_t>(first),
                                         mesh.weights.begin() + static_cast<std::ptrdiff_t>(first + width));
        const std::vector<std::uint32_t> bones(mesh.bones.begin() + static_cast<std::ptrdiff_t>(first),
                                               mesh.bones.begin() + static_cast<std::ptrdiff_t>(first + width));
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return weights[a] != weights[b] ? weights[a] > weights[b] : bones[a] < bones[b];
        });
        for (std::size_t k = 0; k < width; ++k) {
            const float weight = weights[order[k]];
            mesh.weights[first + k] = weight == 0.0f ? 0.0f : weight;
            mesh.bones[first + k] = weight == 0.0f ? 0u : bones[order[k]];
            if (weight != 0.0f) used = std::max(used, static_cast<std::uint32_t>(k + 1));
        }
    }
    if (used == mesh.influences) return;
    std::vector<float> weights;
    std::vector<std::uint32_t> bones;
    for (std::size_t at = 0; at < mesh.weights.size(); ++at) {
        if (at % width >= used) continue;
        weights.push_back(mesh.weights[at]);
        bones.push_back(mesh.bones[at]);
    }
    mesh.weights = std::move(weights);
    mesh.bones = std::move(bones);
    mesh.influences = used;
}

/// The distance, in metres, by which changed weights move points of the skin in the sampled poses.
double effect_of(const Mesh& mesh, std::span<const std::uint32_t> weights, double largest,
                 const SkinMatrices& matrices) {
    double worst = 0.0;
    std::vector<double> change(mesh.influences);
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        bool changes = false;
        for (std::size_t k = 0; k < mesh.influences; ++k) {
            const std::size_t at = vertex * mesh.influences + k;
            change[k] = weights[at] / largest - mesh.weights[at];
            changes = changes || std::abs(change[k]) > 1e-9;
        }
        if (!changes) continue;
        const glm::dvec4 position(glm::dvec3(mesh.positions[vertex]), 1.0);
        for (const auto& palette : matrices) {
            glm::dvec3 moved(0.0);
            for (std::size_t k = 0; k < mesh.influences; ++k)
                moved += change[k] * glm::dvec3(palette[mesh.bones[vertex * mesh.influences + k]] * position);
            worst = std::max(worst, std::sqrt(moved.x * moved.x + moved.y * moved.y + moved.z * moved.z));
        }
    }
    return worst * kBetweenSamples;
}

/// Quantises weights to as few levels as `most_error` allows; returns the resulting error, in metres.
double compact_weights(Mesh& mesh, CompactMesh& compact, double most_error, const SkinMatrices& matrices) {
    constexpr std::uint32_t kFewest = 0xff;
    constexpr std::uint32_t kMost = 0xffff;
    constexpr double kMore = 1.2;  // levels for the next attempt
    const std::size_t width = mesh.influences;
    std::vector<std::uint32_t> integers(mesh.weights.size());
    double levels = kFewest;
    for (;;) {
        const auto largest = static_cast<std::uint32_t>(std::min<double>(std::ceil(levels), kMost));
        for (std::size_t first = 0; first + width <= integers.size(); first += width) {
            quantise_weights(std::span(mesh.weights).subspan(first, width), largest,
                             std::span(integers).subspan(first, width));
        }
        const double effect = effect_of(mesh, integers, largest, matrices);
        if (!(effect <= most_error)) {
            if (largest == kMost) return 0.0;  // unchanged
            const double needed = most_error > 0.0 ? levels * effect / most_error : double{kMost};
            levels = largest == kFewest ? std::max(needed, levels * kMore) : levels * kMore;
            if (!std::isfinite(levels)) levels = kMost;
            continue;
        }
        for (std::size_t at = 0; at < integers.size(); ++at)
            mesh.weights[at] = static_cast<float>(integers[at]) / static_cast<float>(largest);
        sort_influences(mesh);  // some may now be 0
        integers.resize(mesh.weights.size());
        for (std::size_t at = 0; at < mesh.weights.size(); ++at)
            integers[at] = static_cast<std::uint32_t>(std::lround(mesh.weights[at] * static_cast<float>(largest)));
        compact.weights = store_weights(integers, mesh.influences, largest);
        const StreamView view = compact.weights->view();
        for (std::size_t at = 0; at < mesh.weights.size(); ++at) {
            mesh.weights[at] = view.number(static_cast<std::uint32_t>(at / mesh.influences),
                                           static_cast<std::uint32_t>(at % mesh.influences));
        }
        return effect;
    }
}

// --- inverse bind matrices

std::vector<glm::dmat4> rests_of(const Scene& scene) {
    std::vector<RestRecord> rests;
    std::vector<std::uint32_t> parents;
    for (const Joint& joint : scene.joints) {
        rests.push_back(to_record(joint.rest));
        parents.push_back(joint.parent);
    }
    return rest_matrices(rests, parents);
}

/// The distance, in metres, by which changed inverse bind matrices move points of the skin in the sampled poses.
double effect_of(const Mesh& mesh, std::span<const glm::mat4> binds, const Poses& poses) {
    double worst = 0.0;
    std::vector<glm::dmat4> changes;
    for (const EvaluatedPose& pose : poses) {
        changes.clear();
        for (std::size_t entry = 0; entry < binds.size(); ++entry) {
            changes.push_back(pose.joints[mesh.palette.joints[entry]] *
                              (glm::dmat4(binds[entry]) - glm::dmat4(mesh.palette.inverse_bind[entry])));
        }
        for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
            const glm::dvec4 position(glm::dvec3(mesh.positions[vertex]), 1.0);
            glm::dvec3 moved(0.0);
            for (std::size_t k = 0; k < mesh.influences; ++k) {
                const std::size_t at = vertex * mesh.influences + k;
                moved += double{mesh.weights[at]} * glm::dvec3(changes[mesh.bones[at]] * position);
            }
            const double distance = std::sqrt(moved.x * moved.x + moved.y * moved.y + moved.z * moved.z);
            if (!(distance <= worst)) worst = std::isnan(distance) ? std::numeric_limits<double>::infinity() : distance;
        }
    }
    return worst * kBetweenSamples;
}

/// Derives the matrices from the rest pose if that moves no point further than `most_error`; returns the error in
/// metres.
double derive_palette(Mesh& mesh, CompactMesh& compact, double most_error, std::span<const glm::dmat4> rests,
                      const Poses& poses) {
    const Palette& palette = mesh.palette;
    if (palette.joints.empty()) return 0.0;
    for (const glm::mat4& base :
         {glm::mat4(1.0f), glm::mat4(rests[palette.joints[0]] * glm::dmat4(palette.inverse_bind[0]))}) {
        std::vector<glm::mat4> derived;
        for (const std::uint32_t joint : palette.joints) derived.push_back(derive_inverse_bind(rests[joint], base));
        const double effect = effect_of(mesh, derived, poses);
        if (!(effect <= most_error)) continue;
        mesh.palette.inverse_bind = std::move(derived);
        compact.bind_base = base;
        return effect;
    }
    return 0.0;
}

// --- other streams

/// Replaces the source's numbers with those that the integers decode to.
template <class Vector>
void take_back(const std::optional<StoredStream>& stream, std::vector<Vector>& values) {
    if (stream) stream->view().decode(std::span(values));
}

void take_back(const std::optional<StoredStream>& stream, std::vector<float>& values) {
    if (!stream) return;
    const StreamView view = stream->view();
    for (std::size_t at = 0; at < values.size(); ++at) {
        values[at] = view.number(static_cast<std::uint32_t>(at / view.components),
                                 static_cast<std::uint32_t>(at % view.components));
    }
}

/// Texels per unit of texture coordinates, for the largest image that the scene uses, with the materials' scale; 0 if
/// no image's size is known.
double texels_per_unit(const Scene& scene) {
    std::uint32_t largest = 0;
    for (const Image& image : scene.images) largest = std::max(largest, longer_side(image).value_or(0));
    float scale = 1.0f;
    for (const Material& material : scene.materials) {
        for (const TextureUse* use :
             {&material.base_colour_texture, &material.metallic_roughness_texture, &material.normal_texture,
              &material.occlusion_texture, &material.emissive_texture}) {
            scale = std::max({scale, std::abs(use->scale.x), std::abs(use->scale.y)});
        }
    }
    return static_cast<double>(largest) * scale;
}

/// Quantises texture coordinates to a quarter of a texel, and to 12 bits of their range.
std::optional<StoredStream> compact_coords(const Stream& stream, double texels) {
    if (stream.values.empty() || smallest_exact_fractions(stream.values).type == ComponentType::u8) return std::nullopt;
    glm::dvec2 low(std::numeric_limits<double>::max());
    glm::dvec2 high(std::numeric_limits<double>::lowest());
    for (std::size_t at = 0; at < stream.values.size(); ++at) {
        const int c = static_cast<int>(at % 2);
        low[c] = std::min(low[c], double{stream.values[at]});
        high[c] = std::max(high[c], double{stream.values[at]});
    }
    double most = 0.5 * std::max(high.x - low.x, high.y - low.y) / kCoordSteps;
    if (texels > 0.0) most = std::min(most, 0.25 / texels);
    return quantise_boxed(stream.values, stream.components, most * std::sqrt(2.0));
}

/// The error budget of one mesh.
struct Budget {
    double model = 0.0;    ///< metres, for positions, weights and targets together
    double stretch = 1.0;  ///< from the mesh's space to model space
    std::span<const glm::dmat4> rests;
    const Poses& poses;
};

void compact_mesh(Scene& scene, std::uint32_t number, CompactMesh& compact, const Budget& budget,
                  const SkinMatrices& matrices, double texels) {
    Mesh& mesh = scene.meshes[number];
    const bool is_framed = has_frames(mesh) || mesh.grid;  // already minimal, and exact
    double left = budget.model;
    if (mesh.influences != 0) {
        sort_influences(mesh);
        left -= derive_palette(mesh, compact, kPaletteShare * left, budget.rests, budget.poses);
        left -= compact_weights(mesh, compact, kWeightShare * left, matrices);
    }
    const bool has_targets = std::any_of(mesh.targets.begin(), mesh.targets.end(),
                                         [](const MorphTarget& t) { return !t.positions.empty(); });
    const double positions = left * (has_targets ? 0.5 : 1.0) / budget.stretch;
    const double shifts = left * 0.5 / budget.stretch;
    if (!mesh.positions.empty() && !is_framed)
        compact.positions = quantise_boxed({&mesh.positions[0].x, mesh.positions.size() * 3}, 3, positions, true);
    if (!mesh.normals.empty() && !is_framed) compact.normals = quantise_normals(mesh.normals, kDirectionBits);
    if (!mesh.tangents.empty()) compact.tangents = quantise_tangents(mesh.tangents, kDirectionBits);
    take_back(compact.positions, mesh.positions);
    take_back(compact.normals, mesh.normals);
    take_back(compact.tangents, mesh.tangents);
    for (Stream& stream : mesh.texture_coords) {
        take_back(compact.texture_coords.emplace_back(compact_coords(stream, texels)), stream.values);
    }
    for (Stream& stream : mesh.colours) {
        take_back(compact.colours.emplace_back(quantise_colours(stream.values, stream.components)), stream.values);
    }
    constexpr double kDirectionShift = 1.0 / 256.0;  // for the displacement of a unit normal
    compact.targets.resize(mesh.targets.size());
    compact_targets(scene, number, compact, shifts);
    for (std::size_t t = 0; t < mesh.targets.size(); ++t) {
        MorphTarget& target = mesh.targets[t];
        CompactTarget& stored = compact.targets[t];
        if (target.is_frame) continue;
        stored.normals = quantise_shifts(target.normals, kDirectionShift);
        stored.tangents = quantise_shifts(target.tangents, kDirectionShift);
        take_back(stored.normals, target.normals);
        take_back(stored.tangents, target.tangents);
    }
}

}  // namespace

CompactGeometry compact_geometry(Scene& scene, double most_error, const std::function<void(double)>& progress) {
    CompactGeometry geometry;
    geometry.error = most_error;
    const Poses poses = sample_poses(scene, kMostPoses);
    const std::vector<glm::dmat4> rests = rests_of(scene);
    const double texels = texels_per_unit(scene);
    for (std::uint32_t number = 0; number < scene.meshes.size(); ++number) {
        Mesh& mesh = scene.meshes[number];
        CompactMesh& compact = geometry.meshes.emplace_back();
        const SkinMatrices matrices = skin_matrices(mesh, poses);
        compact.stretch = stretch_of(matrices);
        const Budget budget{most_error, compact.stretch, rests, poses};
        compact.vertex_of.resize(mesh.positions.size());
        std::iota(compact.vertex_of.begin(), compact.vertex_of.end(), 0u);
        compact_mesh(scene, number, compact, budget, matrices, texels);
        if (!mesh.positions.empty()) {
            if (mesh.collapse.empty()) merge_vertices(mesh, compact);
            order_for_codecs(mesh, compact, levels_of(scene, number));
        }
        if (progress) progress(static_cast<double>(number + 1) / static_cast<double>(scene.meshes.size()));
    }
    return geometry;
}

}  // namespace bendy::converter
