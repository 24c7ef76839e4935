#include "base/core/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace skyloop::inline base {
namespace {

constexpr std::array<double, 10> powers_of_ten{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};

constexpr auto digit_pairs = [] {
    std::array<char, 200> pairs{};
    for (std::size_t i = 0; i < 100; ++i) {
        pairs[2 * i] = static_cast<char>('0' + i / 10);
        pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return pairs;
}();

// Writes digits from the last to the first, two at a time: a division takes longer than all the rest.
struct DigitWriter {
    char* first;
    std::uint64_t number;

    void put() {
        *--first = static_cast<char>('0' + number % 10);
        number /= 10;
    }
    void put_pair() {
        const char* pair = &digit_pairs[2 * (number % 100)];
        number /= 100;
        *--first = pair[1];
        *--first = pair[0];
    }
};

void append_digits(std::string& text, bool negative, std::uint64_t number, int decimals) {
    std::array<char, 24> digits;
    char* const end = digits.data() + digits.size();
    DigitWriter writer{end, number};
    for (int i = 1; i < decimals; i += 2)
        writer.put_pair();
    if (decimals % 2 == 1) writer.put();
    if (decimals > 0) *--writer.first = '.';
    while (writer.number >= 10)
        writer.put_pair();
    if (writer.number > 0 || writer.first == end || *writer.first == '.') writer.put();
    if (negative) *--writer.first = '-';
    text.append(writer.first, end);
}

}  // namespace

void append_fixed(std::string& text, double value, int decimals) {
    const double scaled = std::abs(value) * powers_of_ten.at(static_cast<std::size_t>(decimals));
    // The product is off by at most 2^-53 of itself: further than that from a tie it rounds as the exact one would.
    constexpr double exact_below = 1LL << 52, doubt = 1.0 / (1LL << 52);
    if (scaled < exact_below) {
        const auto whole = static_cast<std::int64_t>(scaled);  // an instruction, where std::floor would be a call
        const double rest = scaled - static_cast<double>(whole);
        if (std::abs(rest - 0.5) > scaled * doubt)
            return append_digits(text, std::signbit(value), static_cast<std::uint64_t>(whole) + (rest > 0.5 ? 1 : 0),
                                 decimals);
    }
    std::array<char, 400> longest;  // 309 digits stand before the point
    const auto end =
        std::to_chars(longest.data(), longest.data() + longest.size(), value, std::chars_format::fixed, decimals);
    text.append(longest.data(), end.ptr);
}

void append_padded(std::string& text, int value, int characters) {
    std::array<char, 12> digits;
    const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    const char* first = digits.data();
    if (value < 0) text.push_back(*first++);
    const std::ptrdiff_t missing = characters - (end - digits.data());
    if (missing > 0) text.append(static_cast<std::size_t>(missing), '0');
    text.append(first, end);
}

}  // namespace skyloop::inline base
