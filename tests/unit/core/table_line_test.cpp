#include "base/core/table_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using testing::ElementsAre;

LineCells cells_of_table_line(std::string_view line, char separator) {
    LineCells cells{"of the line before"};
    split_table_line(line, separator, cells);
    return cells;
}

TEST(TableLine, IsCutAtSeparatorsThatNoQuotesHold) {
    EXPECT_THAT(cells_of_table_line("a, \"b, c\" ,,d\r", ','), ElementsAre("a", "b, c", "", "d"));
    EXPECT_THAT(cells_of_table_line("5\" of rain,b", ','), ElementsAre("5\" of rain", "b"));
    EXPECT_THAT(cells_of_table_line("33 54'36\"S,18 24'0\"W,\"a, b\"", ','),
                ElementsAre("33 54'36\"S", "18 24'0\"W", "a, b"));
    EXPECT_THAT(cells_of_table_line("", ';'), ElementsAre(""));
}

TEST(TableLine, BlanksInARowAreOneSeparator) {
    EXPECT_THAT(cells_of_table_line("  1 \t 2\t3 \r", ' '), ElementsAre("1", "2", "3"));
    LineCells cells;
    split_line("1  2\t3", " ", true, cells);
    EXPECT_THAT(cells, ElementsAre("1", "2\t3"));
}

TEST(TableLine, TellsItsSeparator) {
    EXPECT_EQ(separator_in("a;b\tc"), ';');
    EXPECT_EQ(separator_in("a;b,c"), ',');
    EXPECT_EQ(separator_in("a b"), ' ');
}

TEST(TableLine, HasNoMoreCellsThanNames) {
    EXPECT_FALSE(width_mistake({"1", "2"}, 2));
    EXPECT_FALSE(width_mistake({"1", "2", "", ""}, 2));
    EXPECT_FALSE(width_mistake({"1"}, 2));
    EXPECT_THAT(width_mistake({"1", "2", "", "3"}, 2).value_or(""), testing::StartsWith("4 cells under 2 names; "));
}

}  // namespace
}  // namespace skyloop
