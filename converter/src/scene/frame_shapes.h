#pragma once

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

// Targets that are frames hold absolute shapes; these functions convert them to displacements.

/// The index of the first frame among the mesh's targets.
inline std::uint32_t first_frame(const Mesh& mesh) {
    const auto frame =
        std::find_if(mesh.targets.begin(), mesh.targets.end(), [](const MorphTarget& t) { return t.is_frame; });
    return static_cast<std::uint32_t>(frame - mesh.targets.begin());
}

inline bool has_frames(const Mesh& mesh) {
    return !mesh.targets.empty() && mesh.targets.back().is_frame;
}

/// A vertex's displacement at full weight of the target.
/// \param stream  the target's stream, not empty
/// \param own     the mesh's stream of the same kind
template <class Vector>
glm::dvec3 shift_of(const MorphTarget& target, const std::vector<glm::vec3>& stream, const std::vector<Vector>& own,
                    std::size_t vertex) {
    const glm::dvec3 there(stream[vertex]);
    return target.is_frame ? there - glm::dvec3(own[vertex]) : there;
}

/// The displacements of all vertices, as floats; empty if the target or the mesh has no such stream.
inline std::vector<glm::vec3> shifts_of(const MorphTarget& target, const std::vector<glm::vec3>& stream,
                                        const std::vector<glm::vec3>& own) {
    if (!target.is_frame) return stream;
    std::vector<glm::vec3> shifts;
    if (own.empty()) return shifts;
    shifts.reserve(stream.size());
    for (std::size_t vertex = 0; vertex < stream.size(); ++vertex)
        shifts.emplace_back(shift_of(target, stream, own, vertex));
    return shifts;
}

/// Seconds from the first frame to the end of the last one.
inline double length_of(const Clip& clip, const Play& play) {
    return (play.frames - 1.0 + (play.closed ? 1.0 : 0.0)) / clip.frame_rate;
}

/// Two frames, numbered like Play::first, and the second one's weight.
struct FramePair {
    std::uint32_t left = 0, right = 0;
    double fraction = 0.0;
};

inline FramePair frames_at(const Clip& clip, const Play& play, double seconds) {
    const double at = (seconds - clip.frame_start) * clip.frame_rate;
    const std::uint32_t last = play.closed ? play.frames : play.frames - 1;  // in frames from the first one
    const double held = std::clamp(at, 0.0, static_cast<double>(last));
    const auto left = static_cast<std::uint32_t>(held);
    const auto number = [&](std::uint32_t frame) { return play.first + frame % play.frames; };
    return {number(left), number(std::min(left + 1, last)), held - left};
}

/// The span of the keys of tracks and frames, without packed tracks; nothing if there are none.
inline std::optional<ClipSpan> span_of_tracks(const Clip& clip) {
    std::optional<ClipSpan> span;
    const auto add = [&](float start, float end) {
        span = span ? ClipSpan{std::min(span->start, start), std::max(span->end, end)} : ClipSpan{start, end};
    };
    for (const Track& track : clip.tracks) add(track.times.front(), track.times.back());
    for (const Play& play : clip.plays)
        add(clip.frame_start, static_cast<float>(clip.frame_start + length_of(clip, play)));
    return span;
}

/// As above, with curves; zeros if there are no keys.
inline ClipSpan span_of_keys(const Clip& clip) {
    std::optional<ClipSpan> span = span_of_tracks(clip);
    for (const Curve& curve : clip.curves) {
        const ClipSpan own{curve.times.front(), curve.times.back()};
        span = span ? ClipSpan{std::min(span->start, own.start), std::max(span->end, own.end)} : own;
    }
    return span.value_or(ClipSpan());
}

/// The clip's span: from its first to its last key, or as stated.
inline ClipSpan span_of(const Clip& clip) {
    const ClipSpan keys = span_of_keys(clip);
    if (!clip.stated_span) return keys;
    if (clip.tracks.empty() && clip.plays.empty() && clip.curves.empty()) return *clip.stated_span;
    return {std::min(keys.start, clip.stated_span->start), std::max(keys.end, clip.stated_span->end)};
}

}  // namespace bendy::converter
