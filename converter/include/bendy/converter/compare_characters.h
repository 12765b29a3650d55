#pragma once

#include <bendy/converter/error_bound.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bendy::converter {

/// One difference between two characters that exceeds the tolerance.
struct CharacterDifference {
    enum class Kind : std::uint8_t {
        only_in_a,
        only_in_b,
        value,    ///< `what` has both values
        distance  ///< something is `metres` away from its place in A
    };
    Kind kind = Kind::value;
    std::string place;    ///< for example joint "Hips"; mesh "Body", vertex 3, clip "Walk" at 0.250 s; as A has it
    std::string what;     ///< one line, or empty
    double metres = 0.0;  ///< for Kind::distance
};

/// The largest difference over all corners in one attribute that is not a length.
struct LookDifference {
    std::string place;  ///< mesh "Body", normals
    double apart = 0.0;
    double allowed = 0.0;
    std::string unit;  ///< "degrees", or empty for plain numbers
};

struct CharacterComparison {
    double tolerance = 0.0;       ///< metres
    std::optional<double> worst;  ///< metres: the largest distance found; nothing: not measured
    std::string worst_place;      ///< empty if nothing differs
    std::vector<LookDifference> looks;
    std::vector<CharacterDifference> differences;  ///< none: the characters are alike
    std::uint64_t left_out = 0;                    ///< number of further differences that are not listed
    /// So many parts lie within the tolerance of one another that they could not be matched.
    bool gave_up = false;
};

/// Compares the contents of two files, however they are stored: the same joints by name, at rest; the same clips by
/// name; the same polygons of each material, in any order and with any vertices. Every corner of a polygon is compared
/// where it is drawn: at rest, with every morph target at full weight, and in every clip as measure_error plays it.
/// Normals, tangents, texture coordinates, colours and other attributes have separate limits: 2 degrees, 1/1024 of the
/// range (colours: 1/128). Not compared: levels of detail, rigs, extras, and vertices that no primitive uses.
/// \param tolerance  a share is relative to A's height
/// \param progress   called with the fraction done, 0 to 1; may be empty
CharacterComparison compare_characters(const Scene& a, const Scene& b, const ErrorBound& tolerance,
                                       const std::function<void(double)>& progress = {});

}  // namespace bendy::converter
