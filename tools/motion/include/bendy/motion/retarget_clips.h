#pragma once

#include <bendy/edit/edit.h>
#include <bendy/format/byte_reader.h>
#include <bendy/runtime/retarget.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Clips of one character on another one, from file to file.
namespace bendy::motion {

/// Their words for users, by number.
inline constexpr std::array<std::string_view, 3> kLimitsWords{"soft", "hard", "off"};
/// Returns nothing for any other word.
std::optional<Limits> parse_limits(std::string_view word);

struct RetargetClips {
    std::string clip{};  ///< which of the other file's clips: see edit::find_named; empty: all of them
    RetargetOptions retarget{};
    edit::SameName same_name = edit::SameName::error;
    /// Between animals on four legs, takes RestPoses::alike in place of those of `retarget` if feet miss their places,
    /// or hips are lowered, by more than kFarMiss, and by less than kBetter of that then; says so.
    bool chooses_rests = false;
};

/// A number of a clip where it is largest.
struct Worst {
    std::string joint{};  ///< of the target; empty: nowhere
    float seconds = 0.0f;
    double amount = 0.0;
};

/// A joint whose own rotation jumps: see kPopTurn. The amount is its largest turn in kPopSeconds, in radians.
struct Pop : Worst {
    double of_source = 0.0;  ///< the most that any joint of the source turns in that time in its clip
};

/// A clip on its new character, in numbers. Angles in radians, distances in metres.
struct RetargetedClip {
    std::string clip{};  ///< its name in the source
    std::size_t frames = 0;
    std::size_t limited = 0;  ///< frames in which a limit acts
    double mean_off = 0.0;    ///< between directions of bones and the source's
    Worst off{};              ///< the same, where it is largest
    Worst missed{};           ///< by what a hand or foot misses its place
    double lowered = 0.0;     ///< hips, at most, so that feet reach the ground
    double mean_error = 0.0;  ///< between the keys that are stored and what was computed
    double error = 0.0;
    std::vector<Pop> pops{};  ///< one for each joint that pops
};

/// Appends clips of another file's character to this file's first object, retargeted (bendy/runtime/retarget.h). Both
/// need roles. Everything that a clip has comes along: its markers, its named curves, its weights of morph targets.
///
/// Joints whose numbers are the source's in every frame keep its tracks, byte for byte; the others have linear tracks
/// with as few keys as keep every rotation within kMostTurned (or kMostTurnedFree) and every translation within
/// kMostMoved of the legs' length. How far joints are from where Retarget has them, also between the keys, is measured
/// and reported. A joint that would jump where the source does not, from one end of its limits to the other or from one
/// side of a straight leg to the other, begins to turn before and ends after, at kTurnSpeed beyond kOfSource times the
/// source's largest turn.
///
/// The result is measured against the source, too: the angles between the directions of bones that both bodies have.
/// Warnings name the worst that point elsewhere by more than kFarOfLimb or kFarOfOthers, why they do, and what changes
/// it; feet and hands that miss their places, and hips that are lowered, by more than kFarMiss; joints that pop.
///
/// How firmly heels and toes stand comes with the clip as the curves left_heel_contact, left_toes_contact,
/// right_heel_contact and right_toes_contact, from 0 in the air to 1 on the ground. Where the source's clip has one of
/// them, they are taken from it and are not looked for.
///
/// A clip that animates nothing that has a counterpart is left out with a warning. A problem, if none is left: no
/// clips, no clip of that name, a character without roles, bodies of different kinds, a name that exists already,
/// numbers that are not finite.
/// \param numbers  if given, receives those of each clip
edit::Edited retarget_clips(Bytes file, Bytes other, const RetargetClips& options, edit::Log& log,
                            std::vector<RetargetedClip>* numbers = nullptr);

inline constexpr double kMostTurned = 0.00004;  ///< radians
inline constexpr double kMostTurnedFree =
    0.000004;                                 ///< without limits and planted feet, where keys of the source are exact
inline constexpr double kMostMoved = 0.0001;  ///< of the length of the legs
inline constexpr double kHardLegSpeed =
    16.0;  ///< radians a second: kTurnSpeed of legs under hard limits, whose feet stand
inline constexpr double kMostWeight = 0.002;  ///< of a morph target, of a contact, of a scale

/// A joint pops that turns in kPopSeconds by more than kPopTurn degrees and more than kPopOfSource times as far as any
/// joint of the source in its whole clip.
inline constexpr double kPopSeconds = 1.0 / 240.0, kPopTurn = 8.0, kPopOfSource = 2.0;

/// A warning names what is farther off than this. Limbs take the source's directions, while trunks, necks, collarbones
/// and feet keep those of their own rig (docs/decisions/0070). A test compares docs/retarget.md with these numbers.
inline constexpr double kFarOfLimb = 20.0, kFarOfOthers = 50.0;  ///< degrees
inline constexpr double kFarMiss = 0.05;                         ///< of the length of the legs
inline constexpr double kBetter = 0.75;  ///< of the sum over the clips of what feet miss and hips are lowered by

}  // namespace bendy::motion
