#pragma once

#include <bendy/format/marker.h>
#include <bendy/format/public.h>
#include <bendy/runtime/playback.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

// Markers that a walk meets: footsteps, hits, the moment when a hand lets go.
namespace BENDY_PUBLIC bendy {

/// Those of a stretch: `markers` ascend by seconds. In the order of the time line, whichever way it was walked.
[[nodiscard]] std::span<const Marker> markers_in(std::span<const Marker> markers, const TimeSpan& span);

/// How many a walk meets; passes are counted, not walked.
[[nodiscard]] std::uint64_t count_markers(std::span<const Marker> markers, const PlayedInterval& played);

/// Calls visit(marker) for each that the walk meets, in the order in which it meets them. Each is met once in a pass:
/// one at the start as playing begins there, one at the end as it gets there, one where ping_pong turns as it turns. A
/// visit that gives back bool ends it with false. Takes as long as there are markers to be met: see count_markers.
/// \param markers  ascending by seconds; those outside what is played are never met
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

/// The first of them, as many as `met` takes, into the caller's memory. How many were written.
[[nodiscard]] std::size_t collect_markers(std::span<const Marker> markers, const PlayedInterval& played,
                                          std::span<const Marker*> met);

}  // namespace bendy
