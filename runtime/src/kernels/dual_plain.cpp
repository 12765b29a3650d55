#include "plain.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cstddef>

namespace bendy {
namespace {

/// v -> linear * v + translation, for one vertex.
struct Moved {
    glm::dmat3 linear{0.0};
    glm::dvec3 translation{0.0};
};

/// Some vertices and the transforms of their bones.
class PlainDuals {
public:
    PlainDuals(const SkinBlock& block, std::span<const StretchedMotion> motions, double scale, bool is_stretched)
        : block_(block), motions_(motions), scale_(scale), is_stretched_(is_stretched) {}

    void run() const {
        for (std::size_t vertex = 0; vertex < block_.vertices; ++vertex) write(vertex, mix(vertex));
    }

private:
    [[nodiscard]] double weight(std::size_t at) const { return block_.weights[at]; }
    [[nodiscard]] const StretchedMotion& motion(std::size_t at) const {
        return motions_[block_.bones8 != nullptr ? block_.bones8[at] : block_.bones16[at]];
    }

    /// Returns the blended motion. q and -q are the same rotation: each is taken with the sign that matches the
    /// heaviest one.
    [[nodiscard]] Moved mix(std::size_t vertex) const {
        const std::size_t first = vertex * block_.influences;
        std::size_t heaviest = first;
        for (std::size_t at = first; at < first + block_.influences; ++at) {
            if (weight(at) > weight(heaviest)) heaviest = at;
        }
        if (block_.influences == 0 || !(weight(heaviest) > 0.0)) return {};
        const StretchedMotion& pivot = motion(heaviest);
        StretchedMotion sum;
        sum.real = sum.dual = glm::dquat(0.0, 0.0, 0.0, 0.0);
        sum.stretch = glm::dmat3(0.0);
        double all = 0.0;
        for (std::size_t at = first; at < first + block_.influences; ++at) {
            if (weight(at) == 0.0) continue;
            const StretchedMotion& add = motion(at);
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
        if (!(length > kNothing) || !(all > kNothing)) {  // negative weights cancel the others
            sum = pivot;
            length = all = 1.0;
        }
        return to_moved(sum, length, all);
    }

    [[nodiscard]] Moved to_moved(const StretchedMotion& sum, double length, double all) const {
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
    std::span<const StretchedMotion> motions_;
    double scale_;
    bool is_stretched_;
};

}  // namespace

void dual_plain(const SkinBlock& block, std::span<const StretchedMotion> motions, double scale, bool is_stretched) {
    PlainDuals(block, motions, scale, is_stretched).run();
}

}  // namespace bendy
