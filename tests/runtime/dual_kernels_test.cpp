#include <bendy/runtime/kernels.h>

#include "runtime/dual_comparison.h"
#include "runtime/tried_kernels.h"

#include <gtest/gtest.h>

namespace bendy::dual_kernels_test {
namespace {

using test::RandomBlock;
using test::Tried;

void compare(RandomBlock& random, const Tried& kernel, std::size_t positions, std::size_t normals,
             std::size_t tangents) {
    for (const bool is_stretched : {false, true}) {
        const test::DualErrors errors =
            test::dual_errors_of(random, is_stretched, kernel.dual, positions, normals, tangents);
        EXPECT_TRUE(errors.are_small()) << kernel.name << ", " << random.block.vertices << " vertices of "
                                        << random.block.influences << (is_stretched ? ", stretched" : "")
                                        << ": positions " << errors.positions << " units in the last place, directions "
                                        << errors.directions
                                        << (errors.has_strayed ? ", and memory of others written" : "");
    }
}

TEST(DualKernels, AllAgreeWithDoublesWhateverTheCounts) {
    for (const Tried& kernel : test::tried_kernels()) {
        for (const std::size_t vertices : {0u, 1u, 3u, 4u, 5u, 7u, 8u, 9u, 15u, 16u, 17u, 31u, 64u, 65u, 101u}) {
            for (std::size_t influences = 1; influences <= 10; ++influences) {
                RandomBlock random(vertices, influences, static_cast<unsigned>(vertices * 100 + influences));
                compare(random, kernel, 3, 3, 4);
                random.block.bones8 = nullptr;
                random.block.bones16 = random.bones16.data();
                compare(random, kernel, 3, 3, 0);
            }
        }
    }
}

TEST(DualKernels, AnyStrideAndAnySubset) {
    for (const Tried& kernel : test::tried_kernels()) {
        for (const std::size_t positions : {0u, 3u, 5u}) {
            for (const std::size_t normals : {0u, 3u, 4u, 11u}) {
                for (const std::size_t tangents : {0u, 4u, 9u}) {
                    RandomBlock random(29, 4, 11);
                    if (positions == 0) random.block.positions = nullptr;
                    if (normals == 0) random.block.normals = nullptr;
                    if (tangents == 0) random.block.tangents = nullptr;
                    compare(random, kernel, positions, normals, tangents);
                }
            }
        }
    }
}

}  // namespace
}  // namespace bendy::dual_kernels_test
