#pragma once

#include <bendy/diff/compare_files.h>
#include <bendy/format/leaf_parts.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace bendy::diff {

/// Compares the contents of chunks that are already paired.
class ContentComparer {
public:
    static constexpr std::uint64_t kMostSteps = 4'000'000'000;

    ContentComparer(const ReadFile& a, const ReadFile& b, Differences& differences)
        : a_(a), b_(b), differences_(differences) {}

    void compare_leaves(ChunkPair leaves);
    /// Compares two CYCL chunks track by track; a track is identified by what it animates. This covers their TRAK,
    /// PACK, TIME and KEYV.
    void compare_clips(ChunkPair clips);

private:
    // For kinds whose numbers need interpretation: compare_content.cpp.
    void compare_streams(ChunkPair leaves, const StreamView& a, const StreamView& b);
    void compare_collapses(ChunkPair leaves, const CollapseView& a, const CollapseView& b);
    void compare_markers(ChunkPair leaves, const ClipView& a, const ClipView& b);
    void compare_roles(ChunkPair leaves, const ObjectView& a, const ObjectView& b);
    void compare_tracks(ChunkPair clips, const std::string& name, const TrackView& a, const TrackView& b);

    // For all other kinds, as described by leaf_parts.def: compare_parts.cpp.
    void compare_parts(ChunkPair leaves);
    void compare_fields(ChunkPair leaves, const std::string& prefix, const RecordLayout& layout, Bytes a, Bytes b);
    void compare_field(ChunkPair leaves, const std::string& prefix, const RecordField& field, Bytes a, Bytes b);
    void compare_records(ChunkPair leaves, const LocatedPart& a, const LocatedPart& b);
    void compare_number_parts(ChunkPair leaves, const LocatedPart& a, const LocatedPart& b);
    void compare_names(ChunkPair leaves, const LeafPart& part, Bytes a, Bytes b);
    void compare_bytes(ChunkPair leaves, Bytes a, Bytes b);
    [[nodiscard]] std::string row_name(ChunkPair leaves, const LeafPart& part, std::uint64_t row) const;
    static std::string joint_name(const ObjectView* object, std::uint64_t joint);

    using NumberAt = std::function<double(std::uint64_t)>;
    void compare_numbers(ChunkPair chunks, const std::string& part, std::uint64_t count, std::uint64_t components,
                         const NumberAt& a, const NumberAt& b, bool are_whole = false);
    void compare_spans(ChunkPair chunks, const std::string& part, std::uint32_t components, std::span<const float> a,
                       std::span<const float> b);
    void add_value(ChunkPair chunks, std::string part, Value a, Value b);
    void take(std::uint64_t steps);

    const ReadFile& a_;
    const ReadFile& b_;
    Differences& differences_;
    std::uint64_t effort_ = kMostSteps;
};

}  // namespace bendy::diff
