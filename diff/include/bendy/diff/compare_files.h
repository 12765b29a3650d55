#pragma once

#include <bendy/diff/difference.h>
#include <bendy/format/document.h>

#include <memory>
#include <vector>

namespace bendy::diff {

/// A good file, read.
struct ReadFile {
    ChunkTree tree;
    Document document;
    std::vector<UnpackedTrack> unpacked;              ///< what the document's packed clips hold, as tracks of theirs
    std::vector<std::unique_ptr<StreamView>> frames;  ///< streams of FRMS, all frames together
    std::vector<const StreamView*> streams;           ///< by chunk number; null: no stream
    std::vector<const ClipView*> clips;               ///< by chunk number; null: no clip
    std::vector<const ObjectView*> objects;           ///< by chunk number; null: no object
};

/// Reads a file that passes bendy::validate. The views refer to `bytes` and to the result itself.
std::unique_ptr<ReadFile> read_file(Bytes bytes);

/// Thrown where tracks share keys so that comparing them all would take for ever: no real file does.
struct TooMuchToCompare {};

/// Everything in which two files differ, in A's order. Where sums are equal it does not look further.
Differences compare_files(const ReadFile& a, const ReadFile& b);

}  // namespace bendy::diff
