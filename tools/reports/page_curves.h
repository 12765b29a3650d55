#pragma once

#include <bendy/format/document.h>
#include <bendy/json/json.h>

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace bendy::tools {

/// Samples the tracks of a file's clips for drawing, through the runtime, whatever their encoding. Tracks may share
/// keys, so the file's size does not bound the work: a budget of numbers does.
class CurveSampler {
public:
    /// Shares the budget among the tracks of all objects.
    explicit CurveSampler(std::span<const ObjectView> objects);

    /// Returns the clips of an object: name, length, tracks with their values at some times, and the number of tracks
    /// left out.
    OrderedJson clips(const ObjectView& object);

    /// Returns the lists of times that the tracks refer to by number.
    [[nodiscard]] OrderedJson times() const;
    [[nodiscard]] std::size_t points_per_track() const { return points_; }
    /// The number of tracks drawn with fewer points than they have keys.
    [[nodiscard]] std::size_t thinned() const { return thinned_; }
    [[nodiscard]] std::size_t left_out() const { return left_out_; }

private:
    OrderedJson sampled(const TrackView& track, const ClipView& clip, const ObjectView& object);
    /// Adds the tracks of a PACK, at some of its frames.
    void add_packed(const PackedView& packed, const ClipView& clip, const ObjectView& object, OrderedJson& tracks);
    static OrderedJson packed_track(const PackedGroup& group, std::uint32_t track, std::uint32_t frames);
    std::size_t number_of(std::vector<float> times);

    std::map<std::vector<float>, std::size_t> numbers_;  // numbers of the lists of times
    std::vector<std::vector<float>> lists_;
    std::uint64_t budget_;  // numbers that may still be sampled
    std::size_t points_ = 0;
    std::size_t thinned_ = 0;
    std::size_t left_out_ = 0;
};

}  // namespace bendy::tools
