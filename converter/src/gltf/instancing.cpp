#include "instancing.h"

#include "accessor.h"
#include "extensions.h"
#include "failure.h"
#include "gltf_out/buffer.h"
#include "losses.h"
#include "source/transform.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace bendy::converter::gltf {
namespace {

/// A number in JSON text, with what reading it takes.
constexpr std::uint64_t kBytesPerNumber = 64;

/// The accessor of each attribute, all with as many elements.
std::vector<std::pair<std::string, std::size_t>> attributes_of(const Document& document, const Json& extension,
                                                               const std::string& place) {
    if (!extension.is_object()) fail(place, "it must be an object");
    const Json* attributes = find(extension, "attributes");
    if (attributes == nullptr || !attributes->is_object() || attributes->empty())
        fail(place + ".attributes", "an object with one attribute or more is expected");
    std::vector<std::pair<std::string, std::size_t>> list;
    for (auto member = attributes->begin(); member != attributes->end(); ++member) {
        const std::string here = place + ".attributes." + key(member.key());
        const auto& accessors = document.model.accessors;
        if (!member->is_number_unsigned() || member->get<std::uint64_t>() >= accessors.size())
            fail(here, "the number of an accessor is expected (there are " + std::to_string(accessors.size()) + ")");
        const auto index = member->get<std::size_t>();
        if (!list.empty() && accessors[index].count != accessors[list.front().second].count) {
            fail(here, at("accessors", index) + " has " + std::to_string(accessors[index].count) +
                           " elements, that of " + list.front().first + " has " +
                           std::to_string(accessors[list.front().second].count));
        }
        list.emplace_back(member.key(), index);
    }
    return list;
}

const Json* find_instancing(const Document& document, std::size_t node) {
    const Json* extensions = find(document.json["nodes"][node], "extensions");
    return extensions == nullptr || !extensions->is_object() ? nullptr
                                                             : find(*extensions, std::string(kInstancing).c_str());
}

class Reader {
public:
    Reader(const Document& document, std::size_t node)
        : document_(document), place_(at("nodes", node) + ".extensions." + std::string(kInstancing)) {}

    std::vector<Transform> read(const Json& extension) {
        for (const auto& [name, accessor] : attributes_of(document_, extension, place_)) {
            const std::string here = place_ + ".attributes." + key(name);
            if (instances_.empty()) {
                const auto count = static_cast<std::uint64_t>(document_.model.accessors[accessor].count);
                document_.budget.take(count, sizeof(Joint) + sizeof(Transform), here);
                instances_.resize(count);
            }
            if (name == "TRANSLATION") {
                const std::vector<float> values = read_vectors(accessor, 3, here);
                for (std::size_t i = 0; i < instances_.size(); ++i)
                    instances_[i].translation = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
            } else if (name == "SCALE") {
                const std::vector<float> values = read_vectors(accessor, 3, here);
                for (std::size_t i = 0; i < instances_.size(); ++i)
                    instances_[i].scale = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
            } else if (name == "ROTATION") {
                read_rotations(read_vectors(accessor, 4, here), here);
            } else {
                losses_.add("attributes of instances", quote(name), here);
            }
        }
        losses_.report(document_.report);
        return std::move(instances_);
    }

private:
    std::vector<float> read_vectors(std::size_t accessor, std::size_t components, const std::string& place) const {
        if (component_count(document_.model.accessors[accessor]) != components)
            fail(place, at("accessors", accessor) + " must hold VEC" + std::to_string(components));
        return read_floats(document_, accessor, place);
    }

    void read_rotations(const std::vector<float>& values, const std::string& place) {
        std::uint64_t far_off = 0;
        for (std::size_t i = 0; i < instances_.size(); ++i) {
            const UnitQuaternion unit =
                make_unit({values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]});
            if (unit.length == 0.0) fail(place, "the rotation of instance " + std::to_string(i) + " is (0, 0, 0, 0)");
            constexpr double kByteRounding = 2e-2;  // of normalised bytes, the coarsest that the extension allows
            if (std::abs(unit.length - 1.0) > kByteRounding) ++far_off;
            instances_[i].rotation = unit.value;
        }
        if (far_off > 0)
            document_.report.warn("rotation of an instance is no unit quaternion, normalised", place, far_off);
    }

    const Document& document_;
    std::string place_;
    std::vector<Transform> instances_;
    Losses losses_;
};

}  // namespace

std::vector<Transform> read_instances(const Document& document, std::size_t node) {
    const Json* extension = find_instancing(document, node);
    const Json& source = document.json["nodes"][node];
    if (extension == nullptr || !source.contains("mesh")) return {};
    if (source.contains("skin")) {
        document.report.warn("instances of a mesh with a skin are not made: the extension does not say where they are",
                             at("nodes", node));
        return {};
    }
    return Reader(document, node).read(*extension);
}

void inline_instances(const Document& document, Json& extension, const std::string& place) {
    for (const auto& [name, index] : attributes_of(document, extension, place)) {
        const std::string here = place + ".attributes." + key(name);
        const tinygltf::Accessor& accessor = document.model.accessors[index];
        document.budget.take(std::uint64_t{accessor.count} * component_count(accessor), kBytesPerNumber, here);
        Json numbers{{"type", document.json["accessors"][index]["type"]}};
        const bool is_whole =
            !accessor.normalized && (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                     accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                                     accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
        if (is_whole) {
            numbers["integers"] = true;
            numbers["values"] = read_unsigned(document, index, here);
        } else {
            numbers["values"] = gltf_out::numbers(read_floats(document, index, here));
        }
        extension["attributes"][name] = std::move(numbers);
    }
}

}  // namespace bendy::converter::gltf
