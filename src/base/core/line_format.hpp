/// How a byte lies on an asynchronous serial line.
#pragma once

#include <algorithm>
#include <cstdint>

namespace skyloop {

enum class Parity { none, even, odd };

struct SerialFormat {
    int data_bits = 8;  ///< 7 or 8
    Parity parity = Parity::none;
    int stop_bits = 1;    ///< 1 or 2
    bool rtscts = false;  ///< each end sends only while the other lets it

    /// Bits of one byte on the line, with its start bit.
    [[nodiscard]] constexpr int bits_per_byte() const {
        return 1 + data_bits + (parity == Parity::none ? 0 : 1) + stop_bits;
    }
    /// How long one byte takes, ns, rounded up. @param baud bit/s
    [[nodiscard]] constexpr std::int64_t byte_ns(std::uint32_t baud) const {
        return bits_per_byte() * std::int64_t{1'000'000'000} / std::max<std::int64_t>(baud, 1) + 1;
    }
};

}  // namespace skyloop
