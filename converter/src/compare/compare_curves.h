#pragma once

#include <bendy/converter/compare_characters.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter {

/// What B's things are in A, by number; kNone: nothing.
struct CurveTargets {
    std::span<const std::uint32_t> joints, materials, meshes;
};

struct CurveDifference {
    CharacterDifference::Kind kind = CharacterDifference::Kind::value;
    std::string curve;  ///< `curve "FootDown"`
    std::string what;
};

/// Compares the curves of two clips by what they animate: those that only one has, names, components, and values at
/// every key of either and half-way between keys. Values may be one step of their component's range / 65535 apart.
std::vector<CurveDifference> compare_curves(const Scene& a, const Clip& clip_a, const Scene& b, const Clip& clip_b,
                                            const CurveTargets& targets);

}  // namespace bendy::converter
