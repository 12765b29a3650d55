#pragma once

#include "settled_frame.h"

#include <bendy/runtime/retarget.h>

#include <optional>

namespace bendy {

/// Contacts that are given, as from curves, in place of those that are found.
using GivenContacts = std::optional<ContactWeights>;

/// Returns how firm a contact is, and writes it into the result.
float weight_of(SettledFrame& frame, Contact contact, const GivenContacts& given, float found);

/// Brings the body of who sits, lies or kneels to the height above the ground that the source's has, although it
/// may be thicker; but not below the ground, where many a source is.
void lay_body(SettledFrame& frame, const GivenContacts& given);

/// The same after limits have turned head and trunk.
void lay_again(SettledFrame& frame);

/// Says where feet and hands on the ground are to be.
void plant_limbs(SettledFrame& frame, RetargetState& state, const GivenContacts& given);

/// Lowers the hips until the feet that stand on the ground are within reach.
void lower_hips(SettledFrame& frame);

}  // namespace bendy
