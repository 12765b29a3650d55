#include "reports/describe_rig.h"

#include "reports/messages.h"

#include <bendy/format/ik_chain.h>
#include <bendy/format/role.h>
#include <bendy/format/text.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>
#include <tuple>

namespace bendy::tools {
namespace {

constexpr float kDegrees = 180.0f / std::numbers::pi_v<float>;

using Triple = std::array<float, 3>;

Triple in_degrees(Triple radians) {
    for (float& angle : radians) angle *= kDegrees;
    return radians;
}

bool is_free(float low, float high) {
    return low == -ConstraintRecord::kFree && high == ConstraintRecord::kFree;
}

std::string range_text(float low, float high) {
    if (is_free(low, high)) return "free";
    if (low == -ConstraintRecord::kFree) return "up to " + brief(high);
    if (high == ConstraintRecord::kFree) return "from " + brief(low);
    return brief(low) + " to " + brief(high);
}

/// Describes the ranges of the axes from `first` on: "0 to 1, free and 2 to 3 deg".
std::string ranges_text(const Triple& low, const Triple& high, std::size_t first, std::size_t last,
                        std::string_view unit) {
    std::string text;
    bool has_number = false;
    for (std::size_t axis = first; axis < last; ++axis) {
        if (axis != first) text += axis + 1 == last ? " and " : ", ";
        text += range_text(low[axis], high[axis]);
        has_number = has_number || !is_free(low[axis], high[axis]);
    }
    if (has_number) text.append(" ").append(unit);
    return text;
}

std::string rotation_text(const ConstraintRecord& constraint) {
    const Triple low = in_degrees(constraint.rotation_min);
    const Triple high = in_degrees(constraint.rotation_max);
    const auto ranges = [&](std::size_t first, std::size_t last) { return ranges_text(low, high, first, last, "deg"); };
    std::string model(name_at(kShownNames<ConstraintModel>, constraint.model));
    switch (static_cast<ConstraintModel>(constraint.model)) {
        case ConstraintModel::hinge:
            return model + ' ' + ranges(0, 1);
        case ConstraintModel::swing_twist_ellipse:
        case ConstraintModel::swing_twist_pyramid:
            return model + ", twist " + ranges(0, 1) + ", swing " + ranges(1, 3);
        case ConstraintModel::euler_box:
            return model + ' ' + std::string(name_at(kShownNames<EulerOrder>, constraint.euler_order)) + ' ' +
                   ranges(0, 3);
        case ConstraintModel::largest_angle:
            return model + (high[0] == ConstraintRecord::kFree ? " free" : ' ' + brief(high[0]) + " deg");
        default:
            return model;
    }
}

std::string translation_text(const ConstraintRecord& constraint) {
    constexpr Triple kNothing{};
    bool all_free = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
        all_free = all_free && is_free(constraint.translation_min[axis], constraint.translation_max[axis]);
    if (all_free) return {};
    if (constraint.translation_min == kNothing && constraint.translation_max == kNothing) return "no translation";
    return "translation " + ranges_text(constraint.translation_min, constraint.translation_max, 0, 3, "m");
}

void add_flags(std::string& text, std::uint8_t flags) {
    if ((flags & kApproximated) != 0) add_part(text, "approximated");
    if ((flags & kProposed) != 0) add_part(text, "proposed");
}

/// Returns "NAME NUMBER UNIT" if the number is not its default.
void add_number(std::string& text, std::string_view name, float number, float usual, std::string_view unit = {}) {
    if (number == usual) return;
    add_part(text, std::string(name) + ' ' + brief(number) + std::string(unit));
}

template <std::size_t N>
void add_numbers(std::string& text, std::string_view name, const std::array<float, N>& numbers,
                 const std::array<float, N>& usual, std::string_view unit = {}) {
    if (numbers != usual) add_part(text, std::string(name) + ' ' + brief(numbers) + std::string(unit));
}

}  // namespace

std::string joint_name(const SkeletonView& skeleton, std::uint32_t joint) {
    if (joint >= skeleton.joints.size()) return "no joint " + std::to_string(joint);
    const std::string_view name = skeleton.joints[joint].name;
    return name.empty() ? "joint " + std::to_string(joint) : brief(name);
}

std::string constraint_text(const ConstraintRecord& constraint) {
    constexpr Triple kNothing{};
    std::string text = rotation_text(constraint);
    if (const std::string translation = translation_text(constraint); !translation.empty()) add_part(text, translation);
    add_numbers(text, "stiffness", constraint.stiffness, kNothing);
    add_number(text, "soft zone", constraint.soft_zone * kDegrees, 0.0f, " deg");
    add_numbers(text, "preferred", in_degrees(constraint.preferred), kNothing, " deg");
    if (constraint.scope == static_cast<std::uint8_t>(ConstraintScope::ik_only)) add_part(text, "IK only");
    if (constraint.scope == static_cast<std::uint8_t>(ConstraintScope::all_but_ik)) add_part(text, "all but IK");
    add_flags(text, constraint.flags);
    if ((constraint.flags & kRestOutside) != 0) add_part(text, "rest outside");
    return text;
}

RigIndex::RigIndex(const ChunkTree& tree) : tree_(&tree) {
    Faults ignored;
    for (const std::uint32_t number : tree.children(0)) {
        if (!(tree[number].id == FourCC("OBJE")) || !tree[number].is_container()) continue;
        Object& object = objects_.emplace_back();
        object.chunk = number;
        object.skeleton = read_skeleton(tree, number, ignored);
        const auto joints = static_cast<std::uint32_t>(object.skeleton.joints.size());
        object.roles = read_roles(tree, number, joints, ignored);
        // POLY may come after a child's chunk.
        std::stable_sort(object.skeleton.submeshes.begin(), object.skeleton.submeshes.end(),
                         [](const SubmeshView& x, const SubmeshView& y) { return x.joint < y.joint; });
        object.depths.reserve(object.skeleton.joints.size());
        for (const JointView& joint : object.skeleton.joints)
            object.depths.push_back(joint.parent == kNone ? 0 : object.depths[joint.parent] + 1);
        for (const std::uint32_t child : tree.children(number)) {
            if (tree[child].id == FourCC("IKCH") && tree[child].is_container()) object.chains.push_back(child);
        }
        object.chain_weights = object.skeleton.chain_weights;
        std::stable_sort(object.chain_weights.begin(), object.chain_weights.end(),
                         [](const ChainWeightView& a, const ChainWeightView& b) {
                             return std::tie(a.chain, a.joint) < std::tie(b.chain, b.joint);
                         });
    }
}

const RigIndex::Object* RigIndex::object_of(std::uint32_t chunk) const {
    const auto after =
        std::upper_bound(objects_.begin(), objects_.end(), chunk,
                         [](std::uint32_t number, const Object& object) { return number < object.chunk; });
    if (after == objects_.begin()) return nullptr;
    const Object& object = *std::prev(after);
    return chunk < (*tree_)[object.chunk].end ? &object : nullptr;
}

const JointView* RigIndex::joint_of(std::uint32_t chunk) const {
    const Object* object = object_of(chunk);
    if (object == nullptr) return nullptr;
    const auto& joints = object->skeleton.joints;
    const auto joint =
        std::lower_bound(joints.begin(), joints.end(), chunk,
                         [](const JointView& view, std::uint32_t number) { return view.chunk < number; });
    return joint != joints.end() && joint->chunk == chunk ? &*joint : nullptr;
}

bool RigIndex::has_rest(std::uint32_t chunk) const {
    if (joint_of(chunk) == nullptr) return false;
    const std::uint32_t pivot = tree_->find(chunk, FourCC("PIVO"));
    if (pivot != kNone && tree_->find(pivot, FourCC("REST")) != kNone) return true;
    return tree_->find(object_of(chunk)->chunk, FourCC("JNTS")) != kNone;
}

std::span<const SubmeshView> RigIndex::submeshes_of(std::uint32_t chunk) const {
    const JointView* joint = joint_of(chunk);
    if (joint == nullptr) return {};
    const SkeletonView& skeleton = object_of(chunk)->skeleton;
    const auto number = static_cast<std::uint32_t>(joint - skeleton.joints.data());
    const auto first =
        std::lower_bound(skeleton.submeshes.begin(), skeleton.submeshes.end(), number,
                         [](const SubmeshView& view, std::uint32_t other) { return view.joint < other; });
    const auto last =
        std::find_if(first, skeleton.submeshes.end(), [&](const SubmeshView& view) { return view.joint != number; });
    return {skeleton.submeshes.data() + (first - skeleton.submeshes.begin()), static_cast<std::size_t>(last - first)};
}

std::string RigIndex::role_of(std::uint32_t chunk) const {
    const JointView* view = joint_of(chunk);
    if (view == nullptr) return {};
    const Object& object = *object_of(chunk);
    const auto joint = static_cast<std::uint32_t>(view - object.skeleton.joints.data());
    const RoleRecord* record = bendy::role_of(object.roles, joint);
    return record == nullptr ? std::string() : role_text(*record);
}

std::string RigIndex::links_text(const Object& object, std::uint32_t chain, const ChainRecord& record) const {
    const auto& joints = object.skeleton.joints;
    const auto label = [&](std::uint32_t joint) {
        const auto chain_weight = std::lower_bound(
            object.chain_weights.begin(), object.chain_weights.end(), std::tie(chain, joint),
            [](const ChainWeightView& view, const auto& key) { return std::tie(view.chain, view.joint) < key; });
        const bool has_weight =
            chain_weight != object.chain_weights.end() && chain_weight->chain == chain && chain_weight->joint == joint;
        return joint_name(object.skeleton, joint) +
               (has_weight ? " (" + brief(chain_weight->weight) + ')' : std::string());
    };
    if (record.start >= joints.size() || record.effector >= joints.size() || record.start > record.effector ||
        (*tree_)[joints[record.start].chunk].end <= joints[record.effector].chunk)
        return label(record.start) + " is not above " + label(record.effector);

    constexpr std::uint32_t kMostLinks = 5;
    constexpr std::uint32_t kLastLinks = 2;  // the number shown of a longer chain, after its start
    const std::uint32_t above = object.depths[record.effector] - object.depths[record.start];
    const std::uint32_t shown = above < kMostLinks ? above : kLastLinks;
    std::string text;
    std::uint32_t joint = record.effector;
    for (std::uint32_t link = 0; link < shown; ++link) {
        text.insert(0, " > " + label(joint));
        joint = joints[joint].parent;
    }
    if (shown < above) text.insert(0, " > ... " + grouped(above - shown) + " more ...");
    return label(record.start) + text;
}

std::string RigIndex::chain_text(std::uint32_t chunk) const {
    const Object* object = object_of(chunk);
    const std::uint32_t info = (*tree_)[chunk].is_container() ? tree_->find(chunk, FourCC("KINF")) : kNone;
    if (object == nullptr || info == kNone || tree_->encoding_fault(info)) return {};
    const auto record = record_at<ChainRecord>(*tree_, info);
    const auto place = std::lower_bound(object->chains.begin(), object->chains.end(), chunk);
    std::string text = links_text(*object, static_cast<std::uint32_t>(place - object->chains.begin()), record);
    add_part(text, name_at(kShownNames<Solver>, record.solver));
    if (record.target != kNone) add_part(text, "target " + joint_name(object->skeleton, record.target));
    if (record.pole != kNone) add_part(text, "pole " + joint_name(object->skeleton, record.pole));
    add_number(text, "position", record.position_weight, 1.0f);
    add_number(text, "rotation", record.rotation_weight, 0.0f);
    add_number(text, "influence", record.influence, 1.0f);
    add_flags(text, record.flags);
    return text;
}

std::string RigIndex::chain_info_text(std::uint32_t chunk) const {
    constexpr ChainRecord kUsual;
    const auto record = record_at<ChainRecord>(*tree_, chunk);
    std::string text = chain_text((*tree_)[chunk].parent);
    if (record.iterations != 0) add_part(text, "at most " + grouped(record.iterations) + " iterations");
    if (record.priority != 0) add_part(text, "priority " + std::to_string(record.priority));
    add_number(text, "tolerance", record.tolerance, 0.0f, " m");
    add_numbers(text, "pole vector", record.pole_vector, kUsual.pole_vector);
    add_number(text, "pole angle", record.pole_angle * kDegrees, 0.0f, " deg");
    add_numbers(text, "tip", record.tip_offset, kUsual.tip_offset, " m");
    add_numbers(text, "tip rotation", record.tip_rotation, kUsual.tip_rotation);
    add_number(text, "stretch", record.stretch, 0.0f);
    add_number(text, "compress", record.compress, 0.0f);
    return text;
}

std::string RigIndex::chain_weight_text(std::uint32_t chunk) const {
    const auto record = record_at<ChainWeightRecord>(*tree_, chunk);
    std::string text = brief(record.weight) + " in ";
    const Object* object = object_of(chunk);
    if (object == nullptr || record.chain >= object->chains.size())
        return text + "no chain " + std::to_string(record.chain);
    const std::uint32_t name = tree_->find(object->chains[record.chain], FourCC("NAME"));
    const std::string_view words =
        name == kNone || (*tree_)[name].is_container() ? std::string_view() : as_text(tree_->payload(name));
    return text + (words.empty() ? "chain " + std::to_string(record.chain) : brief(words));
}

}  // namespace bendy::tools
