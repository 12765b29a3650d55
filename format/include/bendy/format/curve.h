#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

// CURV: a named curve of a clip: an animated number, or up to four of them, that is neither a joint's transform nor a
// morph target's weight.
namespace BENDY_PUBLIC bendy {

/// How many things of each kind a curve can refer to.
struct TargetCounts {
    std::uint32_t joints = 0;     ///< of the object
    std::uint32_t materials = 0;  ///< HEAD's
    std::uint32_t meshes = 0;     ///< of the object
    std::uint32_t textures = 0;
};

/// A packed value is a whole number of so many steps, from the smallest of its component to the largest.
inline constexpr double kPackedCurveSteps = 65'535.0;

/// One curve. There are keys * components values; a cubic curve has three times as many: the in-tangent, value and
/// out-tangent of each key, `components` numbers each.
struct CurveView {
    std::uint32_t chunk = 0;
    std::string_view name;  ///< may be empty
    std::string_view path;  ///< of the property, relative to the target: "pbrMetallicRoughness/baseColorFactor"; a JSON
                            ///< pointer if there is no target; may be empty
    CurveTarget kind = CurveTarget::nothing;
    std::uint32_t target = kNone;  ///< joint, HEAD's material, mesh or texture, as `kind` says
    std::uint32_t components = 1;  ///< 1 to 4
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t keys = 0;                 ///< 1 or more
    std::span<const float> times;           ///< seconds, one a key; they ascend in files that pass check_curve_values
    std::span<const float> values;          ///< empty if packed
    std::span<const std::uint16_t> packed;  ///< empty unless packed; never of a cubic curve
    std::span<const float> box;  ///< if packed: the smallest value of each component, then the largest of each
    float max_error = 0.0f;      ///< largest difference between a stored value and the source's; 0 exact

    [[nodiscard]] bool is_packed() const { return !packed.empty(); }
    [[nodiscard]] std::size_t value_count() const { return is_packed() ? packed.size() : values.size(); }

    /// Number `index` of the values in the file's order, unpacked.
    [[nodiscard]] float value(std::size_t index) const {
        if (!is_packed()) return values[index];
        const double lowest = box[index % components];
        const double highest = box[components + index % components];
        return static_cast<float>(lowest + packed[index] * (highest - lowest) / kPackedCurveSteps);
    }
};

/// Reads a CURV's payload and checks all that memory safety hangs on: sizes, counts, enumerations, and that the target
/// is one of `counts`. Times and values lie in the payload, which starts at a multiple of 4 bytes. Nothing, and a fault
/// at `offset`, if it is no curve. `chunk` of the result is not set.
std::optional<CurveView> read_curve(Bytes payload, const TargetCounts& counts, std::uint64_t offset, Faults& faults);

/// The payload for the curve, which has `keys` times and as many values as these ask for, or as many packed ones and a
/// box. Its name and its path are less than 4 GiB each. `chunk` is not used.
std::vector<std::byte> write_curve(const CurveView& curve);

/// Faults of meaning that do not endanger memory: times that do not ascend, numbers that are not finite, an error below
/// zero.
void check_curve_values(const CurveView& curve, std::uint64_t offset, Faults& faults);

}  // namespace bendy
