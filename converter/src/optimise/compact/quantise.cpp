#include "optimise/compact/quantise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace bendy::converter {
namespace {

constexpr double kLengthTolerance = 1e-3;  // from 1, for a unit vector

template <class T>
void put(StoredStream& stream, std::int64_t value) {
    const auto narrow = static_cast<T>(value);
    std::array<std::byte, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), &narrow, sizeof narrow);
    stream.bytes.insert(stream.bytes.end(), bytes.begin(), bytes.end());
}

void put_integer(StoredStream& stream, std::int64_t value) {
    switch (stream.type) {
        case ComponentType::u8:
        case ComponentType::i8:
            return put<std::uint8_t>(stream, value);
        case ComponentType::u32:
            return put<std::uint32_t>(stream, value);
        default:
            return put<std::uint16_t>(stream, value);
    }
}

/// True if no element differs from its value by more than `most_error`.
bool keeps(const StoredStream& stream, std::span<const float> values, double most_error) {
    const StreamView view = stream.view();
    for (std::uint32_t element = 0; element < view.elements; ++element) {
        double square = 0.0;
        for (std::uint32_t c = 0; c < view.components; ++c) {
            const double difference =
                double{view.number(element, c)} - values[std::size_t{element} * view.components + c];
            square += difference * difference;
        }
        if (!(square <= most_error * most_error)) return false;
    }
    return true;
}

/// The step whose rounding moves an element by at most `most_error`, with a margin for the floats that decode it.
float step_of(double most_error, std::uint32_t components) {
    constexpr double kSpare = 0.999;
    return static_cast<float>(2.0 * kSpare * most_error / std::sqrt(static_cast<double>(components)));
}

struct Range {
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
};

std::vector<Range> ranges_of(std::span<const float> values, std::uint32_t components) {
    std::vector<Range> ranges(components);
    for (std::size_t at = 0; at < values.size(); ++at) {
        Range& range = ranges[at % components];
        range.low = std::min(range.low, values[at]);
        range.high = std::max(range.high, values[at]);
    }
    return ranges;
}

/// Whole steps from minimum to value.
std::int64_t steps_to(float value, const StreamBox& box) {
    return box.step == 0.0f ? 0 : std::llround((double{value} - box.minimum) / box.step);
}

struct Point {
    double x = 0.0, y = 0.0;
};

Point to_octahedron(const glm::dvec3& v) {
    const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
    const Point p{v.x / sum, v.y / sum};
    if (v.z >= 0.0) return p;
    return {(1.0 - std::abs(p.y)) * (p.x < 0.0 ? -1.0 : 1.0), (1.0 - std::abs(p.x)) * (p.y < 0.0 ? -1.0 : 1.0)};
}

/// The integers that decode nearest to a unit vector, chosen from the four grid points around it.
class DirectionQuantiser {
public:
    explicit DirectionQuantiser(unsigned bits)
        : type_(bits <= 8 ? ComponentType::i8 : ComponentType::i16),
          largest_(bits <= 8 ? 127 : 32767),
          steps_((std::int64_t{1} << (bits - 1)) - 1) {}

    [[nodiscard]] ComponentType type() const { return type_; }
    [[nodiscard]] std::int64_t largest() const { return largest_; }

    [[nodiscard]] std::array<std::int64_t, 2> operator()(const glm::dvec3& v) const {
        const Point p = to_octahedron(v);
        const auto steps = static_cast<double>(steps_);
        std::array<std::int64_t, 2> best{};
        double most = -2.0;
        for (const double dx : {0.0, 1.0}) {
            for (const double dy : {0.0, 1.0}) {
                const std::int64_t x = scaled(std::floor(p.x * steps) + dx);
                const std::int64_t y = scaled(std::floor(p.y * steps) + dy);
                const glm::vec3 d = decode_octahedral(fraction(x), fraction(y));
                const double cosine = d.x * v.x + d.y * v.y + d.z * v.z;
                if (cosine > most) {
                    most = cosine;
                    best = {x, y};
                }
            }
        }
        return best;
    }

private:
    [[nodiscard]] std::int64_t scaled(double step) const {
        const auto limit = static_cast<double>(steps_);
        return std::llround(std::clamp(step, -limit, limit) / limit * static_cast<double>(largest_));
    }
    [[nodiscard]] float fraction(std::int64_t value) const {
        return static_cast<float>(value) / static_cast<float>(largest_);
    }

    ComponentType type_;
    std::int64_t largest_;
    std::int64_t steps_;
};

/// Stores a direction, or the code for none; false if its length is neither 1 nor 0.
bool put_direction(StoredStream& stream, const DirectionQuantiser& quantise, const glm::dvec3& v) {
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    if (length == 0.0) {
        put_integer(stream, -quantise.largest() - 1);
        put_integer(stream, -quantise.largest() - 1);
        return true;
    }
    if (!(std::abs(length - 1.0) <= kLengthTolerance)) return false;
    for (const std::int64_t number : quantise(v / length)) put_integer(stream, number);
    return true;
}

StoredStream directions(const DirectionQuantiser& quantise, std::uint32_t components) {
    StoredStream stream;
    stream.type = quantise.type();
    stream.numbers = Numbers::normalised;
    stream.components = components;
    stream.is_octahedral = true;
    return stream;
}

}  // namespace

std::optional<StoredStream> quantise_boxed(std::span<const float> values, std::uint32_t components, double most_error,
                                           bool allow_wide) {
    const std::int64_t most_steps = allow_wide ? 0xffffff : 0xffff;
    const float step = step_of(most_error, components);
    StoredStream stream;
    stream.components = components;
    std::int64_t most = 0;
    for (const Range& range : ranges_of(values, components)) {
        if (values.empty()) break;
        const bool is_flat = range.low == range.high;
        if (!is_flat && !(step > 0.0f)) return std::nullopt;
        stream.boxes.push_back({range.low, is_flat ? 0.0f : step});
        if (!is_flat && (double{range.high} - range.low) / step > static_cast<double>(most_steps)) return std::nullopt;
        most = std::max(most, steps_to(range.high, stream.boxes.back()));
    }
    if (values.empty() || most > most_steps) return std::nullopt;
    const float largest_number = most <= 0xffff ? 65536.0f : 4294967296.0f;
    for (const StreamBox& box : stream.boxes) {  // what any integer stands for must be a number
        if (!std::isfinite(box.minimum + largest_number * box.step)) return std::nullopt;
    }
    stream.type = most <= 0xff ? ComponentType::u8 : (most <= 0xffff ? ComponentType::u16 : ComponentType::u32);
    for (std::size_t at = 0; at < values.size(); ++at)
        put_integer(stream, steps_to(values[at], stream.boxes[at % components]));
    if (!keeps(stream, values, most_error)) return std::nullopt;
    return stream;
}

std::optional<StoredStream> quantise_shifts(std::span<const glm::vec3> shifts, double most_error) {
    if (shifts.empty()) return std::nullopt;
    const float step = step_of(most_error, 3);
    if (!(step > 0.0f) || !std::isfinite(65536.0f * step)) return std::nullopt;
    const std::span<const float> values(&shifts[0].x, shifts.size() * 3);
    StoredStream stream;
    stream.components = 3;
    stream.boxes.assign(3, {0.0f, step});
    std::int64_t most = 0;
    for (const float value : values) {
        if (!(std::abs(double{value}) / step <= 32767.0)) return std::nullopt;
        most = std::max<std::int64_t>(most, std::abs(steps_to(value, stream.boxes[0])));
    }
    stream.type = most <= 127 ? ComponentType::i8 : ComponentType::i16;
    for (const float value : values) put_integer(stream, steps_to(value, stream.boxes[0]));
    if (!keeps(stream, values, most_error)) return std::nullopt;
    return stream;
}

std::optional<StoredStream> quantise_normals(std::span<const glm::vec3> normals, unsigned bits) {
    const DirectionQuantiser quantise(bits);
    StoredStream stream = directions(quantise, 2);
    for (const glm::vec3& normal : normals) {
        if (!put_direction(stream, quantise, normal)) return std::nullopt;
    }
    return stream;
}

std::optional<StoredStream> quantise_tangents(std::span<const glm::vec4> tangents, unsigned bits) {
    const DirectionQuantiser quantise(bits);
    StoredStream stream = directions(quantise, 3);
    for (const glm::vec4& tangent : tangents) {
        if (std::abs(tangent.w) != 1.0f || !put_direction(stream, quantise, glm::vec3(tangent))) return std::nullopt;
        put_integer(stream, tangent.w < 0.0f ? -quantise.largest() : quantise.largest());
    }
    return stream;
}

std::optional<StoredStream> quantise_colours(std::span<const float> values, std::uint32_t components) {
    StoredStream stream;
    stream.numbers = Numbers::normalised;
    stream.components = components;
    for (const float value : values) {
        if (!(value >= 0.0f && value <= 1.0f)) return std::nullopt;
        put_integer(stream, std::lround(value * 255.0f));
    }
    return stream;
}

void quantise_weights(std::span<const float> weights, std::uint32_t levels, std::span<std::uint32_t> out) {
    double sum = 0.0;
    for (const float weight : weights) sum += weight;
    std::vector<std::pair<double, std::size_t>> left;  // what rounding down removes
    std::uint32_t total = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const double exact = sum > 0.0 ? weights[k] / sum * levels : 0.0;
        out[k] = std::min(levels, static_cast<std::uint32_t>(std::floor(exact)));
        total += out[k];
        left.emplace_back(out[k] - exact, k);
    }
    std::sort(left.begin(), left.end());  // largest remainder first; ties by index
    for (std::size_t k = 0; total < levels && !left.empty(); k = (k + 1) % left.size(), ++total) ++out[left[k].second];
}

StoredStream store_weights(std::span<const std::uint32_t> weights, std::uint32_t influences, std::uint32_t levels) {
    StoredStream stream;
    stream.type = levels <= 0xff ? ComponentType::u8 : ComponentType::u16;
    stream.components = influences;
    if (levels == 0xff || levels == 0xffff) {
        stream.numbers = Numbers::normalised;
    } else {
        stream.boxes.assign(influences, {0.0f, 1.0f / static_cast<float>(levels)});
    }
    for (const std::uint32_t weight : weights) put_integer(stream, weight);
    return stream;
}

}  // namespace bendy::converter
