#include "skin_block.h"

#if defined(__SSE4_1__)

#include "lanes_sse4.h"

namespace bendy {
namespace {

#include "skin_lanes.h"

}  // namespace

void skin_sse4(const SkinBlock& block) {
    skin_lanes(block);
}

}  // namespace bendy

#endif
