#pragma once

#include "scene/json_text.h"

#include <bendy/format/records.h>

#include <array>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter {

/// How a source writes records. Angles are degrees in rig files, which people edit, and radians elsewhere. glTF
/// extensions have keys and words in glTF's camelCase.
enum class Notation : std::uint8_t { rig_file, extras, gltf };

/// A key or word of rig files in the notation: `soft_zone` is `softZone` in glTF.
std::string spelled(std::string_view word, Notation notation);

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

/// Used by both readers and writers of degrees, so that written angles are read back bit for bit.
constexpr double to_radians(double degrees) {
    return degrees * kRadiansPerDegree;
}

// Names in rig files come from kValueNames, except for these.
inline constexpr std::span<const std::string_view> kOrderNames = kShownNames<EulerOrder>;
inline constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};

/// Reads the members of a JSON object one by one, with checks. Keys and words are given as in rig files. Every function
/// fails at the member's path, and leaves its target unchanged if the member is missing.
class Fields {
public:
    /// Fails if the value is not an object or a member occurs twice.
    Fields(const OrderedJson& object, std::string place, Notation notation);

    [[nodiscard]] const std::string& place() const { return place_; }
    [[nodiscard]] Notation notation() const { return notation_; }
    [[nodiscard]] std::string place_of(std::string_view key) const;
    /// The member, or null.
    const OrderedJson* find(std::string_view key);
    /// Fails if the member is missing.
    const OrderedJson& need(std::string_view key);
    /// Fails at the first member that was never asked for, naming it.
    void refuse_others() const;

    void read(std::string_view key, std::string& text);
    /// true or false; also 0 or 1, as Blender writes them.
    void read(std::string_view key, bool& value);
    void read(std::string_view key, float& number, float low = -std::numeric_limits<float>::max(),
              float high = std::numeric_limits<float>::max());
    void read(std::string_view key, std::span<float> numbers, float low = -std::numeric_limits<float>::max(),
              float high = std::numeric_limits<float>::max());
    /// Converts to radians.
    void read_angle(std::string_view key, float& angle);
    void read_angles(std::string_view key, std::span<float> angles);
    /// [minimum, maximum]; null means free.
    void read_range(std::string_view key, float& low, float& high);
    /// As above, converted to radians.
    void read_angle_range(std::string_view key, float& low, float& high);
    /// Normalises the quaternion if necessary.
    void read_rotation(std::string_view key, std::array<float, 4>& rotation);
    void read_integer(std::string_view key, std::uint64_t most, std::uint64_t& number);
    /// Finds the index of a word in a list.
    void read_word(std::string_view key, std::span<const std::string_view> words, std::uint8_t& number);

private:
    const OrderedJson& object_;
    std::string place_;
    Notation notation_;
    std::vector<bool> is_read_;
    std::vector<std::string_view> asked_;  ///< literals
};

/// A JSON value for a message: short, on one line.
std::string shown(const OrderedJson& value);

/// A finite number in the range of float; fails at `place`.
/// \param notation  of an angle: degrees are converted to radians
float to_float(const OrderedJson& value, const std::string& place, Notation notation = Notation::extras);

/// `place` and the member's name.
std::string member(const std::string& place, std::string_view name);

/// The elements of a list; fails at `place` if the value is not a list.
const OrderedJson& need_list(const OrderedJson& value, const std::string& place);

}  // namespace bendy::converter
