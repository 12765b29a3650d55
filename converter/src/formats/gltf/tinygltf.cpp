// The only translation unit that compiles tinygltf's implementation.

// tinygltf's writer needs this and does not include it.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "tinygltf.h"

#include "scene/failure.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace bendy::converter::gltf {
namespace {

/// The same for tinygltf, without `extensions` and `extras`: it would copy them, and takes 152 bytes for each value.
// NOLINTNEXTLINE(misc-no-recursion): parsed JSON is at most 128 levels deep
nlohmann::json for_tinygltf(const Json& value) {
    switch (value.kind()) {
        case JsonKind::null:
            return nullptr;
        case JsonKind::boolean:
            return value.get<bool>();
        case JsonKind::negative:
            return value.get<std::int64_t>();
        case JsonKind::unsigned_integer:
            return value.get<std::uint64_t>();
        case JsonKind::number:
            return value.get<double>();
        case JsonKind::string:
            return value.text();
        case JsonKind::array:
            break;
        case JsonKind::object:
            nlohmann::json object = nlohmann::json::object();
            for (const auto& [name, member] : value.items()) {
                if (name != "extensions" && name != "extras") object[name] = for_tinygltf(member);
            }
            return object;
    }
    nlohmann::json array = nlohmann::json::array();
    for (const Json& element : value) array.push_back(for_tinygltf(element));
    return array;
}

/// Calls one of tinygltf's readers. In version 2.9 some of them have two more parameters: for warnings, and for how
/// strict to be.
template <class Read, class Element, class... Context>
bool call(Read read, Element& element, std::string& error, const nlohmann::json& json, Context... context) {
    if constexpr (std::is_invocable_v<Read, Element*, Context..., std::string*, const nlohmann::json&, bool>) {
        return read(&element, context..., &error, json, false);
    } else {
        std::string warning;
        return read(&element, context..., &error, &warning, json, false, {});
    }
}

/// Reads every element of an array of the root.
template <class Element, class Read, class... Context>
void read_all(std::vector<Element>& elements, const Json& root, const char* name, Read read, Context... context) {
    const Json& array = array_of(root, name);
    elements.resize(array.size());
    for (std::size_t i = 0; i < array.size(); ++i) {
        std::string error;
        if (!call(read, elements[i], error, for_tinygltf(array[i]), context...))
            fail(at(name, i), "tinygltf: " + error.substr(0, error.find('\n')));
    }
}

bool read_scene(tinygltf::Scene* scene, std::string* error, const nlohmann::json& json, bool /*keep_text*/) {
    tinygltf::ParseStringProperty(&scene->name, error, json, "name", false);
    tinygltf::ParseIntegerArrayProperty(&scene->nodes, error, json, "nodes", false);
    return true;
}

bool read_texture(tinygltf::Texture* texture, std::string* error, const nlohmann::json& json, bool keep_text) {
    return tinygltf::ParseTexture(texture, error, json, keep_text, {});
}

void expect_same_size(std::size_t read, const Json& source, const std::string& place) {
    if (read != source.size()) {
        fail(place, "only " + std::to_string(read) + " of " + std::to_string(source.size()) + " could be read");
    }
}

/// Adds the channels without a target node, which tinygltf 2.7 leaves out.
void complete_channels(std::vector<tinygltf::AnimationChannel>& channels, const Json& source,
                       const std::string& place) {
    if (channels.size() == source.size()) return;
    std::vector<tinygltf::AnimationChannel> all;
    all.reserve(source.size());
    auto next = channels.begin();
    for (const Json& channel : source) {
        const Json& target = channel["target"];
        if (!target.contains("node")) {
            all.emplace_back();
            all.back().sampler = channel["sampler"].get<int>();
            all.back().target_path = target["path"].get<std::string>();
        } else if (next != channels.end()) {
            all.push_back(std::move(*next++));
        }
    }
    channels = std::move(all);
    expect_same_size(channels.size(), source, place);
}

}  // namespace

tinygltf::Model read_structure(const Json& root) {
    tinygltf::Model model;
    read_all(model.accessors, root, "accessors", tinygltf::ParseAccessor);
    read_all(model.animations, root, "animations", tinygltf::ParseAnimation);
    read_all(model.materials, root, "materials", tinygltf::ParseMaterial);
    read_all(model.meshes, root, "meshes", tinygltf::ParseMesh, &model);
    read_all(model.nodes, root, "nodes", tinygltf::ParseNode);
    read_all(model.samplers, root, "samplers", tinygltf::ParseSampler);
    read_all(model.scenes, root, "scenes", read_scene);
    read_all(model.skins, root, "skins", tinygltf::ParseSkin);
    read_all(model.textures, root, "textures", read_texture);
    if (const Json* scene = find(root, "scene"); scene != nullptr) model.defaultScene = scene->get<int>();

    for (std::size_t i = 0; i < model.meshes.size(); ++i) {
        expect_same_size(model.meshes[i].primitives.size(), root["meshes"][i]["primitives"],
                         at("meshes", i) + ".primitives");
    }
    for (std::size_t i = 0; i < model.animations.size(); ++i) {
        complete_channels(model.animations[i].channels, root["animations"][i]["channels"],
                          at("animations", i) + ".channels");
    }
    return model;
}

}  // namespace bendy::converter::gltf
