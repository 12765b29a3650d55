#include "formats/gltf_out/buffer.h"

#include "scene/stored_numbers.h"

#include <bendy/format/charconv.h>
#include <bendy/format/records.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <string_view>

namespace bendy::converter::gltf_out {
namespace {

constexpr std::size_t kAlignment = 4;

enum class Code : int { u8 = 5121, u16 = 5123, u32 = 5125, f32 = 5126 };  // glTF's component type codes

const char* type_name(std::uint32_t components) {
    switch (components) {
        case 1:
            return "SCALAR";
        case 2:
            return "VEC2";
        case 3:
            return "VEC3";
        case 4:
            return "VEC4";
        case 9:
            return "MAT3";
        default:
            return "MAT4";
    }
}

Json describe(Code code, std::size_t count, std::uint32_t components) {
    return {{"componentType", static_cast<int>(code)}, {"count", count}, {"type", type_name(components)}};
}

void add_bounds(Json& accessor, std::span<const float> values, std::uint32_t components) {
    std::vector<float> low(values.begin(), values.begin() + components);
    std::vector<float> high(low);
    for (std::size_t i = components; i < values.size(); ++i) {
        float& least = low[i % components];
        float& most = high[i % components];
        least = std::min(least, values[i]);
        most = std::max(most, values[i]);
    }
    accessor["min"] = json_numbers(low);
    accessor["max"] = json_numbers(high);
}

std::size_t hash_of(Bytes bytes) {
    return std::hash<std::string_view>()({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// The narrowest type. Indices must not use a type's largest value, which would restart a strip.
Code narrowest(std::span<const std::uint32_t> values, bool are_indices) {
    const std::uint32_t largest = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
    if (!are_indices && largest <= 0xff) return Code::u8;
    return largest < 0xffff || (!are_indices && largest == 0xffff) ? Code::u16 : Code::u32;
}

template <class T>
std::vector<std::byte> as_bytes_of(std::span<const std::uint32_t> values) {
    std::vector<std::byte> bytes;
    bytes.reserve(values.size() * sizeof(T));
    for (const std::uint32_t value : values) {
        const auto pieces = bit_cast<std::array<std::byte, sizeof(T)>>(static_cast<T>(value));
        bytes.insert(bytes.end(), pieces.begin(), pieces.end());
    }
    return bytes;
}

std::size_t size_of(Code code) {
    return code == Code::u8 ? 1 : code == Code::u16 ? 2 : 4;
}

std::vector<std::byte> encode(std::span<const std::uint32_t> values, Code code) {
    if (code == Code::u8) return as_bytes_of<std::uint8_t>(values);
    if (code == Code::u16) return as_bytes_of<std::uint16_t>(values);
    return as_bytes_of<std::uint32_t>(values);
}

}  // namespace

std::uint32_t Buffer::add_view(Bytes bytes, std::size_t element, Use use) {
    std::vector<std::byte> strided;
    const std::size_t stride = (element + kAlignment - 1) / kAlignment * kAlignment;
    if (use == Use::vertices && stride != element) {
        strided.resize(bytes.size() / element * stride);
        for (std::size_t i = 0; i < bytes.size() / element; ++i)
            std::memcpy(strided.data() + i * stride, bytes.data() + i * element, element);
        bytes = strided;
    }
    Json view{{"buffer", 0}, {"byteLength", bytes.size()}};
    if (use == Use::vertices) view["byteStride"] = stride;
    if (use != Use::data) view["target"] = use == Use::vertices ? 34962 : 34963;

    const std::size_t hash = hash_of(bytes);
    const auto [first, last] = known_views_.equal_range(hash);
    for (auto known = first; known != last; ++known) {
        Json other = views_[known->second];
        const auto offset = other["byteOffset"].get<std::size_t>();
        other.erase("byteOffset");
        if (other == view &&
            std::equal(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset)))
            return known->second;
    }
    bytes_.resize((bytes_.size() + kAlignment - 1) / kAlignment * kAlignment);
    view["byteOffset"] = bytes_.size();
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    const auto index = static_cast<std::uint32_t>(views_.size());
    views_.push_back(std::move(view));
    known_views_.emplace(hash, index);
    return index;
}

std::uint32_t Buffer::add_accessor(Json accessor) {
    const auto [known, is_new] =
        known_accessors_.try_emplace(accessor.dump(), static_cast<std::uint32_t>(accessors_.size()));
    if (is_new) accessors_.push_back(std::move(accessor));
    return known->second;
}

std::uint32_t Buffer::add_floats(std::span<const float> values, std::uint32_t components, Use use, bool with_bounds) {
    Json accessor = describe(Code::f32, values.size() / components, components);
    accessor["bufferView"] = add_view(std::as_bytes(values), components * sizeof(float), use);
    if (with_bounds) add_bounds(accessor, values, components);
    return add_accessor(std::move(accessor));
}

std::uint32_t Buffer::add_fractions(std::span<const float> values, std::uint32_t components) {
    const StoredNumbers stored = smallest_exact_fractions(values);
    if (stored.type == ComponentType::f32) return add_floats(values, components, Use::vertices, false);
    const Code code = stored.type == ComponentType::u8 ? Code::u8 : Code::u16;
    Json accessor = describe(code, values.size() / components, components);
    accessor["normalized"] = true;
    accessor["bufferView"] = add_view(stored.bytes, components * size_of(code), Use::vertices);
    return add_accessor(std::move(accessor));
}

std::uint32_t Buffer::add_integers(std::span<const std::uint32_t> values, std::uint32_t components, Use use) {
    const Code code = narrowest(values, use == Use::indices);
    Json accessor = describe(code, values.size() / components, components);
    accessor["bufferView"] = add_view(encode(values, code), components * size_of(code), use);
    return add_accessor(std::move(accessor));
}

std::uint32_t Buffer::add_displacements(std::span<const float> values) {
    constexpr std::uint32_t kComponents = 3;
    constexpr std::size_t kElement = kComponents * sizeof(float);
    std::vector<std::uint32_t> touched;
    std::vector<float> stored;
    for (std::size_t i = 0; i < values.size(); i += kComponents) {
        const auto element = values.subspan(i, kComponents);
        const bool is_zero =
            std::all_of(element.begin(), element.end(), [](float v) { return bit_cast<std::uint32_t>(v) == 0; });
        if (is_zero) continue;
        touched.push_back(static_cast<std::uint32_t>(i / kComponents));
        stored.insert(stored.end(), element.begin(), element.end());
    }
    const std::size_t count = values.size() / kComponents;
    const Code code = narrowest(touched, false);
    if (touched.size() * (kElement + size_of(code)) >= count * kElement)
        return add_floats(values, kComponents, Use::vertices, true);
    Json accessor = describe(Code::f32, count, kComponents);
    add_bounds(accessor, values, kComponents);
    if (!touched.empty()) {
        accessor["sparse"] = {
            {"count", touched.size()},
            {"indices",
             {{"bufferView", add_view(encode(touched, code), size_of(code), Use::data)},
              {"componentType", static_cast<int>(code)}}},
            {"values", {{"bufferView", add_view(std::as_bytes(std::span(stored)), kElement, Use::data)}}}};
    }
    return add_accessor(std::move(accessor));
}

std::uint32_t Buffer::add_bytes(Bytes bytes) {
    return add_view(bytes, 1, Use::data);
}

}  // namespace bendy::converter::gltf_out
