#include "skin_block.h"

#if defined(__wasm_simd128__)

#include "lanes_wasm.h"

namespace bendy {
namespace {

#include "skin_lanes.h"

}  // namespace

void skin_wasm(const SkinBlock& block) {
    skin_lanes(block);
}

}  // namespace bendy

#endif
