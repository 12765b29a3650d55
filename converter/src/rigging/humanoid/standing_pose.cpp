#include "standing_pose.h"

#include "assumed_stand.h"
#include "clip_frames.h"
#include "clip_rotations.h"
#include "scene/turn_roots.h"

#include <bendy/format/standing_pose.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

using Bone = HumanBone;

constexpr double kUpright = 35.0;   // degrees, of trunk and legs
constexpr double kBentKnee = 40.0;  // degrees
constexpr double kUneven = 0.03;    // of the height, between the feet
constexpr double kStraight = 15.0;  // degrees: heads lie up to 10 in front of the hips
constexpr double kUnlike = 6.0;     // degrees: bodies that are made to stand have 3 at most, walks 10 and more
constexpr double kChance = 2.0;     // degrees: frames of clips in which the sides are less alike are so by chance

constexpr double kNearUp = 0.82, kNearFront = 0.94, kAlong = 0.985;  // cosines: 35, 20 and 10 degrees

/// The coordinate axis that is within an angle of a unit vector. A stance that leans or is turned a little must not
/// tilt the ground.
std::optional<glm::dvec3> near_axis(const glm::dvec3& v, double cosine) {
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(v[axis]) < cosine) continue;
        glm::dvec3 exact(0.0);
        exact[axis] = v[axis] < 0.0 ? -1.0 : 1.0;
        return exact;
    }
    return std::nullopt;
}

/// Degrees between two directions; 180 if one has none.
double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    const auto from = unit(a);
    const auto to = unit(b);
    return from && to ? degrees_of(0.5 * glm::distance(*from, *to)) : 180.0;
}

/// The height of the lowest of a leg's joints.
double lowest_of_leg(const RestFrames& pose, const Humanoid& bones, HumanBone lower, HumanBone foot, HumanBone toes,
                     const glm::dvec3& up) {
    double lowest = glm::dot(up, pose.position(bones[lower]));
    for (const HumanBone bone : {foot, toes}) {
        if (bones.has(bone)) lowest = std::min(lowest, glm::dot(up, pose.position(bones[bone])));
    }
    return lowest;
}

glm::dvec3 foot_of(const RestFrames& pose, const Humanoid& bones, HumanBone lower, HumanBone foot) {
    return pose.position(bones.has(foot) ? bones[foot] : bones[lower]);
}

}  // namespace

bool Standing::is_upright() const {
    return lean < kUpright && legs < kUpright && has_head_on_top;
}

bool Standing::stands() const {
    return is_upright() && knees < kBentKnee && feet < kUneven;
}

bool Standing::is_straight() const {
    return std::max(lean, legs) < kStraight;
}

bool Standing::is_made_to_stand() const {
    return stands() && mirror < kUnlike;
}

double Standing::flaws() const {
    const auto square = [](double flaw, double usual) { return flaw * flaw / (usual * usual); };
    return square(lean, kUpright / 2.0) + square(legs, kUpright / 2.0) + square(knees, kBentKnee) +
           square(feet, kUneven);
}

namespace {

/// Degrees by which the left thigh is off the mirror image of the right one; 0 if nothing tells.
double off_mirror(const RestFrames& pose, const Humanoid& bones, const glm::dvec3& left, const glm::dvec3& up) {
    const auto across = unit_across(left, up);
    const auto own = pose.direction(bones[Bone::left_upper_leg], bones[Bone::left_lower_leg]);
    const auto other = pose.direction(bones[Bone::right_upper_leg], bones[Bone::right_lower_leg]);
    if (!across || !own || !other) return 0.0;
    return angle_between(*own, *other - 2.0 * glm::dot(*other, *across) * *across);
}

/// Where the body's ends are in a pose.
struct Ends {
    glm::dvec3 head, tops, feet;  ///< tops: between the hip joints, where hips may be anywhere in the pelvis
    glm::dvec3 hip_line;          ///< from the right hip joint to the left
};

bool has_ends(const Humanoid& bones) {
    constexpr std::array kEnds{
        Bone::hips,           Bone::head, Bone::left_upper_leg, Bone::left_lower_leg, Bone::right_upper_leg,
        Bone::right_lower_leg};
    return std::all_of(kEnds.begin(), kEnds.end(), [&](Bone bone) { return bones.has(bone); });
}

std::optional<Ends> ends_of(const RestFrames& pose, const Humanoid& bones) {
    if (!has_ends(bones)) return std::nullopt;
    const glm::dvec3 left = foot_of(pose, bones, Bone::left_lower_leg, Bone::left_foot);
    const glm::dvec3 right = foot_of(pose, bones, Bone::right_lower_leg, Bone::right_foot);
    const glm::dvec3 left_top = pose.position(bones[Bone::left_upper_leg]);
    const glm::dvec3 right_top = pose.position(bones[Bone::right_upper_leg]);
    return Ends{pose.position(bones[Bone::head]), 0.5 * (left_top + right_top), 0.5 * (left + right),
                left_top - right_top};
}

}  // namespace

std::optional<Standing> judge_stand(const RestFrames& pose, const Humanoid& bones, const glm::dvec3& up) {
    const std::optional<Ends> ends = ends_of(pose, bones);
    if (!ends) return std::nullopt;
    const double size = glm::distance(ends->head, ends->tops) + glm::distance(ends->tops, ends->feet);
    if (!std::isfinite(size) || !(size > 0.0)) return std::nullopt;
    Standing standing;
    standing.lean = angle_between(ends->head - ends->tops, up);
    standing.legs = angle_between(ends->tops - ends->feet, up);
    const double on_left = lowest_of_leg(pose, bones, Bone::left_lower_leg, Bone::left_foot, Bone::left_toes, up);
    const double on_right = lowest_of_leg(pose, bones, Bone::right_lower_leg, Bone::right_foot, Bone::right_toes, up);
    standing.feet = std::abs(on_left - on_right) / size;
    standing.mirror = off_mirror(pose, bones, ends->hip_line, up);
    standing.has_head_on_top = true;
    for (const Bone bone : {Bone::hips, Bone::spine, Bone::chest, Bone::upper_chest, Bone::neck}) {
        if (bones.has(bone) && glm::dot(up, pose.position(bones[bone]) - ends->head) > 0.0)
            standing.has_head_on_top = false;
    }
    standing.knees = 0.0;
    for (const auto& [upper, lower, foot] :
         {std::array{Bone::left_upper_leg, Bone::left_lower_leg, Bone::left_foot},
          std::array{Bone::right_upper_leg, Bone::right_lower_leg, Bone::right_foot}}) {
        if (!bones.has(foot)) continue;
        const glm::dvec3 knee = pose.position(bones[lower]);
        standing.knees = std::max(standing.knees,
                                  angle_between(knee - pose.position(bones[upper]), pose.position(bones[foot]) - knee));
    }
    return standing;
}

// --- candidates

namespace {

/// A joint's bind matrix as a rotation and a matrix.
struct BoundJoint {
    Rotation turn{1.0, 0.0, 0.0, 0.0};
    glm::dmat4 matrix{1.0};
};

/// By joint; nothing for those that no skin binds, or whose matrix flattens or mirrors.
std::vector<std::optional<BoundJoint>> find_bound(const Scene& scene) {
    std::vector<std::optional<BoundJoint>> bound(scene.joints.size());
    for (const Mesh& mesh : scene.meshes) {
        for (std::size_t entry = 0; entry < mesh.palette.joints.size(); ++entry) {
            auto& place = bound[mesh.palette.joints[entry]];
            const glm::dmat4 to_joint(mesh.palette.inverse_bind[entry]);
            if (place || !(std::abs(glm::determinant(glm::dmat3(to_joint))) > 1e-12)) continue;
            const glm::dmat4 matrix = glm::inverse(to_joint);
            const auto x = unit(matrix[0]);
            const auto y = x ? unit_across(matrix[1], *x) : std::nullopt;
            if (!y || glm::determinant(glm::dmat3(matrix)) < 0.0 || !std::isfinite(glm::dot(matrix[3], matrix[3])))
                continue;
            place = BoundJoint{rotation_of_axes(glm::dmat3(*x, *y, glm::cross(*x, *y))), matrix};
        }
    }
    return bound;
}

glm::dmat4 matrix_of(const Transform& local) {
    glm::dmat3 axes =
        glm::mat3_cast(to_rotation({local.rotation.x, local.rotation.y, local.rotation.z, local.rotation.w}));
    for (int axis = 0; axis < 3; ++axis) axes[axis] *= double{local.scale[axis]};
    glm::dmat4 matrix(axes);
    matrix[3] = glm::dvec4(glm::dvec3(local.translation), 1.0);
    return matrix;
}

}  // namespace

CandidatePose turned(const Scene& scene, const Rotation& turn, CandidatePose pose) {
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (scene.joints[joint].parent != kNone) continue;
        Transform& local = pose.locals[joint];
        const glm::vec4& q = local.rotation;
        const Rotation own = glm::normalize(turn * to_rotation({q.x, q.y, q.z, q.w}));
        local.rotation = {own.x, own.y, own.z, own.w};
        local.translation = glm::vec3(turn * glm::dvec3(local.translation));
    }
    return pose;
}

std::vector<CandidatePose> find_bind_poses(const Scene& scene) {
    constexpr double kSame = 0.99996;  // cosine of half a degree: of half the angle
    const std::vector<std::optional<BoundJoint>> bound = find_bound(scene);
    const auto first = std::find_if(bound.begin(), bound.end(), [](const auto& one) { return one.has_value(); });
    if (first == bound.end()) return {};
    const auto root = static_cast<std::uint32_t>(first - bound.begin());
    CandidatePose pose{StandingEvidence::bind_pose, rest_of(scene)};
    const RestFrames rest(scene);
    // From model space at rest to that of the bind matrices; where the root is, both agree.
    const Rotation turn = glm::normalize(first->value().turn * glm::conjugate(rest.turn(root)));
    std::vector<Rotation> turns;     // in the space of the bind matrices
    std::vector<glm::dmat4> places;  // as turns
    glm::dmat4 above_root(first->value().matrix * glm::inverse(matrix_of(pose.locals[root])));
    bool differs = false;
    for (std::uint32_t joint = root; scene.joints[joint].parent != kNone;) {
        joint = scene.joints[joint].parent;
        above_root = above_root * glm::inverse(matrix_of(pose.locals[joint]));
    }
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        const Rotation above = parent == kNone ? turn : turns[parent];
        const glm::dmat4 space = parent == kNone ? above_root : places[parent];  // a copy: places grow
        Transform& local = pose.locals[joint];
        const Rotation own = to_rotation({local.rotation.x, local.rotation.y, local.rotation.z, local.rotation.w});
        turns.push_back(bound[joint] ? bound[joint]->turn : glm::normalize(above * own));
        places.push_back(bound[joint] ? bound[joint]->matrix : space * matrix_of(local));
        if (!bound[joint]) continue;
        const Rotation found = glm::normalize(glm::conjugate(above) * turns.back());
        differs = differs || std::abs(glm::dot(found, own)) < kSame;
        local.rotation = {found.x, found.y, found.z, found.w};
        const glm::vec3 place(glm::inverse(space) * places.back()[3]);
        if (std::isfinite(glm::dot(place, place))) local.translation = place;
    }
    if (!differs && std::abs(turn.w) > kSame) return {};
    CandidatePose as_bound = turned(scene, turn, pose);
    return {std::move(as_bound), std::move(pose)};
}

namespace {

/// The body's own up: from the hip joints to the head, and from the feet to the hip joints.
std::optional<glm::dvec3> own_up(const RestFrames& pose, const Humanoid& bones) {
    const std::optional<Ends> ends = ends_of(pose, bones);
    const auto trunk = ends ? unit(ends->head - ends->tops) : std::nullopt;
    const auto legs = ends ? unit(ends->tops - ends->feet) : std::nullopt;
    return trunk && legs ? unit(*trunk + *legs) : std::nullopt;
}

}  // namespace

glm::dvec3 find_up(const Scene& scene, const Humanoid& bones) {
    constexpr double kSteady = 0.8;  // length of the mean of unit vectors
    constexpr glm::dvec3 kModelUp(0.0, 1.0, 0.0);
    if (!has_ends(bones)) return kModelUp;
    glm::dvec3 sum(0.0);
    double frames = 0.0;
    visit_frames(scene, [&](const std::vector<Transform>& locals) {
        sum += own_up(RestFrames(scene, locals), bones).value_or(glm::dvec3(0.0));
        frames += 1.0;
    });
    const glm::dvec3 mean = frames == 0.0 ? sum : sum / frames;
    const auto up = unit(mean);
    return up && glm::length(mean) > kSteady ? near_axis(*up, kNearUp).value_or(kModelUp) : kModelUp;
}

std::optional<CandidatePose> find_standing_frame(const Scene& scene, const Humanoid& bones, const glm::dvec3& up) {
    std::optional<CandidatePose> best;
    if (!has_ends(bones)) return best;
    Standing best_so_far;
    visit_frames(scene, [&](std::vector<Transform> locals) {
        const std::optional<Standing> standing = judge_stand(RestFrames(scene, locals), bones, up);
        const auto is_worse = [&] {
            if (standing->is_made_to_stand() != best_so_far.is_made_to_stand()) return best_so_far.is_made_to_stand();
            if (standing->is_upright() != best_so_far.is_upright()) return best_so_far.is_upright();
            return standing->flaws() >= best_so_far.flaws();
        };
        if (!standing || (best && is_worse())) return;
        best_so_far = *standing;
        best = CandidatePose{StandingEvidence::clip, std::move(locals)};
    });
    return best;
}

namespace {

/// X left, Y up, Z forward of a body, to model space.
std::optional<Rotation> axes_of(const RestFrames& pose, const Humanoid& bones, const glm::dvec3& up) {
    glm::dvec3 across(0.0);
    for (const HumanBone bone : {HumanBone::left_upper_leg, HumanBone::left_upper_arm}) {
        const HumanBone other = converter::mirrored(bone);
        if (bones.has(bone) && bones.has(other)) across += pose.position(bones[bone]) - pose.position(bones[other]);
    }
    const auto level = unit_across(across, up);
    const auto left = level ? unit_across(near_axis(*level, kNearFront).value_or(*level), up) : std::nullopt;
    if (!left) return std::nullopt;
    return rotation_of_axes(glm::dmat3(*left, up, glm::cross(*left, up)));
}

/// The pose turned as a whole so that an axis of the body is up; with Y up it faces Z.
std::optional<CandidatePose> turn_to_front(const Scene& scene, const Humanoid& bones, const glm::dvec3& own_up,
                                           const glm::dvec3& up, CandidatePose pose) {
    const auto axes = axes_of(RestFrames(scene, pose.locals), bones, own_up);
    const auto x = unit_across({1.0, 0.0, 0.0}, up);
    const auto left = x ? x : unit_across({0.0, 0.0, 1.0}, up);
    if (!axes || !left) return std::nullopt;
    const Rotation turn = rotation_of_axes(glm::dmat3(*left, up, glm::cross(*left, up))) * glm::conjugate(*axes);
    return turned(scene, turn, std::move(pose));
}

}  // namespace

std::optional<CandidatePose> turn_upright(const Scene& scene, const Humanoid& bones, const glm::dvec3& up,
                                          CandidatePose pose) {
    const auto own = own_up(RestFrames(scene, pose.locals), bones);
    if (!own) return std::nullopt;
    return turn_to_front(scene, bones, near_axis(*own, kAlong).value_or(*own), up, std::move(pose));
}

// --- the scene's

namespace {

Humanoid humanoid_of(const std::vector<RoleRecord>& roles) {
    Humanoid bones;
    for (const RoleRecord& record : roles) {
        if (record.role < static_cast<std::uint16_t>(kFirstChainRole))
            bones[static_cast<Role>(record.role)] = record.joint;
    }
    return bones;
}

/// The joints that STND turns: those that have a role, and those between them that do not turn as at rest. By number.
std::vector<std::uint32_t> list_standing(const Scene& scene, const std::vector<Transform>& locals) {
    std::vector<bool> is_body(scene.joints.size()), is_above(scene.joints.size());
    for (const RoleRecord& role : scene.roles) is_body[role.joint] = true;
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {  // parents come first
        const std::uint32_t parent = scene.joints[joint].parent;
        is_above[joint] = parent != kNone && (is_above[parent] || is_body[parent]);
    }
    std::vector<bool> carries(scene.joints.size());
    std::vector<std::uint32_t> found;
    for (auto joint = static_cast<std::uint32_t>(scene.joints.size()); joint-- > 0;) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (parent != kNone && (is_body[joint] || carries[joint])) carries[parent] = true;
        const bool is_between = is_above[joint] && carries[joint];
        const bool is_turned = locals[joint].rotation != scene.joints[joint].rest.rotation;
        if (is_body[joint] || (is_between && is_turned)) found.push_back(joint);
    }
    std::reverse(found.begin(), found.end());
    return found;
}

/// The rest pose with some joints turned as they are in another pose: STND's meaning.
std::vector<Transform> with_turns(const Scene& scene, const std::vector<Transform>& stands) {
    const RestFrames pose(scene, stands);
    const std::vector<std::uint32_t> standing = list_standing(scene, stands);
    std::vector<Transform> locals = rest_of(scene);
    std::vector<Rotation> turns;  // in model space
    auto next = standing.begin();
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        const Rotation above = parent == kNone ? Rotation(1.0, 0.0, 0.0, 0.0) : turns[parent];
        glm::vec4& q = locals[joint].rotation;
        if (next != standing.end() && *next == joint) {
            const Rotation own = glm::normalize(glm::conjugate(above) * pose.turn(joint));
            q = {own.x, own.y, own.z, own.w};
            ++next;
        }
        turns.push_back(glm::normalize(above * to_rotation({q.x, q.y, q.z, q.w})));
    }
    return locals;
}

/// The heights of the lowest and the highest joint with a role.
std::pair<double, double> heights_of(const Scene& scene, const RestFrames& pose, const glm::dvec3& up) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (const RoleRecord& role : scene.roles) {
        lowest = std::min(lowest, glm::dot(up, pose.position(role.joint)));
        highest = std::max(highest, glm::dot(up, pose.position(role.joint)));
    }
    return {lowest, highest};
}

/// The ground of the clips if they move the body: where its lowest joint is in most frames; in jumps it is higher.
std::optional<double> ground_of_clips(const Scene& scene, std::uint32_t hips, const glm::dvec3& up) {
    std::vector<bool> carries(scene.joints.size());
    for (std::uint32_t joint = hips; joint != kNone; joint = scene.joints[joint].parent) carries[joint] = true;
    const auto moves_hips = [&](const Track& track) {
        return track.path == TrackPath::translation && carries[track.target];
    };
    const bool is_moved = std::any_of(scene.clips.begin(), scene.clips.end(), [&](const Clip& clip) {
        return std::any_of(clip.tracks.begin(), clip.tracks.end(), moves_hips);
    });
    if (!is_moved) return std::nullopt;
    std::vector<double> lows;
    visit_frames(scene, [&](const std::vector<Transform>& locals) {
        const double low = heights_of(scene, RestFrames(scene, locals), up).first;
        if (std::isfinite(low)) lows.push_back(low);
    });
    const auto quarter = lows.begin() + static_cast<std::ptrdiff_t>(lows.size() / 4);
    std::nth_element(lows.begin(), quarter, lows.end());
    return lows.empty() ? std::nullopt : std::optional(*quarter);
}

std::optional<StandingPose> make_standing_pose(const Scene& scene, const Humanoid& bones, const glm::dvec3& up,
                                               const CandidatePose& from) {
    const RestFrames stands(scene, from.locals);
    const RestFrames pose(scene, with_turns(scene, from.locals));
    const auto axes = axes_of(pose, bones, up);
    if (!axes) return std::nullopt;
    StandingPose standing;
    for (const std::uint32_t joint : list_standing(scene, from.locals))
        standing.rotations.push_back(standing_rotation(joint, to_record(stands.turn(joint))));
    const auto [lowest, highest] = heights_of(scene, pose, up);
    constexpr double kNear = 0.02;  // of the height: feet dip into the ground
    const double of_clips = ground_of_clips(scene, bones[Bone::hips], up).value_or(lowest);
    const double ground = std::abs(of_clips - lowest) < kNear * (highest - lowest) ? lowest : of_clips;
    standing.pose.axes = to_record(*axes);
    standing.pose.ground = static_cast<float>(ground);
    standing.pose.height = static_cast<float>(highest - lowest);
    if (!std::isfinite(standing.pose.ground) || !std::isfinite(standing.pose.height)) return std::nullopt;
    standing.pose.evidence = static_cast<std::uint8_t>(from.evidence);
    return standing;
}

bool is_made_to_stand(const RestFrames& pose, const Humanoid& bones, const glm::dvec3& up) {
    const std::optional<Standing> standing = judge_stand(pose, bones, up);
    return standing && standing->is_made_to_stand();
}

/// The pose to trust, if the rest pose does not stand, and whether something shows that the body does.
struct FoundStand {
    std::optional<CandidatePose> pose;
    bool is_shown = true;
};

/// Each pose is judged as STND will keep it: joints that hang on nothing, as feet of some robots, stay where they rest.
FoundStand find_stand(const Scene& scene, const Humanoid& bones, const glm::dvec3& up, const Standing& rest) {
    const auto judge = [&](const std::optional<CandidatePose>& pose) {
        const auto judged =
            pose ? judge_stand(RestFrames(scene, with_turns(scene, pose->locals)), bones, up) : std::nullopt;
        return judged.value_or(Standing());
    };
    std::vector<CandidatePose> poses = find_bind_poses(scene);
    poses.push_back({StandingEvidence::rest_pose, rest_of(scene)});
    for (CandidatePose& candidate : poses) {
        auto pose = turn_upright(scene, bones, up, std::move(candidate));
        if (judge(pose).is_made_to_stand()) return {std::move(pose)};
    }
    const auto best = find_standing_frame(scene, bones, up);
    auto frame =
        best ? turn_to_front(scene, bones, up, up, *best) : std::nullopt;  // in its clips a body looks anywhere
    const Standing in_clip = judge(frame);
    if (in_clip.is_made_to_stand() && in_clip.is_straight() && in_clip.mirror < kChance) return {std::move(frame)};
    auto assumed =
        turn_to_front(scene, bones, {0.0, 1.0, 0.0}, up,
                      {StandingEvidence::assumed, assume_stand(scene, bones, best ? best->locals : rest_of(scene),
                                                               in_clip.stands() ? std::optional(up) : std::nullopt)});
    // A T is upright, unless parts of the body hang on nothing.
    const Standing as_t = judge(assumed);
    const bool is_better = in_clip.stands() && as_t.flaws() < in_clip.flaws();
    if (as_t.is_made_to_stand() && (as_t.is_straight() || is_better)) return {std::move(assumed), in_clip.stands()};
    if (rest.stands() && rest.flaws() < in_clip.flaws()) return {std::nullopt};
    return {in_clip.stands() ? std::move(frame) : std::nullopt, in_clip.stands()};
}

std::string why_not(const Standing& standing) {
    const auto degrees = [](double angle) { return std::to_string(std::lround(angle)) + " degrees"; };
    if (!standing.is_upright()) return "its trunk is " + degrees(standing.lean) + " from upright";
    if (standing.knees >= kBentKnee) return "a knee is bent by " + degrees(standing.knees);
    return standing.feet >= kUneven ? "one foot is above the other" : "its sides differ";
}

}  // namespace

void orient(Scene& scene, SourceUp up, bool faces_front, Report& report) {
    const glm::dmat3 z_to_y({1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0});
    const Humanoid bones = humanoid_of(scene.roles);
    if (up == SourceUp::found && find_up(scene, bones).z > 0.5) {
        turn_roots(scene, z_to_y);
        report.suggest(
            "the body stands along Z in its clips, so Z is taken as up and turned to Y: --up y leaves it as it is");
    } else if (up == SourceUp::z) {
        turn_roots(scene, z_to_y);
    }
    const glm::dvec3 y(0.0, 1.0, 0.0);
    const RestFrames frames(scene);
    const auto stand = own_up(frames, bones);
    const auto axes = stand && glm::dot(*stand, y) > 0.8 ? axes_of(frames, bones, y) : std::nullopt;
    if (!axes) {
        if (faces_front) report.warn("--face front: no body that stands with Y up is found, so nothing is turned");
        return;
    }
    const glm::dvec3 front = *axes * glm::dvec3(0.0, 0.0, 1.0);
    if (front.z >= std::abs(front.x)) return;
    if (!faces_front) {
        if (front.z < -std::abs(front.x) && scene.extensions.find("\"VRM\"") != std::string::npos) {
            report.suggest(
                "the character faces -Z, as VRM 0 has it; viewers look at its back: --face front turns it to +Z");
        }
        return;
    }
    const double s = std::abs(front.x) > std::abs(front.z) ? (front.x > 0.0 ? -1.0 : 1.0) : 0.0;
    const double c = s == 0.0 ? -1.0 : 0.0;
    turn_roots(scene, glm::dmat3({c, 0.0, -s}, {0.0, 1.0, 0.0}, {s, 0.0, c}));
}

void find_standing_pose(Scene& scene, Report& report) {
    if (scene.standing_pose || scene.roles.empty()) return;
    const Humanoid bones = humanoid_of(scene.roles);
    const RestFrames frames(scene);
    if (is_made_to_stand(frames, bones, {0.0, 1.0, 0.0})) return;
    const glm::dvec3 up = find_up(scene, bones);
    const std::optional<Standing> rest = judge_stand(frames, bones, up);
    if (!rest || rest->is_made_to_stand()) return;  // the file has another axis up than glTF
    const FoundStand found = find_stand(scene, bones, up, *rest);
    if (found.pose) scene.standing_pose = make_standing_pose(scene, bones, up, *found.pose);
    if (found.is_shown && (scene.standing_pose || rest->stands())) return;
    report.warn("the body does not stand in its rest pose (" + why_not(*rest) + "), nor in a clip: " +
                (scene.standing_pose ? "that it stands as a T of its bones is assumed"
                                     : "clips are retargeted to and from it as if it did") +
                ". `bendy edit --stand CLIP@SECONDS` or --stand-as FILE says how it stands");
}

}  // namespace bendy::converter
