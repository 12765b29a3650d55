#pragma once

#include "plan/skin_block.h"
#include "plan/stretched_motion.h"

#include <span>

namespace bendy {

/// Skinning by dual quaternions in double precision, one vertex at a time: the reference for the kernels. `scale`
/// applies to everything; `is_stretched`: not all stretches of the motions are 1.
void dual_plain(const SkinBlock& block, std::span<const StretchedMotion> motions, double scale, bool is_stretched);

}  // namespace bendy
