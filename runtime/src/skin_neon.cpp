#include "skin_block.h"

#if defined(__aarch64__)

#include "lanes_neon.h"

namespace bendy {
namespace {

#include "skin_lanes.h"

}  // namespace

void skin_neon(const SkinBlock& block) {
    skin_lanes(block);
}

}  // namespace bendy

#endif
