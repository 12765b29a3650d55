#pragma once

#include <bendy/format/public.h>

#include <cstdint>

// Limits shared by all readers and writers; spec/limits.md is the same list for people.
namespace BENDY_PUBLIC bendy {

inline constexpr std::uint16_t kVersionMajor = 0;
inline constexpr std::uint16_t kVersionMinor = 1;

inline constexpr std::uint64_t kMaxPayload = (std::uint64_t{1} << 48) - 1;  ///< bytes; the header has 48 bits for it
inline constexpr std::uint32_t kMaxDepth = 65'536;                          ///< nested containers, including HEAD
inline constexpr std::uint32_t kMaxChunks = 0x7fff'ffff;                    ///< chunks in a file
inline constexpr std::uint32_t kMaxJoints = 65'000;     ///< joints of an object: in the worst case each is a level
inline constexpr std::uint32_t kMaxInfluences = 1'024;  ///< bones per vertex
inline constexpr std::uint32_t kNone = 0xffff'ffff;     ///< "none" in every 32-bit index field

}  // namespace bendy
