#pragma once

#include <bendy/converter/import.h>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace bendy::converter::test {

using Json = nlohmann::json;
using Bytes = std::vector<std::byte>;

/// Little-endian bytes of numbers.
template <class T>
Bytes bytes_of(const std::vector<T>& values) {
    Bytes bytes(values.size() * sizeof(T));
    if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

inline Bytes bytes_of(std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

template <class T>
constexpr int component_type_of() {
    if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
    if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
    if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
    return 5126;
}

inline std::size_t components_of(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    return type == "MAT3" ? 9 : 16;
}

inline void append_u32(Bytes& bytes, std::uint32_t value) {
    for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(value >> shift & 0xffu));
}

inline void append_chunk(Bytes& bytes, std::string_view type, const Bytes& payload) {
    append_u32(bytes, static_cast<std::uint32_t>(payload.size()));
    const Bytes id = bytes_of(type);
    bytes.insert(bytes.end(), id.begin(), id.end());
    bytes.insert(bytes.end(), payload.begin(), payload.end());
}

/// A GLB of these chunks, with a right header.
inline Bytes make_glb(const std::vector<std::pair<std::string, Bytes>>& chunks) {
    Bytes glb = bytes_of("glTF");
    append_u32(glb, 2);
    append_u32(glb, 0);
    for (const auto& [type, payload] : chunks) append_chunk(glb, type, payload);
    const auto size = static_cast<std::uint32_t>(glb.size());
    std::memcpy(glb.data() + 8, &size, sizeof size);
    return glb;
}

/// A folder of the running test's own, empty at the start.
inline std::filesystem::path test_folder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    auto folder = std::filesystem::path(testing::TempDir()) /
                  (std::string("bendy_gltf_") + info->test_suite_name() + '_' + info->name());
    static std::string last;
    if (last != folder.string()) std::filesystem::remove_all(folder);
    last = folder.string();
    std::filesystem::create_directories(folder);
    return folder;
}

inline std::filesystem::path write_file(const std::filesystem::path& name, const Bytes& bytes) {
    const auto file = test_folder() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
}

struct Import {
    Result<Scene, ImportError> result;
    Report report;

    /// The scene; a failed import fails the test and gives an empty one.
    const Scene& operator*() const {
        static const Scene kEmpty;
        if (result) return *result;
        ADD_FAILURE() << result.error().place << ": " << result.error().message;
        return kEmpty;
    }
    const Scene* operator->() const { return &**this; }

    [[nodiscard]] std::string place() const { return result ? "no error" : result.error().place; }
    [[nodiscard]] std::string message() const { return result ? "no error" : result.error().message; }

    /// How often a warning with this text in it was given.
    [[nodiscard]] std::uint64_t warned(std::string_view text) const {
        std::uint64_t count = 0;
        for (const Warning& warning : report.warnings()) {
            if (warning.message.find(text) != std::string::npos) count += warning.count;
        }
        return count;
    }
};

inline Import import_file(const std::filesystem::path& file, const GltfOptions& options = {}) {
    Report report;
    auto result = import_gltf(file, options, report);
    return {std::move(result), std::move(report)};
}

inline Import import_bytes(const Bytes& bytes, const GltfOptions& options = {}) {
    return import_file(write_file("asset.bin", bytes), options);
}

inline Import import_text(std::string_view text, const GltfOptions& options = {}) {
    return import_bytes(bytes_of(text), options);
}

/// glTF under construction: `json` is the root, without buffers; add_view and add_accessor fill the one buffer.
class Gltf {
public:
    Json json = {{"asset", {{"version", "2.0"}}}};

    std::size_t add_view(const Bytes& bytes) {
        while (buffer_.size() % 4 != 0) buffer_.push_back(std::byte{0});
        json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}});
        buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
        return json["bufferViews"].size() - 1;
    }

    template <class T>
    std::size_t add_accessor(const std::vector<T>& values, const char* type, bool normalised = false) {
        const std::size_t view = add_view(bytes_of(values));
        Json accessor = {{"bufferView", view},
                         {"componentType", component_type_of<T>()},
                         {"count", values.size() / components_of(type)},
                         {"type", type}};
        if (normalised) accessor["normalized"] = true;
        json["accessors"].push_back(std::move(accessor));
        return json["accessors"].size() - 1;
    }

    std::size_t add_node(Json node) {
        json["nodes"].push_back(std::move(node));
        return json["nodes"].size() - 1;
    }

    /// A mesh of one primitive; `attributes` by name.
    std::size_t add_mesh(Json attributes, Json more = Json::object()) {
        more["attributes"] = std::move(attributes);
        json["meshes"].push_back({{"primitives", {std::move(more)}}});
        return json["meshes"].size() - 1;
    }

    /// Positions 0 0 0, 1 0 0, 2 0 0, ...
    std::size_t add_positions(std::size_t count) {
        std::vector<float> values(count * 3);
        for (std::size_t i = 0; i < count; ++i) values[i * 3] = static_cast<float>(i);
        return add_accessor(values, "VEC3");
    }

    /// An animation of one channel.
    void add_animation(std::size_t node, const char* path, std::size_t input, std::size_t output,
                       const char* interpolation = "LINEAR") {
        json["animations"].push_back(
            {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
    }

    [[nodiscard]] Json& primitive(std::size_t mesh = 0, std::size_t index = 0) {
        return json["meshes"][mesh]["primitives"][index];
    }

    [[nodiscard]] Bytes glb() const {
        Json root = json;
        if (!buffer_.empty()) root["buffers"] = {{{"byteLength", buffer_.size()}}};
        return make_glb({{"JSON", bytes_of(root.dump())}, {std::string("BIN\0", 4), buffer_}});
    }

    [[nodiscard]] const Bytes& buffer() const { return buffer_; }

    [[nodiscard]] Import import(const GltfOptions& options = {}) const { return import_bytes(glb(), options); }

private:
    Bytes buffer_;
};

/// One node with a triangle.
inline Gltf make_triangle() {
    Gltf gltf;
    gltf.add_mesh({{"POSITION", gltf.add_positions(3)}});
    gltf.add_node({{"mesh", 0}});
    return gltf;
}

/// A mesh of `vertices` vertices skinned to `joints` joints in a row: nodes 0.. are the joints, the last carries the
/// mesh. `sets` of JOINTS_n and WEIGHTS_n, four values per vertex each.
struct InfluenceSet {
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
};
inline Gltf make_skinned(std::size_t joints, const std::vector<InfluenceSet>& sets) {
    Gltf gltf;
    const std::size_t vertices = sets.at(0).joints.size() / 4;
    Json attributes = {{"POSITION", gltf.add_positions(vertices)}};
    for (std::size_t s = 0; s < sets.size(); ++s) {
        attributes["JOINTS_" + std::to_string(s)] = gltf.add_accessor(sets[s].joints, "VEC4");
        attributes["WEIGHTS_" + std::to_string(s)] = gltf.add_accessor(sets[s].weights, "VEC4");
    }
    gltf.add_mesh(std::move(attributes), {{"mode", 0}});
    Json skin_joints = Json::array();
    for (std::size_t j = 0; j < joints; ++j) {
        gltf.add_node(j + 1 < joints ? Json{{"children", {j + 1}}} : Json::object());
        skin_joints.push_back(j);
    }
    gltf.json["skins"] = {{{"joints", skin_joints}}};
    gltf.add_node({{"mesh", 0}, {"skin", 0}});
    return gltf;
}

}  // namespace bendy::converter::test
