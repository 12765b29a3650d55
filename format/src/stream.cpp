#include <bendy/format/mesh.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace bendy {
namespace {

template <class T>
T load(Bytes data, std::uint64_t at) {
    T value{};
    copy_at(data, at * sizeof(T), value);
    return value;
}

/// Returns the value that an integer represents.
template <class T>
float scaled(T value, const StreamView& stream, std::uint32_t component) {
    const auto number = static_cast<float>(value);
    if (!stream.boxes.empty()) return stream.boxes[component].minimum + stream.boxes[component].step * number;
    if constexpr (sizeof(T) < 4) {
        constexpr auto kLargest = static_cast<float>(std::numeric_limits<T>::max());
        if (stream.normalised) return std::max(number / kLargest, -1.0f);
    }
    return number;
}

/// Calls visit(load), where load(at) returns one of the stream's numbers as stored.
template <class Visit>
auto with_type(const StreamView& stream, const Visit& visit) {
    switch (stream.type) {
        case ComponentType::u8:
            return visit([&](std::uint64_t at) { return load<std::uint8_t>(stream.data, at); });
        case ComponentType::i8:
            return visit([&](std::uint64_t at) { return load<std::int8_t>(stream.data, at); });
        case ComponentType::u16:
            return visit([&](std::uint64_t at) { return load<std::uint16_t>(stream.data, at); });
        case ComponentType::i16:
            return visit([&](std::uint64_t at) { return load<std::int16_t>(stream.data, at); });
        case ComponentType::u32:
            return visit([&](std::uint64_t at) { return load<std::uint32_t>(stream.data, at); });
        default:
            return visit([&](std::uint64_t at) { return load<float>(stream.data, at); });
    }
}

/// Returns the direction at the start of an element; zero if both numbers are the type's smallest.
template <class Load>
glm::vec3 direction_at(const StreamView& stream, const Load& load, std::uint64_t at) {
    using T = decltype(load(at));
    const T x = load(at);
    const T y = load(at + 1);
    if constexpr (std::is_signed_v<T> && sizeof(T) < 4) {
        constexpr T kNone = std::numeric_limits<T>::min();
        if (x == kNone && y == kNone) return glm::vec3(0.0f);
    }
    return decode_octahedral(scaled(x, stream, 0), scaled(y, stream, 1));
}

template <class Vector, class Load>
Vector vector_at(const StreamView& stream, const Load& load, std::uint64_t element) {
    const std::uint64_t at = element * stream.components;
    Vector vector;
    if constexpr (Vector::length() == 3) {
        if (!stream.list.empty()) return stream.list[static_cast<std::size_t>(load(at))];
    }
    if (stream.is_octahedral) {
        const glm::vec3 direction = direction_at(stream, load, at);
        for (int c = 0; c < 3; ++c) vector[c] = direction[c];
        if constexpr (Vector::length() == 4) vector[3] = scaled(load(at + 2), stream, 2);
        return vector;
    }
    for (int c = 0; c < Vector::length(); ++c)
        vector[c] = scaled(load(at + static_cast<unsigned>(c)), stream, static_cast<std::uint32_t>(c));
    return vector;
}

template <class Vector>
void decode_vectors(const StreamView& stream, std::span<Vector> out) {
    assert(out.size() <= stream.elements);
    if (stream.type == ComponentType::f32) {
        const auto source = view_at<Vector>(stream.data, 0, out.size());
        std::copy(source.begin(), source.end(), out.begin());
        return;
    }
    with_type(stream, [&](const auto& load) {
        for (std::size_t element = 0; element < out.size(); ++element)
            out[element] = vector_at<Vector>(stream, load, element);
    });
}

}  // namespace

glm::vec3 decode_octahedral(float x, float y) {
    glm::vec3 v(x, y, 1.0f - std::abs(x) - std::abs(y));
    if (v.z < 0.0f) {
        v.x = (1.0f - std::abs(y)) * (x < 0.0f ? -1.0f : 1.0f);
        v.y = (1.0f - std::abs(x)) * (y < 0.0f ? -1.0f : 1.0f);
    }
    const float length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return {v.x / length, v.y / length, v.z / length};  // |x| + |y| + |z| is 1 or more: no division by zero
}

glm::vec3 StreamView::vec3(std::uint32_t element) const {
    assert(element < elements && (!list.empty() || components >= (is_octahedral ? 2u : 3u)));
    if (type == ComponentType::f32)
        return load<glm::vec3>(data.subspan(std::size_t{element} * components * sizeof(float)), 0);
    return with_type(*this, [&](const auto& load) { return vector_at<glm::vec3>(*this, load, element); });
}

glm::vec4 StreamView::vec4(std::uint32_t element) const {
    assert(element < elements && components >= (is_octahedral ? 3u : 4u));
    return with_type(*this, [&](const auto& load) { return vector_at<glm::vec4>(*this, load, element); });
}

void StreamView::decode(std::span<glm::vec3> out) const {
    decode_vectors(*this, out);
}

void StreamView::decode(std::span<glm::vec4> out) const {
    decode_vectors(*this, out);
}

void StreamView::decode(std::span<float> out) const {
    assert(out.size() <= std::size_t{elements} * components);
    with_type(*this, [&](const auto& load) {
        for (std::uint32_t c = 0; c < components; ++c) {
            for (std::size_t at = c; at < out.size(); at += components) out[at] = scaled(load(at), *this, c);
        }
    });
}

float StreamView::number(std::uint32_t element, std::uint32_t component) const {
    assert(element < elements && component < components);
    const std::uint64_t at = std::uint64_t{element} * components + component;
    return with_type(*this, [&](const auto& load) { return scaled(load(at), *this, component); });
}

std::uint32_t StreamView::index(std::uint32_t element, std::uint32_t component) const {
    assert(element < elements && component < components);
    const std::uint64_t at = std::uint64_t{element} * components + component;
    switch (type) {
        case ComponentType::u8:
            return load<std::uint8_t>(data, at);
        case ComponentType::u16:
            return load<std::uint16_t>(data, at);
        case ComponentType::u32:
            return load<std::uint32_t>(data, at);
        default:
            return 0;
    }
}

}  // namespace bendy
