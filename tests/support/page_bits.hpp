/// Fields of navigation messages by their places.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace skyloop::test {

/// Fields of a message in 32-bit words, by the place of their first bit.
struct PageBits {
    std::vector<std::uint32_t> words;
    [[nodiscard]] std::uint64_t field(std::size_t at, int width) const {
        std::uint64_t value = 0;
        for (std::size_t i = at; i < at + static_cast<std::size_t>(width); ++i)
            value = value << 1 | (words[i / 32] >> (31 - i % 32) & 1);
        return value;
    }
    /// In two's complement, times 2^exponent.
    [[nodiscard]] double scaled(std::size_t at, int width, int exponent) const {
        const auto raw = static_cast<std::int64_t>(field(at, width) << (64 - width)) >> (64 - width);
        return std::ldexp(static_cast<double>(raw), exponent);
    }
    [[nodiscard]] double positive(std::size_t at, int width, int exponent) const {
        return std::ldexp(static_cast<double>(field(at, width)), exponent);
    }
};

/// The 128 bits of a word of I/NAV out of an even and an odd page of four words each.
inline PageBits inav_word_of(const std::vector<std::uint32_t>& pages) {
    const PageBits all{pages};
    PageBits word;
    for (std::size_t at = 0; at < 128; at += 16)
        if (at % 32 == 0)
            word.words.push_back(static_cast<std::uint32_t>(
                (at + 32 <= 112 ? all.field(2 + at, 32) : all.field(2 + at, 16) << 16 | all.field(130, 16))));
    return word;
}

}  // namespace skyloop::test
