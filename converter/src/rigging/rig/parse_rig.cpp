#include "parse_rig.h"

#include "scene/failure.h"
#include "scene/source/source_file.h"

#include <bendy/converter/source_format.h>
#include <bendy/format/clip.h>
#include <bendy/format/constraint.h>
#include <bendy/format/diagnostics.h>

#include <algorithm>
#include <bitset>
#include <unordered_set>

namespace bendy::converter {
namespace {

/// Fails if a member is present that the model does not use.
void refuse(Fields& fields, std::string_view key, ConstraintModel model) {
    if (fields.find(key) == nullptr) return;
    fail(fields.place_of(key),
         "it means nothing for model " +
             spelled(kValueNames<ConstraintModel>[static_cast<std::size_t>(model)], fields.notation()));
}

void read_rotation_limits(Fields& fields, ConstraintModel model, ConstraintRecord& constraint) {
    if (model == ConstraintModel::largest_angle) {
        if (const OrderedJson* angle = fields.find("angle"); angle != nullptr && !angle->is_null()) {
            fields.read_angle("angle", constraint.rotation_max[0]);
            if (constraint.rotation_max[0] < 0.0f) fail(fields.place_of("angle"), "it is less than 0");
        }
    } else {
        refuse(fields, "angle", model);
    }
    const std::size_t ranges = model == ConstraintModel::largest_angle ? 0 : limited_axes(model);
    const bool is_swing =
        model == ConstraintModel::swing_twist_ellipse || model == ConstraintModel::swing_twist_pyramid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axis >= ranges) {
            refuse(fields, kAxisNames[axis], model);
            continue;
        }
        float& low = constraint.rotation_min[axis];
        float& high = constraint.rotation_max[axis];
        fields.read_angle_range(kAxisNames[axis], low, high);
        if (is_swing && axis != 0 && !(low <= 0.0f && high >= 0.0f))
            fail(fields.place_of(kAxisNames[axis]), "a swing's range must hold 0");
    }
}

void read_translation(Fields& fields, ConstraintRecord& constraint) {
    const OrderedJson* value = fields.find("translation");
    if (value == nullptr) return;
    Fields translation(*value, fields.place_of("translation"), fields.notation());
    for (std::size_t axis = 0; axis < 3; ++axis)
        translation.read_range(kAxisNames[axis], constraint.translation_min[axis], constraint.translation_max[axis]);
    translation.refuse_others();
}

void read_flag(Fields& fields, std::string_view key, std::uint8_t flag, std::uint8_t& flags) {
    bool is_set = false;
    fields.read(key, is_set);
    if (is_set) flags |= flag;
}

}  // namespace

void check_constraint_at(const ConstraintRecord& constraint, const std::string& place) {
    ConstraintRecord admitted = constraint;
    admitted.flags |= kRestOutside;
    Faults faults;
    check_constraint(admitted, 0, 0, faults);
    if (!faults.empty()) fail(place, describe(faults.list().front()));
}

ConstraintRecord parse_constraint(const OrderedJson& value, const std::string& place, Notation notation) {
    Fields fields(value, place, notation);
    ConstraintRecord constraint;
    fields.need("model");
    fields.read_word("model", kValueNames<ConstraintModel>, constraint.model);
    const auto model = static_cast<ConstraintModel>(constraint.model);
    if (model == ConstraintModel::euler_box) {
        fields.read_word("order", kOrderNames, constraint.euler_order);
    } else {
        refuse(fields, "order", model);
    }
    fields.read_word("scope", kValueNames<ConstraintScope>, constraint.scope);
    fields.read_rotation("frame", constraint.frame);
    read_rotation_limits(fields, model, constraint);
    read_translation(fields, constraint);
    fields.read("stiffness", constraint.stiffness, 0.0f, 1.0f);
    fields.read_angles("preferred", constraint.preferred);
    fields.read_angle("soft_zone", constraint.soft_zone);
    if (constraint.soft_zone < 0.0f) fail(fields.place_of("soft_zone"), "it is less than 0");
    read_flag(fields, "approximated", kApproximated, constraint.flags);
    read_flag(fields, "proposed", kProposed, constraint.flags);
    read_flag(fields, "rest_outside", kRestOutside, constraint.flags);
    fields.refuse_others();
    check_constraint_at(constraint, place);
    return constraint;
}

std::vector<ConstraintRecord> parse_constraints(const OrderedJson& value, const std::string& place, Notation notation) {
    if (!value.is_array()) return {parse_constraint(value, place, notation)};
    std::vector<ConstraintRecord> constraints;
    std::bitset<kConstraintScopes> taken;
    for (std::size_t i = 0; i < value.size(); ++i) {
        const ConstraintRecord constraint = parse_constraint(value[i], at(place, i), notation);
        if (taken[constraint.scope]) {
            fail(at(place, i), "there is a second constraint of scope " +
                                   spelled(kValueNames<ConstraintScope>[constraint.scope], notation));
        }
        taken.set(constraint.scope);
        constraints.push_back(constraint);
    }
    return constraints;
}

namespace {

void read_needed(Fields& fields, std::string_view key, std::string& text) {
    fields.need(key);
    fields.read(key, text);
}

void read_weights(Fields& fields, Notation notation, RigChain& chain) {
    const OrderedJson* value = fields.find("weights");
    if (value == nullptr) return;
    Fields weights(*value, fields.place_of("weights"), notation);  // an object, every key once
    for (const auto& [name, weight] : value->items()) {
        const std::string place = weights.place_of(name);
        const float number = to_float(weight, place);
        if (!(number >= 0.0f && number <= 1.0f)) fail(place, shown(weight) + " is not between 0 and 1");
        chain.weights.emplace_back(parse_joint_key(name, place), number);
    }
}

}  // namespace

void parse_chain_settings(Fields& fields, ChainRecord& record) {
    fields.read_word("solver", kValueNames<Solver>, record.solver);
    std::uint64_t number = record.iterations;
    fields.read_integer("iterations", 65535, number);
    record.iterations = static_cast<std::uint16_t>(number);
    number = record.priority;
    fields.read_integer("priority", 255, number);
    record.priority = static_cast<std::uint8_t>(number);
    fields.read("tolerance", record.tolerance, 0.0f);
    fields.read("pole_vector", record.pole_vector);
    fields.read_angle("pole_angle", record.pole_angle);
    fields.read("tip_offset", record.tip_offset);
    fields.read_rotation("tip_rotation", record.tip_rotation);
    fields.read("position_weight", record.position_weight, 0.0f, 1.0f);
    fields.read("rotation_weight", record.rotation_weight, 0.0f, 1.0f);
    fields.read("influence", record.influence, 0.0f, 1.0f);
    fields.read("stretch", record.stretch, 0.0f);
    fields.read("compress", record.compress, 0.0f, 1.0f);
    read_flag(fields, "approximated", kApproximated, record.flags);
    read_flag(fields, "proposed", kProposed, record.flags);
}

void parse_standing_settings(Fields& fields, StandingPoseRecord& record) {
    fields.need("axes");
    fields.read_rotation("axes", record.axes);
    fields.read("ground", record.ground);
    fields.read("height", record.height, 0.0f);
    fields.read_word("evidence", kValueNames<StandingEvidence>, record.evidence);
}

std::array<float, 3> parse_standing_rotation(const OrderedJson& value, const std::string& place) {
    std::array<float, 3> rotation{};
    need_list(value, place);
    if (value.size() != rotation.size())
        fail(place, "expected x y z of a rotation, found " + std::to_string(value.size()) + " numbers");
    double square = 0.0;
    for (std::size_t k = 0; k < rotation.size(); ++k) {
        rotation[k] = to_float(value[k], at(place, k));
        square += double{rotation[k]} * rotation[k];
    }
    if (square > 1.0 + 2.0 * kUnitTolerance) fail(place, "no unit quaternion has these x y z");
    return rotation;
}

RigChain parse_chain(const OrderedJson& value, const std::string& place, Notation notation) {
    Fields fields(value, place, notation);
    RigChain chain;
    chain.place = place;
    read_needed(fields, "name", chain.name);
    read_needed(fields, "start", chain.start);
    read_needed(fields, "effector", chain.effector);
    fields.read("target", chain.target);
    fields.read("pole", chain.pole);
    parse_chain_settings(fields, chain.record);
    read_weights(fields, notation, chain);
    if (const OrderedJson* extras = fields.find("extras"); extras != nullptr && !extras->is_null())
        chain.extras = extras->dump();
    fields.refuse_others();
    return chain;
}

namespace {

/// A joint, or null: none has the role; for a chain the list of its joints.
RigRole parse_role(std::string_view word, const OrderedJson& value, const std::string& place) {
    RigRole role;
    role.place = place;
    const auto& words = kValueNames<Role>;
    const auto* const found = std::find(words.begin() + 1, words.end(), word);
    if (found == words.end()) fail(place, "there is no role " + quote(word));
    role.role = static_cast<Role>(found - words.begin());
    const bool is_chain = role.role >= kFirstChainRole;
    const auto add = [&](const OrderedJson& joint, const std::string& where) {
        if (!joint.is_string()) fail(where, "expected the name of a joint, found " + shown(joint));
        role.joints.push_back(joint.get<std::string>());
    };
    if (!is_chain) {
        if (!value.is_null()) add(value, place);
        return role;
    }
    need_list(value, place);
    for (std::size_t i = 0; i < value.size(); ++i) add(value[i], at(place, i));
    return role;
}

RigStandingPose parse_standing_pose(const OrderedJson& value, const std::string& place) {
    Fields fields(value, place, Notation::rig_file);
    RigStandingPose standing;
    parse_standing_settings(fields, standing.pose);
    const std::string at_rotations = fields.place_of("rotations");
    const OrderedJson& rotations = fields.need("rotations");
    Fields entries(rotations, at_rotations, Notation::rig_file);  // an object, every key once
    for (const auto& [joint, rotation] : rotations.items())
        standing.rotations.emplace_back(joint, parse_standing_rotation(rotation, entries.place_of(joint)));
    fields.refuse_others();
    return standing;
}

constexpr std::uint64_t kVersion = 1;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

}  // namespace

Rig parse_rig(std::string_view text, Report& report) {
    const auto root = parse_json_text<OrderedJson>(text, report);
    Fields fields(root, {}, Notation::rig_file);
    Rig rig;
    if (const OrderedJson& version = fields.need("bendy_rig"); version != kVersion)
        fail("bendy_rig", "layout " + shown(version) + " is not supported, only 1");
    fields.read("complete", rig.complete);
    if (const OrderedJson* joints = fields.find("joints"); joints != nullptr) {
        Fields entries(*joints, "joints", Notation::rig_file);  // an object, every key once
        for (const auto& [name, value] : joints->items()) {
            const std::string place = entries.place_of(name);
            rig.joints.push_back(
                {parse_joint_key(name, place), place, parse_constraints(value, place, Notation::rig_file)});
        }
    }
    std::unordered_set<std::string> names;
    if (const OrderedJson* chains = fields.find("chains"); chains != nullptr) {
        need_list(*chains, "chains");
        for (std::size_t i = 0; i < chains->size(); ++i) {
            RigChain chain = parse_chain((*chains)[i], at("chains", i), Notation::rig_file);
            if (!names.insert(chain.name).second)
                fail(at("chains", i) + ".name", "there is an earlier chain " + quote(chain.name));
            rig.chains.push_back(std::move(chain));
        }
    }
    if (const OrderedJson* roles = fields.find("roles"); roles != nullptr) {
        Fields entries(*roles, "roles", Notation::rig_file);
        rig.roles.emplace();
        for (const auto& [word, value] : roles->items())
            rig.roles->push_back(parse_role(word, value, entries.place_of(word)));
    }
    if (const OrderedJson* standing = fields.find("standing_pose"); standing != nullptr) {
        rig.has_standing_pose = true;
        if (!standing->is_null()) rig.standing_pose = parse_standing_pose(*standing, "standing_pose");
    }
    if (const OrderedJson* clips = fields.find("markers"); clips != nullptr) {
        Fields entries(*clips, "markers", Notation::rig_file);
        rig.clips.emplace();
        for (const auto& [key, value] : clips->items()) {
            const std::string place = entries.place_of(key);
            rig.clips->push_back({key, place, parse_markers(value, place, WrongMarkers::fail, report)});
        }
    }
    if (const OrderedJson* curves = fields.find("curves"); curves != nullptr)
        rig.curves = parse_curves(*curves, "curves");
    std::string schema;
    fields.read("$schema", schema);  // for editors
    fields.refuse_others();
    return rig;
}

Rig read_rig(const std::filesystem::path& file, Report& report) {
    const auto bytes = read_file(file, {}, kMostBytes);
    if (std::string why = why_not_a_rig(bytes); !why.empty()) fail({}, std::move(why));
    Rig rig = parse_rig({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, report);
    rig.source = file.filename().string() + ": ";
    return rig;
}

std::optional<Rig> take_rig_from_extras(Scene& scene, Report& report) {
    if (scene.extras.find(kRigInExtras) == std::string::npos) return std::nullopt;
    const std::string place = "scene.extras." + std::string(kRigInExtras);
    try {
        auto extras = parse_json_text<Json>(scene.extras, report);
        if (!extras.is_object() || !extras.contains(kRigInExtras)) return std::nullopt;
        Rig rig = parse_rig(extras[kRigInExtras].dump(), report);
        rig.source = place + '.';
        extras.erase(kRigInExtras);
        scene.extras = extras.empty() ? std::string() : extras.dump();
        return rig;
    } catch (const Failure& failure) {
        report.warn("rig left out: " + failure.error.message,
                    failure.error.place.empty() ? place : place + '.' + failure.error.place);
        return std::nullopt;
    }
}

}  // namespace bendy::converter
