#include "inspect/page_skeleton.h"

#include "inspect/page_number.h"
#include "terminal/text.h"

#include <bendy/runtime/transform.h>

#include <algorithm>
#include <vector>

namespace bendy::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostJoints = 20'000;
constexpr std::size_t kMostChains = 1'000;
constexpr std::size_t kMostLinks = 1'000;  // of one chain

glm::dmat4 rest_matrix(const RestRecord& rest) {
    JointTransform transform;
    transform.rotation = glm::quat(rest.rotation[3], rest.rotation[0], rest.rotation[1], rest.rotation[2]);
    transform.translation = {rest.translation[0], rest.translation[1], rest.translation[2]};
    transform.scale = {rest.scale[0], rest.scale[1], rest.scale[2]};
    return to_matrix(transform, {rest.shear[0], rest.shear[1], rest.shear[2]});
}

/// The constraints of the joints, one text for each.
std::vector<std::string> constraint_texts(const SkeletonView& skeleton, std::size_t joints) {
    std::vector<std::string> texts(joints);
    for (const ConstraintView& constraint : skeleton.constraints) {
        if (constraint.joint >= joints) continue;
        std::string& text = texts[constraint.joint];
        text += (text.empty() ? "" : " | ") + constraint_text(constraint.record);
    }
    return texts;
}

/// The joints from the effector up to the start; empty if that is not above it.
Json links_of(const SkeletonView& skeleton, const ChainRecord& chain) {
    Json links = Json::array();
    std::uint32_t joint = chain.effector;
    while (joint < skeleton.joints.size() && links.size() < kMostLinks) {
        links.push_back(joint);
        if (joint == chain.start) return links;
        joint = skeleton.joints[joint].parent;
    }
    return links.size() == kMostLinks ? links : Json::array();
}

}  // namespace

Json page_joints(const ObjectView& object) {
    const auto& joints = object.skeleton.joints;
    const std::size_t count = std::min(joints.size(), kMostJoints);
    const std::vector<std::string> constraints = constraint_texts(object.skeleton, count);
    std::vector<glm::dmat4> model_space(count);
    Json parents = Json::array();
    Json names = Json::array();
    Json chunks = Json::array();
    Json translations = Json::array();
    Json rotations = Json::array();
    Json scales = Json::array();
    Json places = Json::array();
    for (std::size_t number = 0; number < count; ++number) {
        const JointView& joint = joints[number];
        const bool is_root = joint.parent == kNone;
        const glm::dmat4 local = rest_matrix(joint.rest);
        model_space[number] = is_root ? local : model_space[joint.parent] * local;
        parents.push_back(is_root ? -1 : static_cast<std::int64_t>(joint.parent));
        names.push_back(brief(joint.name));
        chunks.push_back(joint.chunk);
        translations.push_back(page_numbers(joint.rest.translation));
        rotations.push_back(page_numbers(joint.rest.rotation));
        scales.push_back(page_numbers(joint.rest.scale));
        const glm::dvec4 place = model_space[number][3];
        places.push_back(page_numbers(
            std::array{static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z)}));
    }
    return {{"total", joints.size()},     {"parent", std::move(parents)}, {"name", std::move(names)},
            {"chunk", std::move(chunks)}, {"t", std::move(translations)}, {"r", std::move(rotations)},
            {"s", std::move(scales)},     {"place", std::move(places)},   {"constraints", constraints}};
}

Json page_chains(const ObjectView& object, const RigIndex& rigs) {
    Json list = Json::array();
    for (const ChainView& chain : object.chains) {
        if (list.size() == kMostChains) break;
        list.push_back({{"name", brief(chain.name)},
                        {"chunk", chain.chunk},
                        {"text", rigs.chain_text(chain.chunk)},
                        {"links", links_of(object.skeleton, chain.record)}});
    }
    return {{"total", object.chains.size()}, {"list", std::move(list)}};
}

}  // namespace bendy::cli
