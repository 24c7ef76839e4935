#include "skyloop/base/fixed_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace skyloop {
namespace {

constexpr std::array<double, 10> powers_of_ten{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};

void append_digits(std::string& text, std::uint64_t number, int decimals) {
    std::array<char, 24> digits;
    char* first = digits.data() + digits.size();
    const auto put = [&] {
        *--first = static_cast<char>('0' + number % 10);
        number /= 10;
    };
    for (int i = 0; i < decimals; ++i)
        put();
    if (decimals > 0) *--first = '.';
    do
        put();
    while (number > 0);
    text.append(first, digits.data() + digits.size());
}

}  // namespace

void append_fixed(std::string& text, double value, int decimals) {
    const double scaled = std::abs(value) * powers_of_ten.at(static_cast<std::size_t>(decimals));
    // The product is off by at most 2^-53 of itself: further than that from a tie it rounds as the exact one would.
    constexpr double exact_below = 1LL << 52, doubt = 1.0 / (1LL << 52);
    if (scaled < exact_below) {
        const double whole = std::floor(scaled), rest = scaled - whole;
        if (std::abs(rest - 0.5) > scaled * doubt) {
            if (std::signbit(value)) text.push_back('-');
            return append_digits(text, static_cast<std::uint64_t>(whole) + (rest > 0.5 ? 1 : 0), decimals);
        }
    }
    std::array<char, 400> longest;  // 309 digits stand before the point
    const auto end =
        std::to_chars(longest.data(), longest.data() + longest.size(), value, std::chars_format::fixed, decimals);
    text.append(longest.data(), end.ptr);
}

}  // namespace skyloop
