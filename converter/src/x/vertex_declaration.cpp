#include "vertex_declaration.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

namespace bendy::converter::x {
namespace {

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
    std::uint32_t first = 0;  ///< word of a vertex

    [[nodiscard]] bool has_floats() const { return type <= kFloat4; }
    [[nodiscard]] std::uint32_t floats() const { return type - kFloat1 + 1; }
};

std::vector<Element> read_elements(ObjectReader& in, std::uint32_t& stride) {
    std::vector<Element> elements(in.count(4, "elements of a vertex"));
    for (Element& element : elements) {
        element.type = in.integer();
        if (element.type >= kWords.size())
            in.refuse("there is no vertex element of type " + std::to_string(element.type));
        in.integer();  // method: of tessellators
        element.usage = in.integer();
        element.index = in.integer();
        element.first = stride;
        stride += kWords[element.type];
    }
    return elements;
}

float float_of(ObjectReader& in, std::uint32_t word) {
    const auto number = std::bit_cast<float>(word);
    if (!std::isfinite(number)) in.refuse("a number of a vertex is not finite");
    return number;
}

/// D3DCOLOR: alpha, red, green, blue from the highest byte.
glm::vec4 colour_of(std::uint32_t word) {
    const auto part = [&](unsigned shift) { return static_cast<float>(word >> shift & 255u) / 255.0f; };
    return {part(16), part(8), part(0), part(24)};
}

/// What becomes of an element.
enum class Use : std::uint8_t { none, normals, coords, colours };

Use use_of(const Element& element) {
    if (element.index != 0) return Use::none;
    if (element.usage == kNormal && element.has_floats() && element.floats() >= 3) return Use::normals;
    if (element.usage == kTexCoord && element.has_floats() && element.floats() >= 2) return Use::coords;
    const bool is_colour = element.type == kColour || element.type == kFloat4;
    return element.usage == kColourUsage && is_colour ? Use::colours : Use::none;
}

}  // namespace

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

}  // namespace bendy::converter::x
