#include "extensions.h"
#include "parts.h"
#include "rigging/rig/attach_rig.h"
#include "scene/failure.h"

#include <bendy/format/constraint.h>

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

namespace bendy::converter::gltf {
namespace {

/// Extras are last: chains keep them.
constexpr std::array kFurther{"extensions", "extras"};

class RigReader {
public:
    RigReader(const Document& document, const Skeleton& skeleton, Scene& scene)
        : document_(document), skeleton_(skeleton), scene_(scene) {}

    void read() {
        for (std::uint32_t joint = 0; joint < scene_.joints.size(); ++joint) {
            if (skeleton_.instance_of_joint[joint] == kNone) read_node(joint);
        }
        const std::string place = "extensions." + std::string(kIkChains);
        const Json* extension = find_extension(document_.json, kIkChains);
        if (extension != nullptr) guard("chains left out", place, [&] { read_chains(*extension, place); });
        const std::string at_stand = "extensions." + std::string(kStandingPose);
        const Json* standing = find_extension(document_.json, kStandingPose);
        if (standing != nullptr) {
            guard("standing pose left out", at_stand,
                  [&] { scene_.standing_pose = read_standing_pose(*standing, at_stand); });
        }
    }

private:
    static const Json* find_extension(const Json& object, std::string_view name) {
        const Json* extensions = find(object, "extensions");
        return extensions == nullptr || !extensions->is_object() ? nullptr
                                                                 : find(*extensions, std::string(name).c_str());
    }

    /// Runs `work`. A failure becomes a warning.
    template <class Work>
    void guard(const char* left_out, const std::string& place, Work work) {
        try {
            work();
        } catch (const Failure& failure) {
            document_.report.warn(std::string(left_out) + ": " + failure.error.message,
                                  failure.error.place.empty() ? place : failure.error.place);
        }
    }

    /// Removes what every object of glTF may have and records have no place for.
    void remove_further(OrderedJson& object, const std::string& place, std::span<const char* const> names) {
        for (const char* name : names) {
            if (!object.is_object() || object.erase(name) == 0) continue;
            document_.report.warn("further data of limits, roles and chains left out", member(place, name));
        }
    }

    /// The list that is the extension's only member.
    OrderedJson read_list(const Json& extension, const char* name, const std::string& place) {
        auto own = parse_json_text<OrderedJson>(extension.dump(), document_.report);
        remove_further(own, place, kFurther);
        Fields fields(own, place, Notation::gltf);
        OrderedJson list = need_list(fields.need(name), fields.place_of(name));
        fields.refuse_others();
        return list;
    }

    void read_node(std::uint32_t joint) {
        const std::uint32_t node = skeleton_.node_of_joint[joint];
        const Json& source = document_.json["nodes"][node];
        const std::string before = at("nodes", node) + ".extensions.";
        if (const Json* limits = find_extension(source, kJointLimits); limits != nullptr) {
            const std::string place = before + std::string(kJointLimits);
            guard("limits left out", place,
                  [&] { scene_.joints[joint].constraints = read_limits(*limits, place, scene_.joints[joint].name); });
        }
        if (const Json* role = find_extension(source, kJointRole); role != nullptr) {
            const std::string place = before + std::string(kJointRole);
            guard("role left out", place, [&] { scene_.roles.push_back(read_role(*role, joint, place)); });
        }
    }

    RoleRecord read_role(const Json& extension, std::uint32_t joint, const std::string& place) {
        auto own = parse_json_text<OrderedJson>(extension.dump(), document_.report);
        remove_further(own, place, kFurther);
        Fields fields(own, place, Notation::gltf);
        fields.need("role");
        std::uint8_t role = 0;
        fields.read_word("role", std::span(kValueNames<Role>).subspan(1), role);
        ++role;
        std::uint64_t number = 0;
        const bool is_chain = role >= static_cast<std::uint8_t>(kFirstChainRole);
        if (is_chain) fields.need("place");
        fields.read_integer("place", is_chain ? 0xffff : 0, number);
        fields.refuse_others();
        const RoleRecord record{joint, role, static_cast<std::uint16_t>(number)};
        if (!roles_.emplace(record.role, record.place).second) fail(place, "an earlier node has the same role");
        return record;
    }

    StandingPose read_standing_pose(const Json& extension, const std::string& place) {
        auto own = parse_json_text<OrderedJson>(extension.dump(), document_.report);
        remove_further(own, place, kFurther);
        Fields fields(own, place, Notation::gltf);
        StandingPose standing;
        parse_standing_settings(fields, standing.pose);
        const std::string at_rotations = fields.place_of("rotations");
        const OrderedJson& list = need_list(fields.need("rotations"), at_rotations);
        for (std::size_t i = 0; i < list.size(); ++i) {
            Fields each(list[i], at(at_rotations, i), Notation::gltf);
            each.need("node");
            const std::uint32_t joint = read_joint(each, "node");
            standing.rotations.push_back(
                {joint, parse_standing_rotation(each.need("rotation"), each.place_of("rotation"))});
            each.refuse_others();
        }
        fields.refuse_others();
        sort_rotations(standing.rotations, at_rotations);
        return standing;
    }

    std::vector<ConstraintRecord> read_limits(const Json& extension, const std::string& place,
                                              const std::string& joint) {
        const std::string at_limits = place + ".limits";
        OrderedJson limits = read_list(extension, "limits", place);
        for (std::size_t i = 0; i < limits.size(); ++i) remove_further(limits[i], at(at_limits, i), kFurther);
        std::vector<ConstraintRecord> constraints = parse_constraints(limits, at_limits, Notation::gltf);
        for (ConstraintRecord& constraint : constraints) flag_rest_outside(constraint, joint, place, document_.report);
        return constraints;
    }

    void read_chains(const Json& extension, const std::string& place) {
        const std::string at_chains = place + ".chains";
        OrderedJson list = read_list(extension, "chains", place);
        index_.emplace(scene_);
        std::unordered_set<std::string> names;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string here = at(at_chains, i);
            guard("chain left out", here, [&] {
                Chain chain = read_chain(list[i], here);
                if (!chain.name.empty() && !names.insert(chain.name).second) {
                    document_.report.warn(
                        "there is an earlier chain " + quote(chain.name) + ": only that one is found by this name",
                        here + ".name");
                }
                scene_.chains.push_back(std::move(chain));
            });
        }
    }

    Chain read_chain(OrderedJson& json, const std::string& place) {
        remove_further(json, place, std::span(kFurther).first(1));
        Fields fields(json, place, Notation::gltf);
        Chain chain;
        fields.read("name", chain.name);
        fields.need("start");
        fields.need("effector");
        for (const auto& [key, joint] : {std::pair{"start", &chain.record.start},
                                         {"effector", &chain.record.effector},
                                         {"target", &chain.record.target},
                                         {"pole", &chain.record.pole}}) {
            if (fields.find(key) != nullptr) *joint = read_joint(fields, key);
        }
        const ChainRecord& record = chain.record;
        if (!index_->is_above(record.start, record.effector))
            fail(fields.place_of("start"), "it is neither the effector nor above it");
        parse_chain_settings(fields, chain.record);
        if (const OrderedJson* weights = fields.find("weights"); weights != nullptr) {
            const std::string at_weights = fields.place_of("weights");
            chain.weights = read_weights(need_list(*weights, at_weights), at_weights, record);
        }
        if (const OrderedJson* extras = fields.find("extras"); extras != nullptr && !extras->is_null())
            chain.extras = extras->dump();
        fields.refuse_others();
        return chain;
    }

    /// The joint of the node whose number a member is.
    std::uint32_t read_joint(Fields& fields, std::string_view key) const {
        std::uint64_t node = 0;
        const std::size_t count = skeleton_.joint_of_node.size();
        fields.read_integer(key, count - 1, node);
        const std::uint32_t joint = skeleton_.joint_of_node[static_cast<std::size_t>(node)];
        if (joint == kNone) fail(fields.place_of(key), "node " + std::to_string(node) + " is not in the scene");
        return joint;
    }

    std::vector<Chain::Weight> read_weights(const OrderedJson& list, const std::string& place,
                                            const ChainRecord& record) const {
        std::vector<Chain::Weight> weights;
        std::unordered_set<std::uint32_t> weighted;
        for (std::size_t i = 0; i < list.size(); ++i) {
            Fields fields(list[i], at(place, i), Notation::gltf);
            Chain::Weight& weight = weights.emplace_back();
            fields.need("node");
            fields.need("weight");
            weight.joint = read_joint(fields, "node");
            fields.read("weight", weight.weight, 0.0f, 1.0f);
            fields.refuse_others();
            if (!index_->is_above(record.start, weight.joint) || !index_->is_above(weight.joint, record.effector))
                fail(fields.place_of("node"), "the node is not of this chain");
            if (!weighted.insert(weight.joint).second) fail(fields.place_of("node"), "the node has an earlier weight");
        }
        return weights;
    }

    const Document& document_;
    const Skeleton& skeleton_;
    Scene& scene_;
    std::optional<JointIndex> index_;                          ///< for chains
    std::set<std::pair<std::uint16_t, std::uint16_t>> roles_;  ///< with their places
};

}  // namespace

void import_rig_extensions(const Document& document, const Skeleton& skeleton, Scene& scene) {
    RigReader(document, skeleton, scene).read();
}

}  // namespace bendy::converter::gltf
