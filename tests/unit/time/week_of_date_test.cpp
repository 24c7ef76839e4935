#include "base/time/utc_time.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

TEST(WeekOfDate, TakesTheWeekThatTheTimeOfWeekIsNearestIn) {
    using std::chrono::milliseconds;
    const UtcTime saturday{2024, 3, 9, 23, 59, 50, 0};  // 8 s of GPS time into week 2305
    EXPECT_EQ(week_of_date(saturday, milliseconds(8'000)), 2305);
    EXPECT_EQ(week_of_date(saturday, milliseconds(604'799'000)), 2304) << "told a little before";
    const UtcTime before{2024, 3, 9, 23, 59, 40, 0};
    EXPECT_EQ(week_of_date(before, milliseconds(604'798'000)), 2304);
    EXPECT_EQ(week_of_date(before, milliseconds(1'000)), 2305) << "told a little later";
    EXPECT_EQ(week_of_date(saturday, milliseconds(302'408'000)), 2305) << "half a week";
    EXPECT_EQ(week_of_date(saturday, milliseconds(302'408'001)), 2304);
    EXPECT_FALSE(week_of_date({2024, 2, 30, 0, 0, 0, 0}, milliseconds(0)));
}

}  // namespace
}  // namespace skyloop
