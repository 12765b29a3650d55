#include "gltf_out/instancing.h"

#include "failure.h"
#include "gltf/extensions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::gltf_out {
namespace {

/// One attribute's numbers.
struct Numbers {
    std::uint32_t components = 0;
    std::vector<float> floats;
    std::vector<std::uint32_t> integers;  ///< one of the two is filled

    [[nodiscard]] std::size_t elements() const { return std::max(floats.size(), integers.size()) / components; }
};

std::uint32_t components_of(const Json& type) {
    constexpr std::array kTypes{"SCALAR", "VEC2", "VEC3", "VEC4"};
    const auto found = std::find(kTypes.begin(), kTypes.end(), type);
    return found == kTypes.end() ? 0 : static_cast<std::uint32_t>(found - kTypes.begin() + 1);
}

std::optional<Numbers> read_numbers(const Json& attribute) {
    if (!attribute.is_object() || !attribute.contains("type") || !attribute.contains("values")) return std::nullopt;
    Numbers numbers;
    numbers.components = components_of(attribute["type"]);
    const Json& values = attribute["values"];
    if (numbers.components == 0 || !values.is_array() || values.empty() || values.size() % numbers.components != 0)
        return std::nullopt;
    const bool are_integers = attribute.value("integers", Json()) == true;
    for (const Json& value : values) {
        if (are_integers) {
            if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
                return std::nullopt;
            numbers.integers.push_back(value.get<std::uint32_t>());
        } else {
            if (!value.is_number() || !(std::abs(value.get<double>()) <= double{std::numeric_limits<float>::max()}))
                return std::nullopt;
            numbers.floats.push_back(value.get<float>());
        }
    }
    return numbers;
}

/// Whether all attributes hold numbers, as many each.
bool export_attributes(Json& extension, Buffer& buffer) {
    if (!extension.is_object() || !extension.contains("attributes")) return false;
    Json& attributes = extension["attributes"];
    if (!attributes.is_object() || attributes.empty()) return false;
    std::vector<std::pair<std::string, Numbers>> all;
    for (auto attribute = attributes.begin(); attribute != attributes.end(); ++attribute) {
        std::optional<Numbers> numbers = read_numbers(*attribute);
        if (!numbers || (!all.empty() && all.front().second.elements() != numbers->elements())) return false;
        all.emplace_back(attribute.key(), *std::move(numbers));
    }
    for (const auto& [name, numbers] : all) {
        attributes[name] = numbers.integers.empty()
                               ? buffer.add_floats(numbers.floats, numbers.components, Buffer::Use::data, false)
                               : buffer.add_integers(numbers.integers, numbers.components, Buffer::Use::data);
    }
    return true;
}

}  // namespace

void export_instances(Json& nodes, Buffer& buffer, Report& report) {
    const std::string name(gltf::kInstancing);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto extensions = nodes[i].find("extensions");
        if (extensions == nodes[i].end()) continue;
        const auto extension = extensions->find(name);
        if (extension == extensions->end() || export_attributes(*extension, buffer)) continue;
        report.warn("extension left out, numbers in it are the source's: " + name, at("joints", i));
        extensions->erase(extension);
        if (extensions->empty()) nodes[i].erase("extensions");
    }
}

}  // namespace bendy::converter::gltf_out
