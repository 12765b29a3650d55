#pragma once

#include <bendy/format/document.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace bendy::cli {

/// Samples the tracks of a file's clips for drawing, through the runtime, whatever their encoding. The file's size
/// does not bound the work, since tracks may share keys: a budget of numbers does.
class CurveSampler {
public:
    /// Shares the budget among the tracks of all objects.
    explicit CurveSampler(std::span<const ObjectView> objects);

    /// The clips of an object: name, length, tracks with their values at some times; how many tracks were left out.
    nlohmann::ordered_json clips(const ObjectView& object);

    /// The lists of times that the tracks name by number.
    [[nodiscard]] nlohmann::ordered_json times() const;
    [[nodiscard]] std::size_t points_per_track() const { return points_; }
    /// Tracks that are drawn with fewer points than they have keys.
    [[nodiscard]] std::size_t thinned() const { return thinned_; }
    [[nodiscard]] std::size_t left_out() const { return left_out_; }

private:
    nlohmann::ordered_json sampled(const TrackView& track, const ClipView& clip, const ObjectView& object);
    /// Adds the tracks of a PACK, at some of its frames.
    void add_packed(const PackedView& packed, const ClipView& clip, const ObjectView& object,
                    nlohmann::ordered_json& tracks);
    static nlohmann::ordered_json packed_track(const PackedGroup& group, std::uint32_t track, std::uint32_t frames);
    std::size_t number_of(std::vector<float> times);

    std::map<std::vector<float>, std::size_t> numbers_;  // of the lists of times
    std::vector<std::vector<float>> lists_;
    std::uint64_t budget_;  // numbers that may still be sampled
    std::size_t points_ = 0;
    std::size_t thinned_ = 0;
    std::size_t left_out_ = 0;
};

}  // namespace bendy::cli
