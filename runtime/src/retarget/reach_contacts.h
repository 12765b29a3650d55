#pragma once

#include "settled_frame.h"

namespace bendy {

/// Brings feet and hands to where contacts want them: everything else keeps its direction as far as limits allow.
void reach_contacts(SettledFrame& frame);

}  // namespace bendy
