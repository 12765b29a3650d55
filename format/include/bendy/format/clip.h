#pragma once

#include <bendy/format/curve.h>
#include <bendy/format/error.h>
#include <bendy/format/marker.h>
#include <bendy/format/mesh.h>
#include <bendy/format/packed_clip.h>
#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

// CYCL: a clip, with tracks of timed keys or of fixed frames.
namespace BENDY_PUBLIC bendy {

/// One animated property. Its key times are times[0 .. keys) or, for fixed frames, start + k / frame_rate. It has keys
/// * components values; three times as many for cubic interpolation: in-tangent, value, out-tangent of each key.
struct TrackView {
    TrackPath path = TrackPath::translation;
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t target = 0;  ///< joint; for weights: mesh
    std::uint32_t components = 0;
    std::uint32_t keys = 0;
    std::span<const float> times;  ///< seconds, ascending; empty for fixed frames
    std::span<const float> values;
};

struct ClipView {
    std::uint32_t chunk = 0;
    std::string_view name;
    float start = 0.0f;       ///< seconds
    float end = 0.0f;         ///< seconds
    float frame_rate = 0.0f;  ///< of `plays` and of tracks with fixed frames, per second
    bool loop = false;
    bool has_info = false;  ///< CINF was read
    std::vector<TrackView> tracks;
    std::optional<PackedView> packed;  ///< tracks that are not in `tracks`
    /// Frames of a mesh, one after another: frame k has full weight at start + k / frame_rate; between two frames the
    /// weight is split between them. `first` is an index in MeshView::frames(): first + frames, which is 1 or more,
    /// does not exceed their number. If `closed` is 1, the first frame follows the last one.
    std::vector<PlayRecord> plays;
    std::string_view extras;
    std::string_view more;        ///< JSON object, or empty
    std::vector<Marker> markers;  ///< ascending by seconds, possibly equal, in all files that pass check_clip_values
    std::vector<CurveView> curves;
};

/// Reads a CYCL chunk and makes all checks that memory safety depends on: keys inside TIME and KEYV, targets inside
/// `counts` and `meshes`, components that match the target. Faults are added to `faults`; a track or a curve with a
/// fault is left out.
/// \param counts  its `meshes` is the size of `meshes`
ClipView read_clip(const ChunkTree& tree, std::uint32_t chunk, const TargetCounts& counts,
                   std::span<const MeshView> meshes, Faults& faults);

/// Adds faults of content that do not affect memory safety: key times and markers that do not ascend or are outside
/// [start, end], numbers that are not finite, rotations that are not unit quaternions within kUnitTolerance, two tracks
/// for one property or with values that partly overlap. Takes time linear in the chunk's size, whatever the tracks
/// share.
void check_clip_values(const ChunkTree& tree, const ClipView& clip, Faults& faults);

inline constexpr float kUnitTolerance = 1e-4f;  ///< deviation of a quaternion's length from 1

}  // namespace bendy
