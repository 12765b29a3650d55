#include <bendy/converter/error_bound.h>

#include <gtest/gtest.h>

namespace bendy::converter::error_bound_test {
namespace {

TEST(ErrorBound, LengthsAndShares) {
    const auto value = [](std::string_view text) { return parse_error_bound(text)->value; };
    EXPECT_DOUBLE_EQ(value("0.1mm"), 1e-4);
    EXPECT_DOUBLE_EQ(value("1 cm"), 1e-2);
    EXPECT_DOUBLE_EQ(value("50um"), 5e-5);
    EXPECT_DOUBLE_EQ(value("2m"), 2.0);
    EXPECT_DOUBLE_EQ(value("0.005%"), 5e-5);
    EXPECT_TRUE(parse_error_bound("0.005%")->is_share);
    EXPECT_FALSE(parse_error_bound("1mm")->is_share);
}

TEST(ErrorBound, ErrorsSayWhatIsWrong) {
    const auto error = [](std::string_view text) {
        const auto bound = parse_error_bound(text);
        return bound ? std::string("accepted") : bound.error();
    };
    EXPECT_NE(error("0.1").find("no unit"), std::string::npos);
    EXPECT_NE(error("0.1").find("0.1mm"), std::string::npos);
    EXPECT_NE(error("1in").find("unknown unit"), std::string::npos);
    EXPECT_NE(error("-1mm").find("not above zero"), std::string::npos);
    EXPECT_NE(error("0%").find("not above zero"), std::string::npos);
    EXPECT_NE(error("infmm").find("not above zero"), std::string::npos);
    EXPECT_NE(error("nanmm").find("not above zero"), std::string::npos);
    EXPECT_NE(error("").find("not an error bound"), std::string::npos);
    EXPECT_NE(error("small").find("not an error bound"), std::string::npos);
}

}  // namespace
}  // namespace bendy::converter::error_bound_test
