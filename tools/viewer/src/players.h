#pragma once

#include <bendy/runtime.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

// Moves the character in the window: the player of a file's clips, and the tentacle demo.

namespace bendy::viewer {

/// The state of an IK chain in the window: if it is on, its tip reaches for the target.
struct ChainControl {
    bool is_on = false;
    glm::vec3 target{0.0f};  ///< metres, model space
};

/// Plays one clip of a model or a mix of two, and lets chains reach. It needs no window and draws nothing. The model
/// must outlive it.
class Player {
public:
    explicit Player(const Model& model);

    void step(double seconds);
    /// Computes the pose for the current time, without advancing it.
    void update() { update(0.0); }

    bool is_playing = true;
    bool obeys_constraints = false;  ///< clamps the clip's pose to the constraints
    std::uint32_t clip = 0;          ///< kNone: the rest pose
    std::uint32_t other = kNone;     ///< the clip mixed in, or kNone
    float share = 0.5f;              ///< of the other clip
    float speed = 1.0f;
    float phase = 0.0f;  ///< 0 to 1 through the clips; mixed clips have the same phase
    std::vector<ChainControl> chains;

    /// Returns the seconds from one start to the next.
    [[nodiscard]] double length() const;
    [[nodiscard]] Pose& pose() { return pose_; }

private:
    void update(double seconds);
    void sample_at_phase(std::uint32_t number, Pose& pose) const;

    const Model* model_;
    Pose pose_;
    Pose mixed_in_;
    ReachState reached_;
};

enum class DemoKey : std::uint8_t {
    quit,
    bones,
    forward,
    inverse,
    pause,
    turntable,
    wireframe,
    help,
    next_joint,
    previous_joint,
    left,
    right,
    up,
    down,
    page_up,
    page_down
};

struct DemoState {
    bool quits = false;
    bool bones = false;
    bool forward = false;  ///< forward kinematics: the keys bend the tentacle
    bool inverse = false;  ///< the target pulls the tip; not together with forward
    bool paused = false;   ///< stops the animation, which plays if neither is on
    bool turntable = false;
    bool wireframe = false;
    bool help = true;
    double time = 0.0;            ///< of the animation, seconds from its start
    double angle = 0.0;           ///< of the turntable, radians
    glm::vec3 bend{0.0f};         ///< forward: of the whole chain about the model's axes, radians
    std::uint32_t joint = kNone;  ///< forward: the joint that the keys bend; kNone: the whole chain
    glm::vec3 target{0.0f};       ///< metres, model space
};

/// The Bendy Tentacle Demo: the effect of the keys. It needs no window and draws nothing. It plays the model's clip
/// "Wave", or its first clip if there is none. After every step the joints satisfy their constraints.
class Demo {
public:
    /// The model must outlive it and have at least one chain.
    explicit Demo(const Model& model);

    /// Sets the picture's right and up as unit vectors in model space, because the keys refer to the picture. The
    /// defaults are +X and +Y.
    void look_along(const glm::vec3& right, const glm::vec3& up);
    /// Handles a key press. An arrow, PgUp or PgDn moves the target, the tentacle or one joint a little.
    void press(DemoKey key);
    /// Handles a key that was held down for some seconds.
    void hold(DemoKey key, double seconds);
    /// Advances the time.
    void step(double seconds);
    /// Moves the target as near to the position as it may go, and lets it pull.
    void drag_target(const glm::vec3& position);

    [[nodiscard]] const DemoState& state() const { return state_; }
    [[nodiscard]] Pose& pose() { return pose_; }
    [[nodiscard]] const Chain& chain() const { return *chain_; }
    /// The chain's joints, from its start to the effector.
    [[nodiscard]] const std::vector<std::uint32_t>& links() const { return links_; }
    [[nodiscard]] glm::vec3 tip();
    /// Returns how far the worst joint is outside its constraint, radians. While the target pulls, the chain's joints
    /// have the constraints for IK.
    [[nodiscard]] double violation() const;

private:
    [[nodiscard]] const Constraint* constraint_record_of(std::uint32_t joint) const;
    void hold_constraints();
    void set_mode(bool forward, bool inverse);
    void move(const glm::vec3& direction, float amount);
    void move_target(const glm::vec3& position);
    void choose_joint(int step);
    void bend_all(const glm::vec3& direction, float amount);
    void bend_joint(const glm::vec3& direction, float amount);
    [[nodiscard]] glm::quat bent_with_all(std::uint32_t joint) const;
    void pose_by_hand();
    void pull();
    void look_for_another_way(float distance);

    const Model* model_;
    const Chain* chain_;
    const Clip* clip_;
    Pose pose_;
    Pose before_;  // the last pose of the previous mode, from which the new one is blended in
    DemoState state_;
    glm::vec3 start_{0.0f};               // of the chain at rest, model space
    glm::vec3 right_{1.0f, 0.0f, 0.0f};   // of the picture
    glm::vec3 up_{0.0f, 1.0f, 0.0f};      // likewise
    std::vector<std::uint32_t> links_;    // the chain's joints, from its start
    std::vector<bool> is_link_;           // of the chain, one per joint
    std::vector<glm::quat> rest_turns_;   // in model space, one per joint
    std::vector<glm::quat> joint_bends_;  // forward: added to the bend of the whole chain; one per joint
    float reach_ = 1.0f;                  // the chain's length at rest
    double since_mode_ = 1e9;
    double pull_time_ = 0.0;  // seconds not yet used by pulls
    // If constraints stop the pull short of a target that the tip can reach, the tentacle moves to a pose that another
    // solver has found; once for each position of the target.
    Pose other_way_;
    double since_other_way_ = 1e9;
    float last_distance_ = 0.0f;
    int still_ = 0;  // pulls without progress
    bool has_looked_ = false;
};

}  // namespace bendy::viewer
