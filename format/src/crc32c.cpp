#include <bendy/format/crc32c.h>

#include "crc32c_kernels.h"

#include <bendy/format/processor.h>
#include <bendy/format/public.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#if defined(BENDY_X86_64)
#include <nmmintrin.h>
#if defined(__GNUC__) || defined(__clang__)  // others take every instruction everywhere
#define BENDY_CRC32C __attribute__((target("sse4.2")))
#else
#define BENDY_CRC32C
#endif
#elif defined(BENDY_GNU) && defined(__aarch64__) && defined(__linux__)
#include <arm_acle.h>
#include <sys/auxv.h>
#define BENDY_CRC32C __attribute__((target("+crc")))
#endif

namespace bendy {
namespace {

constexpr std::uint32_t kReflectedPolynomial = 0x82f63b78u;

using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

// tables[0] is the bytewise table; tables[k] advances a byte over k more zero bytes, so that eight bytes are summed at
// a time ("slicing-by-8", Kounavis and Berry, 2005).
// The tables do not compress: WebAssembly, which is downloaded, computes them when it starts.
#ifdef __EMSCRIPTEN__
#define BENDY_TABLE const
#define BENDY_MAKE_TABLE inline
#else
#define BENDY_TABLE constexpr
#define BENDY_MAKE_TABLE constexpr
#endif

BENDY_MAKE_TABLE Tables make_tables() {
    Tables tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t sum = byte;
        for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1u) != 0 ? kReflectedPolynomial : 0u);
        tables[0][byte] = sum;
    }
    for (std::size_t k = 1; k < tables.size(); ++k) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t last = tables[k - 1][byte];
            tables[k][byte] = (last >> 8) ^ tables[0][last & 0xffu];
        }
    }
    return tables;
}

BENDY_TABLE Tables kTables = make_tables();

/// Eight bytes at a time; runs everywhere, and is the reference for the other kernel.
std::uint32_t sum_by_tables(Bytes bytes, std::uint32_t before) {
    std::uint32_t sum = ~before;
    std::size_t at = 0;
    for (; bytes.size() - at >= 8; at += 8) {
        std::uint64_t word = 0;
        copy_at(bytes, at, word);
        word ^= sum;
        sum = 0;
        for (std::size_t k = 0; k < 8; ++k) sum ^= kTables[7 - k][word >> (8 * k) & 0xffu];
    }
    for (; at < bytes.size(); ++at)
        sum = (sum >> 8) ^ kTables[0][(sum ^ std::to_integer<std::uint32_t>(bytes[at])) & 0xffu];
    return ~sum;
}

#ifdef BENDY_CRC32C

// The instruction has a latency of three cycles and a throughput of one, so three lanes are summed in parallel and then
// combined: how a sum changes over n more zero bytes is linear in its bits. (Adler, crc32c.c; Gopal et al., "Fast CRC
// Computation for iSCSI Polynomial Using CRC32 Instruction", 2011.) Long lanes come first: memory is prefetched along
// each, and that takes a while to start.
constexpr std::size_t kLongLane = 16384;  // bytes
constexpr std::size_t kLane = 1024;       // bytes

using Columns = std::array<std::uint32_t, 32>;  // the result for each bit of a sum

constexpr std::uint32_t applied(const Columns& columns, std::uint32_t sum) {
    std::uint32_t result = 0;
    for (std::size_t bit = 0; bit < 32; ++bit) {
        if ((sum >> bit & 1u) != 0) result ^= columns[bit];
    }
    return result;
}

constexpr Columns twice(const Columns& columns) {
    Columns result{};
    for (std::size_t bit = 0; bit < 32; ++bit) result[bit] = applied(columns, columns[bit]);
    return result;
}

using LaneTables = std::array<std::array<std::uint32_t, 256>, 4>;

/// Advances a sum over `lane` zero bytes, a power of two: one table per byte of the sum.
constexpr LaneTables make_lane_tables(std::size_t lane) {
    Columns columns{};  // over one zero bit
    columns[0] = kReflectedPolynomial;
    for (std::size_t bit = 1; bit < 32; ++bit) columns[bit] = std::uint32_t{1} << (bit - 1);
    for (std::size_t bits = 1; bits < lane * 8; bits *= 2) columns = twice(columns);
    LaneTables tables{};
    for (std::uint32_t place = 0; place < 4; ++place) {
        for (std::uint32_t byte = 0; byte < 256; ++byte) tables[place][byte] = applied(columns, byte << (8 * place));
    }
    return tables;
}

template <std::size_t lane>
constexpr LaneTables kOverLane = make_lane_tables(lane);

template <std::size_t lane>
std::uint32_t over_lane(std::uint32_t sum) {
    const LaneTables& tables = kOverLane<lane>;
    return tables[0][sum & 0xffu] ^ tables[1][sum >> 8 & 0xffu] ^ tables[2][sum >> 16 & 0xffu] ^ tables[3][sum >> 24];
}

/// `at` must point to eight bytes.
BENDY_CRC32C inline std::uint32_t add_word(std::uint32_t sum, const std::byte* at) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, sizeof word);
#if defined(BENDY_X86_64)
    return static_cast<std::uint32_t>(_mm_crc32_u64(sum, word));
#else
    return __crc32cd(sum, word);
#endif
}

BENDY_CRC32C inline std::uint32_t add_byte(std::uint32_t sum, std::byte byte) {
#if defined(BENDY_X86_64)
    return _mm_crc32_u8(sum, std::to_integer<std::uint8_t>(byte));
#else
    return __crc32cb(sum, std::to_integer<std::uint8_t>(byte));
#endif
}

/// Sums as many bytes as fill whole sets of three lanes, and removes them from `bytes`.
template <std::size_t lane>
BENDY_CRC32C std::uint32_t add_lanes(std::uint32_t sum, Bytes& bytes) {
    constexpr std::size_t kWord = sizeof(std::uint64_t);
    for (; bytes.size() >= 3 * lane; bytes = bytes.subspan(3 * lane)) {
        std::uint32_t second = 0;
        std::uint32_t third = 0;
        const std::byte* const end = bytes.data() + lane;
        for (const std::byte* at = bytes.data(); at != end; at += 2 * kWord) {
            sum = add_word(sum, at);
            second = add_word(second, at + lane);
            third = add_word(third, at + 2 * lane);
            sum = add_word(sum, at + kWord);
            second = add_word(second, at + kWord + lane);
            third = add_word(third, at + kWord + 2 * lane);
        }
        sum = over_lane<lane>(over_lane<lane>(sum) ^ second) ^ third;
    }
    return sum;
}

bool has_instruction() {
#if defined(BENDY_X86_64)
    return processor_has(Instructions::sse4_2);
#else
    return (getauxval(AT_HWCAP) & HWCAP_CRC32) != 0;
#endif
}

/// With the processor's own instruction (SSE 4.2, or ARMv8's CRC extension), three lanes in parallel.
BENDY_CRC32C std::uint32_t sum_by_instruction(Bytes bytes, std::uint32_t before) {
    constexpr std::size_t kWord = sizeof(std::uint64_t);
    std::uint32_t sum = add_lanes<kLongLane>(~before, bytes);
    sum = add_lanes<kLane>(sum, bytes);
    for (; bytes.size() >= kWord; bytes = bytes.subspan(kWord)) sum = add_word(sum, bytes.data());
    for (const std::byte byte : bytes) sum = add_byte(sum, byte);
    return ~sum;
}

#else

bool has_instruction() {
    return false;
}

std::uint32_t sum_by_instruction(Bytes bytes, std::uint32_t before) {
    return sum_by_tables(bytes, before);
}

#endif

constexpr std::array<Crc32cKernel, 2> kKernels{
    {{"instruction", has_instruction, sum_by_instruction}, {"tables", [] { return true; }, sum_by_tables}}};

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
