#include "plan/skin_block.h"

#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <immintrin.h>

namespace bendy {
namespace skin_with_avx2 {
namespace {

#include "lanes_avx2.h"

#include "store_lanes.h"

#include "skin_lanes.h"

#include "dual_lanes.h"

}  // namespace
}  // namespace skin_with_avx2

void skin_avx2(const SkinBlock& block) {
    skin_with_avx2::skin_lanes(block);
}

void dual_avx2(const DualBlock& block) {
    skin_with_avx2::dual_lanes(block);
}

}  // namespace bendy

#endif
