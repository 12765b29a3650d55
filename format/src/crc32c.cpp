#include <bendy/format/crc32c.h>

#include "crc32c_kernels.h"

#include <algorithm>
#include <array>

namespace bendy {
namespace {

constexpr std::array<Crc32cKernel, 2> kKernels{
    {{"instruction", has_crc32c_instruction, crc32c_instruction}, {"tables", [] { return true; }, crc32c_tables}}};

}  // namespace

std::span<const Crc32cKernel> crc32c_kernels() {
    return kKernels;
}

std::uint32_t crc32c(Bytes bytes, std::uint32_t before) {
    static const auto best = std::find_if(kKernels.begin(), kKernels.end(),
                                          [](const Crc32cKernel& kernel) { return kernel.is_supported(); });
    return best->sum(bytes, before);
}

}  // namespace bendy
