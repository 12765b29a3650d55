#include "kernel_table.h"

#include <bendy/format/public.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace bendy {
namespace plainly {
namespace {

constexpr bool kHasForms = false;  // four times the code
constexpr bool kFlushesDenormals = false;
constexpr void (*kTwoBones)(TwoBoneBlock&) = nullptr;

#include "lanes_plain.h"

#include "read_lanes.h"

#include "all_lanes.h"

}  // namespace
}  // namespace plainly

const KernelTable kPlainTable = plainly::kTable;

}  // namespace bendy
