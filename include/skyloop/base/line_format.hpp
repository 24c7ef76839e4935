/// How a byte lies on an asynchronous serial line.
#pragma once

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
};

}  // namespace skyloop
