#include "formats/gltf/extensions.h"
#include "formats/gltf_out/parts.h"
#include "rigging/rig/record_lines.h"
#include "scene/failure.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::gltf_out {
namespace {

Json limits_of(const Joint& joint, Report& report) {
    Json limits = Json::array();
    for (const ConstraintRecord& constraint : joint.constraints)
        limits.push_back(parse_json_text<Json>(write_constraint(constraint, Notation::gltf), report));
    return limits;
}

/// A joint's number is its node's.
Json write_chain(const Chain& chain, const std::string& place, Report& report) {
    const ChainRecord& record = chain.record;
    RecordLine line(Notation::gltf);
    add_chain_settings(line, record);
    auto written = parse_json_text<Json>(line.text(), report);
    if (!chain.name.empty()) written["name"] = chain.name;
    written["start"] = record.start;
    written["effector"] = record.effector;
    if (record.target != kNone) written["target"] = record.target;
    if (record.pole != kNone) written["pole"] = record.pole;
    for (const Chain::Weight& weight : chain.weights)
        written["weights"].push_back({{"node", weight.joint}, {"weight", json_number(weight.weight)}});
    add_extras(written, chain.extras, place, report);
    return written;
}

}  // namespace

void export_rig(const Scene& scene, Json& root, Report& report) {
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        if (scene.joints[i].constraints.empty()) continue;
        root["nodes"][i]["extensions"][std::string(gltf::kJointLimits)]["limits"] = limits_of(scene.joints[i], report);
    }
    for (const RoleRecord& record : scene.roles) {
        Json& role = root["nodes"][record.joint]["extensions"][std::string(gltf::kJointRole)];
        role["role"] = spelled(kValueNames<Role>[record.role], Notation::gltf);
        if (record.role >= static_cast<std::uint16_t>(kFirstChainRole)) role["place"] = record.place;
    }
    if (scene.standing_pose) {
        RecordLine line(Notation::gltf);
        add_standing_settings(line, scene.standing_pose->pose);
        auto standing = parse_json_text<Json>(line.text(), report);
        standing["rotations"] = Json::array();
        for (const StandingRotationRecord& record : scene.standing_pose->rotations) {
            Json rotation = Json::array();
            for (const float number : record.rotation) rotation.push_back(json_number(number));
            standing["rotations"].push_back({{"node", record.joint}, {"rotation", std::move(rotation)}});
        }
        root["extensions"][std::string(gltf::kStandingPose)] = std::move(standing);
    }
    for (std::size_t i = 0; i < scene.chains.size(); ++i) {
        root["extensions"][std::string(gltf::kIkChains)]["chains"].push_back(
            write_chain(scene.chains[i], at("chains", i), report));
    }
}

}  // namespace bendy::converter::gltf_out
