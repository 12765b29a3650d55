#pragma once

#include <bendy/format/public.h>

#include <cstdint>

// The limits that every reader and writer shares; spec/limits.md is the same list for people.
namespace BENDY_PUBLIC bendy {

inline constexpr std::uint16_t kVersionMajor = 0;
inline constexpr std::uint16_t kVersionMinor = 1;

inline constexpr std::uint64_t kMaxPayload = (std::uint64_t{1} << 48) - 1;  ///< bytes, by the header's 48 bits
inline constexpr std::uint32_t kMaxDepth = 65'536;                          ///< nested containers, HEAD being the first
inline constexpr std::uint32_t kMaxChunks = 0x7fff'ffff;                    ///< chunks in a file
inline constexpr std::uint32_t kMaxJoints = 65'000;     ///< joints of an object: each is a level in the worst case
inline constexpr std::uint32_t kMaxInfluences = 1'024;  ///< bones per vertex
inline constexpr std::uint32_t kNone = 0xffff'ffff;     ///< "no such thing" in every 32-bit index field

}  // namespace bendy
