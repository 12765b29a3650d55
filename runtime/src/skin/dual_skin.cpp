#include <bendy/runtime/dual_skin.h>

#include <bendy/runtime/local_to_model.h>
#include <bendy/runtime/skin.h>

#include "kernels/dual_plain.h"
#include "kernels/skin_kernel.h"
#include "math/rigid_part.h"
#include "plan/pose_plan.h"
#include "staging.h"

#include <glm/gtc/matrix_inverse.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

namespace bendy {
namespace {

double largest(const glm::dmat3& m) {
    double most = 0.0;
    for (int c = 0; c < 3; ++c) most = std::max({most, std::abs(m[c].x), std::abs(m[c].y), std::abs(m[c].z)});
    return most;
}

/// Scaled to the volume of a rotation, unless it is near that already; none if it is flat.
std::optional<glm::dmat3> with_volume_one(const glm::dmat3& matrix) {
    constexpr double kNear = 0.1;
    constexpr double kFlat = 1e-9;  // volume of a unit cube, below which the inverse is noise
    if (std::abs(glm::determinant(matrix) - 1.0) < kNear) return matrix;
    const double size = largest(matrix);
    const glm::dmat3 scaled = matrix / (size > 0.0 ? size : 1.0);
    const double volume = glm::determinant(scaled);
    if (!(volume > kFlat)) return std::nullopt;
    return scaled / std::cbrt(volume);
}

/// The rotation nearest to a matrix of positive volume: Newton's iteration (Higham, Computing the Polar Decomposition,
/// 1986).
glm::dmat3 nearest_rotation_matrix(const glm::dmat3& matrix) {
    constexpr int kSteps = 60;       // 2 for what is nearly a rotation
    constexpr double kClose = 1e-8;  // a step of this size leaves its square
    const auto start = with_volume_one(matrix);
    if (!start) return rigid_axes(matrix);
    glm::dmat3 at = *start;
    for (int step = 0; step < kSteps; ++step) {
        const glm::dmat3 cofactors(glm::cross(at[1], at[2]), glm::cross(at[2], at[0]), glm::cross(at[0], at[1]));
        const glm::dmat3 next = 0.5 * (at + cofactors / glm::dot(at[0], cofactors[0]));
        const double change = largest(next - at);
        at = next;
        if (change < kClose) break;
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

StretchedMotion motion_of(const glm::dmat4& matrix, const glm::dvec3& place) {
    const glm::dmat3 linear(matrix);
    // A mirrored joint is one that turns and stretches by less than nothing.
    const glm::dmat3 turn = nearest_rotation_matrix(glm::determinant(linear) < 0.0 ? -linear : linear);
    StretchedMotion motion;
    motion.stretch = glm::transpose(turn) * linear;
    motion.shift = place - motion.stretch * place;
    motion.real = glm::normalize(glm::quat_cast(turn));
    const glm::dvec3 translation = glm::dvec3(matrix * glm::dvec4(place, 1.0)) - motion.real * place;
    motion.dual = 0.5 * (glm::dquat(0.0, translation) * motion.real);
    return motion;
}

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

DualSkinning::DualSkinning(const Model& model)
    : model_(&model),
      motions_(model.largest_palette()),
      kernel_motions_(motions_.size()),
      kernel_stretches_(motions_.size()) {
    for (const Pool& pool : model.pools()) {
        first_place_.push_back(static_cast<std::uint32_t>(places_.size()));
        for (const glm::mat4& inverse_bind : pool.palette.inverse_bind()) places_.push_back(place_of(inverse_bind));
    }
}

void DualSkinning::find_motions(std::uint32_t pool, Pose& pose) {
    are_motions_good_ = false;
    const auto palette = pose.palette(pool);
    const auto& joints = model_->pools()[pool].palette.joints;
    if (palette.empty()) return;
    const auto topmost = static_cast<std::size_t>(std::min_element(joints.begin(), joints.end()) - joints.begin());
    const glm::dmat3 top(matrix_of(palette[topmost]));
    scale_ = std::cbrt(glm::determinant(top));
    constexpr double kFlat = 1e-4;  // of its longest side: no scale of all, then
    if (!(std::abs(scale_) > kFlat * largest(top))) scale_ = 1.0;
    constexpr double kStretched = 2e-6;  // more than what rounding does to a rotation
    is_stretched_ = false;
    for (std::size_t entry = 0; entry < palette.size(); ++entry) {
        glm::dmat4 matrix = matrix_of(palette[entry]);
        if (!std::isfinite(largest(glm::dmat3(matrix)) + glm::length(glm::dvec3(matrix[3])))) return;
        for (int c = 0; c < 4; ++c) matrix[c] = glm::dvec4(glm::dvec3(matrix[c]) / scale_, c == 3 ? 1.0 : 0.0);
        motions_[entry] = motion_of(matrix, places_[first_place_[pool] + entry]);
        is_stretched_ = is_stretched_ || largest(motions_[entry].stretch - glm::dmat3(1.0)) > kStretched;
    }
    are_motions_good_ = true;
    has_kernel_ = skin_kernels(kernel()).dual != nullptr && round_motions(palette.size());
}

bool DualSkinning::round_motions(std::size_t count) {
    float sum = 0.0f;  // of what is finite times 0 is 0
    const auto put = [&sum](float& to, double number) {
        to = static_cast<float>(number);
        sum += 0.0f * to;
    };
    const auto put_quaternion = [&put](float(&to)[4], const glm::dquat& q) {
        put(to[0], q.x);
        put(to[1], q.y);
        put(to[2], q.z);
        put(to[3], q.w);
    };
    for (std::size_t entry = 0; entry < count; ++entry) {
        const StretchedMotion& motion = motions_[entry];
        put_quaternion(kernel_motions_[entry].real, motion.real);
        put_quaternion(kernel_motions_[entry].dual, motion.dual);
        if (!is_stretched_) continue;
        PaletteMatrix& stretch = kernel_stretches_[entry];
        for (int row = 0; row < 3; ++row) {
            for (int c = 0; c < 3; ++c) put(stretch.rows[row][c], motion.stretch[c][row]);
            put(stretch.rows[row][3], motion.shift[row]);
        }
    }
    return sum == 0.0f;
}

void DualSkinning::skin_found(std::uint32_t pool, std::uint32_t vertices, Pose& pose, const Vertices& out) {
    const Pool& source = model_->pools()[pool];
    SkinBlock wanted{};
    wanted.vertices = vertices;
    wanted.out_positions = output_of(out.positions);
    wanted.out_normals = output_of(out.normals);
    wanted.out_tangents = output_of(out.tangents);
    if (has_kernel_ && is_stretched_) wanted.palette = kernel_stretches_.data();
    Staging staging(source, nullptr, pose.target_weights().subspan(model_->first_target(pool), source.targets.size()),
                    wanted);
    DualKernel* const run = has_kernel_ ? skin_kernels(kernel()).dual : nullptr;
    DualBlock block{wanted, kernel_motions_.data(), static_cast<float>(scale_)};
    for (std::size_t first = 0; first < vertices; first += block.vertices.vertices) {
        block.vertices.vertices = std::min(vertices - first, staging.capacity());
        staging.fill(first, wanted, block.vertices);
        if (run != nullptr) {
            run(block);
        } else {
            dual_plain(block.vertices, motions_, scale_, is_stretched_);
        }
    }
}

bool DualSkinning::skin_pool(std::uint32_t pool, Pose& pose, const Lod* lod, const Vertices& out, bool is_next) {
    const Pool& source = model_->pools()[pool];
    const std::uint32_t vertices = lod != nullptr ? lod->vertices(pool) : source.vertices;
    if (!fits(out, vertices)) return false;
    if (!source.is_rigid()) {
        if (!is_next || model_->pose_plan().same_palette[pool] == pool) find_motions(pool, pose);
        if (are_motions_good_) {
            skin_found(pool, vertices, pose, out);
            return true;
        }
    }
    return lod != nullptr ? bendy::skin(*model_, pool, pose, *lod, out) : bendy::skin(*model_, pool, pose, out);
}

bool DualSkinning::skin_all(Pose& pose, const Lod* lod, const Vertices& out) {
    if (!fits(out, model_->vertex_count())) return false;
    bool is_good = true;
    for (std::uint32_t pool = 0; pool < model_->pools().size(); ++pool)
        is_good = skin_pool(pool, pose, lod, part_of(out, model_->first_vertex(pool)), true) && is_good;
    return is_good;
}

bool DualSkinning::skin(std::uint32_t pool, Pose& pose, const Vertices& out) {
    assert(&pose.model() == model_ && pool < model_->pools().size());
    return skin_pool(pool, pose, nullptr, out, false);
}

bool DualSkinning::skin(std::uint32_t pool, Pose& pose, const Lod& lod, const Vertices& out) {
    assert(&pose.model() == model_ && pool < model_->pools().size());
    return skin_pool(pool, pose, &lod, out, false);
}

bool DualSkinning::skin(Pose& pose, const Vertices& out) {
    return skin_all(pose, nullptr, out);
}

bool DualSkinning::skin(Pose& pose, const Lod& lod, const Vertices& out) {
    return skin_all(pose, &lod, out);
}

}  // namespace bendy
