#pragma once

#include <bendy/converter/scene.h>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace bendy::converter {

// Evaluates a Scene at a time, in double precision and by glTF's rules alone. It shares no code with the runtime except
// trig.h, so that the two can be compared. Uses no libm function but the square root, so that results are the same
// everywhere.

struct EvaluatedPose {
    std::vector<glm::dmat4> joints;                  ///< joint to model space
    std::vector<std::vector<double>> morph_weights;  ///< per mesh
};

/// The rest pose, with the targets' rest weights.
void evaluate_rest(const Scene& scene, EvaluatedPose& pose);

/// A clip at a time on its time line, in seconds; tracks hold their first and last key. Properties that are not
/// animated rest.
void evaluate(const Scene& scene, const Clip& clip, double seconds, EvaluatedPose& pose);

/// The shortest great arc between two rotations (x y z w). Lengths near 1 are interpolated as well.
class Arc {
public:
    Arc() = default;
    Arc(const std::array<double, 4>& from, const std::array<double, 4>& to);
    /// \param u  0 to 1
    [[nodiscard]] std::array<double, 4> at(double u) const;

private:
    std::array<double, 4> from_{}, to_{};  // unit, unless they are the same
    double from_length_ = 1.0, to_length_ = 1.0;
    double cosine_ = 0.0, sine_ = 0.0;  // twice those of half the angle
    double half_angle_ = 0.0;           // radians
    bool is_point_ = true;              // both are the same
};

/// Evaluates a clip at many times, as `evaluate` does. What no track moves is computed once.
class ClipEvaluator {
public:
    /// Refers to both.
    ClipEvaluator(const Scene& scene, const Clip& clip);
    void at(double seconds, EvaluatedPose& pose);

    /// The joints that tracks move, ascending.
    [[nodiscard]] const std::vector<std::uint32_t>& moved() const { return moved_; }
    /// From now on, `at` computes only the places of some joints: of those that move and of those that are needed. The
    /// others have a constant place relative to their carrier, the nearest joint above them that moves.
    /// \param moved   the joints that count as moving: at least those of moved()
    /// \param needed  per joint
    /// \param pose    the one that `at` will be called with: receives the places of joints without a carrier
    void follow(std::span<const std::uint32_t> moved, const std::vector<bool>& needed, EvaluatedPose& pose);
    /// After `follow`, per joint: itself if it moves, kNone if nothing moves it.
    [[nodiscard]] const std::vector<std::uint32_t>& carriers() const { return carriers_; }
    /// After `follow`, per joint: from its space to that of its carrier; to model space if it has none.
    [[nodiscard]] const std::vector<glm::dmat4>& to_carriers() const { return to_carriers_; }
    /// After `follow`, the number of joints whose places `at` computes.
    [[nodiscard]] std::size_t computed() const { return steps_.size(); }

private:
    struct Placement {
        glm::dvec3 translation;
        std::array<double, 4> rotation;  // x y z w
        glm::dvec3 scale;
    };
    struct Moving {
        std::uint32_t track = 0;
        std::size_t near_key = 0;                                       // where its keys are looked for first
        std::size_t arc_key = std::numeric_limits<std::size_t>::max();  // the arc is the one from this key
        Arc arc{};
    };

    /// A joint whose place is that of `above`, which comes before it, times the way to its parent and its own matrix.
    struct Step {
        std::uint32_t joint = 0;
        std::uint32_t above = kNone;
        bool skips_parent = false;  // `above` is the parent's carrier
    };

    void set(const Track& track, EvaluatedPose& pose);

    const Scene& scene_;
    const Clip& clip_;
    std::vector<Placement> placements_;  // per joint
    std::vector<glm::dmat4> locals_;     // per joint: the matrix of its placement
    std::vector<Moving> moving_;
    std::vector<std::uint32_t> moved_;  // the joints of those tracks, each once
    std::vector<double> value_;
    bool follows_ = false;
    std::vector<std::uint32_t> carriers_;  // per joint
    std::vector<glm::dmat4> to_carriers_;  // per joint
    std::vector<Step> steps_;
};

/// One track's value at a time: `components` numbers. Linear rotations follow the shortest great arc, cubic ones are
/// normalised.
/// \param near_key  any number; receives the key before the time. From there, the interval and the next are searched
///                  first.
void evaluate_track(const Track& track, double seconds, std::vector<double>& value, std::size_t& near_key);
void evaluate_track(const Track& track, double seconds, std::vector<double>& value);

/// A mesh's vertices in model space: displaced by its targets, then moved by its bones, or by its joint if it is rigid.
/// \param morph_weights  one per target, or empty: not displaced
std::vector<glm::dvec3> evaluate_vertices(const Mesh& mesh, const std::vector<double>& morph_weights,
                                          const std::vector<glm::dmat4>& joints);

/// Poses for estimates: the rest pose, then every clip at evenly spaced times from its first key to its last.
/// \param most          limit for all clips together; large skeletons get fewer poses, at most about 33 MB
/// \param most_of_clip  limit per clip
std::vector<EvaluatedPose> sample_poses(const Scene& scene, std::size_t most,
                                        std::size_t most_of_clip = std::numeric_limits<std::size_t>::max());

/// Distance from a joint, as a share of the character's height, at which its rotation and scale are measured where no
/// skin shows them.
constexpr double kJointReach = 0.03;

/// Metres: the height of the character's skin at rest, or its largest side if it is flat. Without vertices, the size of
/// the skeleton: of its joints' origins at rest or, if these coincide, over its clips; 1 if they always coincide.
double height_at_rest(const Scene& scene);

}  // namespace bendy::converter
