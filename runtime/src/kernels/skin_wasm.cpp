#include "plan/skin_block.h"

#include <bendy/format/processor.h>

#if defined(BENDY_WASM_SIMD)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <wasm_simd128.h>

namespace bendy {
namespace skin_with_wasm {
namespace {

#include "lanes_wasm.h"

#include "store_lanes.h"

#include "skin_lanes.h"

#include "dual_lanes.h"

}  // namespace
}  // namespace skin_with_wasm

void skin_wasm(const SkinBlock& block) {
    skin_with_wasm::skin_lanes(block);
}

void dual_wasm(const DualBlock& block) {
    skin_with_wasm::dual_lanes(block);
}

}  // namespace bendy

#endif
