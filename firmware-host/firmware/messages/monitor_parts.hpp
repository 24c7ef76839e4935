/// The parts in which MON and SEC messages are made.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "firmware/navigation_state.hpp"

namespace skyloop::firmware {

/// MON-HW, HW2, HW3, RF and SPAN. Empty for any other.
std::vector<Bytes> make_hardware_message(UbxMessageId message, const ReportContext& context);
/// MON-COMMS, TXBUF, RXBUF, IO and MSGPP. Empty for any other.
std::vector<Bytes> make_port_message(UbxMessageId message, const ReportContext& context);

/// True for firmware of the high-precision line (FWVER=HPG): two front ends, and its own numbers for ports.
inline bool is_high_precision(const BoardProfile& board) {
    return std::any_of(board.identity.extensions.begin(), board.identity.extensions.end(),
                       [](const std::string& text) { return text.starts_with("FWVER=HPG"); });
}

/// A text filled up with zeros, or cut.
template <std::size_t Size>
std::array<char, Size> padded_text(std::string_view text) {
    std::array<char, Size> characters{};
    std::copy_n(text.begin(), std::min(Size, text.size()), characters.begin());
    return characters;
}

}  // namespace skyloop::firmware
