#include "keep_members.h"

#include "failure.h"
#include "further_members.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::gltf {
namespace {

class MemberKeeper {
public:
    MemberKeeper(const Document& document, const Skeleton& skeleton, Scene& scene)
        : document_(document),
          root_(document.json),
          skeleton_(skeleton),
          scene_(scene),
          is_image_said_(scene.images.size()) {}

    void run() {
        scene_.source_more = text_of(further_members(root_, Element::root), {});
        for (std::size_t joint = 0; joint < scene_.joints.size(); ++joint) {
            if (skeleton_.instance_of_joint[joint] == kNone) keep_node(joint);
        }
        for (std::size_t i = 0; i < scene_.materials.size(); ++i)
            scene_.materials[i].more = text_of(further_members(root_["materials"][i], Element::material), "materials");
        for (std::size_t i = 0; i < scene_.textures.size(); ++i) keep_texture(i);
        for (std::size_t i = 0; i < scene_.cycles.size(); ++i)
            scene_.cycles[i].more = text_of(further_members(root_["animations"][i], Element::animation), "animations");
    }

private:
    std::string text_of(const Json& members, const std::string& place) const {
        if (members.empty()) return {};
        std::string text = members.dump();
        document_.budget.take(text.size(), 1, place);
        return text;
    }

    void keep_node(std::size_t joint) {
        const std::uint32_t number = skeleton_.node_of_joint[joint];
        const Json& node = root_["nodes"][number];
        Json more = further_members(node, Element::node);
        if (const Json* skin = find(node, "skin");
            skin != nullptr && skeleton_.is_drawn[joint] && node.contains("mesh")) {
            add(more, "skin", further_members(root_["skins"][skin->get<std::size_t>()], Element::skin));
        }
        if (const Json* camera = find(node, "camera"); camera != nullptr) {
            document_.report.warn("camera kept as JSON, not interpreted", at("nodes", number) + ".camera");
            more["camera"] = root_["cameras"][camera->get<std::size_t>()];
        }
        scene_.joints[joint].more = text_of(more, "nodes");
    }

    void keep_texture(std::size_t index) {
        const Json& texture = root_["textures"][index];
        Json more = further_members(texture, Element::texture);
        if (const Json* sampler = find(texture, "sampler"); sampler != nullptr)
            add(more, "sampler", further_members(root_["samplers"][sampler->get<std::size_t>()], Element::sampler));
        Json images = Json::array();
        bool any = false;
        for (const std::uint32_t image : scene_.textures[index].images) {
            Json members;
            if (!is_image_said_[image]) members = further_members(root_["images"][image], Element::image);
            is_image_said_[image] = true;
            any = any || !members.empty();
            images.push_back(members.empty() ? Json() : std::move(members));
        }
        if (any) more["source"] = std::move(images);
        scene_.textures[index].more = text_of(more, "textures");
    }

    static void add(Json& more, const char* member, Json members) {
        if (!members.empty()) more[member] = std::move(members);
    }

    const Document& document_;
    const Json& root_;
    const Skeleton& skeleton_;
    Scene& scene_;
    std::vector<bool> is_image_said_;
};

class Reporter {
public:
    Reporter(const Document& document, const Skeleton& skeleton) : document_(document), root_(document.json) {
        for (const auto* kind : {"meshes", "skins", "cameras", "samplers"})
            used_.emplace(kind, std::vector<bool>(array_of(root_, kind).size()));
        for (std::size_t joint = 0; joint < skeleton.node_of_joint.size(); ++joint) mark_node(skeleton, joint);
        for (const Json& texture : array_of(root_, "textures")) mark("samplers", texture, "sampler");
    }

    void run() {
        add_unused("meshes", "meshes that no node of the scene draws");
        add_unused("skins", "skins that no mesh of the scene uses");
        add_unused("cameras", "cameras that no node of the scene has");
        add_unused("samplers", "samplers that no texture uses");
        const Json& meshes = array_of(root_, "meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            if (used_["meshes"][i])
                lose_list(meshes[i], "primitives", Element::primitive, "primitives", at("meshes", i));
        }
        const Json& animations = array_of(root_, "animations");
        for (std::size_t i = 0; i < animations.size(); ++i) {
            lose_list(animations[i], "channels", Element::channel, "animation channels", at("animations", i));
            lose_list(animations[i], "samplers", Element::animation_sampler, "animation samplers", at("animations", i));
        }
        lose_list(root_, "accessors", Element::accessor, "accessors", {});
        lose_list(root_, "bufferViews", Element::buffer_view, "bufferViews", {});
        lose_list(root_, "buffers", Element::buffer, "buffers", {});
        losses_.report(document_.report);
    }

private:
    void mark_node(const Skeleton& skeleton, std::size_t joint) {
        const Json& node = root_["nodes"][skeleton.node_of_joint[joint]];
        mark("cameras", node, "camera");
        if (!skeleton.is_drawn[joint] || !node.contains("mesh")) return;
        mark("meshes", node, "mesh");
        mark("skins", node, "skin");
    }

    void mark(const char* kind, const Json& user, const char* member) {
        if (const Json* index = find(user, member); index != nullptr) used_[kind][index->get<std::size_t>()] = true;
    }

    void add_unused(const char* kind, const std::string& message) {
        const Json& all = array_of(root_, kind);
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (!used_[kind][i]) losses_.add(message, call(all[i], kind, i), at(kind, i));
        }
    }

    void lose_list(const Json& owner, const char* member, Element element, const char* nouns,
                   const std::string& place) {
        const Json& list = array_of(owner, member);
        for (std::size_t i = 0; i < list.size(); ++i)
            lose_members(list[i], element, nouns, place.empty() ? at(member, i) : place + '.' + at(member, i), losses_);
    }

    const Document& document_;
    const Json& root_;
    std::map<std::string, std::vector<bool>> used_;
    Losses losses_;
};

}  // namespace

void keep_members(const Document& document, const Skeleton& skeleton, Scene& scene) {
    MemberKeeper(document, skeleton, scene).run();
}

void report_left_out(const Document& document, const Skeleton& skeleton) {
    Reporter(document, skeleton).run();
}

}  // namespace bendy::converter::gltf
