#include "plan/skin_block.h"

#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <immintrin.h>

namespace bendy {
namespace skin_with_sse4 {
namespace {

#include "lanes_sse4.h"

#include "store_lanes.h"

#include "skin_lanes.h"

#include "dual_lanes.h"

}  // namespace
}  // namespace skin_with_sse4

void skin_sse4(const SkinBlock& block) {
    skin_with_sse4::skin_lanes(block);
}

void dual_sse4(const DualBlock& block) {
    skin_with_sse4::dual_lanes(block);
}

}  // namespace bendy

#endif
