#include "conventions.h"
#include "object_reader.h"
#include "scene/source/source_file.h"

#include <bendy/format/charconv.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::x {
namespace {

/// The vertex streams of a DeclData; absent ones are empty.
struct DeclaredStreams {
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> coords;   ///< the first set
    std::vector<glm::vec4> colours;  ///< the first set, 0 to 1
};

// D3DDECLTYPE
constexpr std::uint32_t kFloat1 = 0;
constexpr std::uint32_t kFloat4 = 3;
constexpr std::uint32_t kColour = 4;
/// 32-bit words that each type takes, FLOAT1 to FLOAT16_4.
constexpr std::array<std::uint32_t, 17> kWords{1, 2, 3, 4, 1, 1, 1, 2, 1, 1, 2, 1, 2, 1, 1, 1, 2};

// D3DDECLUSAGE
constexpr std::uint32_t kNormal = 3;
constexpr std::uint32_t kTexCoord = 5;
constexpr std::uint32_t kColourUsage = 10;
constexpr std::array<const char*, 14> kUsageNames{"positions",
                                                  "blend weights",
                                                  "blend indices",
                                                  "normals",
                                                  "point sizes",
                                                  "texture coordinates",
                                                  "tangents",
                                                  "binormals",
                                                  "tessellate factors",
                                                  "transformed positions",
                                                  "colours",
                                                  "fog",
                                                  "depth",
                                                  "samples"};

struct Element {
    std::uint32_t type = 0;
    std::uint32_t usage = 0;
    std::uint32_t index = 0;
    std::uint32_t first = 0;  ///< word offset in a vertex

    [[nodiscard]] bool has_floats() const { return type <= kFloat4; }
    [[nodiscard]] std::uint32_t floats() const { return type - kFloat1 + 1; }
};

std::vector<Element> read_elements(ObjectReader& in, std::uint32_t& stride) {
    std::vector<Element> elements(in.count(4, "elements of a vertex"));
    for (Element& element : elements) {
        element.type = in.integer();
        if (element.type >= kWords.size()) in.refuse("unknown vertex element type " + std::to_string(element.type));
        in.integer();  // method: for tessellators only
        element.usage = in.integer();
        element.index = in.integer();
        element.first = stride;
        stride += kWords[element.type];
    }
    return elements;
}

float float_of(ObjectReader& in, std::uint32_t word) {
    const auto number = bit_cast<float>(word);
    if (!std::isfinite(number)) in.refuse("a number of a vertex is not finite");
    return number;
}

/// D3DCOLOR: alpha, red, green, blue, from the highest byte down.
glm::vec4 colour_of(std::uint32_t word) {
    const auto part = [&](unsigned shift) { return static_cast<float>(word >> shift & 255u) / 255.0f; };
    return {part(16), part(8), part(0), part(24)};
}

/// How an element is imported.
enum class Use : std::uint8_t { none, normals, coords, colours };

Use use_of(const Element& element) {
    if (element.index != 0) return Use::none;
    if (element.usage == kNormal && element.has_floats() && element.floats() >= 3) return Use::normals;
    if (element.usage == kTexCoord && element.has_floats() && element.floats() >= 2) return Use::coords;
    const bool is_colour = element.type == kColour || element.type == kFloat4;
    return element.usage == kColourUsage && is_colour ? Use::colours : Use::none;
}

/// Reads a DeclData after its type: a Direct3D 9 vertex declaration (D3DVERTEXELEMENT9: type, method, usage, index of
/// the usage) and the vertices' bytes as 32-bit numbers. Other usages, such as tangents and further texture
/// coordinates, are reported. Fails on types that Direct3D does not define and if the size does not match `vertices`.
DeclaredStreams read_vertex_declaration(ObjectReader& in, std::size_t vertices) {
    const std::string place = in.place();
    in.head();
    std::uint32_t stride = 0;
    const std::vector<Element> elements = read_elements(in, stride);
    const std::uint32_t count = in.count(1, "words of vertices");
    if (stride == 0 ? count != 0 : count % stride != 0 || count / stride != vertices) {
        in.refuse("expected " + std::to_string(stride) + " words for each of " + std::to_string(vertices) +
                  " vertices, found " + std::to_string(count));
    }
    std::vector<std::uint32_t> words(count);
    DeclaredStreams streams;
    for (std::uint32_t& word : words) word = in.integer();
    for (const Element& element : elements) {
        const Use use = use_of(element);
        const bool is_repeated = (use == Use::normals && !streams.normals.empty()) ||
                                 (use == Use::coords && !streams.coords.empty()) ||
                                 (use == Use::colours && !streams.colours.empty());
        if (use == Use::none || is_repeated) {
            const char* const usage = element.usage < kUsageNames.size() ? kUsageNames[element.usage] : "numbers";
            in.report().warn(std::string(usage) + " of a DeclData left out (usage " + std::to_string(element.usage) +
                                 ", set " + std::to_string(element.index) + ')',
                             place);
            continue;
        }
        for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
            const std::uint32_t* const at = words.data() + vertex * stride + element.first;
            const auto number = [&](std::size_t i) { return float_of(in, at[i]); };
            if (use == Use::normals) {
                streams.normals.emplace_back(number(0), number(1), number(2));
            } else if (use == Use::coords) {
                streams.coords.emplace_back(number(0), number(1));
            } else if (element.type == kColour) {
                streams.colours.push_back(colour_of(*at));
            } else {
                streams.colours.emplace_back(number(0), number(1), number(2), number(3));
            }
        }
    }
    in.end_of("DeclData");
    return streams;
}

void begin(ObjectReader& in, Named& object) {
    object.place = in.place();
    object.identifier = in.head();
    object.name = to_utf8(object.identifier, object.place, in.report());
}

class MeshReader {
public:
    MeshReader(ObjectReader& in, std::vector<Material>& materials) : in_(in), materials_(materials) {}

    Mesh read() {
        begin(in_, mesh_);
        mesh_.positions = in_.vectors<glm::vec3>(in_.count(3, "vertices"));
        read_faces();
        std::string_view type;
        while (in_.inner(type, "Mesh")) read_inner(type);
        return std::move(mesh_);
    }

private:
    void read_faces() {
        const std::uint32_t faces = in_.count(2, "faces");
        mesh_.face_sizes.reserve(faces);
        for (std::uint32_t face = 0; face < faces; ++face) {
            const std::uint32_t corners = in_.count(1, "corners of a face");
            if (corners == 0) in_.refuse("a face has no corners");
            mesh_.face_sizes.push_back(corners);
            for (std::uint32_t corner = 0; corner < corners; ++corner)
                mesh_.corners.push_back(in_.index(mesh_.positions.size(), "vertices"));
        }
    }

    void read_inner(std::string_view type) {
        if (type == "MeshNormals") {
            read_normals();
        } else if (type == "MeshTextureCoords") {
            read_coords();
        } else if (type == "MeshVertexColors") {
            read_colours();
        } else if (type == "MeshMaterialList") {
            read_materials();
        } else if (type == "DeclData") {
            read_declared();
        } else if (type == "SkinWeights") {
            read_skin();
        } else if (type == "BendyName") {
            mesh_.name = read_name(in_);
        } else if (type == "XSkinMeshHeader" || type == "VertexDuplicationIndices") {
            in_.skip(type);  // redundant
        } else {
            in_.skip_unknown(type);
        }
    }

    /// Reads a count that must equal the number of vertices or faces.
    std::uint32_t count_as(std::size_t expected, std::uint32_t numbers_each, const char* what) {
        const std::uint32_t count = in_.count(numbers_each, what);
        if (count != expected)
            in_.refuse("expected " + std::to_string(expected) + ' ' + what + ", found " + std::to_string(count));
        return count;
    }

    /// Reports an object that a mesh may have only once.
    bool is_second(bool is_there, const char* what) {
        if (is_there)
            in_.report().warn("second " + std::string(what) + " of a mesh left out, the first is kept", in_.place());
        return is_there;
    }

    void read_normals() {
        if (is_second(!mesh_.normals.empty(), "MeshNormals")) return in_.skip("MeshNormals");
        in_.head();
        mesh_.normals = in_.vectors<glm::vec3>(in_.count(3, "normals"));
        const std::uint32_t faces = count_as(mesh_.face_sizes.size(), 2, "faces of normals");
        mesh_.normal_corners.reserve(mesh_.corners.size());
        for (std::uint32_t face = 0; face < faces; ++face) {
            count_as(mesh_.face_sizes[face], 1, "normals of a face");
            for (std::uint32_t corner = 0; corner < mesh_.face_sizes[face]; ++corner)
                mesh_.normal_corners.push_back(in_.index(mesh_.normals.size(), "normals"));
        }
        in_.end_of("MeshNormals");
    }

    void read_coords() {
        if (is_second(!mesh_.coords.empty(), "MeshTextureCoords")) return in_.skip("MeshTextureCoords");
        in_.head();
        mesh_.coords = in_.vectors<glm::vec2>(count_as(mesh_.positions.size(), 2, "texture coordinates"));
        in_.end_of("MeshTextureCoords");
    }

    /// Reads vertex colours; each has a vertex number, and not every vertex has one.
    void read_colours() {
        if (is_second(!mesh_.colours.empty(), "MeshVertexColors")) return in_.skip("MeshVertexColors");
        in_.head();
        const std::uint32_t colours = in_.count(5, "colours");
        mesh_.colours.assign(mesh_.positions.size(), glm::vec4(1.0f));
        for (std::uint32_t i = 0; i < colours; ++i) {
            glm::vec4& colour = mesh_.colours[in_.index(mesh_.positions.size(), "vertices")];
            for (int component = 0; component < 4; ++component) colour[component] = in_.number();
        }
        in_.end_of("MeshVertexColors");
    }

    /// Reads a DeclData, which Direct3D 9 exporters write instead of the three above: the bytes of a vertex buffer.
    void read_declared() {
        DeclaredStreams streams = read_vertex_declaration(in_, mesh_.positions.size());
        if (!streams.normals.empty() && !is_second(!mesh_.normals.empty(), "normals")) {
            mesh_.normals = std::move(streams.normals);
            mesh_.normal_corners = mesh_.corners;
        }
        if (!streams.coords.empty() && !is_second(!mesh_.coords.empty(), "texture coordinates"))
            mesh_.coords = std::move(streams.coords);
        if (!streams.colours.empty() && !is_second(!mesh_.colours.empty(), "vertex colours"))
            mesh_.colours = std::move(streams.colours);
    }

    void read_materials() {
        if (is_second(!mesh_.face_slots.empty(), "MeshMaterialList")) return in_.skip("MeshMaterialList");
        const std::string list = in_.place();
        in_.head();
        const std::uint32_t slots = in_.count(1, "materials");
        const std::uint32_t faces = in_.count(1, "faces' materials");
        const std::size_t expected = mesh_.face_sizes.size();
        // Some writers give one number for all faces.
        if (faces != expected && faces != 1)
            in_.refuse("expected " + std::to_string(expected) + " faces' materials, found " + std::to_string(faces));
        std::vector<std::uint32_t> numbers;
        for (std::uint32_t face = 0; face < faces; ++face) numbers.push_back(in_.index(slots, "materials"));
        if (expected != 0) numbers.resize(expected, numbers.front());
        if (expected == 0) numbers.clear();
        std::string_view type;
        while (in_.inner(type, "MeshMaterialList")) read_slot(type);
        if (mesh_.slots.size() < slots) {
            in_.refuse("the list that begins at " + list + " has " + std::to_string(mesh_.slots.size()) +
                       " materials, but says " + std::to_string(slots));
        }
        mesh_.face_slots = std::move(numbers);
    }

    void read_slot(std::string_view type) {
        MaterialSlot slot;
        slot.place = in_.place();
        if (type == "{") {
            slot.identifier = in_.reference();
        } else if (type == "Material") {
            slot.material = static_cast<std::uint32_t>(materials_.size());
            materials_.push_back(read_material(in_));
            materials_.back().is_own = true;
        } else {
            return in_.skip_unknown(type);
        }
        mesh_.slots.push_back(std::move(slot));
    }

    void read_skin() {
        Skin skin;
        skin.place = in_.place();
        in_.head();
        skin.frame = in_.string();
        const std::uint32_t count = in_.count(2, "weights");
        skin.vertices.reserve(count);
        skin.weights.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i)
            skin.vertices.push_back(in_.index(mesh_.positions.size(), "vertices"));
        for (std::uint32_t i = 0; i < count; ++i) skin.weights.push_back(in_.number());
        for (double& number : skin.offset) number = in_.exact_number();
        in_.end_of("SkinWeights");
        mesh_.skins.push_back(std::move(skin));
    }

    ObjectReader& in_;
    std::vector<Material>& materials_;
    Mesh mesh_;
};

}  // namespace

Mesh read_mesh(ObjectReader& in, std::vector<Material>& materials) {
    return MeshReader(in, materials).read();
}

Material read_material(ObjectReader& in) {
    Material material;
    begin(in, material);
    for (int i = 0; i < 4; ++i) material.colour[i] = in.number();
    material.power = in.number();
    for (int i = 0; i < 3; ++i) material.specular[i] = in.number();
    for (int i = 0; i < 3; ++i) material.emissive[i] = in.number();
    std::string_view type;
    while (in.inner(type, "Material")) {
        if (type == "TextureFilename" || type == "TextureFileName") {
            in.head();
            std::string file(in.string());
            if (!material.texture.empty()) {
                in.report().warn("further texture of a material left out", in.place());
            } else {
                material.texture = std::move(file);
            }
            in.end_of("TextureFilename");
        } else if (type == "BendyName") {
            material.name = read_name(in);
        } else {
            in.skip_unknown(type);
        }
    }
    return material;
}

std::string read_name(ObjectReader& in) {
    in.head();
    std::string name = decode_text(in.string());
    in.end_of("BendyName");
    return name;
}

}  // namespace bendy::converter::x
