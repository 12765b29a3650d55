#pragma once

#include <bendy/format/public.h>
#include <bendy/format/records.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace bendy {

struct RetargetPlan;  // internal

}  // namespace bendy

// Retargeting: the pose of one character on another one of different build. What corresponds is known from the joints'
// roles, not from their names; the rest poses may differ (arms out or down), face other ways and have other sizes.
namespace BENDY_PUBLIC bendy {

/// What the two rest poses have in common.
enum class RestPoses : std::uint8_t {
    /// Nothing: they are measured. A limb gets the direction that it has in the source.
    measured,
    /// Both show the same pose, whatever small differences there are in the directions of limbs, as VRM demands. Joints
    /// turn exactly as in the source, and the hips' travel is scaled by the hips' height.
    alike,
};

/// How the target's constraints act.
enum class Limits : std::uint8_t {
    /// Those that no author gave but a program proposed are soft: a joint that is to be e beyond one is
    /// e / (1 + e / kSoftLimit) beyond it. All others are hard.
    soft,
    hard,  ///< no joint is beyond its constraint
    off,   ///< none acts
};
inline constexpr double kSoftLimit = 0.2617993877991494;  ///< radians: 15 degrees, most that a joint is beyond

struct RetargetOptions {
    RestPoses rest_poses = RestPoses::measured;
    Limits limits = Limits::soft;
    /// Moves feet and hands, while they touch the ground, as far as the source's move, times the length of the legs,
    /// and keeps body, feet and hands from sinking into it, hands together that are near each other, and hands on the
    /// own body. Has no effect on limbs with joints between their three that have no IK chain.
    bool plants_feet = true;
};

/// The legs that a body stands on, by its roles. Poses can be retargeted between bodies of the same kind.
enum class BodyKind : std::uint8_t {
    human,
    four_legs,  ///< an animal with hind legs and front legs
    two_legs,   ///< an animal with hind legs only, such as a bird
};

/// Why two models cannot be retargeted.
struct RetargetError {
    enum class Reason : std::uint8_t {
        no_roles,    ///< the model does not say what its joints are
        not_finite,  ///< a place of a joint at rest is not finite
        other_body,  ///< the two are not of the same kind
    };
    Reason reason = Reason::no_roles;
    bool is_source = false;                                       ///< whose fault it is: the source's or the target's
    BodyKind source = BodyKind::human, target = BodyKind::human;  ///< for other_body
};

/// Says what is wrong and what to write in the rig file. Allocates.
std::string error_text(const RetargetError& error);

/// Contacts. Each foot has two points that may touch the ground; those of an animal's hind legs have the names of a
/// human's, and the heel is where the paw or the hoof begins. A human's hands may touch it too, and so may its body
/// (head, trunk, thighs or knees) when it sits, lies or kneels. Hands close together, as on one sword, also count, and
/// a hand on the own head, trunk or thighs, or on a prop in the other hand.
enum class Contact : std::uint8_t {
    left_heel,
    left_toes,
    right_heel,
    right_toes,
    left_front_heel,
    left_front_toes,
    right_front_heel,
    right_front_toes,
    left_hand,
    right_hand,
    body,
    hands,
    left_hand_body,
    right_hand_body,
};
inline constexpr std::size_t kContacts = 14;
/// How firm each contact is: 0 none (a foot in the air), 1 full (on the ground).
using ContactWeights = std::array<float, kContacts>;

/// A character's memory of the last frame: where its feet and hands rested, and the rotations of its joints. Make a
/// new one where the motion jumps (another clip, a seek).
struct RetargetState {
    struct Stand {
        glm::vec3 offset{0.0f};  ///< metres, target: from where the source's point would be, in the foot's heading
        float weight = 0.0f;     ///< of the last frame
    };
    std::array<Stand, kContacts> stands{};  ///< by Contact
    /// Rotations of the last call that gave seconds: of the source's joints, then of the target's. Empty: unknown.
    std::vector<glm::quat> turns;
};

/// How quickly a joint turns that jumps where the source does not, from one end of its limits to the other or from one
/// side of a straight leg to the other: beyond kOfSource times the largest turn of the source's joints.
inline constexpr double kTurnSpeed = 8.0;  ///< radians a second
inline constexpr double kOfSource = 1.5;

/// What had to give way in a frame.
struct Retargeted {
    float turned = 0.0f;  ///< radians: most that a constraint turned a joint away from where it was to be
    std::uint32_t turned_joint = kNone;  ///< of the target
    float missed = 0.0f;                 ///< metres: most that a hand or foot is away from where it was to be
    std::uint32_t missed_joint = kNone;
    float lowered = 0.0f;       ///< metres: by how much the hips were lowered so that the feet reach the ground
    ContactWeights contacts{};  ///< as given or, otherwise, as found
};

/// How the poses of one model become poses of another. Making one allocates; retargeting with it does not. Contains
/// work memory, so each thread needs one of its own (a copy will do).
///
/// Joints with a role turn as those of the source do, also where the two have different numbers of joints in the spine,
/// the neck, the tail or a wing. Legs of animals correspond joint by joint from hip and shoulder outwards. Joints with
/// equal names and no role come along, such as props. So do morph targets with equal names, or with the same name in
/// another spelling ("eyeBlinkLeft", "EyeBlink_L"); several may follow one. All others keep their rest relative to
/// their parent. Limbs keep the target's lengths; the hips' travel is scaled by the length of the legs.
class Retarget {
public:
    /// Both models are humans, animals on four legs, or animals on two. They need not be whole: joints with a role that
    /// the source lacks keep their rest relative to their parent, and feet are planted where both have the whole leg,
    /// from hip to foot. Where one has no legs, the hips travel from where they are at rest.
    static Result<Retarget, RetargetError> make(const Model& source, const Model& target,
                                                const RetargetOptions& options = {});
    Retarget(const Retarget& other);
    Retarget(Retarget&& other) noexcept;
    Retarget& operator=(const Retarget& other);
    Retarget& operator=(Retarget&& other) noexcept;
    ~Retarget();

    [[nodiscard]] const Model& source() const;
    [[nodiscard]] const Model& target() const;
    /// Turns directions from the source's model space to the target's: both bodies' up and front correspond.
    [[nodiscard]] const glm::dquat& turn() const;
    /// The target's size as a multiple of the source's, by the length of the legs; where one of the two has none, by
    /// that of the legs' upper bones, the trunk or the arms.
    [[nodiscard]] float scale() const;
    /// The length of the target's legs (of an animal, its hind legs) from hip to foot, metres; where one of the two has
    /// none, of what the sizes are compared by.
    [[nodiscard]] float leg() const;
    /// For each joint of the target, the source's joint that turns it, or kNone. Where two joints do, the nearer one.
    [[nodiscard]] std::span<const std::uint32_t> joints() const;
    /// For each morph target of the target, the source's, or kNone.
    [[nodiscard]] std::span<const std::uint32_t> morph_targets() const;

private:
    friend struct RetargetPlan;
    explicit Retarget(std::unique_ptr<RetargetPlan> plan);

    std::unique_ptr<RetargetPlan> plan_;
};

/// Sets `pose`, of the target, to the source's pose. Where neither a constraint nor a contact acts, limbs have the
/// directions of the source's. What a constraint holds back, the joints below make up for as far as theirs allow. Feet
/// and hands on the ground are then brought to their places by IK, within the constraints; the body of who sits, lies
/// or kneels is brought to the height above the ground that the source's has. Retargeting to a model of
/// the same build copies the numbers bit by bit.
///
/// Errors: other_model, and nothing changes; not_finite, and the pose is at rest.
/// \param source    not `pose` itself
/// \param contacts  such as from curves of the clip; otherwise found by the height of heel and toes above where they
///                  are at rest, of hands and body by that of the skin. Numbers within 0.005 of 0 or 1 count as these
/// \param seconds   since the last call with this state, 0 to 1: joints then turn at most at kTurnSpeed, inside their
///                  limits, so that they arrive late where they would jump. 0, NaN: they may jump. The first call with
///                  seconds allocates
[[nodiscard]] Result<Retargeted, CallError> retarget(Pose& pose, Retarget& retarget, Pose& source, RetargetState& state,
                                                     const std::optional<ContactWeights>& contacts = std::nullopt,
                                                     float seconds = 0.0f);

}  // namespace bendy
