#include <bendy/runtime/dual_skin.h>

#include <bendy/runtime/local_to_model.h>
#include <bendy/runtime/skin.h>

#include "rigid_part.h"
#include "skin_vertex.h"
#include "staging.h"

#include <glm/gtc/matrix_inverse.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace bendy {
namespace {

using Motion = DualSkinning::Motion;

double largest(const glm::dmat3& m) {
    double most = 0.0;
    for (int c = 0; c < 3; ++c) most = std::max({most, std::abs(m[c].x), std::abs(m[c].y), std::abs(m[c].z)});
    return most;
}

/// The rotation nearest to a matrix of positive volume: Newton's iteration (Higham, Computing the Polar Decomposition,
/// 1986).
glm::dmat3 nearest_rotation_matrix(const glm::dmat3& matrix) {
    constexpr double kFlat = 1e-9;  // volume of a unit cube, below which the inverse is noise
    constexpr int kSteps = 60;      // 4 for what is nearly a rotation
    const double size = largest(matrix);
    glm::dmat3 at = matrix / (size > 0.0 ? size : 1.0);
    if (!(glm::determinant(at) > kFlat)) return rigid_axes(matrix);
    for (int step = 0; step < kSteps; ++step) {
        const glm::dmat3 next = 0.5 * (at + glm::transpose(glm::inverse(at)));
        const double change = largest(next - at);
        at = next;
        if (change < 1e-15) break;
    }
    return at;
}

glm::dmat4 matrix_of(const PaletteMatrix& entry) {
    glm::dmat4 matrix(1.0);
    for (int row = 0; row < 3; ++row) {
        for (int c = 0; c < 4; ++c) matrix[c][row] = entry.rows[row][c];
    }
    return matrix;
}

/// Where the joint stood in the pool when it was bound; the pool's origin if its matrix has no inverse.
glm::dvec3 place_of(const glm::mat4& inverse_bind) {
    const glm::dmat4 bind = glm::inverse(glm::dmat4(inverse_bind));
    const glm::dvec3 place(bind[3]);
    const bool is_good = std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
    return is_good ? place : glm::dvec3(0.0);
}

Motion motion_of(const glm::dmat4& matrix, const glm::dvec3& place) {
    const glm::dmat3 linear(matrix);
    // A mirrored joint is one that turns and stretches by less than nothing.
    const glm::dmat3 turn = nearest_rotation_matrix(glm::determinant(linear) < 0.0 ? -linear : linear);
    Motion motion;
    motion.stretch = glm::transpose(turn) * linear;
    motion.shift = place - motion.stretch * place;
    motion.real = glm::normalize(glm::quat_cast(turn));
    const glm::dvec3 translation = glm::dvec3(matrix * glm::dvec4(place, 1.0)) - motion.real * place;
    motion.dual = 0.5 * (glm::dquat(0.0, translation) * motion.real);
    return motion;
}

/// v -> linear * v + translation, for one vertex.
struct Moved {
    glm::dmat3 linear{0.0};
    glm::dvec3 translation{0.0};
};

/// Some vertices and what their bones do.
class DualBlock {
public:
    DualBlock(const SkinBlock& block, std::span<const Motion> motions, double scale, bool is_stretched)
        : block_(block), motions_(motions), scale_(scale), is_stretched_(is_stretched) {}

    void run() const {
        for (std::size_t vertex = 0; vertex < block_.vertices; ++vertex) write(vertex, mix(vertex));
    }

private:
    [[nodiscard]] double weight(std::size_t at) const { return block_.weights[at]; }
    [[nodiscard]] const Motion& motion(std::size_t at) const {
        return motions_[block_.bones8 != nullptr ? block_.bones8[at] : block_.bones16[at]];
    }

    /// The blended motion. q and -q are one rotation: all are taken on the side of the heaviest one.
    [[nodiscard]] Moved mix(std::size_t vertex) const {
        const std::size_t first = vertex * block_.influences;
        std::size_t heaviest = first;
        for (std::size_t at = first; at < first + block_.influences; ++at) {
            if (weight(at) > weight(heaviest)) heaviest = at;
        }
        if (block_.influences == 0 || !(weight(heaviest) > 0.0)) return {};
        const Motion& pivot = motion(heaviest);
        Motion sum;
        sum.real = sum.dual = glm::dquat(0.0, 0.0, 0.0, 0.0);
        sum.stretch = glm::dmat3(0.0);
        double all = 0.0;
        for (std::size_t at = first; at < first + block_.influences; ++at) {
            if (weight(at) == 0.0) continue;
            const Motion& add = motion(at);
            const double signed_weight = glm::dot(add.real, pivot.real) < 0.0 ? -weight(at) : weight(at);
            sum.real = sum.real + signed_weight * add.real;
            sum.dual = sum.dual + signed_weight * add.dual;
            all += weight(at);
            if (!is_stretched_) continue;
            sum.stretch += weight(at) * add.stretch;
            sum.shift += weight(at) * add.shift;
        }
        constexpr double kNothing = 1e-12;
        double length = glm::length(sum.real);
        if (!(length > kNothing) || !(all > kNothing)) {  // weights below zero cancel the others
            sum = pivot;
            length = all = 1.0;
        }
        return to_moved(sum, length, all);
    }

    [[nodiscard]] Moved to_moved(const Motion& sum, double length, double all) const {
        const glm::dquat real = sum.real / length;
        const glm::dquat shift = 2.0 * ((sum.dual / length) * glm::conjugate(real));
        Moved moved{glm::mat3_cast(real), glm::dvec3(shift.x, shift.y, shift.z)};
        if (is_stretched_) {
            moved.translation += moved.linear * (sum.shift / all);
            moved.linear = moved.linear * (sum.stretch / all);
        }
        moved.linear *= scale_;
        moved.translation *= scale_;
        return moved;
    }

    void write(std::size_t vertex, const Moved& moved) const {
        if (block_.out_positions.data != nullptr) {
            put(block_.out_positions, vertex,
                moved.linear * vec3_at(block_.positions + 3 * vertex) + moved.translation);
        }
        if (block_.out_normals.data == nullptr && block_.out_tangents.data == nullptr) return;
        const glm::dmat3& m = moved.linear;
        const double side = glm::determinant(m) < 0.0 ? -1.0 : 1.0;
        if (block_.out_normals.data != nullptr) {
            const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
            put(block_.out_normals, vertex, unit_or_zero(side * (cofactors * vec3_at(block_.normals + 3 * vertex))));
        }
        if (block_.out_tangents.data == nullptr) return;
        const float* const tangent = block_.tangents + 4 * vertex;
        put(block_.out_tangents, vertex, unit_or_zero(m * vec3_at(tangent)));
        block_.out_tangents.data[vertex * block_.out_tangents.stride + 3] = static_cast<float>(side) * tangent[3];
    }

    const SkinBlock& block_;
    std::span<const Motion> motions_;
    double scale_;
    bool is_stretched_;
};

template <class Vector>
SkinOutput output_of(std::span<Vector> vectors) {
    if (vectors.empty()) return {nullptr, 0};
    return {&vectors.front().x, static_cast<std::size_t>(Vector::length())};
}

bool fits(const Vertices& out, std::uint64_t vertices) {
    const auto is_long_enough = [&](const auto& span) { return span.empty() || span.size() >= vertices; };
    return is_long_enough(out.positions) && is_long_enough(out.normals) && is_long_enough(out.tangents);
}

/// From a vertex on.
Vertices part_of(const Vertices& out, std::uint64_t first) {
    const auto rest = [&](auto span) { return span.empty() ? span : span.subspan(first); };
    return {rest(out.positions), rest(out.normals), rest(out.tangents)};
}

}  // namespace

DualSkinning::DualSkinning(const Model& model) : model_(&model), motions_(model.largest_palette()) {
    for (const Pool& pool : model.pools()) {
        first_place_.push_back(static_cast<std::uint32_t>(places_.size()));
        for (const glm::mat4& inverse_bind : pool.palette.inverse_bind()) places_.push_back(place_of(inverse_bind));
    }
}

bool DualSkinning::find_motions(std::uint32_t pool, Pose& pose) {
    const auto palette = pose.palette(pool);
    const auto& joints = model_->pools()[pool].palette.joints;
    if (palette.empty()) return false;
    const auto topmost = static_cast<std::size_t>(std::min_element(joints.begin(), joints.end()) - joints.begin());
    const glm::dmat3 top(matrix_of(palette[topmost]));
    scale_ = std::cbrt(glm::determinant(top));
    constexpr double kFlat = 1e-4;  // of its longest side: no scale of all, then
    if (!(std::abs(scale_) > kFlat * largest(top))) scale_ = 1.0;
    constexpr double kStretched = 2e-6;  // more than what rounding does to a rotation
    is_stretched_ = false;
    for (std::size_t entry = 0; entry < palette.size(); ++entry) {
        glm::dmat4 matrix = matrix_of(palette[entry]);
        if (!std::isfinite(largest(glm::dmat3(matrix)) + glm::length(glm::dvec3(matrix[3])))) return false;
        for (int c = 0; c < 4; ++c) matrix[c] = glm::dvec4(glm::dvec3(matrix[c]) / scale_, c == 3 ? 1.0 : 0.0);
        motions_[entry] = motion_of(matrix, places_[first_place_[pool] + entry]);
        is_stretched_ = is_stretched_ || largest(motions_[entry].stretch - glm::dmat3(1.0)) > kStretched;
    }
    return true;
}

bool DualSkinning::skin_pool(std::uint32_t pool, std::uint32_t vertices, Pose& pose, const Vertices& out) {
    const Pool& source = model_->pools()[pool];
    if (vertices == 0) return true;
    SkinBlock wanted{};
    wanted.vertices = vertices;
    wanted.out_positions = output_of(out.positions);
    wanted.out_normals = output_of(out.normals);
    wanted.out_tangents = output_of(out.tangents);
    Staging staging(source, nullptr, pose.target_weights().subspan(model_->first_target(pool), source.targets.size()),
                    wanted);
    SkinBlock block = wanted;
    for (std::size_t first = 0; first < vertices; first += block.vertices) {
        block.vertices = std::min(vertices - first, staging.capacity());
        staging.fill(first, wanted, block);
        DualBlock(block, motions_, scale_, is_stretched_).run();
    }
    return true;
}

bool DualSkinning::skin(std::uint32_t pool, Pose& pose, const Vertices& out) {
    assert(&pose.model() == model_ && pool < model_->pools().size());
    const std::uint32_t vertices = model_->pools()[pool].vertices;
    if (!fits(out, vertices)) return false;
    const bool is_dual = !model_->pools()[pool].is_rigid() && find_motions(pool, pose);
    return is_dual ? skin_pool(pool, vertices, pose, out) : bendy::skin(*model_, pool, pose, out);
}

bool DualSkinning::skin(std::uint32_t pool, Pose& pose, const Lod& lod, const Vertices& out) {
    assert(&pose.model() == model_ && pool < model_->pools().size());
    if (!fits(out, lod.vertices(pool))) return false;
    const bool is_dual = !model_->pools()[pool].is_rigid() && find_motions(pool, pose);
    return is_dual ? skin_pool(pool, lod.vertices(pool), pose, out) : bendy::skin(*model_, pool, pose, lod, out);
}

bool DualSkinning::skin(Pose& pose, const Vertices& out) {
    if (!fits(out, model_->vertex_count())) return false;
    bool is_good = true;
    for (std::uint32_t pool = 0; pool < model_->pools().size(); ++pool)
        is_good = skin(pool, pose, part_of(out, model_->first_vertex(pool))) && is_good;
    return is_good;
}

bool DualSkinning::skin(Pose& pose, const Lod& lod, const Vertices& out) {
    if (!fits(out, model_->vertex_count())) return false;
    bool is_good = true;
    for (std::uint32_t pool = 0; pool < model_->pools().size(); ++pool)
        is_good = skin(pool, pose, lod, part_of(out, model_->first_vertex(pool))) && is_good;
    return is_good;
}

}  // namespace bendy
