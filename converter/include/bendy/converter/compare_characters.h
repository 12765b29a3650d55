#pragma once

#include <bendy/converter/error_bound.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bendy::converter {

/// One thing in which two characters differ by more than they may.
struct CharacterDifference {
    enum class Kind : std::uint8_t {
        only_in_a,
        only_in_b,
        value,    ///< `what` has both values
        distance  ///< something is `metres` away from where it should be
    };
    Kind kind = Kind::value;
    std::string place;    ///< for example joint "Hips"; mesh "Body", vertex 3, clip "Walk" at 0.250 s; as A has it
    std::string what;     ///< one line, or empty
    double metres = 0.0;  ///< of a distance
};

/// How far apart what looks alike is, where that has no length: the largest of all corners.
struct LookDifference {
    std::string place;  ///< mesh "Body", normals
    double apart = 0.0;
    double allowed = 0.0;
    std::string unit;  ///< "degrees", or empty: numbers
};

struct CharacterComparison {
    double tolerance = 0.0;       ///< metres
    std::optional<double> worst;  ///< metres: the farthest that anything is from where it should be; none: not measured
    std::string worst_place;      ///< empty where nothing is
    std::vector<LookDifference> looks;
    std::vector<CharacterDifference> differences;  ///< none: the characters are alike
    std::uint64_t left_out = 0;                    ///< further differences that are not listed
    /// So much lies within the tolerance of everything that what belongs together was not found.
    bool gave_up = false;
};

/// Compares what two files mean, however it is stored: the same joints by name, at rest; the same clips by name; the
/// same polygons of each material, in whatever order and with whatever vertices. Every corner of a polygon is compared
/// where it is drawn: at rest, with every morph target at full weight, and in every clip as measure_error
/// plays it. Normals, tangents, texture coordinates, colours and other attributes have limits of their own:
/// 2 degrees, 1/1024 of the range (colours: 1/128). Not compared: levels of detail, rigs, extras, vertices that nothing
/// is drawn of.
/// \param tolerance  a share is one of A's height
/// \param progress   is told the part that is done, 0 to 1; may be empty
CharacterComparison compare_characters(const Scene& a, const Scene& b, const ErrorBound& tolerance,
                                       const std::function<void(double)>& progress = {});

}  // namespace bendy::converter
