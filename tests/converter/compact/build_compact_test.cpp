#include "compact/build_compact.h"

#include <bendy/converter/import_gltf.h>
#include <bendy/format/validate.h>

#include <gtest/gtest.h>

#include <filesystem>

namespace bendy::converter {
namespace {

TEST(BuildCompact, EveryBoundIsKeptAndNoneGivesTheExactFile) {
    Report unheard;
    const auto scene = import_gltf(std::filesystem::path(BENDY_SOURCE_DIR) / "examples" / "tentacle.glb", {}, unheard);
    ASSERT_TRUE(scene) << scene.error().message;
    for (const double share : {5e-5, 1e-3, 1e-2}) {
        Report report;
        const auto bytes = build_compact(*scene, {share, true}, "test", report, {});
        ASSERT_TRUE(report.compact) << share;
        EXPECT_GT(report.compact->measured_error, 0.0);
        EXPECT_LE(report.compact->measured_error, report.compact->max_error);
        EXPECT_DOUBLE_EQ(report.compact->max_error, share * report.compact->height);
        EXPECT_TRUE(validate(bytes).empty());
    }
}

}  // namespace
}  // namespace bendy::converter
