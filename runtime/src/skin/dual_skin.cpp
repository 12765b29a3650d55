#include "dual_skin.h"

#include "kernels/kernel_table.h"
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

/// Converts motions to the kernels' layout.
class MotionWriter {
public:
    /// Splits a palette entry, without the common scale, into a stretch and a rigid motion after it.
    /// \param place  of the joint, in mesh space
    void put(const glm::dmat4& matrix, const glm::dvec3& place, DualMotion& motion, PaletteMatrix& stretches) {
        const glm::dmat3 linear(matrix);
        // A mirrored joint is treated as a rotation with a negative stretch.
        const glm::dmat3 turn = nearest_rotation_matrix(glm::determinant(linear) < 0.0 ? -linear : linear);
        const glm::dquat real = glm::normalize(glm::quat_cast(turn));
        const glm::dvec3 translation = glm::dvec3(matrix * glm::dvec4(place, 1.0)) - real * place;
        put(real, motion.real);
        put(0.5 * (glm::dquat(0.0, translation) * real), motion.dual);
        const glm::dmat3 stretch = glm::transpose(turn) * linear;
        const glm::dvec3 shift = place - stretch * place;
        for (int row = 0; row < 3; ++row) {
            for (int c = 0; c < 3; ++c) put(stretch[c][row], stretches.rows[row][c]);
            put(shift[row], stretches.rows[row][3]);
        }
        constexpr double kStretched = 2e-6;  // more than rounding does to a rotation
        is_stretched_ = is_stretched_ || largest(stretch - glm::dmat3(1.0)) > kStretched;
    }
    [[nodiscard]] bool is_stretched() const { return is_stretched_; }
    [[nodiscard]] bool are_finite() const { return sum_ == 0.0f; }

private:
    void put(double number, float& to) {
        to = static_cast<float>(number);
        sum_ += 0.0f * to;
    }
    void put(const glm::dquat& q, float (&to)[4]) {
        put(q.x, to[0]);
        put(q.y, to[1]);
        put(q.z, to[2]);
        put(q.w, to[3]);
    }

    float sum_ = 0.0f;  ///< a finite number times 0 is 0
    bool is_stretched_ = false;
};

/// Computes the motions from the palette, unless it is not finite.
void find_motions(PoseState& state, std::uint32_t mesh, DualMotions& dual) {
    dual.are_good = false;
    const auto& joints = state.data->object.meshes[mesh].palette.joints;
    if (joints.empty() || !state.make_palette(mesh)) return;
    const auto palette = std::span<const PaletteMatrix>(state.palette).first(joints.size());
    const auto topmost = static_cast<std::size_t>(std::min_element(joints.begin(), joints.end()) - joints.begin());
    const glm::dmat3 top(matrix_of(palette[topmost]));
    dual.scale = std::cbrt(glm::determinant(top));
    constexpr double kFlat = 1e-4;  // relative to its longest side: no uniform scale then
    if (!(std::abs(dual.scale) > kFlat * largest(top))) dual.scale = 1.0;
    MotionWriter writer;
    for (std::size_t entry = 0; entry < palette.size(); ++entry) {
        glm::dmat4 matrix = matrix_of(palette[entry]);
        for (int c = 0; c < 4; ++c) matrix[c] = glm::dvec4(glm::dvec3(matrix[c]) / dual.scale, c == 3 ? 1.0 : 0.0);
        writer.put(matrix, dual.places[dual.first_place[mesh] + entry], dual.motions[entry], dual.stretches[entry]);
    }
    dual.is_stretched = writer.is_stretched();
    dual.are_good = writer.are_finite();
}

}  // namespace

DualMotions::DualMotions(const Model& model) : motions(model.largest_palette()), stretches(motions.size()) {
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
    wanted.palette = dual.is_stretched ? dual.stretches.data() : nullptr;
    Staging staging(data.object.meshes[mesh], nullptr, false, weights, state.active_targets, wanted);
    DualKernel* const kernel = kernel_table().dual;
    DualBlock block{wanted, dual.motions.data(), static_cast<float>(dual.scale)};
    for (std::size_t first = 0; first < wanted.vertices; first += block.vertices.vertices) {
        block.vertices.vertices = std::min(wanted.vertices - first, staging.capacity());
        staging.fill(first, wanted, block.vertices);
        kernel(block);
    }
    return true;
}

}  // namespace bendy
