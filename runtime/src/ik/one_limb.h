#pragma once

#include "plan/blocks.h"

#include <bendy/format/public.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>

// Numbers for two_bone.h: doubles, for one limb.
namespace bendy::one_limb {

constexpr std::size_t kLimbs = 1;
using Number = double;
using Mask = bool;

BENDY_ALWAYS_INLINE Number root(Number number) {
    return std::sqrt(number);
}
BENDY_ALWAYS_INLINE Number absolute(Number number) {
    return std::abs(number);
}
BENDY_ALWAYS_INLINE Number greater(Number a, Number b) {
    return a > b ? a : b;
}
template <class Value>
BENDY_ALWAYS_INLINE Value chosen(Mask mask, Value a, Value b) {
    return mask ? a : b;
}
BENDY_ALWAYS_INLINE Mask both(Mask a, Mask b) {
    return a && b;
}
BENDY_ALWAYS_INLINE Mask either(Mask a, Mask b) {
    return a || b;
}
BENDY_ALWAYS_INLINE Mask opposite(Mask mask) {
    return !mask;
}
BENDY_ALWAYS_INLINE bool is_any(Mask mask) {
    return mask;
}
BENDY_ALWAYS_INLINE bool is_every(Mask mask) {
    return mask;
}
BENDY_ALWAYS_INLINE Number loaded(const double* from) {
    return *from;
}

#include "kernels/two_bone.h"

BENDY_ALWAYS_INLINE glm::dquat glm_of(const Rotation& q) {
    return {q.w, q.x, q.y, q.z};
}
BENDY_ALWAYS_INLINE glm::dvec3 glm_of(const Vector& v) {
    return {v.x, v.y, v.z};
}
BENDY_ALWAYS_INLINE Rotation rotation_of(const glm::dquat& q) {
    return {q.x, q.y, q.z, q.w};
}
BENDY_ALWAYS_INLINE Vector vector_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

/// Sets the numbers of one limb in a set of limbs.
template <std::size_t numbers, std::size_t limbs, class Numbers>
BENDY_ALWAYS_INLINE void put(const Numbers& from, double (&to)[numbers][limbs], std::size_t limb) {
    for (std::size_t c = 0; c < numbers; ++c) to[c][limb] = from[static_cast<int>(c)];
}

}  // namespace bendy::one_limb
