#pragma once

#include <bendy/runtime.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace bendy::viewer {

/// An IK chain as the window has it: switched on, its tip goes to the target.
struct ChainControl {
    bool is_on = false;
    glm::vec3 target{0.0f};  ///< metres, model space
};

/// Plays a model's clips, one or two mixed, and lets chains reach; without window or drawing. The model must outlive
/// it.
class Player {
public:
    explicit Player(const Model& model);

    void step(double seconds);
    /// Poses for the present time without letting it go on.
    void update();

    bool is_playing = true;
    bool obeys_constraints = false;  ///< brings the clip's pose inside the constraints
    std::uint32_t clip = 0;          ///< kNone: the rest pose
    std::uint32_t other = kNone;     ///< the clip mixed in, or kNone
    float share = 0.5f;              ///< of the other one
    float speed = 1.0f;
    float phase = 0.0f;  ///< 0 to 1 through the clips: two that are mixed keep step
    std::vector<ChainControl> chains;

    /// Seconds from one start to the next, of what is played.
    [[nodiscard]] double length() const;
    [[nodiscard]] Pose& pose() { return pose_; }

private:
    void sample_at_phase(std::uint32_t number, Pose& pose) const;

    const Model* model_;
    Pose pose_;
    Pose mixed_in_;
};

}  // namespace bendy::viewer
