#pragma once

#include "plan/skin_block.h"
#include "plan/stretched_motion.h"

#include <span>

namespace bendy {

/// Skinning by dual quaternions in double precision, one vertex after another: what the kernels are held against.
/// `scale` multiplies all; `is_stretched`: the motions' stretches are not all 1.
void dual_plain(const SkinBlock& block, std::span<const StretchedMotion> motions, double scale, bool is_stretched);

}  // namespace bendy
