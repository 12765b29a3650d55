#pragma once

#include <bendy/format/public.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <type_traits>
#include <vector>

namespace bendy::converter {

/// The point of a triangle that is nearest to `p`: its barycentric weights and its squared distance. A degenerate
/// triangle counts as its edges.
struct ClosestPoint {
    glm::vec3 weights{1.0f, 0.0f, 0.0f};
    float distance_squared = 0.0f;
};

/// C. Ericson, Real-Time Collision Detection, 5.1.5.
inline ClosestPoint closest_point(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const auto at = [&](const glm::vec3& weights) {
        const glm::vec3 apart = p - (weights.x * a + weights.y * b + weights.z * c);
        return ClosestPoint{weights, glm::dot(apart, apart)};
    };
    const auto share = [](float part, float other) { return part + other > 0.0f ? part / (part + other) : 0.0f; };
    const glm::vec3 ab = b - a;
    const glm::vec3 ac = c - a;
    const float d1 = glm::dot(ab, p - a);
    const float d2 = glm::dot(ac, p - a);
    if (d1 <= 0.0f && d2 <= 0.0f) return at({1.0f, 0.0f, 0.0f});
    const float d3 = glm::dot(ab, p - b);
    const float d4 = glm::dot(ac, p - b);
    if (d3 >= 0.0f && d4 <= d3) return at({0.0f, 1.0f, 0.0f});
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) {
        const float t = share(d1, -d3);
        return at({1.0f - t, t, 0.0f});
    }
    const float d5 = glm::dot(ab, p - c);
    const float d6 = glm::dot(ac, p - c);
    if (d6 >= 0.0f && d5 <= d6) return at({0.0f, 0.0f, 1.0f});
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) {
        const float t = share(d2, -d6);
        return at({1.0f - t, 0.0f, t});
    }
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
        const float t = share(d4 - d3, d5 - d6);
        return at({0.0f, 1.0f - t, t});
    }
    const float sum = va + vb + vc;
    if (!(sum > 0.0f)) return at({1.0f, 0.0f, 0.0f});
    return at({va / sum, vb / sum, vc / sum});
}

inline constexpr std::size_t kFour = 4;

/// Four floats processed together; each rounds like a float. select(which, a, b) takes a's lanes where `which` is true.
#if defined(BENDY_GNU)
using FourFloats = float __attribute__((vector_size(16)));

template <class Mask>
FourFloats select(const Mask& which, const FourFloats& a, const FourFloats& b) {
    return which ? a : b;
}
#else
struct FourFloats {
    std::array<float, kFour> lanes;
    float operator[](std::size_t k) const { return lanes[k]; }
};
using FourFlags = std::array<bool, kFour>;

/// Applies a function to each lane.
template <class Result, class Function, class... Four>
Result for_each_lane(const Function& function, const Four&... four) {
    Result result{};
    if constexpr (std::is_same_v<Result, FourFloats>) {
        for (std::size_t k = 0; k < kFour; ++k) result.lanes[k] = function(four[k]...);
    } else {
        for (std::size_t k = 0; k < kFour; ++k) result[k] = function(four[k]...);
    }
    return result;
}

inline FourFloats operator+(const FourFloats& a, const FourFloats& b) {
    return for_each_lane<FourFloats>(std::plus<>(), a, b);
}
inline FourFloats operator-(const FourFloats& a, const FourFloats& b) {
    return for_each_lane<FourFloats>(std::minus<>(), a, b);
}
inline FourFloats operator*(const FourFloats& a, const FourFloats& b) {
    return for_each_lane<FourFloats>(std::multiplies<>(), a, b);
}
inline FourFloats operator/(const FourFloats& a, const FourFloats& b) {
    return for_each_lane<FourFloats>(std::divides<>(), a, b);
}
inline FourFloats operator-(const FourFloats& a) {
    return for_each_lane<FourFloats>(std::negate<>(), a);
}
inline FourFloats operator+(const FourFloats& a, float b) {
    return a + FourFloats{{b, b, b, b}};
}
inline FourFlags operator<(const FourFloats& a, const FourFloats& b) {
    return for_each_lane<FourFlags>(std::less<>(), a, b);
}
inline FourFlags operator>(const FourFloats& a, const FourFloats& b) {
    return for_each_lane<FourFlags>(std::greater<>(), a, b);
}
inline FourFlags operator<=(const FourFloats& a, const FourFloats& b) {
    return for_each_lane<FourFlags>(std::less_equal<>(), a, b);
}
inline FourFlags operator>=(const FourFloats& a, const FourFloats& b) {
    return for_each_lane<FourFlags>(std::greater_equal<>(), a, b);
}
inline FourFlags operator&(const FourFlags& a, const FourFlags& b) {
    return for_each_lane<FourFlags>(std::logical_and<>(), a, b);
}
inline FourFloats select(const FourFlags& which, const FourFloats& a, const FourFloats& b) {
    return for_each_lane<FourFloats>([](bool first, float x, float y) { return first ? x : y; }, which, a, b);
}
#endif

/// Positions of points in several shapes, interleaved per point: first at rest, then the other shapes by axis, so that
/// four shapes are processed together. Lanes past the last shape repeat the rest position.
class ShapedPlaces {
public:
    explicit ShapedPlaces(std::size_t shapes) : posed_(shapes - 1), lanes_((posed_ + kFour - 1) / kFour * kFour) {}

    /// The number of shapes besides the rest: in groups of four, and including padding.
    [[nodiscard]] std::size_t fours() const { return lanes_ / kFour; }
    [[nodiscard]] std::size_t lanes() const { return lanes_; }

    void reserve(std::size_t points) { floats_.reserve(points * stride()); }

    /// \param place_in  returns the position in a shape by its number; 0: at rest
    template <class PlaceIn>
    void add(const PlaceIn& place_in) {
        const glm::vec3 rest = place_in(std::size_t{0});
        const std::size_t first = floats_.size();
        floats_.resize(first + stride());
        for (int axis = 0; axis < 3; ++axis) floats_[first + static_cast<std::size_t>(axis)] = rest[axis];
        for (std::size_t s = 0; s < lanes_; ++s) {
            const glm::vec3 place = s < posed_ ? place_in(s + 1) : rest;
            for (int axis = 0; axis < 3; ++axis)
                floats_[first + kFour + static_cast<std::size_t>(axis) * lanes_ + s] = place[axis];
        }
    }

    [[nodiscard]] glm::vec3 rest(std::size_t point) const {
        const float* at = floats_.data() + point * stride();
        return {at[0], at[1], at[2]};
    }
    /// The position in a shape; 0: at rest.
    [[nodiscard]] glm::vec3 place(std::size_t shape, std::size_t point) const {
        if (shape == 0) return rest(point);
        const float* at = posed(point) + shape - 1;
        return {at[0], at[lanes_], at[2 * lanes_]};
    }
    /// The positions in the shapes besides the rest: `lanes` x, then y, then z.
    [[nodiscard]] const float* posed(std::size_t point) const { return floats_.data() + point * stride() + kFour; }

private:
    [[nodiscard]] std::size_t stride() const { return kFour + 3 * lanes_; }

    std::size_t posed_;
    std::size_t lanes_;
    std::vector<float> floats_;
};

struct FourPlaces {
    FourFloats x, y, z;
};

inline FourFloats load_four(const float* from) {
    FourFloats four;
    std::memcpy(&four, from, sizeof four);
    return four;
}

/// Loads four positions; axes are `apart` floats apart.
inline FourPlaces load_places(const float* from, std::size_t apart) {
    return {load_four(from), load_four(from + apart), load_four(from + 2 * apart)};
}

/// The squared distances of four points from four triangles: bit for bit the results of closest_point, by the same
/// steps, with selects instead of branches.
inline FourFloats four_distances(const FourPlaces& p, const FourPlaces& a, const FourPlaces& b, const FourPlaces& c) {
    const FourFloats zero{};
    const FourFloats one = zero + 1.0f;
    const auto minus = [](const FourPlaces& u, const FourPlaces& v) {
        return FourPlaces{u.x - v.x, u.y - v.y, u.z - v.z};
    };
    const auto dot = [](const FourPlaces& u, const FourPlaces& v) { return u.x * v.x + u.y * v.y + u.z * v.z; };
    const auto share = [&](const FourFloats& part, const FourFloats& other) {
        const FourFloats sum = part + other;
        return select(sum > zero, part / sum, zero);
    };
    const FourPlaces ab = minus(b, a);
    const FourPlaces ac = minus(c, a);
    const FourPlaces ap = minus(p, a);
    const FourPlaces bp = minus(p, b);
    const FourPlaces cp = minus(p, c);
    const FourFloats d1 = dot(ab, ap);
    const FourFloats d2 = dot(ac, ap);
    const FourFloats d3 = dot(ab, bp);
    const FourFloats d4 = dot(ac, bp);
    const FourFloats d5 = dot(ab, cp);
    const FourFloats d6 = dot(ac, cp);
    const FourFloats va = d3 * d6 - d5 * d4;
    const FourFloats vb = d5 * d2 - d1 * d6;
    const FourFloats vc = d1 * d4 - d3 * d2;
    const FourFloats sum = va + vb + vc;

    // Last case first, so that an earlier case overrides it.
    FourFloats u = select(sum > zero, va / sum, one);
    FourFloats v = select(sum > zero, vb / sum, zero);
    FourFloats w = select(sum > zero, vc / sum, zero);
    const auto choose = [&](const auto& is_case, const FourFloats& first, const FourFloats& second,
                            const FourFloats& third) {
        u = select(is_case, first, u);
        v = select(is_case, second, v);
        w = select(is_case, third, w);
    };
    const FourFloats bc = share(d4 - d3, d5 - d6);
    choose((va <= zero) & (d4 - d3 >= zero) & (d5 - d6 >= zero), zero, one - bc, bc);
    const FourFloats on_ac = share(d2, -d6);
    choose((vb <= zero) & (d2 >= zero) & (d6 <= zero), one - on_ac, zero, on_ac);
    choose((d6 >= zero) & (d5 <= d6), zero, zero, one);
    const FourFloats on_ab = share(d1, -d3);
    choose((vc <= zero) & (d1 >= zero) & (d3 <= zero), one - on_ab, on_ab, zero);
    choose((d3 >= zero) & (d4 <= d3), zero, one, zero);
    choose((d1 <= zero) & (d2 <= zero), one, zero, zero);

    const FourPlaces apart{p.x - (u * a.x + v * b.x + w * c.x), p.y - (u * a.y + v * b.y + w * c.y),
                           p.z - (u * a.z + v * b.z + w * c.z)};
    return dot(apart, apart);
}

}  // namespace bendy::converter
