#include "base/core/number_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

namespace skyloop {
namespace {

std::string fixed(double value, int decimals) {
    std::string text;
    append_fixed(text, value, decimals);
    return text;
}

std::string by_printf(double value, int decimals) {
    std::array<char, 400> text;
    return {text.data(), static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.*f", decimals, value))};
}

TEST(FixedText, IsWhatPrintfWrites) {
    const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
    for (const double value : {0.0,
                               1.0,
                               0.5,
                               1.5,
                               2.5,
                               0.25,
                               0.125,
                               0.375,
                               0.00005,
                               0.00015,
                               1e-5,
                               0.99995,
                               999.99995,
                               4503599627370495.5,
                               4503599627370496.0,
                               1e22,
                               most,
                               least,
                               0.1,
                               1.005,
                               2.675})
        for (int decimals = 0; decimals <= 9; ++decimals)
            for (const double signed_value : {value, -value})
                EXPECT_EQ(fixed(signed_value, decimals), by_printf(signed_value, decimals)) << value;
    EXPECT_EQ(fixed(std::numeric_limits<double>::infinity(), 3), "inf");
    EXPECT_EQ(fixed(std::nan(""), 3), "nan");
}

TEST(FixedText, PadsWholeNumbersAsFmtDoes) {
    for (const int value :
         {0, 7, 10, 99, 100, 12345, -1, -42, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()})
        for (int characters = 0; characters <= 12; ++characters) {
            std::string text = "<";
            append_padded(text, value, characters);
            EXPECT_EQ(text, fmt::format("<{:0{}d}", value, characters));
        }
}

// Numbers of all sizes, ties that a double holds, and their neighbours.
TEST(FixedText, RoundsEachNumberAsPrintfDoes) {
    std::mt19937_64 dice(11);
    std::uniform_real_distribution<double> exponent(-12, 17);
    for (int i = 0; i < 200'000; ++i) {
        const int decimals = i % 10;
        double value = std::pow(10.0, exponent(dice));
        if (i % 3 == 0) value = std::floor(value) + 0.5;
        if (i % 3 == 1) value = (std::floor(value * 1000) + 0.5) / 1000;
        if (i % 7 == 0) value = std::nextafter(value, i % 2 == 0 ? 0 : 1e300);
        ASSERT_EQ(fixed(value, decimals), by_printf(value, decimals));
    }
}

TEST(FixedText, AppendsToWhatIsThere) {
    std::string text = "a,";
    append_fixed(text, -1.25, 1);
    EXPECT_EQ(text, "a,-1.2");
}

}  // namespace
}  // namespace skyloop
