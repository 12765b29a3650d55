#pragma once

#include "compact/affine.h"

#include <bendy/converter/scene.h>

namespace bendy::converter {

/// A track of a joint at a time, as glTF 2.0 defines it; sets the property of `local` that it animates. A key nearer
/// than `snap` seconds is taken as it is. Not for weights.
void evaluate_track(const Track& track, double seconds, double snap, Local& local);

}  // namespace bendy::converter
