// Nothing is lost without a word: extras, a member that glTF does not define and a name, in every place of a file that
// can have one, come back in the export at the same place, or are named in a warning.

#include "build_gltf.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/convert.h>
#include <bendy/converter/export.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <string>

namespace bendy::converter::every_place_test {
namespace {

using namespace test;

/// A place in a file, as a JSON pointer and as messages have it.
struct Place {
    std::string pointer;
    std::string path;
};

struct Mark {
    std::string pointer;  ///< of the member
    std::string said;     ///< how a warning names it
    Json value;
};

std::string kind_of(const std::string& path) {
    return std::regex_replace(path, std::regex(R"(\[[0-9]+\])"), "[]");
}

/// Objects that are maps of others: glTF gives them no members of their own.
bool is_map(const std::string& kind) {
    return kind.ends_with("extensions") || kind.ends_with(".attributes") || kind.ends_with(".targets[]");
}

/// Visits every object of the file, those in extras apart.
template <class Visit>
void visit_objects(Json& root, const Visit& visit) {
    struct Open {
        Json* json;
        Place place;
    };
    std::vector<Open> pending{{&root, {}}};
    while (!pending.empty()) {
        const Open open = pending.back();
        pending.pop_back();
        if (open.json->is_object() && !is_map(kind_of(open.place.path))) visit(*open.json, open.place);
        if (!open.json->is_structured()) continue;
        std::size_t index = 0;
        for (const auto& member : open.json->items()) {
            if (open.json->is_object() && member.key() == "extras") continue;
            const std::string& path = open.place.path;
            const std::string place = open.json->is_array() ? path + '[' + std::to_string(index++) + ']'
                                      : path.empty()        ? member.key()
                                                            : path + '.' + member.key();
            pending.push_back({&member.value(), {open.place.pointer + '/' + member.key(), place}});
        }
    }
}

/// Children of the root's arrays have names by the specification.
bool has_name(const std::string& kind) {
    return kind.ends_with("[]") && kind.find('.') == std::string::npos;
}

/// A file with an object of every type that glTF 2.0 has.
Json make_everything(Bytes& buffer) {
    Gltf gltf;
    const auto positions = gltf.add_positions(3);
    const auto sparse_indices = gltf.add_view(bytes_of(std::vector<std::uint16_t>{1}));
    const auto sparse_values = gltf.add_view(bytes_of(std::vector<float>{1.0f, 2.0f, 3.0f}));
    gltf.json["accessors"][positions]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", sparse_indices}, {"componentType", 5123}}},
        {"values", {{"bufferView", sparse_values}}}};
    const auto displacements = gltf.add_positions(3);
    const auto coords = gltf.add_accessor(std::vector<float>(6), "VEC2");
    const auto joints = gltf.add_accessor(std::vector<std::uint8_t>(12), "VEC4");
    const auto weights = gltf.add_accessor(
        std::vector<float>{1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f}, "VEC4");
    const auto times = gltf.add_accessor(std::vector<float>{0.0f, 1.0f}, "SCALAR");
    const auto moves = gltf.add_accessor(std::vector<float>{0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f}, "VEC3");
    const auto places = gltf.add_accessor(std::vector<float>{0.0f, 0.0f, 0.0f, 2.0f, 0.0f, 0.0f}, "VEC3");
    gltf.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", coords}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}},
                  {{"material", 0}, {"targets", {{{"POSITION", displacements}}}}});
    gltf.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", coords}}, {{"material", 0}});
    gltf.add_node({{"mesh", 0}, {"skin", 0}, {"children", {1, 2}}});
    gltf.add_node({{"camera", 0}});
    gltf.add_node({{"camera", 1},
                   {"mesh", 1},
                   {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
    gltf.json["skins"] = {{{"joints", {1, 2}}}};
    gltf.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1.0}, {"ymag", 1.0}, {"zfar", 2.0}, {"znear", 0.1}}}}};
    gltf.json["scenes"] = {{{"nodes", {0}}}};
    gltf.json["scene"] = 0;
    gltf.add_animation(1, "translation", times, moves);
    const auto ktx = gltf.add_view(bytes_of(std::string_view("\xabKTX 20\xbb\r\n\x1a\n....", 16)));
    const auto png = gltf.add_view(bytes_of(std::string_view("\x89PNG\r\n\x1a\n....", 12)));
    gltf.json["images"] = {{{"bufferView", ktx}, {"mimeType", "image/ktx2"}},
                           {{"bufferView", png}, {"mimeType", "image/png"}}};
    gltf.json["samplers"] = {{{"magFilter", 9729}, {"wrapS", 33071}}};
    gltf.json["textures"] = {
        {{"source", 1}, {"sampler", 0}, {"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
    const auto use = [](Json more) {
        more["index"] = 0;
        more["extensions"] = {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}}}, {"ACME_use", Json::object()}};
        return more;
    };
    gltf.json["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", use(Json::object())}, {"metallicRoughnessTexture", use(Json::object())}}},
         {"normalTexture", use({{"scale", 0.5}})},
         {"occlusionTexture", use({{"strength", 0.5}})},
         {"emissiveTexture", use(Json::object())},
         {"extensions", {{"KHR_materials_unlit", Json::object()}, {"KHR_materials_ior", {{"ior", 1.4}}}}}}};
    gltf.json["extensions"] = {{"ACME_file", {{"inner", Json::object()}}}};
    buffer = gltf.buffer();
    gltf.json["buffers"] = {{{"byteLength", buffer.size()}}};
    return gltf.json;
}

/// The objects of glTF 2.0 (Khronos' JSON schemas), and what of extensions the importer reads.
const std::set<std::string> kKinds{"",
                                   "accessors[]",
                                   "accessors[].sparse",
                                   "accessors[].sparse.indices",
                                   "accessors[].sparse.values",
                                   "animations[]",
                                   "animations[].channels[]",
                                   "animations[].channels[].target",
                                   "animations[].samplers[]",
                                   "asset",
                                   "bufferViews[]",
                                   "buffers[]",
                                   "cameras[]",
                                   "cameras[].orthographic",
                                   "cameras[].perspective",
                                   "extensions.ACME_file",
                                   "extensions.ACME_file.inner",
                                   "images[]",
                                   "materials[]",
                                   "materials[].emissiveTexture",
                                   "materials[].extensions.KHR_materials_ior",
                                   "materials[].extensions.KHR_materials_unlit",
                                   "materials[].normalTexture",
                                   "materials[].normalTexture.extensions.ACME_use",
                                   "materials[].normalTexture.extensions.KHR_texture_transform",
                                   "materials[].occlusionTexture",
                                   "materials[].pbrMetallicRoughness",
                                   "materials[].pbrMetallicRoughness.baseColorTexture",
                                   "materials[].pbrMetallicRoughness.metallicRoughnessTexture",
                                   "meshes[]",
                                   "meshes[].primitives[]",
                                   "nodes[]",
                                   "nodes[].extensions.EXT_mesh_gpu_instancing",
                                   "samplers[]",
                                   "scenes[]",
                                   "skins[]",
                                   "textures[]",
                                   "textures[].extensions.KHR_texture_basisu"};

/// Puts extras and an unknown member into every object, and a name where the specification has one.
std::vector<Mark> mark_everything(Json& root) {
    std::vector<Mark> marks;
    std::set<std::string> kinds;
    visit_objects(root, [&](const Json&, const Place& place) {
        kinds.insert(kind_of(place.path));
        const std::string prefix = place.path.empty() ? "" : place.path + '.';
        marks.push_back({place.pointer + "/extras", prefix + "extras", {{"extras of", place.path}}});
        marks.push_back({place.pointer + "/unheardOf", prefix + "unheardOf", "unknown in " + place.path});
        if (has_name(kind_of(place.path)))
            marks.push_back({place.pointer + "/name", "'name of " + place.path + '\'', "name of " + place.path});
    });
    for (const Mark& mark : marks) root[Json::json_pointer(mark.pointer)] = mark.value;
    for (const std::string& kind : kKinds) EXPECT_TRUE(kinds.contains(kind)) << "the file has no " << kind;
    return marks;
}

struct Trip {
    Bytes bendy;
    Json exported;
    std::string said;  ///< all warnings
};

Trip travel(const std::filesystem::path& file, const ConvertOptions& options) {
    Report report;
    Trip trip;
    const auto bytes = convert(file, options, report);
    if (!bytes) {
        ADD_FAILURE() << bytes.error().place << ": " << bytes.error().message;
        return trip;
    }
    trip.bendy = *bytes;
    const auto asset = export_gltf(*bytes, {}, report);
    if (!asset) {
        ADD_FAILURE() << asset.error().message;
        return trip;
    }
    trip.exported = Json::parse(asset->json);
    for (const Warning& warning : report.warnings()) trip.said += warning.first_place + ": " + warning.message + '\n';
    const auto glb = converter::make_glb(*asset);
    write_file("exported.glb", *glb);
    return trip;
}

std::filesystem::path write_marked(std::vector<Mark>& marks) {
    Bytes buffer;
    Json root = make_everything(buffer);
    marks = mark_everything(root);
    return write_file("marked.glb",
                      test::make_glb({{"JSON", bytes_of(root.dump())}, {std::string("BIN\0", 4), buffer}}));
}

void expect_all(const std::vector<Mark>& marks, const Trip& trip) {
    std::size_t kept = 0;
    for (const Mark& mark : marks) {
        const Json::json_pointer pointer(mark.pointer);
        const bool is_kept = trip.exported.contains(pointer) && trip.exported[pointer] == mark.value;
        const bool is_said = trip.said.find(mark.said) != std::string::npos;
        EXPECT_TRUE(is_kept || is_said) << mark.pointer << " is lost without a word";
        kept += is_kept ? 1 : 0;
    }
    EXPECT_GT(kept, marks.size() / 3);  // the test itself looks in the right places
}

TEST(GltfEveryPlace, IsKeptOrNamed) {
    std::vector<Mark> marks;
    const auto file = write_marked(marks);
    const Trip trip = travel(file, {});
    expect_all(marks, trip);
    // And what is kept is kept for good.
    const Trip again = travel(test_folder() / "exported.glb", {});
    EXPECT_EQ(again.bendy, trip.bendy);
    EXPECT_EQ(again.exported, trip.exported);
}

TEST(GltfEveryPlace, IsKeptOrNamedInACompactFile) {
    std::vector<Mark> marks;
    const auto file = write_marked(marks);
    ConvertOptions options;
    options.compact = ErrorBound();
    expect_all(marks, travel(file, options));
}

/// The places of which the issue says so: a warning is not enough.
TEST(GltfEveryPlace, WhatChunksCanHoldIsKept) {
    std::vector<Mark> marks;
    const Trip trip = travel(write_marked(marks), {});
    const std::set<std::string> named{"accessors",
                                      "bufferViews",
                                      "buffers",
                                      "animations[].channels[]",
                                      "animations[].samplers[]",
                                      "meshes[].primitives[]"};
    for (const Mark& mark : marks) {
        const std::string kind = kind_of(std::regex_replace(mark.pointer.substr(1), std::regex("/([0-9]+)"), "[$1]"));
        const bool may_be_lost = std::any_of(named.begin(), named.end(), [&](const std::string& start) {
            return std::regex_replace(kind, std::regex("/"), ".").starts_with(start);
        });
        if (may_be_lost) continue;
        const Json::json_pointer pointer(mark.pointer);
        EXPECT_TRUE(trip.exported.contains(pointer) && trip.exported[pointer] == mark.value) << mark.pointer;
    }
}

TEST(GltfEveryPlace, AFileWithNothingOfTheKindHasNoMoreChunk) {
    Bytes buffer;
    Json root = make_everything(buffer);
    root.erase("cameras");
    for (Json& node : root["nodes"]) node.erase("camera");
    root["materials"][0].erase("normalTexture");
    for (Json& material : root["materials"]) {
        for (const char* use : {"occlusionTexture", "emissiveTexture"}) material[use]["extensions"].erase("ACME_use");
        for (const char* use : {"baseColorTexture", "metallicRoughnessTexture"})
            material["pbrMetallicRoughness"][use]["extensions"].erase("ACME_use");
    }
    const auto file =
        write_file("plain.glb", test::make_glb({{"JSON", bytes_of(root.dump())}, {std::string("BIN\0", 4), buffer}}));
    const Trip trip = travel(file, {});
    const std::string text(reinterpret_cast<const char*>(trip.bendy.data()), trip.bendy.size());
    EXPECT_EQ(text.find("MORE"), std::string::npos);
}

/// What is said of a texture that an edit has taken out is left out, and the export stays good glTF.
TEST(GltfEveryPlace, OfWhatIsGoneNothingIsMade) {
    Scene scene;
    scene.joints.emplace_back();
    scene.joints[0].more = R"({"camera": 3, "skin": 4, "mesh": 5, "children": [7], "name": "not mine", "kept": 1})";
    Material material;
    material.more = R"({"normalTexture": {"extras": 1}, "pbrMetallicRoughness": {"baseColorTexture": {"extras": 2}},
                        "extensions": {"KHR_materials_unlit": {"extras": 3}}, "alphaMode": "BLEND", "kept": 2})";
    scene.materials.push_back(material);
    Texture texture;
    texture.more = R"({"source": [{"name": "nowhere"}], "sampler": 5, "name": 7,
                       "extensions": {"KHR_texture_basisu": {"extras": 4}}})";
    scene.textures.push_back(texture);
    scene.more = "[1, 2]";
    scene.source_more = "{no JSON";
    Report report;
    const Bytes bytes = build_chunks(scene, "test", report);
    const auto asset = export_gltf(bytes, {}, report);
    ASSERT_TRUE(asset) << asset.error().message;
    const Json exported = Json::parse(asset->json);
    EXPECT_EQ(exported["nodes"].dump(), R"([{"kept":1}])");
    EXPECT_EQ(exported["materials"].dump(), R"([{"kept":2}])");
    EXPECT_EQ(exported["textures"].dump(), "[{}]");
    EXPECT_FALSE(exported.contains("cameras"));
    std::string said;
    for (const Warning& warning : report.warnings()) said += warning.message + '\n';
    EXPECT_NE(said.find("not used any more"), std::string::npos);
    EXPECT_NE(said.find("further members left out: not a JSON object"), std::string::npos);
    EXPECT_NE(said.find("further members left out: invalid JSON"), std::string::npos);
}

}  // namespace
}  // namespace bendy::converter::every_place_test
