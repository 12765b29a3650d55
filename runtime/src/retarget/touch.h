#pragma once

#include "plant_contacts.h"
#include "settled_frame.h"

namespace bendy {

/// Hands that touch the own head, trunk or thighs in the source, or what the other hand holds, are to touch the
/// target's there, which may be thicker; and none is to be deeper inside than the source's.
void touch_body(SettledFrame& frame, const GivenContacts& given);

/// Hands that are near each other are to be as near on the target, in arm lengths, although its shoulders may be
/// broader.
void join_hands(SettledFrame& frame, const GivenContacts& given);

}  // namespace bendy
