#pragma once

#include <bendy/runtime.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

// What moves the character in the window: the player of a file's clips, and the tentacle demo.

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
    bool forward = false;  ///< the tentacle is moved by hand
    bool inverse = false;  ///< the target pulls the tip; at most one of these two
    bool paused = false;   ///< the animation, which plays where neither is on
    bool turntable = false;
    bool wireframe = false;
    bool help = true;
    double time = 0.0;            ///< of the animation, seconds from its start
    double angle = 0.0;           ///< of the turntable, radians
    glm::vec3 bend{0.0f};         ///< by hand: of the whole chain about the model's axes, radians
    std::uint32_t joint = kNone;  ///< by hand: the one that the keys bend; kNone: the whole chain
    glm::vec3 target{0.0f};       ///< metres, model space
};

/// The Bendy Tentacle Demo: what the keys do, without window or drawing. Takes a model with a chain; plays its clip
/// "Wave", or else its first. The limits of the joints hold after every step.
class Demo {
public:
    /// The model must outlive it and have at least one chain.
    explicit Demo(const Model& model);

    /// How the picture lies in the model's space, unit vectors: the keys mean what the viewer sees. +X and +Y if nobody
    /// says.
    void look_along(const glm::vec3& right, const glm::vec3& up);
    /// A key went down. An arrow, PgUp or PgDn moves the target, the tentacle or one joint a little.
    void press(DemoKey key);
    /// A key is held down for so long.
    void hold(DemoKey key, double seconds);
    /// Time goes on.
    void step(double seconds);
    /// Puts the target there, as near as it may go, and lets it pull.
    void drag_target(const glm::vec3& position);

    [[nodiscard]] const DemoState& state() const { return state_; }
    [[nodiscard]] Pose& pose() { return pose_; }
    [[nodiscard]] const Chain& chain() const { return *chain_; }
    /// The chain's joints, from its start to the effector.
    [[nodiscard]] const std::vector<std::uint32_t>& links() const { return links_; }
    [[nodiscard]] glm::vec3 tip();
    /// How far the worst of all joints is outside its limits, radians; while the target pulls, the chain's joints have
    /// those that the file gives for IK.
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
    Pose before_;  // what the mode before left, from which the new one eases away
    DemoState state_;
    glm::vec3 start_{0.0f};               // of the chain at rest, model space
    glm::vec3 right_{1.0f, 0.0f, 0.0f};   // of the picture
    glm::vec3 up_{0.0f, 1.0f, 0.0f};      // likewise
    std::vector<std::uint32_t> links_;    // the chain's joints, from its start
    std::vector<bool> is_link_;           // of the chain, one a joint
    std::vector<glm::quat> rest_turns_;   // in model space, one a joint
    std::vector<glm::quat> joint_bends_;  // by hand, after what bends the whole chain; one a joint
    float reach_ = 1.0f;                  // the chain's length at rest
    double since_mode_ = 1e9;
    double pull_time_ = 0.0;  // not yet used by pulling
    // Where the limits keep the force from the target although the tip can reach it, the tentacle goes to a pose that
    // another solver has found; once for each place of the target.
    Pose other_way_;
    double since_other_way_ = 1e9;
    float last_distance_ = 0.0f;
    int still_ = 0;  // pulls without progress
    bool has_looked_ = false;
};

}  // namespace bendy::viewer
