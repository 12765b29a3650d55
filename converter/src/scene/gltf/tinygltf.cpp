// The only translation unit that compiles tinygltf's implementation.

// tinygltf's writer needs this and does not include it.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "tinygltf.h"

#include "scene/failure.h"

#include <limits>
#include <new>
#include <string>

namespace bendy::converter::gltf {
namespace {

// NOLINTNEXTLINE(misc-no-recursion): the nesting of parsed JSON is bounded
Json without_extensions(const Json& source) {
    if (source.is_array()) {
        Json copy = Json::array();
        for (const Json& element : source) copy.push_back(without_extensions(element));
        return copy;
    }
    if (!source.is_object()) return source;
    Json copy = Json::object();
    for (auto member = source.begin(); member != source.end(); ++member) {
        if (member.key() != "extensions" && member.key() != "extras") {
            copy.emplace(member.key(), without_extensions(member.value()));
        }
    }
    return copy;
}

void expect_same_size(std::size_t read, const Json& source, const std::string& place) {
    if (read != source.size()) {
        fail(place, "only " + std::to_string(read) + " of " + std::to_string(source.size()) + " could be read");
    }
}

}  // namespace

tinygltf::Model read_structure(const Json& root) {
    Json prepared = Json::object();
    prepared["asset"]["version"] = "2.0";  // Json's list constructor leaks if memory runs out
    for (const char* key : {"accessors", "animations", "materials", "meshes", "nodes", "samplers", "scene", "scenes",
                            "skins", "textures"}) {
        if (const Json* member = find(root, key); member != nullptr) prepared[key] = without_extensions(*member);
    }
    if (const auto meshes = prepared.find("meshes"); meshes != prepared.end()) {
        for (Json& mesh : *meshes) {
            for (Json& primitive : mesh["primitives"]) primitive.erase("indices");
        }
    }
    if (const auto animations = prepared.find("animations"); animations != prepared.end()) {
        for (Json& animation : *animations) {
            for (Json& channel : animation["channels"]) channel["target"].emplace("node", -1);
        }
    }
    const std::string text = prepared.dump();
    if (text.size() > std::numeric_limits<unsigned>::max()) fail({}, "the JSON is too large");

    tinygltf::Model model;
    std::string error;
    std::string warning;
    tinygltf::TinyGLTF loader;
    if (!loader.LoadASCIIFromString(&model, &error, &warning, text.c_str(), static_cast<unsigned>(text.size()), "",
                                    tinygltf::NO_REQUIRE)) {
        const std::string first_line = error.substr(0, error.find('\n'));
        if (first_line == std::bad_alloc().what()) throw std::bad_alloc();  // it catches every exception from parsing
        fail({}, "tinygltf: " + first_line);
    }
    expect_same_size(model.accessors.size(), array_of(root, "accessors"), "accessors");
    expect_same_size(model.materials.size(), array_of(root, "materials"), "materials");
    expect_same_size(model.nodes.size(), array_of(root, "nodes"), "nodes");
    expect_same_size(model.samplers.size(), array_of(root, "samplers"), "samplers");
    expect_same_size(model.scenes.size(), array_of(root, "scenes"), "scenes");
    expect_same_size(model.skins.size(), array_of(root, "skins"), "skins");
    expect_same_size(model.textures.size(), array_of(root, "textures"), "textures");
    expect_same_size(model.meshes.size(), array_of(root, "meshes"), "meshes");
    for (std::size_t i = 0; i < model.meshes.size(); ++i) {
        expect_same_size(model.meshes[i].primitives.size(), root["meshes"][i]["primitives"],
                         at("meshes", i) + ".primitives");
    }
    expect_same_size(model.animations.size(), array_of(root, "animations"), "animations");
    for (std::size_t i = 0; i < model.animations.size(); ++i) {
        const Json& animation = root["animations"][i];
        expect_same_size(model.animations[i].channels.size(), animation["channels"], at("animations", i) + ".channels");
        expect_same_size(model.animations[i].samplers.size(), animation["samplers"], at("animations", i) + ".samplers");
    }
    return model;
}

}  // namespace bendy::converter::gltf
