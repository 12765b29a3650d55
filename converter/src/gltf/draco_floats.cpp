#include "draco_floats.h"

#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace bendy::converter::gltf {
namespace {

/// One value's integers; false if the buffer ends before.
bool read_integers(const draco::PointAttribute& source, draco::AttributeValueIndex index, std::int32_t* integers) {
    const std::size_t size = source.num_components() * sizeof(std::int32_t);
    const auto at = static_cast<std::size_t>(source.GetBytePos(index));
    if (at > source.buffer()->data_size() || source.buffer()->data_size() - at < size) return false;
    std::memcpy(integers, source.buffer()->data() + at, size);
    return true;
}

/// An empty attribute whose points have the values that they have in the source.
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

/// Bit-stream specification, "quantized attributes": an integer is a share of the range above the least value.
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

/// The direction of a point of the unfolded octahedron, both coordinates from -1 to 1.
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

}  // namespace

std::unique_ptr<draco::PointAttribute> draco_floats(const draco::PointAttribute& source) {
    const draco::AttributeTransformData* const data = source.GetAttributeTransformData();
    if (data == nullptr) return nullptr;
    if (data->transform_type() == draco::ATTRIBUTE_QUANTIZATION_TRANSFORM) return from_range(source);
    return data->transform_type() == draco::ATTRIBUTE_OCTAHEDRON_TRANSFORM ? from_octahedron(source) : nullptr;
}

}  // namespace bendy::converter::gltf
