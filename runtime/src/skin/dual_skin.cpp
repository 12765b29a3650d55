#include "dual_skin.h"

#include "kernels/kernel_table.h"
#include "kernels/plain.h"
#include "math/rigid_part.h"
#include "staging.h"

#include <glm/gtc/matrix_inverse.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace bendy {
namespace {

double largest(const glm::dmat3& m) {
    double most = 0.0;
    for (int c = 0; c < 3; ++c) most = std::max({most, std::abs(m[c].x), std::abs(m[c].y), std::abs(m[c].z)});
    return most;
}

/// Scales a matrix to volume 1, unless it is close to that already; nothing if it is flat.
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

/// Returns the rotation nearest to a matrix of positive volume: Newton's iteration (Higham, Computing the Polar
/// Decomposition, 1986).
glm::dmat3 nearest_rotation_matrix(const glm::dmat3& matrix) {
    constexpr int kSteps = 60;       // 2 for a matrix that is nearly a rotation
    constexpr double kClose = 1e-8;  // a step of this size leaves an error of its square
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

/// Returns the joint's position in the mesh at bind time; the mesh's origin if the matrix is singular.
glm::dvec3 place_of(const glm::mat4& inverse_bind) {
    const glm::dmat4 bind = glm::inverse(glm::dmat4(inverse_bind));
    const glm::dvec3 place(bind[3]);
    const bool is_good = std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
    return is_good ? place : glm::dvec3(0.0);
}

StretchedMotion motion_of(const glm::dmat4& matrix, const glm::dvec3& place) {
    const glm::dmat3 linear(matrix);
    // A mirrored joint is treated as a rotation with a negative stretch.
    const glm::dmat3 turn = nearest_rotation_matrix(glm::determinant(linear) < 0.0 ? -linear : linear);
    StretchedMotion motion;
    motion.stretch = glm::transpose(turn) * linear;
    motion.shift = place - motion.stretch * place;
    motion.real = glm::normalize(glm::quat_cast(turn));
    const glm::dvec3 translation = glm::dvec3(matrix * glm::dvec4(place, 1.0)) - motion.real * place;
    motion.dual = 0.5 * (glm::dquat(0.0, translation) * motion.real);
    return motion;
}

/// Converts the first motions to the kernels' layout; returns false if not all are finite as floats.
bool round_motions(std::size_t count, DualMotions& dual) {
    float sum = 0.0f;  // a finite number times 0 is 0
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
        const StretchedMotion& motion = dual.motions[entry];
        put_quaternion(dual.kernel_motions[entry].real, motion.real);
        put_quaternion(dual.kernel_motions[entry].dual, motion.dual);
        if (!dual.is_stretched) continue;
        PaletteMatrix& stretch = dual.kernel_stretches[entry];
        for (int row = 0; row < 3; ++row) {
            for (int c = 0; c < 3; ++c) put(stretch.rows[row][c], motion.stretch[c][row]);
            put(stretch.rows[row][3], motion.shift[row]);
        }
    }
    return sum == 0.0f;
}

/// Computes the motions from the palette, unless it is not finite.
void find_motions(PoseState& state, std::uint32_t mesh, DualMotions& dual) {
    dual.are_good = false;
    const auto& joints = state.data->object.meshes[mesh].palette.joints;
    if (joints.empty()) return;
    state.make_palette(mesh);
    const auto palette = std::span<const PaletteMatrix>(state.palette).first(joints.size());
    const auto topmost = static_cast<std::size_t>(std::min_element(joints.begin(), joints.end()) - joints.begin());
    const glm::dmat3 top(matrix_of(palette[topmost]));
    dual.scale = std::cbrt(glm::determinant(top));
    constexpr double kFlat = 1e-4;  // relative to its longest side: no uniform scale then
    if (!(std::abs(dual.scale) > kFlat * largest(top))) dual.scale = 1.0;
    constexpr double kStretched = 2e-6;  // more than rounding does to a rotation
    dual.is_stretched = false;
    for (std::size_t entry = 0; entry < palette.size(); ++entry) {
        glm::dmat4 matrix = matrix_of(palette[entry]);
        if (!std::isfinite(largest(glm::dmat3(matrix)) + glm::length(glm::dvec3(matrix[3])))) return;
        for (int c = 0; c < 4; ++c) matrix[c] = glm::dvec4(glm::dvec3(matrix[c]) / dual.scale, c == 3 ? 1.0 : 0.0);
        dual.motions[entry] = motion_of(matrix, dual.places[dual.first_place[mesh] + entry]);
        dual.is_stretched = dual.is_stretched || largest(dual.motions[entry].stretch - glm::dmat3(1.0)) > kStretched;
    }
    dual.are_good = true;
    dual.has_kernel = kernel_table() != nullptr && round_motions(palette.size(), dual);
}

}  // namespace

DualMotions::DualMotions(const Model& model)
    : motions(model.largest_palette()), kernel_motions(motions.size()), kernel_stretches(motions.size()) {
    for (const Mesh& mesh : model.meshes()) {
        first_place.push_back(static_cast<std::uint32_t>(places.size()));
        for (const glm::mat4& inverse_bind : mesh.palette.inverse_bind()) places.push_back(place_of(inverse_bind));
    }
}

bool skin_by_dual_quaternions(PoseState& state, std::uint32_t mesh, std::uint32_t& motions_of,
                              std::span<const float> weights, const SkinBlock& outputs) {
    const ModelData& data = *state.data;
    if (!state.dual) state.dual.emplace(state.model);
    DualMotions& dual = *state.dual;
    const std::uint32_t with_palette = data.pose_plan->same_palette[mesh];
    if (motions_of != with_palette) find_motions(state, mesh, dual);
    motions_of = with_palette;
    if (!dual.are_good) return false;
    SkinBlock wanted = outputs;
    wanted.palette = dual.has_kernel && dual.is_stretched ? dual.kernel_stretches.data() : nullptr;
    Staging staging(data.object.meshes[mesh], nullptr, weights, state.active_targets, wanted);
    const KernelTable* const kernels = dual.has_kernel ? kernel_table() : nullptr;
    DualBlock block{wanted, dual.kernel_motions.data(), static_cast<float>(dual.scale)};
    for (std::size_t first = 0; first < wanted.vertices; first += block.vertices.vertices) {
        block.vertices.vertices = std::min(wanted.vertices - first, staging.capacity());
        staging.fill(first, wanted, block.vertices);
        if (kernels != nullptr) {
            kernels->dual(block);
        } else {
            dual_plain(block.vertices, dual.motions, dual.scale, dual.is_stretched);
        }
    }
    return true;
}

}  // namespace bendy
