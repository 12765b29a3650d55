#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/error.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

// CURV: a named curve of a clip: one to four animated numbers other than a joint's transform or a morph target's
// weight.
namespace BENDY_PUBLIC bendy {

/// The number of things of each kind that a curve can refer to.
struct TargetCounts {
    std::uint32_t joints = 0;     ///< of the object
    std::uint32_t materials = 0;  ///< of HEAD
    std::uint32_t meshes = 0;     ///< of the object
    std::uint32_t textures = 0;
};

/// Packed values are integers from 0 to this number, from the smallest value of the component to the largest.
inline constexpr double kPackedCurveSteps = 65'535.0;

/// The path of a curve that holds a VRM expression's weight: the X of its joint's translation, whose track the clip has
/// too. Such a joint has no place in the body.
inline constexpr std::string_view kExpressionPath = "translation/0";

/// A curve. It has keys * components values; a cubic curve has three times as many: the in-tangent, value and
/// out-tangent of each key, `components` numbers each.
struct CurveView {
    std::uint32_t chunk = 0;
    std::string_view name;  ///< may be empty
    std::string_view path;  ///< path of the property relative to the target: "pbrMetallicRoughness/baseColorFactor"; a
                            ///< JSON pointer for a curve without a target; may be empty
    CurveTarget kind = CurveTarget::nothing;
    std::uint32_t target = kNone;  ///< joint, material in HEAD, mesh or texture, depending on `kind`
    std::uint32_t components = 1;  ///< 1 to 4
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t keys = 0;                 ///< 1 or more
    std::span<const float> times;           ///< seconds, one per key; ascending in files that pass check_curve_values
    std::span<const float> values;          ///< empty if packed
    std::span<const std::uint16_t> packed;  ///< empty unless packed; never for a cubic curve
    std::span<const float> box;  ///< if packed: the smallest value of each component, then the largest of each
    float max_error = 0.0f;      ///< largest difference between a stored value and the source's; 0: exact

    [[nodiscard]] bool is_packed() const { return !packed.empty(); }
    [[nodiscard]] std::size_t value_count() const { return is_packed() ? packed.size() : values.size(); }

    /// Returns value number `index` in file order, unpacked.
    [[nodiscard]] float value(std::size_t index) const {
        if (!is_packed()) return values[index];
        const double lowest = box[index % components];
        const double highest = box[components + index % components];
        return static_cast<float>(lowest + packed[index] * (highest - lowest) / kPackedCurveSteps);
    }
};

/// Reads the payload of a CURV and makes all checks that memory safety depends on: sizes, counts, enumerations, and
/// that the target is one of `counts`. Times and values refer to the payload, which must be aligned to 4 bytes. If it
/// is not a valid curve, adds a fault at `offset` and returns nothing. Does not set `chunk` in the result.
std::optional<CurveView> read_curve(Bytes payload, const TargetCounts& counts, std::uint64_t offset, Faults& faults);

/// Returns the payload for a curve, which has `keys` times and the corresponding number of values, or of packed values
/// and a box. Name and path must each be shorter than 4 GiB. `chunk` is not used.
std::vector<std::byte> write_curve(const CurveView& curve);

/// Adds faults of content that do not affect memory safety: times that do not ascend, numbers that are not finite, a
/// negative error.
void check_curve_values(const CurveView& curve, std::uint64_t offset, Faults& faults);

}  // namespace bendy
