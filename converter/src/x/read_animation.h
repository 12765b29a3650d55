#pragma once

#include "object_reader.h"
#include "x_file.h"

namespace bendy::converter::x {

/// An AnimationSet whose type has been read.
AnimationSet read_animation_set(ObjectReader& in);

}  // namespace bendy::converter::x
