#pragma once

#include "space.h"

#include <bendy/converter/scene.h>

#include <glm/gtc/quaternion.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// By how much a place that was computed quickly may be off.
struct Doubt {
    double linear = 0.0;  ///< of an Affine's linear part: its largest stretch
    double origin = 0.0;  ///< of its origin: metres
};

/// At least the largest factor by which a matrix of finite numbers stretches a vector; that factor, but for rounding,
/// where its columns are at right angles, so that products of many such factors stay small.
double largest_stretch_of(const glm::dmat3& m);

/// The great arc between two unit rotations, prepared for many places on it: evaluate_track's slerp but for rounding,
/// in a tenth of its time.
class Arc {
public:
    Arc() = default;
    /// \param a, b  of any length but 0: between them it changes evenly
    Arc(const glm::dquat& a, const glm::dquat& b);
    /// \param u  0 to 1
    [[nodiscard]] glm::dquat at(double u) const;
    /// False for half turns, but for rounding: which of the two arcs is the shorter, rounding decides.
    [[nodiscard]] bool is_sure() const { return is_sure_; }

private:
    glm::dquat a_{1.0, 0.0, 0.0, 0.0}, b_{1.0, 0.0, 0.0, 0.0};  // of length 1
    double length_a_ = 1.0, length_b_ = 1.0;
    bool is_sure_ = true;
    double angle_ = 0.0;
    double per_sine_ = 0.0;  // 1 / sin(angle); 0: the arc is so short that its chord does
};

/// What is added to the doubt of each rotation, and stands for rounding too: far more than either.
inline constexpr double kRotationDoubt = 1e-12;

/// A joint's place from that of its parent; the doubts that go with it. \param parent  null: a root
void place_nearly(const Local& local, const glm::vec3& shear, const Affine* parent, const Doubt* parent_doubt,
                  Affine& place, Doubt& doubt);

/// Where a clip has a scene's joints, nearly: what costs evaluate most is done once for each pair of keys, and the
/// result may differ by rounding. The doubts say by how much at most, so that only what they leave open must be
/// evaluated exactly.
class NearPoses {
public:
    enum class Rotations : std::uint8_t { as_they_are, of_length_one };

    /// Refers to both, which must outlive it. Tracks of weights are left out.
    NearPoses(const Scene& scene, const Clip& clip, Rotations rotations);
    /// Seconds on the clip's time line; quickest if they ascend.
    void set(double seconds);

    [[nodiscard]] std::span<const Local> locals() const { return locals_; }
    /// To model space.
    [[nodiscard]] std::span<const Affine> places() const { return places_; }
    [[nodiscard]] std::span<const Doubt> doubts() const { return doubts_; }

private:
    struct Cursor {
        const Track* track = nullptr;
        std::size_t key = 0;  // that `arc` begins at, if it has been set
        bool has_arc = false;
        Arc arc{};
    };
    glm::dquat rotation_at(Cursor& cursor, double seconds, bool& is_sure) const;

    const Scene& scene_;
    Rotations rotations_;
    bool is_sure_ = true;  // no rotation's length is far from 1
    std::vector<Local> rest_, locals_;
    std::vector<Cursor> cursors_;
    std::vector<Affine> places_;
    std::vector<Doubt> doubts_;
    std::vector<double> value_;
};

}  // namespace bendy::converter
