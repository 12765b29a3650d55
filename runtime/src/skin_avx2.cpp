#include "skin_block.h"

#if defined(__AVX2__)

#include "lanes_avx2.h"

namespace bendy {
namespace {

#include "skin_lanes.h"

}  // namespace

void skin_avx2(const SkinBlock& block) {
    skin_lanes(block);
}

}  // namespace bendy

#endif
