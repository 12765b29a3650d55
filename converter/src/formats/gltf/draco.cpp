#include "draco.h"

#include "accessor.h"
#include "bounded_draco.h"
#include "scene/failure.h"

#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/attributes/point_attribute.h>
#include <draco/compression/config/compression_shared.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>

namespace bendy::converter::gltf {
namespace {

/// Reads the integers of one value; false if the buffer is too short.
bool read_integers(const draco::PointAttribute& source, draco::AttributeValueIndex index, std::int32_t* integers) {
    const std::size_t size = source.num_components() * sizeof(std::int32_t);
    const auto at = static_cast<std::size_t>(source.GetBytePos(index));
    if (at > source.buffer()->data_size() || source.buffer()->data_size() - at < size) return false;
    std::memcpy(integers, source.buffer()->data() + at, size);
    return true;
}

/// An empty attribute with the source's mapping from points to values.
std::unique_ptr<draco::PointAttribute> make_like(const draco::PointAttribute& source, std::uint8_t components) {
    auto target = std::make_unique<draco::PointAttribute>();
    target->Init(source.attribute_type(), static_cast<std::int8_t>(components), draco::DT_FLOAT32, false,
                 source.size());
    if (source.is_mapping_identity()) {
        target->SetIdentityMapping();
        return target;
    }
    target->SetExplicitMapping(source.indices_map_size());
    for (std::uint32_t i = 0; i < source.indices_map_size(); ++i)
        target->SetPointMapEntry(draco::PointIndex(i), source.mapped_index(draco::PointIndex(i)));
    return target;
}

/// Bit-stream specification, "quantized attributes": an integer is a fraction of the range above the minimum.
std::unique_ptr<draco::PointAttribute> from_range(const draco::PointAttribute& source) {
    draco::AttributeQuantizationTransform transform;
    if (!transform.InitFromAttribute(source)) return nullptr;
    constexpr int kMostBits = 30;
    if (transform.quantization_bits() < 1 || transform.quantization_bits() > kMostBits) return nullptr;
    const auto largest = static_cast<float>((std::int32_t{1} << transform.quantization_bits()) - 1);
    const float step = transform.range() / largest;
    auto target = make_like(source, source.num_components());
    std::vector<std::int32_t> integers(source.num_components());
    std::vector<float> floats(source.num_components());
    for (std::uint32_t i = 0; i < source.size(); ++i) {
        if (!read_integers(source, draco::AttributeValueIndex(i), integers.data())) return nullptr;
        for (std::size_t c = 0; c < floats.size(); ++c)
            floats[c] = static_cast<float>(integers[c]) * step + transform.min_values()[c];
        target->SetAttributeValue(draco::AttributeValueIndex(i), floats.data());
    }
    return target;
}

/// The direction for a point of the unfolded octahedron; both coordinates from -1 to 1.
std::array<float, 3> direction_of(float s, float t) {
    const float x = 1.0f - std::abs(s) - std::abs(t);
    const float behind = x < 0.0f ? -x : 0.0f;
    const float y = s + (s < 0.0f ? behind : -behind);
    const float z = t + (t < 0.0f ? behind : -behind);
    const float square = x * x + y * y + z * z;
    constexpr double kNoDirection = 1e-6;
    if (square < kNoDirection) return {};
    const float scale = 1.0f / std::sqrt(square);
    return {x * scale, y * scale, z * scale};
}

std::unique_ptr<draco::PointAttribute> from_octahedron(const draco::PointAttribute& source) {
    draco::AttributeOctahedronTransform transform;
    if (!transform.InitFromAttribute(source) || source.num_components() != 2) return nullptr;
    constexpr int kMostBits = 30;
    if (transform.quantization_bits() < 2 || transform.quantization_bits() > kMostBits) return nullptr;
    const float step = 2.0f / static_cast<float>((std::int32_t{1} << transform.quantization_bits()) - 2);
    auto target = make_like(source, 3);
    std::array<std::int32_t, 2> integers{};
    for (std::uint32_t i = 0; i < source.size(); ++i) {
        if (!read_integers(source, draco::AttributeValueIndex(i), integers.data())) return nullptr;
        const std::array<float, 3> direction =
            direction_of(static_cast<float>(integers[0]) * step - 1.0f, static_cast<float>(integers[1]) * step - 1.0f);
        target->SetAttributeValue(draco::AttributeValueIndex(i), direction.data());
    }
    return target;
}

/// Converts an attribute that was decoded to integers to floats. Null: it is not transformed, or its parameters are
/// invalid. Draco's own code computes the same, but yields other floats in builds that fuse multiplication and
/// addition, such as Debian's for ARM.
std::unique_ptr<draco::PointAttribute> draco_floats(const draco::PointAttribute& source) {
    const draco::AttributeTransformData* const data = source.GetAttributeTransformData();
    if (data == nullptr) return nullptr;
    if (data->transform_type() == draco::ATTRIBUTE_QUANTIZATION_TRANSFORM) return from_range(source);
    return data->transform_type() == draco::ATTRIBUTE_OCTAHEDRON_TRANSFORM ? from_octahedron(source) : nullptr;
}

constexpr std::size_t kMaxComponents = 16;

// Draco allocates by the counts in its header before it reads the data, and entropy coding may spend almost nothing per
// element. So the counts are first checked against the data size; regular meshes stay below 64 faces per byte.
constexpr std::uint64_t kMaxElements = std::uint64_t{1} << 24;
constexpr std::uint64_t kElementsPerByte = 128;
constexpr std::uint64_t kElementsSlack = std::uint64_t{1} << 12;
constexpr std::uint64_t kMostTables = 16;  // connectivity tables: one for the mesh, and one per attribute with seams
constexpr std::uint64_t kMostComponents = 32;  // of all attributes together, on average

struct Counts {
    std::uint8_t method = 0;
    std::uint64_t faces = 0;
    std::uint64_t vertices = 0;
    std::uint64_t tables = 1;
};

/// Reads the counts before the connectivity (bit-stream specification, sections 3 to 6). False: malformed, or a version
/// before 2.2, which glTF does not use.
bool read_counts(std::span<const std::byte> data, Counts& counts) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(data.data()), data.size());
    std::array<char, 5> magic{};
    std::uint8_t major = 0;
    std::uint8_t minor = 0;
    std::uint8_t geometry = 0;
    std::uint8_t method = 0;
    std::uint16_t flags = 0;
    if (!buffer.Decode(magic.data(), magic.size()) || std::string_view(magic.data(), magic.size()) != "DRACO" ||
        !buffer.Decode(&major) || !buffer.Decode(&minor) || !buffer.Decode(&geometry) || !buffer.Decode(&method) ||
        !buffer.Decode(&flags)) {
        return false;
    }
    if (major != 2 || minor < 2 || geometry != draco::TRIANGULAR_MESH) return false;
    buffer.set_bitstream_version(static_cast<std::uint16_t>(major << 8 | minor));
    constexpr std::uint16_t kHasMetadata = 0x8000;
    if ((flags & kHasMetadata) != 0) {
        draco::GeometryMetadata metadata;
        draco::MetadataDecoder decoder;
        if (!decoder.DecodeGeometryMetadata(&buffer, &metadata)) return false;
    }
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    if (method == draco::MESH_EDGEBREAKER_ENCODING) {
        std::uint8_t traversal = 0;
        if (!buffer.Decode(&traversal)) return false;
    }
    if (!draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer)) return false;
    const bool sequential = method == draco::MESH_SEQUENTIAL_ENCODING;
    if (!sequential && method != draco::MESH_EDGEBREAKER_ENCODING) return false;
    std::uint8_t attributes_with_seams = 0;
    if (!sequential && !buffer.Decode(&attributes_with_seams)) return false;
    counts.method = method;
    counts.faces = sequential ? first : second;
    counts.vertices = sequential ? second : first;
    counts.tables += attributes_with_seams;
    return true;
}

template <class T>
void convert(const draco::PointAttribute& attribute, std::size_t count, int component_type, bool normalise,
             std::vector<float>& values, const std::string& place) {
    const std::size_t components = attribute.num_components();
    std::array<T, kMaxComponents> element{};
    for (std::size_t i = 0; i < count; ++i) {
        const auto index = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
        if (index.value() >= attribute.size() ||
            !attribute.ConvertValue<T>(index, static_cast<std::int8_t>(components), element.data())) {
            fail(place, "Draco: vertex " + std::to_string(i) + " has no value that fits the accessor's componentType");
        }
        for (std::size_t c = 0; c < components; ++c) {
            const auto value = static_cast<double>(element[c]);
            if (!std::isfinite(value)) fail(place, "Draco: vertex " + std::to_string(i) + " is not finite");
            values.push_back(static_cast<float>(normalise ? normalised(value, component_type) : value));
        }
    }
}

DracoPrimitive::Attribute read_attribute(const Document& document, const draco::PointAttribute& source,
                                         std::size_t count, int component_type, bool normalise,
                                         const std::string& place) {
    DracoPrimitive::Attribute attribute;
    attribute.components = source.num_components();
    if (attribute.components == 0 || attribute.components > kMaxComponents) {
        fail(place, "Draco: an attribute of " + std::to_string(attribute.components) + " components");
    }
    if (!source.is_mapping_identity() && source.indices_map_size() < count) {
        fail(place, "Draco: the attribute does not cover all vertices");
    }
    document.budget.take(count, attribute.components * sizeof(float), place);
    attribute.values.reserve(count * attribute.components);
    const auto read = [&](auto component) {
        convert<decltype(component)>(source, count, component_type, normalise, attribute.values, place);
    };
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            read(std::int8_t{});
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            read(std::uint8_t{});
            break;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            read(std::int16_t{});
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            read(std::uint16_t{});
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            read(std::uint32_t{});
            break;
        default:
            read(float{});
            break;
    }
    return attribute;
}

}  // namespace

const Json* find_draco(const Json& primitive) {
    const Json* extensions = find(primitive, "extensions");
    return extensions == nullptr || !extensions->is_object() ? nullptr
                                                             : find(*extensions, "KHR_draco_mesh_compression");
}

DracoPrimitive decode_draco(const Document& document, const tinygltf::Primitive& primitive, const Json& extension,
                            const std::string& place) {
    const std::string here = place + ".extensions.KHR_draco_mesh_compression";
    const auto data = document.buffers.view(extension["bufferView"].get<std::size_t>(), document.budget);
    Counts counts;
    if (!read_counts(data, counts)) fail(here, "Draco: the data does not start with the header of a triangle mesh");
    const std::uint64_t limit = std::min(kMaxElements, kElementsSlack + data.size() * kElementsPerByte);
    if (counts.faces > limit || counts.vertices > limit || counts.faces * counts.tables > limit * kMostTables) {
        fail(here, "Draco: " + std::to_string(data.size()) + " bytes cannot hold " + std::to_string(counts.faces) +
                       " faces and " + std::to_string(counts.vertices) + " vertices");
    }
    document.budget.take(counts.faces + counts.vertices, sizeof(std::uint32_t), here);
    auto decoded = decode_draco_mesh(data, counts.method, limit * kMostComponents);
    if (!decoded.ok()) fail(here, "Draco: " + decoded.status().error_msg_string());
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    if (mesh == nullptr) fail(here, "Draco: the data holds no mesh");

    DracoPrimitive result;
    result.count = mesh->num_points();
    document.budget.take(std::uint64_t{mesh->num_faces()} * 3, sizeof(std::uint32_t), here);
    result.indices.reserve(std::size_t{mesh->num_faces()} * 3);
    for (std::uint32_t f = 0; f < mesh->num_faces(); ++f) {
        for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(f))) {
            if (corner.value() >= result.count) fail(here, "Draco: face " + std::to_string(f) + " is out of range");
            result.indices.push_back(corner.value());
        }
    }
    const Json& attributes = extension["attributes"];
    for (auto entry = attributes.begin(); entry != attributes.end(); ++entry) {
        const std::string attribute_place = place + ".attributes." + key(entry.key());
        const auto id = entry.value().get<std::uint32_t>();
        const draco::PointAttribute* source = mesh->GetAttributeByUniqueId(id);
        if (source == nullptr) {
            fail(here + ".attributes." + key(entry.key()), "Draco: no attribute has the id " + std::to_string(id));
        }
        const std::unique_ptr<draco::PointAttribute> floats = draco_floats(*source);
        if (source->GetAttributeTransformData() != nullptr && floats == nullptr)
            fail(attribute_place, "Draco: the attribute's quantisation makes no sense");
        int component_type = TINYGLTF_COMPONENT_TYPE_FLOAT;
        bool normalise = false;
        if (const auto named = primitive.attributes.find(entry.key()); named != primitive.attributes.end()) {
            const auto& accessor = document.model.accessors[static_cast<std::size_t>(named->second)];
            component_type = accessor.componentType;
            normalise = accessor.normalized;
            if (accessor.count != result.count) {
                fail(attribute_place, "the accessor has " + std::to_string(accessor.count) +
                                          " elements, the Draco data " + std::to_string(result.count));
            }
        }
        result.attributes.emplace(entry.key(), read_attribute(document, floats ? *floats : *source, result.count,
                                                              component_type, normalise, attribute_place));
    }
    return result;
}

}  // namespace bendy::converter::gltf
