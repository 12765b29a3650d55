// Every allocation of a conversion made to fail once: the error says so, nothing is thrown, nothing is left behind. Of
// bendy files: what reads JSON leaks where memory is out, or ends the program in a destructor that allocates; glTF's
// conversion is tried as a program, in tests/cli/failures_test.py.
#include <bendy/converter/convert.h>

#include <bendy/format/document.h>

#include "mutation/fail_each.h"
#include "source_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bendy::converter::convert_memory_test {
namespace {

const std::filesystem::path kSeeds = source_folder() / "tests/seeds";

/// Every `step`-th allocation of a conversion fails once; gives how many.
std::uint64_t fail_each_of(const std::filesystem::path& source, const ConvertOptions& options, std::uint64_t step) {
    Report first;
    const auto expected = convert(source, options, first);
    EXPECT_TRUE(expected.has_value());
    return test::fail_each_allocation(
        [&] {
            try {
                Report report;
                const auto bytes = convert(source, options, report);
                if (bytes) {
                    // Compacting goes without what it has no memory for, and is good but larger.
                    if (options.compact) {
                        if (test::is_failure_pending()) return;  // it would come in the next line
                        ASSERT_TRUE(validate(*bytes).empty());
                        return;
                    }
                    ASSERT_EQ(*bytes, *expected);
                } else {
                    ASSERT_EQ(bytes.error().message, "not enough memory");
                }
            } catch (const std::exception& problem) {
                FAIL() << "thrown: " << problem.what();
            }
        },
        step);
}

TEST(ConvertMemory, FailuresOfImagesAndMaterialsAreSaid) {
    EXPECT_GT(fail_each_of(kSeeds / "robot.bendy", {}, 1), 100u);
}

TEST(ConvertMemory, FailuresOfLevelsAreSaid) {
    ConvertOptions options;
    options.lod = true;
    EXPECT_GT(fail_each_of(kSeeds / "rope.bendy", options, 1), 300u);
}

TEST(ConvertMemory, FailuresOfCompactionAreSaid) {
    ConvertOptions options;
    options.compact = ErrorBound();
    EXPECT_GT(fail_each_of(kSeeds / "rope.bendy", options, 31), 50u);
}

TEST(ConvertMemory, EveryFailureOfConvertingABendyFileIsSaid) {
    EXPECT_GT(fail_each_of(kSeeds / "rope_rigged_compact.bendy", {}, 1), 200u);
}

}  // namespace
}  // namespace bendy::converter::convert_memory_test
