// The kernels of another processor against the plain ones: a program that needs nothing but the C++ library, to
// be run by an emulator. Prints the worst errors; 0 if they are within bounds.

#include "runtime/dual_comparison.h"
#include "runtime/pose_comparison.h"
#include "runtime/skin_comparison.h"

#include <cstdio>

namespace bendy {
namespace {

#if defined(__aarch64__)
constexpr const char* kName = "neon";
constexpr const KernelTable& kKernels = kNeonTable;
#elif defined(__wasm_simd128__)
constexpr const char* kName = "wasm";
constexpr const KernelTable& kKernels = kWasmTable;
#endif

test::SkinErrors errors_of_any_counts() {
    test::SkinErrors errors;
    for (const std::size_t vertices : {0U, 1U, 2U, 3U, 4U, 5U, 7U, 8U, 9U, 31U, 64U, 101U}) {
        for (std::size_t influences = 1; influences <= 10; ++influences) {
            test::RandomBlock random(vertices, influences, static_cast<unsigned>(vertices * 100 + influences));
            errors.add(test::errors_of(random, kKernels.skin, 3, 3, 4));
        }
    }
    return errors;
}

test::SkinErrors errors_of_any_strides() {
    test::SkinErrors errors;
    for (const std::size_t positions : {0U, 3U, 4U, 12U}) {
        for (const std::size_t normals : {0U, 3U, 11U}) {
            for (const std::size_t tangents : {0U, 4U, 9U}) {
                test::RandomBlock random(29, 4, 11);
                errors.add(test::errors_of(random, kKernels.skin, positions, normals, tangents));
            }
        }
    }
    return errors;
}

test::SkinErrors errors_of_wide_bones_and_one_matrix() {
    test::SkinErrors errors;
    for (const std::size_t influences : {1U, 3U, 4U, 8U, 9U}) {
        test::RandomBlock random(45, influences, 7);
        random.block.bones8 = nullptr;
        random.block.bones16 = random.bones16.data();
        errors.add(test::errors_of(random, kKernels.skin, 3, 3, 4));
        random.block.bones16 = nullptr;
        random.block.weights = nullptr;
        errors.add(test::errors_of(random, kKernels.skin, 3, 3, 4));
    }
    return errors;
}

bool skins() {
    test::SkinErrors errors = errors_of_any_counts();
    errors.add(errors_of_any_strides());
    errors.add(errors_of_wide_bones_and_one_matrix());
    std::printf("%s: skinning: positions %.2f of %.0f, directions %.2f of %.0f units in the last place%s\n", kName,
                errors.positions, test::SkinErrors::kMostForPositions, errors.directions,
                test::SkinErrors::kMostForDirections, errors.has_strayed ? "; memory of others written" : "");
    return errors.are_small();
}

bool skins_by_duals() {
    test::DualErrors errors;
    for (const bool is_stretched : {false, true}) {
        for (const std::size_t vertices : {0U, 1U, 3U, 4U, 5U, 9U, 64U, 101U}) {
            for (std::size_t influences = 1; influences <= 10; ++influences) {
                test::RandomBlock random(vertices, influences, static_cast<unsigned>(vertices * 100 + influences));
                errors.add(test::dual_errors_of(random, is_stretched, kKernels.dual, 3, 3, 4));
                errors.add(test::dual_errors_of(random, is_stretched, kKernels.dual, 3, 3, 0));
                errors.add(test::dual_errors_of(random, is_stretched, kKernels.dual, 4, 0, 9));
            }
        }
    }
    std::printf("%s: dual quaternions: positions %.2f of %.0f, directions %.2f of %.0f units in the last place%s\n",
                kName, errors.positions, test::DualErrors::kMostForPositions, errors.directions,
                test::DualErrors::kMostForDirections, errors.has_strayed ? "; memory of others written" : "");
    return errors.are_small();
}

bool poses() {
    const test::PoseErrors errors = test::PoseComparison(kKernels).run();
    std::printf(
        "%s: posing: pose %.2f, palette %.2f, sample %.2f, unpack %.2f, mix %.2f, add %.2f, decode %.2f units "
        "in the last place%s%s\n",
        kName, errors.pose, errors.palette, errors.sample, errors.unpack, errors.mix, errors.add, errors.decode,
        errors.finds_infinity ? "" : "; infinity not found",
        errors.poses_match ? "" : "; poses together differ from poses alone");
    return errors.are_small();
}

bool keeps_zeros() {
    test::RandomBlock random(24, 4, 5);
    for (std::size_t k = 0; k < 3 * 24; ++k) random.normals.data()[k] = 0.0f;
    test::Output out(random.block, 0, 3, 0);
    kKernels.skin(random.block);
    bool are_zero = true;
    for (std::size_t k = 0; k < 3 * 24; ++k) are_zero = are_zero && out.normals.data()[k] == 0.0f;
    return are_zero;
}

}  // namespace
}  // namespace bendy

int main() {
    const bool skins = bendy::skins();
    const bool skins_by_duals = bendy::skins_by_duals();
    const bool poses = bendy::poses();
    const bool keeps_zeros = bendy::keeps_zeros();
    if (!keeps_zeros) std::puts("zeros did not stay zero");
    return skins && skins_by_duals && poses && keeps_zeros ? 0 : 1;
}
