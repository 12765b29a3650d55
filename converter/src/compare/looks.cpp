#include "compare/looks.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace bendy::converter {
namespace {

constexpr double kDirection = 2.0;  // degrees
constexpr double kCoords = 1.0 / 1024.0;
constexpr double kColours = 1.0 / 128.0;

/// From the least to the largest number; 1 at least where there is none.
double range_of(std::span<const float> numbers) {
    if (numbers.empty()) return 1.0;
    const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
    const double range = double{*high} - *low;
    return range > 0.0 ? range : 1.0;
}

double degrees_between(const float* a, const float* b) {
    double dot = 0.0;
    double a_square = 0.0;
    double b_square = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        dot += double{a[c]} * b[c];
        a_square += double{a[c]} * a[c];
        b_square += double{b[c]} * b[c];
    }
    const double lengths = std::sqrt(a_square * b_square);
    if (!(lengths > 0.0)) return 0.0;  // one has no direction: nothing is known
    return trig::acos(std::clamp(dot / lengths, -1.0, 1.0)) * 180.0 / trig::kPi;
}

}  // namespace

Looks::Looks(const Mesh& a, const Mesh& b) {
    const auto pair_vectors = [&](const std::string& name, Kind kind, const auto& here, const auto& there) {
        constexpr auto stride = static_cast<std::uint32_t>(sizeof(here[0]) / sizeof(float));
        if (!here.empty() && !there.empty())
            streams_.push_back({name, kind, stride, &here[0].x, &there[0].x, stride, stride, kDirection});
        if (!here.empty() && there.empty()) only_in_a_.push_back(name);
        if (here.empty() && !there.empty()) only_in_b_.push_back(name);
    };
    pair_vectors("normals", Kind::direction, a.normals, b.normals);
    pair_vectors("tangents", Kind::tangent, a.tangents, b.tangents);
    pair_streams("texture coordinates ", a.texture_coords, b.texture_coords, kCoords);
    pair_streams("colours ", a.colours, b.colours, kColours);
    pair_streams("attribute ", a.attributes, b.attributes, kCoords);
}

void Looks::pair_streams(const std::string& kind, const std::vector<Stream>& a, const std::vector<Stream>& b,
                         double allowed) {
    const auto name_of = [&](const Stream& stream) {
        return kind + (stream.name.empty() ? std::to_string(stream.set) : stream.name);
    };
    const auto find = [](const std::vector<Stream>& list, const Stream& wanted) {
        return std::find_if(list.begin(), list.end(), [&](const Stream& stream) {
            return stream.name == wanted.name && stream.set == wanted.set && !stream.values.empty();
        });
    };
    for (const Stream& stream : a) {
        if (stream.values.empty()) continue;
        const auto other = find(b, stream);
        if (other == b.end()) {
            only_in_a_.push_back(name_of(stream));
            continue;
        }
        const bool is_colour = allowed == kColours;
        const double most = is_colour ? allowed : allowed * range_of(stream.values);
        streams_.push_back({name_of(stream), Kind::numbers, std::min(stream.components, other->components),
                            stream.values.data(), other->values.data(), stream.components, other->components, most});
    }
    for (const Stream& stream : b) {
        if (!stream.values.empty() && find(a, stream) == a.end()) only_in_b_.push_back(name_of(stream));
    }
}

double Looks::apart(const Paired& stream, std::uint32_t a, std::uint32_t b) {
    const float* here = stream.a + std::size_t{a} * stream.a_stride;
    const float* there = stream.b + std::size_t{b} * stream.b_stride;
    if (stream.kind != Kind::numbers) {
        const bool turns = stream.kind == Kind::tangent && (here[3] < 0.0f) != (there[3] < 0.0f);
        return turns ? 180.0 : degrees_between(here, there);
    }
    double largest = 0.0;
    for (std::uint32_t c = 0; c < stream.components; ++c)
        largest = std::max(largest, std::abs(double{here[c]} - there[c]));
    return largest;
}

double Looks::unlikeness(std::uint32_t a, std::uint32_t b) const {
    double sum = 0.0;
    for (const Paired& stream : streams_) sum += apart(stream, a, b) / stream.allowed;
    return sum;
}

}  // namespace bendy::converter
