// The kernels of another processor, and the portable ones, against doubles: a program that needs nothing but the C++
// library, to be run by an emulator. Prints the worst errors; 0 if they are within bounds.

#include "runtime/dual_comparison.h"
#include "runtime/pose_comparison.h"
#include "runtime/skin_comparison.h"

#include <cstdio>

namespace bendy {
namespace {

struct Tried {
    const char* name;
    const KernelTable& kernels;
};

#if defined(__aarch64__)
constexpr Tried kTried[] = {{"neon", kNeonTable}, {"plain", kPlainTable}};
#elif defined(__wasm_simd128__)
constexpr Tried kTried[] = {{"wasm", kWasmTable}, {"plain", kPlainTable}};
#endif

test::SkinErrors errors_of_any_counts(const KernelTable& kernels) {
    test::SkinErrors errors;
    for (const std::size_t vertices : {0U, 1U, 2U, 3U, 4U, 5U, 7U, 8U, 9U, 31U, 64U, 101U}) {
        for (std::size_t influences = 1; influences <= 10; ++influences) {
            test::RandomBlock random(vertices, influences, static_cast<unsigned>(vertices * 100 + influences));
            errors.add(test::errors_of(random, kernels.skin, 3, 3, 4));
        }
    }
    return errors;
}

test::SkinErrors errors_of_any_strides(const KernelTable& kernels) {
    test::SkinErrors errors;
    for (const std::size_t positions : {0U, 3U, 4U, 12U}) {
        for (const std::size_t normals : {0U, 3U, 11U}) {
            for (const std::size_t tangents : {0U, 4U, 9U}) {
                test::RandomBlock random(29, 4, 11);
                errors.add(test::errors_of(random, kernels.skin, positions, normals, tangents));
            }
        }
    }
    return errors;
}

test::SkinErrors errors_of_wide_bones_and_one_matrix(const KernelTable& kernels) {
    test::SkinErrors errors;
    for (const std::size_t influences : {1U, 3U, 4U, 8U, 9U}) {
        test::RandomBlock random(45, influences, 7);
        random.block.bones8 = nullptr;
        random.block.bones16 = random.bones16.data();
        errors.add(test::errors_of(random, kernels.skin, 3, 3, 4));
        random.block.bones16 = nullptr;
        random.block.weights = nullptr;
        errors.add(test::errors_of(random, kernels.skin, 3, 3, 4));
    }
    return errors;
}

bool skins(const Tried& tried) {
    test::SkinErrors errors = errors_of_any_counts(tried.kernels);
    errors.add(errors_of_any_strides(tried.kernels));
    errors.add(errors_of_wide_bones_and_one_matrix(tried.kernels));
    std::printf("%s: skinning: positions %.2f of %.0f, directions %.2f of %.0f units in the last place%s\n", tried.name,
                errors.positions, test::SkinErrors::kMostForPositions, errors.directions,
                test::SkinErrors::kMostForDirections, errors.has_strayed ? "; memory of others written" : "");
    return errors.are_small();
}

bool skins_by_duals(const Tried& tried) {
    test::DualErrors errors;
    for (const bool is_stretched : {false, true}) {
        for (const std::size_t vertices : {0U, 1U, 3U, 4U, 5U, 9U, 64U, 101U}) {
            for (std::size_t influences = 1; influences <= 10; ++influences) {
                test::RandomBlock random(vertices, influences, static_cast<unsigned>(vertices * 100 + influences));
                errors.add(test::dual_errors_of(random, is_stretched, tried.kernels.dual, 3, 3, 4));
                errors.add(test::dual_errors_of(random, is_stretched, tried.kernels.dual, 3, 3, 0));
                errors.add(test::dual_errors_of(random, is_stretched, tried.kernels.dual, 4, 0, 9));
            }
        }
    }
    std::printf("%s: dual quaternions: positions %.2f of %.0f, directions %.2f of %.0f units in the last place%s\n",
                tried.name, errors.positions, test::DualErrors::kMostForPositions, errors.directions,
                test::DualErrors::kMostForDirections, errors.has_strayed ? "; memory of others written" : "");
    return errors.are_small();
}

bool poses(const Tried& tried) {
    const test::PoseErrors errors = test::PoseComparison(tried.kernels).run();
    std::printf(
        "%s: posing: pose %.2f, palette %.2f, sample %.2f, unpack %.2f, mix %.2f, add %.2f, decode %.2f units "
        "in the last place%s%s\n",
        tried.name, errors.pose, errors.palette, errors.sample, errors.unpack, errors.mix, errors.add, errors.decode,
        errors.finds_infinity ? "" : "; infinity not found",
        errors.poses_match ? "" : "; poses together differ from poses alone");
    return errors.are_small();
}

bool keeps_zeros(const Tried& tried) {
    test::RandomBlock random(24, 4, 5);
    for (std::size_t k = 0; k < 3 * 24; ++k) random.normals.data()[k] = 0.0f;
    test::Output out(random.block, 0, 3, 0);
    tried.kernels.skin(random.block);
    bool are_zero = true;
    for (std::size_t k = 0; k < 3 * 24; ++k) are_zero = are_zero && out.normals.data()[k] == 0.0f;
    return are_zero;
}

bool is_good(const Tried& tried) {
    const bool is_skinning = skins(tried);
    const bool is_blending = skins_by_duals(tried);
    const bool is_posing = poses(tried);
    const bool is_keeping_zeros = keeps_zeros(tried);
    if (!is_keeping_zeros) std::printf("%s: zeros did not stay zero\n", tried.name);
    return is_skinning && is_blending && is_posing && is_keeping_zeros;
}

#if defined(__wasm_simd128__)
/// Modules with SIMD have no portable kernel: the one for WebAssembly stands for it.
bool rounds_as_plain() {
    bool is_same = true;
    for (const std::size_t influences : {1U, 3U, 4U, 8U, 9U}) {
        test::RandomBlock random(101, influences, 7);
        test::Output found(random.block, 3, 3, 4);
        kWasmTable.skin(random.block);
        test::Output expected(random.block, 3, 3, 4);
        kPlainTable.skin(random.block);
        is_same = is_same && found.positions.memory == expected.positions.memory &&
                  found.normals.memory == expected.normals.memory && found.tangents.memory == expected.tangents.memory;
    }
    const test::PoseErrors wasm = test::PoseComparison(kWasmTable).run();
    const test::PoseErrors plain = test::PoseComparison(kPlainTable).run();
    is_same = is_same && wasm.pose == plain.pose && wasm.palette == plain.palette && wasm.sample == plain.sample &&
              wasm.unpack == plain.unpack && wasm.mix == plain.mix && wasm.add == plain.add &&
              wasm.decode == plain.decode;
    if (!is_same) std::puts("wasm does not round as plain does");
    return is_same;
}
#else
bool rounds_as_plain() {
    return true;  // neon fuses products and sums
}
#endif

}  // namespace
}  // namespace bendy

int main() {
    bool are_good = bendy::rounds_as_plain();
    for (const bendy::Tried& tried : bendy::kTried) are_good = bendy::is_good(tried) && are_good;
    return are_good ? 0 : 1;
}
