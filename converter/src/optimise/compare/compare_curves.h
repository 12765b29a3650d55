#pragma once

#include <bendy/converter/compare_characters.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bendy::converter {

/// Maps numbers of things in B to those in A; kNone: no counterpart.
struct CurveTargets {
    std::span<const std::uint32_t> joints, materials, meshes;
};

struct CurveDifference {
    CharacterDifference::Kind kind = CharacterDifference::Kind::value;
    std::string curve;  ///< `curve "FootDown"`
    std::string what;
};

/// Compares the curves of two clips by what they animate: curves that only one has, names, components, and values at
/// every key of either and halfway between keys. Values may differ by one step of their component's range / 65535.
std::vector<CurveDifference> compare_curves(const Scene& a, const Clip& clip_a, const Scene& b, const Clip& clip_b,
                                            const CurveTargets& targets);

}  // namespace bendy::converter
