#include "kernel_table.h"

#include <bendy/format/processor.h>

#if defined(BENDY_WASM_SIMD)

#include <bendy/format/public.h>

#include <cstdint>
#include <cstring>

#include <wasm_simd128.h>

namespace bendy {
namespace with_wasm {
namespace {

constexpr bool kHasForms = true;
constexpr bool kFlushesDenormals = false;
constexpr void (*kTwoBones)(TwoBoneBlock&) = nullptr;

#include "lanes_wasm.h"

#include "read_lanes.h"

#include "all_lanes.h"

}  // namespace
}  // namespace with_wasm

const KernelTable kWasmTable = with_wasm::kTable;

}  // namespace bendy

#endif
