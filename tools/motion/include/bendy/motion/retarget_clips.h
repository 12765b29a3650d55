#pragma once

#include <bendy/edit/edit.h>
#include <bendy/format/byte_reader.h>
#include <bendy/runtime/retarget.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

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
/// it; feet and hands that miss their places, and hips that are lowered, by more than kFarMiss.
///
/// How firmly heels and toes stand comes with the clip as the curves left_heel_contact, left_toes_contact,
/// right_heel_contact and right_toes_contact, from 0 in the air to 1 on the ground. Where the source's clip has one of
/// them, they are taken from it and are not looked for.
///
/// A clip that animates nothing that has a counterpart is left out with a warning. A problem, if none is left: no
/// clips, no clip of that name, a character without roles, bodies of different kinds, a name that exists already,
/// numbers that are not finite.
edit::Edited retarget_clips(Bytes file, Bytes other, const RetargetClips& options, edit::Log& log);

inline constexpr double kMostTurned = 0.00004;  ///< radians
inline constexpr double kMostTurnedFree =
    0.000004;                                  ///< without limits and planted feet, where keys of the source are exact
inline constexpr double kMostMoved = 0.0001;   ///< of the length of the legs
inline constexpr double kTurnSpeed = 8.0;      ///< radians a second
inline constexpr double kHardLegSpeed = 16.0;  ///< the same of legs under hard limits, whose feet stand
inline constexpr double kOfSource = 1.5;
inline constexpr double kMostWeight = 0.002;  ///< of a morph target, of a contact, of a scale

/// A warning names what is farther off than this. Limbs take the source's directions, while trunks, necks, collarbones
/// and feet keep those of their own rig (docs/decisions/0070). A test compares docs/retarget.md with these numbers.
inline constexpr double kFarOfLimb = 20.0, kFarOfOthers = 50.0;  ///< degrees
inline constexpr double kFarMiss = 0.05;                         ///< of the length of the legs

}  // namespace bendy::motion
