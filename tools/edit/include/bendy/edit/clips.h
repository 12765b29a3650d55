#pragma once

#include <bendy/edit/edit.h>

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Changes to clips, track by track: keys that need not change keep their numbers. Clips are those of all objects; see
// find_named. Packed tracks of a changed clip become ordinary ones, with a warning.
namespace bendy::edit {

enum class ClipWork : std::uint8_t {
    keep,         ///< strips all other clips
    copy,         ///< adds a clip of another name, after the original
    trim,         ///< keeps a part, which then begins at 0; the ends of the part get keys that lie on the curves
    resample,     ///< one linear key per frame, and one at the end; tracks that step or have a single key stay
    mirror,       ///< left to right; roles, or names, say which joints, meshes and morph targets are pairs
    loop,         ///< the end becomes equal to the start, by a drift of the last seconds, and the clip repeats
    root_motion,  ///< the movement over the ground goes from a joint to one above it, or is taken out
    on_the_spot   ///< its way over the ground is taken out, and what sways and pulses about that way stays
};

struct ClipChange {
    ClipWork work = ClipWork::keep;
    std::vector<std::string> clips;  ///< several only for `keep`
    std::string name;                ///< of a copy; a `*` stands for what the one in `clips` matched
    double from = -std::numeric_limits<double>::infinity();  ///< seconds on the clip's time line; beyond it, its start
    double to = std::numeric_limits<double>::infinity();     ///< the same for its end
    double rate = 0.0;                                       ///< keys per second
    double blend = 0.0;                                      ///< seconds, above 0: how long the drift of `loop` takes
    double window = 0.0;     ///< seconds over which the way of `on_the_spot` is averaged; 0: one cycle of the clip
    std::string from_joint;  ///< that moves over the ground; empty: the highest one that moves, down to the hips
    std::string to_joint;    ///< that moves instead; empty: none
};

/// A change as an option of `bendy edit` names it.
struct ClipWord {
    ClipWork work;
    std::string_view word;   ///< "trim"
    std::string_view shape;  ///< "CLIP=A..B"
    std::string_view help;
};
std::span<const ClipWord> clip_words();

/// Parses what follows a word, as in "trim" and "Run=0.5..1.2".
/// \param texts  one, or several for "keep-clip"
Result<ClipChange, Problem> parse_clip_change(std::string_view word, std::span<const std::string> texts);

/// Returns the file with its clips changed. A name that matches no clip is a problem, as are times outside a clip, a
/// rate beyond 0.001 to 10,000 per second, and a clip that would become larger than 1 GiB.
Edited change_clips(Bytes file, const ClipChange& what, Log& log);

/// Returns the file in which no vertex has more than `most` influences, 1 or more: those with the largest weights,
/// scaled so that their sum is what it was. Meshes that have no more keep their bytes.
Edited limit_influences(Bytes file, std::uint32_t most, Log& log);

}  // namespace bendy::edit
