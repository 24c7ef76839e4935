/// The bytes of the fuzzer, taken one after the other; zeros when they are used up.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/core/bytes.hpp"

namespace skyloop {

class FuzzInput {
public:
    explicit FuzzInput(ByteSpan bytes) : bytes_(bytes) {}
    [[nodiscard]] bool empty() const { return bytes_.empty(); }
    std::uint8_t byte() {
        if (bytes_.empty()) return 0;
        const std::uint8_t first = bytes_[0];
        bytes_ = bytes_.subspan(1);
        return first;
    }
    ByteSpan part(std::size_t size) {
        const ByteSpan head = bytes_.first(std::min(size, bytes_.size()));
        bytes_ = bytes_.subspan(head.size());
        return head;
    }
    /// Two bytes.
    std::uint16_t word() {
        const std::uint8_t high = byte();
        return static_cast<std::uint16_t>(high << 8 | byte());
    }
    /// Often a sensible number up to `most`, at times any pattern of bits.
    double number(double most) {
        const std::uint8_t first = byte();
        if (first < 0xF0) return most * first / 0xEF;
        std::uint64_t bits = 0;
        for (int i = 0; i < 8; ++i)
            bits = bits << 8 | byte();
        return std::bit_cast<double>(bits);
    }

private:
    ByteSpan bytes_;
};

}  // namespace skyloop
