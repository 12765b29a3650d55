#include "kernel_table.h"

#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <immintrin.h>

namespace bendy {
namespace with_avx2 {
namespace {

constexpr bool kHasForms = true;
constexpr bool kFlushesDenormals = true;
constexpr void (*kTwoBones)(TwoBoneBlock&) = two_bones_avx2;

#include "lanes_avx2.h"

#include "read_avx2.h"

#include "all_lanes.h"

}  // namespace
}  // namespace with_avx2

const KernelTable kAvx2Table = with_avx2::kTable;

}  // namespace bendy

#endif
