#pragma once

#include "runtime/skin_in_doubles.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <cstddef>
#include <span>

// Skinning by dual quaternions in doubles: the judge of the kernels, with which it shares no code.
namespace bendy::test {

/// A palette entry: v -> rigid motion of (stretch * v + shift).
struct StretchedMotion {
    glm::dquat real{1.0, 0.0, 0.0, 0.0};  ///< real part of the rigid motion as a dual quaternion; unit
    glm::dquat dual{0.0, 0.0, 0.0, 0.0};
    glm::dmat3 stretch{1.0};
    glm::dvec3 shift{0.0};
};

/// Some vertices and the transforms of their bones.
class BlendedDuals {
public:
    BlendedDuals(const SkinBlock& block, std::span<const StretchedMotion> motions, double scale, bool is_stretched)
        : block_(block), motions_(motions), scale_(scale), is_stretched_(is_stretched) {}

    void run() const {
        for (std::size_t vertex = 0; vertex < block_.vertices; ++vertex) write_moved(block_, vertex, mix(vertex));
    }

private:
    [[nodiscard]] double weight(std::size_t at) const { return block_.weights[at]; }
    [[nodiscard]] const StretchedMotion& motion(std::size_t at) const {
        return motions_[block_.bones8 != nullptr ? block_.bones8[at] : block_.bones16[at]];
    }

    /// Returns the blended motion. q and -q are the same rotation: each is taken with the sign that matches the
    /// heaviest one.
    [[nodiscard]] glm::dmat4x3 mix(std::size_t vertex) const {
        const std::size_t first = vertex * block_.influences;
        std::size_t heaviest = first;
        for (std::size_t at = first; at < first + block_.influences; ++at) {
            if (weight(at) > weight(heaviest)) heaviest = at;
        }
        if (block_.influences == 0 || !(weight(heaviest) > 0.0)) return glm::dmat4x3(0.0);
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
        return to_matrix(sum, length, all);
    }

    [[nodiscard]] glm::dmat4x3 to_matrix(const StretchedMotion& sum, double length, double all) const {
        const glm::dquat real = sum.real / length;
        const glm::dquat shift = 2.0 * ((sum.dual / length) * glm::conjugate(real));
        glm::dmat3 linear = glm::mat3_cast(real);
        glm::dvec3 translation(shift.x, shift.y, shift.z);
        if (is_stretched_) {
            translation += linear * (sum.shift / all);
            linear = linear * (sum.stretch / all);
        }
        return {scale_ * linear[0], scale_ * linear[1], scale_ * linear[2], scale_ * translation};
    }

    const SkinBlock& block_;
    std::span<const StretchedMotion> motions_;
    double scale_;
    bool is_stretched_;
};

inline void dual_in_doubles(const SkinBlock& block, std::span<const StretchedMotion> motions, double scale,
                            bool is_stretched) {
    BlendedDuals(block, motions, scale, is_stretched).run();
}

}  // namespace bendy::test
