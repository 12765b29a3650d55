#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

// The coordinates of a joint's rotation in which its limits are intervals, the swing's ellipse an ellipse, and the
// largest angle a ball.
namespace bendy {

struct IkLink;

/// The rotation of a link as up to three numbers, each of which turns it about one axis: the angle of a hinge; Euler
/// angles, the last rotation first; the tangents of half the swing's angles about Y and Z, which are (y, z) / w of its
/// quaternion, and the twist; (x, y, z) / w of a rotation with a largest angle; or a step from the current rotation,
/// where nothing limits it.
class LimitChart {
public:
    using Numbers = std::array<double, 3>;

    void begin(const IkLink& link);
    /// The same for a link that may turn by an angle from a rotation.
    void begin_within(const IkLink& link, double largest, const glm::dquat& from);
    /// Sets the numbers from a rotation of the link, moved inside the limits, and returns that.
    glm::dquat read(const IkLink& link, const glm::dquat& local);

    /// Starts a step of a free link from its rotation.
    void rebase(const glm::dquat& local) {
        if (kind_ != Kind::free) return;
        local_ = local;
        values_.fill(0.0);
    }

    [[nodiscard]] bool is_free() const { return kind_ == Kind::free && size_ > 0; }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const Numbers& low() const { return low_; }
    [[nodiscard]] const Numbers& high() const { return high_; }
    [[nodiscard]] const Numbers& values() const { return values_; }
    /// Returns true if a number is an angle that nothing limits: it goes around.
    [[nodiscard]] bool goes_around(std::size_t number) const {
        const bool is_angle = kind_ == Kind::hinge || kind_ == Kind::euler || number == 2;
        return kind_ != Kind::free && is_angle && !(high_[number] < std::numeric_limits<double>::infinity());
    }

    /// Returns the link's angular velocities, in the space of `basis`, as each number grows.
    [[nodiscard]] std::array<glm::dvec3, 3> axes() const;
    /// Returns the rotation from that space to that of the link's parent.
    [[nodiscard]] const glm::dquat& basis() const { return rest_frame_; }
    /// Changes the numbers by a step, moves them inside the limits, and returns the link's rotation.
    glm::dquat move(const Numbers& step);
    /// The same for the step of a solver, of which a soft zone leaves half.
    glm::dquat step(const IkLink& link, const Numbers& by);
    /// Returns to other numbers of this chart.
    void set(const Numbers& values) { values_ = values; }

    /// A direction in which the rotation can move: that of a number, or at an edge outwards or along it.
    struct Way {
        Numbers numbers{};
        bool is_at_low = false, is_at_high = false;
        double curvature = 0.0;  ///< of the edge, of which the first way is the outward normal

        [[nodiscard]] bool is_stopped(double gradient) const {
            return (is_at_low && gradient > 0.0) || (is_at_high && gradient < 0.0);
        }
    };
    /// As many as there are numbers.
    [[nodiscard]] std::array<Way, 3> ways() const;

private:
    enum class Kind : std::uint8_t { free, hinge, ellipse, pyramid, euler, ball };

    void put_ball(double largest, const glm::dquat& middle);
    [[nodiscard]] glm::dquat rotation() const;
    /// Returns one of the swing's numbers in half axes of the ellipse.
    [[nodiscard]] double share(std::size_t number) const {
        return values_[number] * (values_[number] < 0.0 ? inverse_low_ : inverse_high_)[number];
    }

    Kind kind_ = Kind::free;
    bool clamps_ = false;  ///< a step, for a soft zone or limits without such coordinates
    std::size_t size_ = 0;
    Numbers values_{}, low_{}, high_{};
    std::array<double, 2> inverse_low_{}, inverse_high_{};  ///< of an ellipse's half axes; 0 if they have no length
    std::array<int, 3> order_{};                            ///< axes of Euler angles
    glm::dquat rest_frame_{1, 0, 0, 0}, frame_{1, 0, 0, 0};
    glm::dquat local_{1, 0, 0, 0};  ///< of a free link
};

}  // namespace bendy
