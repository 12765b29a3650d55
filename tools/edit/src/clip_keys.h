#pragma once

#include "key_track.h"
#include "rewrite.h"

#include <bendy/format/document.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bendy::edit {

/// A track of a clip, to be changed; packed tracks become linear ones.
struct ClipTrack : KeyTrack {
    TrackPath path = TrackPath::translation;
    std::uint32_t target = 0;  ///< joint; for weights: mesh
    bool has_frames = false;   ///< keys at fixed frames: cleared by who changes the times
};

/// A curve of a clip, to be changed.
struct ClipCurve : KeyTrack {
    const CurveView* view = nullptr;
    std::uint32_t target = kNone;
    std::string name, path;
    bool has_new_keys = false;  ///< if false, the keys stay as they are, packed or not
};

struct ClipMarker {
    float seconds = 0.0f;
    std::string name;
};

/// The content of a clip, as ordinary numbers that can be changed.
struct ClipKeys {
    const ObjectView* object = nullptr;
    const ClipView* view = nullptr;
    float start = 0.0f, end = 0.0f;  ///< seconds
    bool loop = false;
    std::vector<ClipTrack> tracks;
    std::vector<ClipCurve> curves;
    std::vector<ClipMarker> markers;
    std::vector<PlayRecord> plays;
    std::uint32_t decoded = 0;  ///< number of tracks that were packed

    /// Calls visit(KeyTrack&) for all tracks and curves, whose times may change.
    template <class Visit>
    void change_keys(const Visit& visit) {
        for (ClipTrack& track : tracks) {
            track.has_frames = false;
            visit(static_cast<KeyTrack&>(track));
        }
        for (ClipCurve& curve : curves) {
            curve.has_new_keys = true;
            visit(static_cast<KeyTrack&>(curve));
        }
    }
};

/// A problem if tracks share their values in a way that makes them much larger than the file.
Result<ClipKeys, Problem> read_keys(const ChunkTree& tree, const ObjectView& object, const ClipView& clip);

/// Changes TRAK, PACK, PLAY, TIME, KEYV, CURV, MARK and CINF of the clip. A problem if a number is not finite or too
/// many keys have come together.
Result<void, Problem> write_keys(const ChunkTree& tree, const ClipKeys& keys, Rewrite& rewrite);

}  // namespace bendy::edit
