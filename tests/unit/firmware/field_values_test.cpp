// How numbers of the receiver become fields.
#include "firmware/messages/field_values.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace skyloop::firmware {
namespace {

// NAV-PVT has the same number without the rest: both have to round alike.
struct SplitValue {
    std::int32_t whole = 7;
    std::int8_t rest = 7;
};
SplitValue split_value(double value, int parts) {
    SplitValue split;
    put_split(value, parts, split.whole, split.rest);
    return split;
}

TEST(SplitValue, RoundsTheWholeAsTheShortFieldDoes) {
    for (const double degrees : {-33.8541730477, 151.2160701254, 47.00000000501, -0.00000005, 0.0, 179.99999999951}) {
        const SplitValue split = split_value(degrees * 1e9, 100);
        EXPECT_EQ(split.whole, std::llround(degrees * 1e7)) << degrees;
        EXPECT_LE(std::abs(split.rest), 50) << degrees;
        EXPECT_NEAR(split.whole * 100.0 + split.rest, degrees * 1e9, 0.51) << degrees;
    }
    EXPECT_EQ(split_value(16, 10).whole, 2);
    EXPECT_EQ(split_value(16, 10).rest, -4);
    EXPECT_EQ(split_value(std::nan(""), 100).whole, 0);
    EXPECT_EQ(split_value(1e300, 100).rest, 0);
}

}  // namespace
}  // namespace skyloop::firmware
