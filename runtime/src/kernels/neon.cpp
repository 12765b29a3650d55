#include "kernel_table.h"

#include <bendy/format/processor.h>

#if defined(BENDY_ARM64)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <arm_neon.h>

namespace bendy {
namespace with_neon {
namespace {

constexpr bool kHasForms = true;
constexpr bool kFlushesDenormals = false;
constexpr void (*kTwoBones)(TwoBoneBlock&) = nullptr;

#include "lanes_neon.h"

#include "read_lanes.h"

#include "all_lanes.h"

}  // namespace
}  // namespace with_neon

const KernelTable kNeonTable = with_neon::kTable;

}  // namespace bendy

#endif
