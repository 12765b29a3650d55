#pragma once

#include <bendy/format/marker.h>
#include <bendy/format/public.h>
#include <bendy/runtime/playback.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

// Markers that playback passes: footsteps, hits, the moment when a hand lets go.
namespace BENDY_PUBLIC bendy {

/// Returns the markers in a span of time, in time line order, whichever direction it was played in. `markers` must be
/// ascending by seconds.
[[nodiscard]] std::span<const Marker> markers_in(std::span<const Marker> markers, const TimeSpan& span);

/// Returns the number of markers that an interval passes. Whole passes are multiplied, not iterated.
[[nodiscard]] std::uint64_t count_markers(std::span<const Marker> markers, const PlayedInterval& played);

/// Calls visit(marker) for each marker that the interval passes, in playback order. Each is visited once per pass: one
/// at the start when playback begins there, one at the end when playback reaches it, one at a turn of ping_pong when it
/// turns. A visit that returns bool stops the iteration with false. Takes time linear in the number of visits: see
/// count_markers.
/// \param markers  ascending by seconds; those outside the played range are never visited
template <class Visit>
void visit_markers(std::span<const Marker> markers, const PlayedInterval& played, const Visit& visit) {
    const auto visit_one = [&](const Marker& marker) {
        if constexpr (std::is_same_v<decltype(visit(marker)), bool>) return visit(marker);
        visit(marker);
        return true;
    };
    const auto visit_span = [&](const TimeSpan& span) {
        const auto met = markers_in(markers, span);
        for (std::size_t k = 0; k < met.size(); ++k) {
            if (!visit_one(span.to < span.from ? met[met.size() - 1 - k] : met[k])) return false;
        }
        return true;
    };
    if (!visit_span(played.first)) return;
    const bool is_met = !markers_in(markers, played.whole(0)).empty() || !markers_in(markers, played.whole(1)).empty();
    for (std::uint64_t k = 0; is_met && k < played.passes; ++k) {
        if (!visit_span(played.whole(k))) return;
    }
    visit_span(played.last);
}

/// Copies the first of these markers, as many as `met` has room for. Returns how many were written.
[[nodiscard]] std::size_t collect_markers(std::span<const Marker> markers, const PlayedInterval& played,
                                          std::span<const Marker*> met);

}  // namespace bendy
