#pragma once

#include <bendy.h>
#include <bendy/format/records.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>

// How structs of bendy.h are checked, and become C++ structs and back, field by field.
namespace bendy::capi {

/// How to check and copy a struct of bendy.h; fields.h specialises it.
template <class Struct>
struct Fields;

template <class Struct>
bendy_status check_fields(const Struct& from, bendy_error* error) {
    return Fields<Struct>::check(from, error);
}

/// Sets the members of a C++ struct, which has the names of all fields.
template <class Struct, class To>
void from_c(const Struct& from, To& to) {
    Fields<Struct>::from_c(from, to);
}

/// Sets the fields of `to` that `from` has members of the same names for.
template <class From, class Struct>
void to_c(const From& from, Struct& to) {
    Fields<Struct>::to_c(from, to);
}

template <class Number, glm::qualifier Q>
void assign(const Number (&from)[3], glm::vec<3, Number, Q>& to) {
    to = {from[0], from[1], from[2]};
}

template <class Number, glm::qualifier Q>
void assign(const glm::vec<3, Number, Q>& from, Number (&to)[3]) {
    for (int c = 0; c < 3; ++c) to[c] = from[c];
}

template <class Number, glm::qualifier Q>
void assign(const Number (&from)[4], glm::qua<Number, Q>& to) {
    to = glm::qua<Number, Q>(from[3], from[0], from[1], from[2]);
}

template <class Number, glm::qualifier Q>
void assign(const glm::qua<Number, Q>& from, Number (&to)[4]) {
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
    to[3] = from.w;
}

inline void assign(const float (&from)[16], glm::mat4& to) {
    to = glm::make_mat4(from);
}

template <std::size_t N>
void assign(const std::array<float, N>& from, float (&to)[N]) {
    std::copy(from.begin(), from.end(), to);
}

inline void assign(const TextureUseRecord& from, bendy_texture_use& to) {
    to = {from.texture, from.coords, {from.offset[0], from.offset[1]}, {from.scale[0], from.scale[1]}, from.rotation};
}

template <std::size_t N>
void assign(const float (&from)[N], float (&to)[N]) {
    std::copy(std::begin(from), std::end(from), to);
}

/// Numbers, flags and enumerations; structs by their fields.
template <class From, class To>
void assign(const From& from, To& to) {
    if constexpr (std::is_same_v<To, bool>) {
        to = from != 0;
    } else if constexpr (std::is_arithmetic_v<To> || std::is_enum_v<To>) {
        to = static_cast<To>(from);
    } else if constexpr (requires { sizeof(Fields<To>); }) {
        to_c(from, to);
    } else {
        from_c(from, to);
    }
}

}  // namespace bendy::capi
