#pragma once

#include <bendy/diff/difference.h>
#include <bendy/format/document.h>

#include <memory>
#include <vector>

namespace bendy::diff {

/// A file that has been read and is valid.
struct ReadFile {
    ChunkTree tree;
    Document document;
    std::vector<UnpackedTrack> unpacked;              ///< the document's packed clips, as ordinary tracks
    std::vector<std::unique_ptr<StreamView>> frames;  ///< the streams of all frames in FRMS
    std::vector<const StreamView*> streams;           ///< by chunk number; null: no stream
    std::vector<const ClipView*> clips;               ///< by chunk number; null: no clip
    std::vector<const ObjectView*> objects;           ///< by chunk number; null: no object
};

/// Reads a file that passes bendy::validate. The views refer to `bytes` and to the result itself.
std::unique_ptr<ReadFile> read_file(Bytes bytes);

/// Thrown if tracks share keys in such a way that comparing them all would take forever; real files never do.
struct TooMuchToCompare {};

/// Returns everything in which two files differ, in A's order. Subtrees with equal sums are not compared further.
Differences compare_files(const ReadFile& a, const ReadFile& b);

}  // namespace bendy::diff
