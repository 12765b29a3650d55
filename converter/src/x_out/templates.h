#pragma once

#include "text.h"

namespace bendy::converter::x_out {

/// The templates that are not in every reader: those for skins, and ours.
void write_templates(Text& text);

}  // namespace bendy::converter::x_out
