#include <bendy/runtime/markers.h>

#include <algorithm>

namespace bendy {

std::span<const Marker> markers_in(std::span<const Marker> markers, const TimeSpan& span) {
    if (span.is_empty()) return {};
    const bool is_back = span.to < span.from;
    const double low = is_back ? span.to : span.from;
    const double high = is_back ? span.from : span.to;
    const bool has_low = !is_back || span.has_end;
    const bool has_high = is_back || span.has_end;
    const auto before = [](const Marker& marker, double seconds) { return double{marker.seconds} < seconds; };
    const auto after = [](double seconds, const Marker& marker) { return seconds < double{marker.seconds}; };
    const auto begin = has_low ? std::lower_bound(markers.begin(), markers.end(), low, before)
                               : std::upper_bound(markers.begin(), markers.end(), low, after);
    const auto end = has_high ? std::upper_bound(begin, markers.end(), high, after)
                              : std::lower_bound(begin, markers.end(), high, before);
    return {begin, end};
}

std::uint64_t count_markers(std::span<const Marker> markers, const PlayedInterval& played) {
    const std::uint64_t back = played.turns ? played.passes / 2 : 0;
    return markers_in(markers, played.first).size() +
           (played.passes - back) * markers_in(markers, played.whole(0)).size() +
           back * markers_in(markers, played.whole(1)).size() + markers_in(markers, played.last).size();
}

std::size_t collect_markers(std::span<const Marker> markers, const PlayedInterval& played,
                            std::span<const Marker*> met) {
    std::size_t count = 0;
    if (met.empty()) return count;
    visit_markers(markers, played, [&](const Marker& marker) {
        met[count++] = &marker;
        return count < met.size();
    });
    return count;
}

}  // namespace bendy
