/// Frames of a CAN bus, and the texts in which tools carry them: lines of SLCAN and of candump.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"

namespace skyloop::inline base {

/// A data frame of classic CAN (ISO 11898-1).
struct CanFrame {
    static constexpr std::size_t most_bytes = 8;

    std::uint32_t id = 0;  ///< 29 bits, or 11 of a frame that is not extended
    bool extended = true;
    std::uint8_t size = 0;                        ///< bytes of `data` that count, 0 … 8
    std::array<std::uint8_t, most_bytes> data{};  ///< those behind them are 0

    [[nodiscard]] ByteSpan bytes() const { return ByteSpan(data).first(size); }
    [[nodiscard]] bool operator==(const CanFrame&) const = default;
};

/// A frame of these bytes; nothing for more than eight, or an id of more bits than it may have.
std::optional<CanFrame> can_frame(std::uint32_t id, bool extended, ByteSpan bytes);

/// "T18042A0A2017D\r": a frame as SLCAN writes it (Lawicel CANUSB manual, commands t and T), with its carriage return.
std::string slcan_line(const CanFrame& frame);
/// A frame from such a line without its carriage return, with or without the four digits of a time stamp behind it.
/// Nothing for any other text, remote frames among it, which no protocol here has.
std::optional<CanFrame> parse_slcan_line(std::string_view line);
/// A frame of a line of `candump -L` or `candump -l`: "(1700000000.123456) can0 18042A0A#017D". Nothing for any other
/// text, remote and error frames and those of CAN FD among it.
std::optional<CanFrame> parse_candump_line(std::string_view line);

/// Cuts bytes into lines that end with a carriage return; line feeds are skipped. Of a line longer than any of SLCAN
/// (64 characters) the rest is lost, and what stays is no frame. State: the unfinished line.
class SlcanLines {
public:
    static constexpr std::size_t longest = 64;

    std::vector<std::string> feed(ByteSpan bytes);

private:
    std::string line_;
};

}  // namespace skyloop::inline base
