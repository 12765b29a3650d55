#include "plan/skin_block.h"

#include <bendy/format/processor.h>

#if defined(BENDY_ARM64)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <arm_neon.h>

namespace bendy {
namespace skin_with_neon {
namespace {

#include "lanes_neon.h"

#include "store_lanes.h"

#include "skin_lanes.h"

#include "dual_lanes.h"

}  // namespace
}  // namespace skin_with_neon

void skin_neon(const SkinBlock& block) {
    skin_with_neon::skin_lanes(block);
}

void dual_neon(const DualBlock& block) {
    skin_with_neon::dual_lanes(block);
}

}  // namespace bendy

#endif
