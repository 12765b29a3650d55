#pragma once

#include "collapse/shaped_places.h"

#include <cstring>

namespace bendy::converter {

struct FourPlaces {
    FourFloats x, y, z;
};

inline FourFloats load_four(const float* from) {
    FourFloats four;
    std::memcpy(&four, from, sizeof four);
    return four;
}

/// Four places, `apart` floats from one axis to the next.
inline FourPlaces load_places(const float* from, std::size_t apart) {
    return {load_four(from), load_four(from + apart), load_four(from + 2 * apart)};
}

/// The squared distances of four places from four triangles: bit for bit what closest_point gives for each, by the same
/// steps; where that branches, this chooses.
inline FourFloats four_distances(const FourPlaces& p, const FourPlaces& a, const FourPlaces& b, const FourPlaces& c) {
    const FourFloats zero{};
    const FourFloats one = zero + 1.0f;
    const auto minus = [](const FourPlaces& u, const FourPlaces& v) {
        return FourPlaces{u.x - v.x, u.y - v.y, u.z - v.z};
    };
    const auto dot = [](const FourPlaces& u, const FourPlaces& v) { return u.x * v.x + u.y * v.y + u.z * v.z; };
    const auto share = [&](const FourFloats& part, const FourFloats& other) {
        const FourFloats sum = part + other;
        return sum > zero ? part / sum : zero;
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

    // The last case first, so that an earlier one overrules it.
    FourFloats u = sum > zero ? va / sum : one;
    FourFloats v = sum > zero ? vb / sum : zero;
    FourFloats w = sum > zero ? vc / sum : zero;
    const auto choose = [&](const auto& is_case, const FourFloats& first, const FourFloats& second,
                            const FourFloats& third) {
        u = is_case ? first : u;
        v = is_case ? second : v;
        w = is_case ? third : w;
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
