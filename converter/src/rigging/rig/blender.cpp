#include "blender.h"

#include "parse_rig.h"
#include "scene/failure.h"

#include <bendy/format/constraint.h>
#include <bendy/format/trig.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace bendy::converter {

std::array<double, 3> to_euler(const Rotation& rotation, EulerOrder order) {
    const auto [first, middle, last] = axes_of(order);
    const glm::dmat3 columns = glm::mat3_cast(rotation);
    const auto entry = [&](std::size_t row, std::size_t column) {
        return columns[static_cast<int>(column)][static_cast<int>(row)];
    };
    const double sign = (first + 1) % 3 == middle ? 1.0 : -1.0;  // sign of the axes' permutation
    std::array<double, 3> angles{};
    angles[first] = trig::atan2(sign * entry(last, middle), entry(last, last));
    angles[middle] = std::asin(std::clamp(-sign * entry(last, first), -1.0, 1.0));
    angles[last] = trig::atan2(sign * entry(middle, first), entry(first, first));
    return angles;
}

namespace {

constexpr float kFree = ConstraintRecord::kFree;
constexpr std::array<std::string_view, 5> kSpaceNames{"rest", "rest_with_parent", "armature", "world", "custom"};
enum class Space : std::uint8_t { rest, rest_with_parent, armature, world, custom };

/// Maps X to the bone's Y, along the bone (the twist axis), Y to its Z and Z to its X.
constexpr std::array<float, 4> kAlongBone{0.5f, 0.5f, 0.5f, 0.5f};
constexpr std::array<std::size_t, 3> kBoneAxis{1, 2, 0};  ///< the bone's axis for X, Y, Z of that frame

struct Box {
    std::array<float, 3> low{-kFree, -kFree, -kFree};
    std::array<float, 3> high{kFree, kFree, kFree};

    /// Intersects with another box; returns false and leaves this one unchanged if nothing remains.
    bool intersect(const Box& other) {
        Box both;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            both.low[axis] = std::max(low[axis], other.low[axis]);
            both.high[axis] = std::min(high[axis], other.high[axis]);
            if (both.low[axis] > both.high[axis]) return false;
        }
        *this = both;
        return true;
    }
};

/// A Limit Rotation or Limit Location constraint.
struct Source {
    std::string place;
    Space space = Space::rest;
    std::array<float, 4> zero{-0.70710678f, 0.0f, 0.0f, 0.70710678f};  ///< the orientation with angles 0
    std::uint8_t order = 0;
    float influence = 1.0f;
    Box box;
};

std::vector<Source> read_sources(Fields& fields, std::string_view key, bool is_rotation) {
    std::vector<Source> sources;
    const OrderedJson* list = fields.find(key);
    if (list == nullptr) return sources;
    need_list(*list, fields.place_of(key));
    for (std::size_t i = 0; i < list->size(); ++i) {
        Source source;
        source.place = at(fields.place_of(key), i);
        Fields one((*list)[i], source.place, Notation::extras);
        auto space = static_cast<std::uint8_t>(Space::rest);
        one.read_word("space", kSpaceNames, space);
        source.space = static_cast<Space>(space);
        if (is_rotation) one.read_word("order", kOrderNames, source.order);
        one.read_rotation("zero", source.zero);
        one.read("influence", source.influence, 0.0f, 1.0f);
        for (std::size_t axis = 0; axis < 3; ++axis)
            one.read_range(kAxisNames[axis], source.box.low[axis], source.box.high[axis]);
        if (source.influence > 0.0f) sources.push_back(std::move(source));
    }
    return sources;
}

void approximate(ConstraintRecord& constraint, const std::string& what, const std::string& place, Report& report) {
    constraint.flags |= kApproximated;
    report.warn(what, place);
}

void note_influence(const Source& source, ConstraintRecord& constraint, Report& report) {
    if (source.influence != 1.0f) {
        approximate(constraint, "a limit with an influence of less than 1 counts in full", source.place + ".influence",
                    report);
    }
}

/// Converts a box that limits not the bone's rotation q but r q conj(zero), where r is the bone's rest orientation in
/// the box's space. That is D Q with D = r conj(zero) and Q = zero q conj(zero). With D = R(last) R(middle) R(first), a
/// frame that undoes the first turn leaves a box for Q that is shifted by D's angles; this is exact if the middle angle
/// is zero. False if the middle angle is too large for the box to approximate the original.
bool shift_box(const Rotation& rest, const Rotation& zero, ConstraintRecord& constraint) {
    constexpr double kResembles = std::numbers::pi / 3.0;
    const auto order = static_cast<EulerOrder>(constraint.euler_order);
    const auto [first, middle, last] = axes_of(order);
    const std::array<double, 3> angles = to_euler(rest * glm::conjugate(zero), order);
    if (std::abs(angles[middle]) > kResembles) return false;
    glm::dvec3 axis(0.0);
    axis[static_cast<int>(first)] = 1.0;
    constraint.frame = to_record(glm::conjugate(zero) * glm::angleAxis(-angles[first], axis));
    for (std::size_t i = 0; i < 3; ++i) {
        float& low = constraint.rotation_min[i];
        float& high = constraint.rotation_max[i];
        const double low_there = low - angles[i];
        const double high_there = high - angles[i];
        const bool is_bounded = std::isfinite(low_there) && std::isfinite(high_there);
        const double turn =
            is_bounded ? 2.0 * std::numbers::pi * std::round((low_there + high_there) / (4.0 * std::numbers::pi)) : 0.0;
        low = static_cast<float>(low_there - turn);
        high = static_cast<float>(high_there - turn);
    }
    return true;
}

/// False if the space is not supported.
bool place_box(const Source& source, const BoneAxes& bone, ConstraintRecord& constraint, Report& report) {
    if (source.space == Space::rest) return true;
    if (source.space == Space::custom) return false;
    approximate(constraint, "a rotation limit counts the parents' motion in Blender, and does not here", source.place,
                report);
    if (source.space == Space::rest_with_parent) return true;
    const Rotation& rest = source.space == Space::world ? bone.in_file : bone.in_armature;
    return shift_box(rest, to_rotation(source.zero), constraint);
}

std::optional<ConstraintRecord> read_rotation_box(Fields& fields, const BoneAxes& bone, Report& report) {
    std::optional<ConstraintRecord> constraint;
    Source first;
    for (Source& source : read_sources(fields, "euler_limits", true)) {
        if (!constraint) {
            constraint.emplace();
            constraint->model = static_cast<std::uint8_t>(ConstraintModel::euler_box);
            constraint->euler_order = source.order;
            first = std::move(source);
            note_influence(first, *constraint, report);
            continue;
        }
        note_influence(source, *constraint, report);
        const bool is_alike = source.space == first.space && source.order == first.order;
        if (!is_alike || !first.box.intersect(source.box)) {
            approximate(*constraint, "of several rotation limits that do not go together the first counts",
                        source.place, report);
        }
    }
    if (!constraint) return constraint;
    constraint->rotation_min = first.box.low;
    constraint->rotation_max = first.box.high;
    if (place_box(first, bone, *constraint, report)) return constraint;
    report.warn("a rotation limit in space " + std::string(kSpaceNames[static_cast<std::size_t>(first.space)]) +
                    " left out: it cannot be held in the joint's rest space",
                first.place);
    return std::nullopt;
}

/// Reads the limits and stiffness of Blender's IK solver.
std::optional<ConstraintRecord> read_ik_limits(Fields& fields) {
    std::optional<ConstraintRecord> constraint;
    const OrderedJson* value = fields.find("swing_twist");
    if (value != nullptr) {
        constraint.emplace();
        constraint->model = static_cast<std::uint8_t>(ConstraintModel::swing_twist_ellipse);
        constraint->frame = kAlongBone;
        Fields ranges(*value, fields.place_of("swing_twist"), Notation::extras);
        constexpr std::array<std::string_view, 3> kRanges{"twist_y", "swing_z", "swing_x"};
        for (std::size_t axis = 0; axis < 3; ++axis)
            ranges.read_angle_range(kRanges[axis], constraint->rotation_min[axis], constraint->rotation_max[axis]);
        constexpr std::array<float, 3> kZeros{};
        if (constraint->rotation_min == kZeros && constraint->rotation_max == kZeros) {
            *constraint = ConstraintRecord{};
            constraint->model = static_cast<std::uint8_t>(ConstraintModel::locked);
        }
    }
    std::array<float, 3> stiffness{};
    fields.read("stiffness", stiffness, 0.0f, 1.0f);
    if (stiffness != std::array<float, 3>{}) {
        if (!constraint) constraint.emplace();
        const bool is_along = constraint->frame == kAlongBone;
        for (std::size_t axis = 0; axis < 3; ++axis)
            constraint->stiffness[axis] = stiffness[is_along ? kBoneAxis[axis] : axis];
    }
    if (!constraint) return constraint;
    constraint->scope = static_cast<std::uint8_t>(ConstraintScope::ik_only);
    check_constraint_at(*constraint, fields.place_of("swing_twist"));
    return constraint;
}

/// Reads location limits along the bone's axes, as a free model without rotation limits.
std::optional<ConstraintRecord> read_location_box(Fields& fields, Report& report) {
    std::optional<ConstraintRecord> constraint;
    Box box;
    for (const Source& source : read_sources(fields, "location_limits", false)) {
        if (source.space != Space::rest) {
            report.warn("a location limit in another space than the joint's rest space left out", source.place);
            continue;
        }
        if (!constraint) constraint.emplace();
        note_influence(source, *constraint, report);
        if (!box.intersect(source.box)) {
            approximate(*constraint, "of several location limits that do not go together the first counts",
                        source.place, report);
        }
    }
    if (!constraint) return constraint;
    constraint->translation_min = box.low;
    constraint->translation_max = box.high;
    return constraint;
}

}  // namespace

std::vector<ConstraintRecord> read_blender_limits(Fields& fields, const BoneAxes& bone, Report& report) {
    std::optional<ConstraintRecord> rotation = read_rotation_box(fields, bone, report);
    const std::optional<ConstraintRecord> ik = read_ik_limits(fields);
    std::optional<ConstraintRecord> location = read_location_box(fields, report);

    // Blender's IK solver ignores constraints and has its own limits; if it has none, the constraints apply to IK as
    // well.
    if (rotation && ik) rotation->scope = static_cast<std::uint8_t>(ConstraintScope::all_but_ik);
    if (rotation && location) {
        if (rotation->frame == ConstraintRecord{}.frame) {
            rotation->translation_min = location->translation_min;
            rotation->translation_max = location->translation_max;
            rotation->flags |= location->flags;
            location.reset();
        } else if (!ik) {
            location->scope = static_cast<std::uint8_t>(ConstraintScope::all_but_ik);  // IK does not translate
        }
    }
    bool is_approximated = false;
    fields.read("approximated", is_approximated);
    std::vector<ConstraintRecord> constraints;
    for (const auto& limit : {rotation, ik, location}) {
        if (!limit) continue;
        constraints.push_back(*limit);
        if (is_approximated) constraints.back().flags |= kApproximated;
    }
    return constraints;
}

namespace {

constexpr double kStraight = 1e-4;  // share of the chain's length: joints nearer than this to the line lie on it

/// The unit component of `vector` at right angles to the unit vector `line`; nothing if it is too short.
std::optional<glm::dvec3> across(const glm::dvec3& vector, const glm::dvec3& line, double shortest) {
    const glm::dvec3 rest = vector - line * glm::dot(vector, line);
    const double length = glm::length(rest);
    if (!(length > shortest)) return std::nullopt;
    return rest / length;
}

class Reader {
public:
    Reader(Fields& fields, std::uint32_t node, const BlenderRig& rig, WorkBudget& budget, Report& report)
        : fields_(fields), node_(node), rig_(rig), budget_(budget), report_(report) {}

    Chain read() {
        fields_.need("name");
        fields_.read("name", chain_.name);
        read_joints();
        read_numbers();
        read_tip();
        choose_solver();
        if (const OrderedJson* target = fields_.find("target"); target != nullptr && !target->is_null()) {
            Fields control(*target, fields_.place_of("target"), Notation::extras);
            chain_.record.target = find_control(control);
            if (chain_.record.target == kNone) approximate("the target of a chain is not a joint: left out", control);
        }
        if (const OrderedJson* pole = fields_.find("pole"); pole != nullptr && !pole->is_null()) {
            Fields control(*pole, fields_.place_of("pole"), Notation::extras);
            read_pole(control);
        }
        check();
        return std::move(chain_);
    }

private:
    /// Checks the range: joints may rest beyond the range of float.
    void check() const {
        const ChainRecord& record = chain_.record;
        const auto is_finite = [](float number) { return std::isfinite(number); };
        const bool is_sound = std::all_of(record.tip_offset.begin(), record.tip_offset.end(), is_finite) &&
                              std::all_of(record.pole_vector.begin(), record.pole_vector.end(), is_finite) &&
                              is_finite(record.pole_angle);
        if (!is_sound) fail(fields_.place(), "its joints rest out of a float's range");
    }

    void approximate(const char* what, const Fields& where) {
        chain_.record.flags |= kApproximated;
        report_.warn(what, where.place());
    }

    std::uint32_t find_joint(const OrderedJson& name, const std::string& place) const {
        if (!name.is_string()) fail(place, "it must be a string, not " + shown(name));
        const std::uint32_t joint = rig_.index.find(name.text(), node_);
        if (joint == kNone) fail(place, "there is no joint " + shown(name));
        return joint;
    }

    void read_joints() {
        const std::string place = fields_.place_of("joints");
        const OrderedJson& names = need_list(fields_.need("joints"), place);
        if (names.empty()) fail(place, "it must not be empty");
        last_ = find_joint(names.back(), at(place, names.size() - 1));
        start_ = find_start(names, place);
        if (!rig_.index.is_above(start_, last_)) {
            fail(place, "joint " + quote(rig_.scene.joints[start_].name) + " is neither " + shown(names.back()) +
                            " itself nor above it");
        }
        for (std::uint32_t joint = last_; joint != start_; joint = rig_.scene.joints[joint].parent)
            links_.push_back(joint);
        links_.push_back(start_);
        std::reverse(links_.begin(), links_.end());
        budget_.take(8 * links_.size());
        chain_.record.start = start_;
        chain_.record.effector = last_;
    }

    /// The first joint of the list that exists in the file.
    std::uint32_t find_start(const OrderedJson& names, const std::string& place) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (!names[i].is_string()) fail(at(place, i), "it must be a string, not " + shown(names[i]));
            const std::uint32_t joint = rig_.index.find(names[i].text(), node_);
            if (joint != kNone) return joint;
            chain_.record.flags |= kApproximated;
            report_.warn("a chain starts at a joint that does not exist: it starts below", at(place, i));
        }
        return last_;
    }

    void read_numbers() {
        ChainRecord& record = chain_.record;
        std::uint64_t iterations = 0;
        fields_.read_integer("iterations", UINT32_MAX, iterations);
        record.iterations = static_cast<std::uint16_t>(std::min<std::uint64_t>(iterations, UINT16_MAX));
        fields_.read("influence", record.influence, 0.0f, 1.0f);
        bool reaches = true;
        bool turns = false;
        bool stretches = false;
        float orientation_weight = 1.0f;
        fields_.read("weight", record.position_weight, 0.0f, 1.0f);
        fields_.read("position", reaches);
        fields_.read("rotation", turns);
        fields_.read("orientation_weight", orientation_weight, 0.0f, 1.0f);
        fields_.read("stretch", stretches);
        if (!reaches) record.position_weight = 0.0f;
        record.rotation_weight = turns ? orientation_weight : 0.0f;
        bool is_approximated = false;
        fields_.read("approximated", is_approximated);
        if (is_approximated) record.flags |= kApproximated;
        if (!stretches) return;
        for (const std::uint32_t joint : links_) record.stretch = std::max(record.stretch, rig_.stretch[joint]);
        if (record.stretch > 0.0f)
            approximate("how readily the bones of a chain stretch is taken as the share that it may grow by", fields_);
    }

    /// Sets the last bone's tip: a child joint at that place, unless the last bone itself is to be rotated.
    void read_tip() {
        std::array<float, 3> offset{};
        fields_.read("effector_offset", offset);
        // In the bone's current axes.
        const Rotation turn = glm::conjugate(rig_.rest.turn(last_)) * rig_.axes[last_];
        glm::dvec3 local(offset[0], offset[1], offset[2]);
        if (2.0 * trig::acos(std::abs(turn.w)) > 1e-3) local = turn * local;
        tip_ = rig_.rest.place(last_, local);
        double length = glm::distance(tip_, rig_.rest.place(last_));
        for (std::size_t i = 1; i < links_.size(); ++i)
            length += glm::distance(rig_.rest.place(links_[i - 1]), rig_.rest.place(links_[i]));
        length_ = length;

        double nearest = 1e-3 * length;
        if (chain_.record.rotation_weight == 0.0f && local != glm::dvec3(0.0)) {
            for (std::uint32_t child = last_ + 1; child < rig_.index.end(last_); child = rig_.index.end(child)) {
                budget_.take(1);
                const double distance = glm::distance(rig_.rest.place(child), tip_);
                if (!(distance < nearest)) continue;
                nearest = distance;
                chain_.record.effector = child;
            }
        }
        if (chain_.record.effector != last_) return;
        for (std::size_t i = 0; i < 3; ++i)
            chain_.record.tip_offset[i] = static_cast<float>(local[static_cast<int>(i)]);
    }

    void choose_solver() {
        if (const OrderedJson* solver = fields_.find("solver"); solver != nullptr && !solver->is_string())
            fail(fields_.place_of("solver"), "it must be a string, not " + shown(*solver));
        const auto& limits = rig_.scene.joints[start_].constraints;
        const bool is_free = std::none_of(limits.begin(), limits.end(), [](const ConstraintRecord& constraint) {
            const auto model = static_cast<ConstraintModel>(constraint.model);
            return model == ConstraintModel::hinge || model == ConstraintModel::locked;
        });
        if (links_.size() == 2 && is_free) chain_.record.solver = static_cast<std::uint8_t>(Solver::two_bone);
    }

    /// The joint that is a target or pole; kNone if there is none.
    [[nodiscard]] std::uint32_t find_control(Fields& control) const {
        std::string object;
        std::string joint;
        control.read("object", object);
        control.read("joint", joint);
        const std::uint32_t top = object.empty() ? kNone : rig_.index.find(object);
        if (joint.empty()) return top;
        return rig_.index.find(joint, top == kNone ? node_ : top);
    }

    void read_pole(Fields& control) {
        const glm::dvec3 start = rig_.rest.place(start_);
        const glm::dvec3 line = (tip_ - start) / std::max(glm::distance(tip_, start), 1e-300);
        chain_.record.pole = find_control(control);
        if (chain_.record.pole == kNone) {
            approximate("the pole of a chain is not a joint: its direction at rest is kept", control);
            std::array<float, 3> position{};
            if (control.find("position") == nullptr) return;
            control.read("position", position);
            const glm::dvec3 there{position[0], position[1], position[2]};
            const glm::dvec3 pole = node_ == kNone ? there : rig_.rest.place(node_, there);
            const auto direction = across(pole - start, line, kStraight * length_);
            if (!direction) return;
            keep_vector(*direction);
        }
        read_pole_angle(control, line);
    }

    void keep_vector(glm::dvec3 direction) {
        const std::uint32_t parent = rig_.scene.joints[start_].parent;
        if (parent != kNone) direction = glm::conjugate(rig_.rest.turn(parent)) * direction;
        for (std::size_t i = 0; i < 3; ++i)
            chain_.record.pole_vector[i] = static_cast<float>(direction[static_cast<int>(i)]);
    }

    /// Blender's pole angle turns an axis of the first bone to the pole; here the bend is turned.
    void read_pole_angle(Fields& control, const glm::dvec3& line) {
        float angle = 0.0f;
        control.read_angle("angle", angle);
        const trig::SinCos turn = trig::sin_cos(double{angle});
        std::array<float, 3> axis{static_cast<float>(turn.cos), 0.0f, static_cast<float>(turn.sin)};
        control.read("axis", axis);
        const glm::dvec3 turned = rig_.axes[start_] * glm::dvec3(axis[0], axis[1], axis[2]);
        glm::dvec3 furthest(0.0);
        for (const std::uint32_t joint : links_) {
            const glm::dvec3 offset = rig_.rest.place(joint) - rig_.rest.place(start_);
            const glm::dvec3 beside = offset - line * glm::dot(offset, line);
            if (glm::length(beside) > glm::length(furthest)) furthest = beside;
        }
        const auto to_pole = across(turned, line, 1e-3);
        const auto bend = across(furthest, line, kStraight * length_);
        if (!to_pole || !bend) return;  // a straight chain has no bend to turn
        chain_.record.pole_angle =
            static_cast<float>(trig::atan2(glm::dot(glm::cross(*to_pole, *bend), line), glm::dot(*to_pole, *bend)));
    }

    Fields& fields_;
    std::uint32_t node_;
    const BlenderRig& rig_;
    WorkBudget& budget_;
    Report& report_;
    Chain chain_;
    std::uint32_t start_ = 0;
    std::uint32_t last_ = 0;
    std::vector<std::uint32_t> links_;  ///< start to last
    glm::dvec3 tip_{0.0};               ///< model space
    double length_ = 0.0;               ///< metres, along the bones
};

}  // namespace

Chain read_blender_chain(Fields& fields, std::uint32_t node, const BlenderRig& rig, WorkBudget& budget,
                         Report& report) {
    return Reader(fields, node, rig, budget, report).read();
}

}  // namespace bendy::converter
