#pragma once

#include "difference.h"

#include <bendy/format/document.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace bendy::cli {

/// A good file, read.
struct ReadFile {
    ChunkTree tree;
    Document document;
    std::vector<UnpackedTrack> unpacked;              ///< what the document's packed cycles hold, as tracks of theirs
    std::vector<std::unique_ptr<StreamView>> frames;  ///< streams of FRMS, all frames together
    std::vector<const StreamView*> streams;           ///< by chunk number; null: no stream
    std::vector<const CycleView*> cycles;             ///< by chunk number; null: no cycle
    std::vector<const TargetView*> targets;    ///< by chunk number; null: no target, or one that displaces nothing
    std::vector<const PaletteView*> palettes;  ///< by chunk number; null: no palette
    std::vector<const ObjectView*> tables;     ///< of JNTS, JNAM and LODD, by chunk number: whose they are; else null
};

/// Thrown where tracks share keys so that comparing them all would take for ever: no real file does.
struct TooMuchToCompare {};

/// Compares what is in chunks that are paired already.
class ContentComparer {
public:
    static constexpr std::uint64_t kMostSteps = 4'000'000'000;

    /// \param tolerance  of floats and of decoded streams, absolute. With one, only meaning counts: numbers may be
    ///                   stored in another type or encoding. Without, everything counts.
    ContentComparer(const ReadFile& a, const ReadFile& b, std::optional<double> tolerance, Differences& differences)
        : a_(a), b_(b), tolerance_(tolerance), differences_(differences) {}

    void compare_leaves(ChunkPair leaves);
    /// Compares two CYCL chunks track by track, a track being known by what it animates. Their TRAK, TIME and KEYV are
    /// done with this.
    void compare_cycles(ChunkPair cycles);
    /// Compares two TARG chunks vertex by vertex, whichever of them name the touched ones. Their INDX, POSI, NORM and
    /// TANG are done with this. Needs a tolerance.
    void compare_targets(ChunkPair targets);

private:
    void compare_streams(ChunkPair leaves, const StreamView& a, const StreamView& b);
    void compare_palettes(ChunkPair leaves);
    void compare_joint_tables(ChunkPair leaves);
    void compare_joint_names(ChunkPair leaves);
    void compare_collapses(ChunkPair leaves);
    void compare_markers(ChunkPair leaves, const CycleView& a, const CycleView& b);
    void compare_fields(ChunkPair leaves);
    void compare_bytes(ChunkPair leaves, Bytes a, Bytes b);
    void compare_displacements(ChunkPair targets, const std::string& part, const StreamView* a_vertices,
                               const StreamView* a, const StreamView* b_vertices, const StreamView* b);
    void compare_tracks(ChunkPair cycles, const std::string& name, const TrackView& a, const TrackView& b);
    void compare_samples(ChunkPair cycles, const std::string& name, const TrackView& a, const TrackView& b);
    using NumberAt = std::function<double(std::uint64_t)>;
    void compare_numbers(ChunkPair chunks, const std::string& part, std::uint64_t count, std::uint32_t components,
                         const NumberAt& a, const NumberAt& b);
    void compare_spans(ChunkPair chunks, const std::string& part, std::uint32_t components, std::span<const float> a,
                       std::span<const float> b);
    void add_value(ChunkPair chunks, std::string part, nlohmann::ordered_json a, nlohmann::ordered_json b);
    void take(std::uint64_t steps);
    [[nodiscard]] bool is_near(double a, double b) const;

    const ReadFile& a_;
    const ReadFile& b_;
    std::optional<double> tolerance_;
    Differences& differences_;
    std::uint64_t effort_ = kMostSteps;
};

}  // namespace bendy::cli
