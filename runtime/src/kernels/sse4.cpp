#include "kernel_table.h"

#include <bendy/format/processor.h>

#if defined(BENDY_X86_64)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <immintrin.h>

namespace bendy {
namespace with_sse4 {
namespace {

constexpr bool kHasForms = true;
constexpr bool kFlushesDenormals = true;
constexpr void (*kTwoBones)(TwoBoneBlock&) = nullptr;

#include "lanes_sse4.h"

#include "read_lanes.h"

#include "all_lanes.h"

}  // namespace
}  // namespace with_sse4

const KernelTable kSse4Table = with_sse4::kTable;

}  // namespace bendy

#endif
