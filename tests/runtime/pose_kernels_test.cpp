#include "runtime/pose_comparison.h"

#include <bendy/runtime/kernels.h>

#include <gtest/gtest.h>

#include <iostream>

namespace bendy::pose_kernels_test {
namespace {

TEST(PoseKernels, AreWithinTheirBoundsOfDoubles) {
    const Kernel before = kernel();
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        SCOPED_TRACE(kernel_name(each));
        const test::PoseErrors errors = test::PoseComparison(kernel_table()).run();
        EXPECT_LE(errors.pose, test::PoseErrors::kMostForPose);
        EXPECT_LE(errors.palette, test::PoseErrors::kMostForPalette);
        EXPECT_LE(errors.sample, test::PoseErrors::kMostForSample);
        EXPECT_LE(errors.unpack, test::PoseErrors::kMostForUnpack);
        EXPECT_LE(errors.mix, test::PoseErrors::kMostForBlends);
        EXPECT_LE(errors.add, test::PoseErrors::kMostForBlends);
        EXPECT_LE(errors.decode, test::PoseErrors::kMostForDecoding);
        EXPECT_TRUE(errors.finds_infinity);
        EXPECT_TRUE(errors.poses_match);
        std::cout << kernel_name(each) << ": units in the last place: pose " << errors.pose << ", palette "
                  << errors.palette << ", sample " << errors.sample << ", unpack " << errors.unpack << ", mix "
                  << errors.mix << ", add " << errors.add << ", decode " << errors.decode << '\n';
    }
    EXPECT_TRUE(set_kernel(before));
}

}  // namespace
}  // namespace bendy::pose_kernels_test
