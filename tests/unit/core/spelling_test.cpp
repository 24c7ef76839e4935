#include "base/core/words.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace skyloop {
namespace {

constexpr std::array<std::string_view, 6> keys{"seed", "start", "duration", "rate", "to", "ionosphere"};

TEST(NearestWord, FindsSlipsOfTheFinger) {
    EXPECT_EQ(nearest_word("sede", keys), "seed");           // neighbours swapped
    EXPECT_EQ(nearest_word("strt", keys), "start");          // a letter left out
    EXPECT_EQ(nearest_word("durattion", keys), "duration");  // a letter too many
    EXPECT_EQ(nearest_word("rape", keys), "rate");           // a wrong letter
    EXPECT_EQ(nearest_word("iono", keys), "ionosphere");     // a start
    EXPECT_EQ(nearest_word("durationseconds", keys), "duration");
}

TEST(NearestWord, FindsAShortKeyThatLacksItsUnit) {
    constexpr std::array<std::string_view, 4> timed{"atlas", "at_s", "at_utc", "for_s"};
    EXPECT_EQ(nearest_word("at", timed), "at_s");
    EXPECT_EQ(nearest_word("for", timed), "for_s");
    EXPECT_EQ(nearest_word("a", timed), "");
}

TEST(NearestWord, SaysNothingWhereNothingIsNear) {
    EXPECT_EQ(nearest_word("elephant", keys), "");
    EXPECT_EQ(nearest_word("", keys), "");
    EXPECT_EQ(nearest_word("xy", keys), "");
    EXPECT_EQ(nearest_word("seed", {}), "");
}

TEST(NearestWord, AShortKnownWordIsNotTheStartOfEverything) { EXPECT_EQ(nearest_word("tolerance", keys), ""); }

TEST(NearestWord, TakesTheNearestOfSeveral) {
    constexpr std::array<std::string_view, 3> names{"latitude", "altitude", "attitude"};
    EXPECT_EQ(nearest_word("latitud", names), "latitude");
    EXPECT_EQ(nearest_word("altitide", names), "altitude");
    EXPECT_EQ(nearest_word("atttude", names), "attitude");
}

TEST(NearestWord, AHugeWordCostsNothing) { EXPECT_EQ(nearest_word(std::string(50'000'000, 'a'), keys), ""); }

TEST(DidYouMean, IsTheEndOfASentence) {
    EXPECT_EQ(did_you_mean("sede", keys), "; did you mean 'seed'?");
    EXPECT_EQ(did_you_mean("elephant", keys), "");
}

}  // namespace
}  // namespace skyloop
