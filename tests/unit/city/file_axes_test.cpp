#include <gtest/gtest.h>

#include "world/city/city_file.hpp"

namespace skyloop::file_axes_test {
namespace {

TEST(FileAxes, ReadsWhichAxisPointsWhere) {
    const auto usual = FileAxes::parse("x,y,z");
    ASSERT_TRUE(usual);
    EXPECT_EQ(usual->axis, (std::array<int, 3>{0, 1, 2}));
    EXPECT_EQ(usual->sign, (std::array<double, 3>{1, 1, 1}));
    const auto up_is_y = FileAxes::parse("x,-z,y");
    ASSERT_TRUE(up_is_y);
    EXPECT_EQ(up_is_y->axis, (std::array<int, 3>{0, 2, 1}));
    EXPECT_EQ(up_is_y->sign, (std::array<double, 3>{1, -1, 1}));
}

TEST(FileAxes, RefusesWhatNamesNotEachAxisOnce) {
    for (const char* text :
         {"", "x", "x,y", "x,y,y", "x,y,z,", "x,y,w", "x y z", "--x,y,z", "x,y,z ", "X,Y,Z", "-,y,z"}) {
        const auto axes = FileAxes::parse(text);
        ASSERT_FALSE(axes) << text;
        EXPECT_EQ(axes.error().code, ErrorCode::usage);
        EXPECT_NE(axes.error().message.find("expected"), std::string::npos) << axes.error().message;
    }
}

}  // namespace
}  // namespace skyloop::file_axes_test
