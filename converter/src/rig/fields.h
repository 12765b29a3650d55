#pragma once

#include "json_text.h"

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

/// In what unit a source gives angles: rig files for people in degrees, extras in radians.
enum class AngleUnit : bool { radians, degrees };

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

/// Both readers and writers of degrees use this, so that what was written comes back to the bit.
constexpr double to_radians(double degrees) {
    return degrees * kRadiansPerDegree;
}

// Rig files use kValueNames for the records' enumerations, except for these.
inline constexpr std::span<const std::string_view> kOrderNames = kShownNames<EulerOrder>;
inline constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};

/// The members of a JSON object, read one by one with their checks. Every reader fails at the member's path, and leaves
/// its target alone where the member is not there.
class Fields {
public:
    /// Fails where the value is no object or a member stands twice.
    Fields(const OrderedJson& object, std::string place, AngleUnit unit);

    [[nodiscard]] const std::string& place() const { return place_; }
    [[nodiscard]] std::string place_of(std::string_view key) const;
    /// The member, or null.
    const OrderedJson* find(std::string_view key);
    /// Fails if the member is not there.
    const OrderedJson& need(std::string_view key);
    /// Fails, naming it, on the first member that was never asked for.
    void refuse_others() const;

    void read(std::string_view key, std::string& text);
    /// true or false; 0 or 1 as well, as Blender writes them.
    void read(std::string_view key, bool& value);
    void read(std::string_view key, float& number, float low = -std::numeric_limits<float>::max(),
              float high = std::numeric_limits<float>::max());
    void read(std::string_view key, std::span<float> numbers, float low = -std::numeric_limits<float>::max(),
              float high = std::numeric_limits<float>::max());
    /// To radians.
    void read_angle(std::string_view key, float& angle);
    void read_angles(std::string_view key, std::span<float> angles);
    /// [minimum, maximum], null: free.
    void read_range(std::string_view key, float& low, float& high);
    /// The same, to radians.
    void read_angle_range(std::string_view key, float& low, float& high);
    /// Made a unit quaternion if it is none.
    void read_rotation(std::string_view key, std::array<float, 4>& rotation);
    void read_integer(std::string_view key, std::uint64_t most, std::uint64_t& number);
    /// The place of a word in a list.
    void read_word(std::string_view key, std::span<const std::string_view> words, std::uint8_t& number);

private:
    const OrderedJson& object_;
    std::string place_;
    AngleUnit unit_;
    std::vector<bool> is_read_;
    std::vector<std::string_view> asked_;  ///< literals
};

/// A JSON value in a message: short, in one line.
std::string shown(const OrderedJson& value);

/// A finite number of a float's range; fails at `place`. \param unit of angles: degrees become radians
float to_float(const OrderedJson& value, const std::string& place, AngleUnit unit = AngleUnit::radians);

/// `place` and the member's name.
std::string member(const std::string& place, std::string_view name);

/// The elements of a list; fails at `place` on another value.
const OrderedJson& need_list(const OrderedJson& value, const std::string& place);

}  // namespace bendy::converter
