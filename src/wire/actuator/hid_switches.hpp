/// The reports of HID devices that switch: relay boards and the MCP2221A.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"

namespace skyloop::inline wire {

/// How a relay board wants its orders. The id pairs of these boards are shared by products that are no relays, so that
/// only the product string tells.
struct RelayBoard {
    enum class Kind {
        dcttech,  ///< product "USBRelayN"
        ucreate,  ///< product "HIDRelay": tells no state
    } kind = Kind::dcttech;
    int relays = 1;
};
/// Nothing: no relay board.
std::optional<RelayBoard> relay_board(std::string_view product);

/// The report that draws or drops relay `number` (from 1): nine bytes, id 0 first.
/// Source: usbrelay (github.com/darrylb123/usbrelay), the orders of both kinds: FF/FD and the number; F0 + the number,
/// or the number alone.
Bytes relay_report(RelayBoard::Kind kind, int number, bool drawn);

/// What a DCTTECH board answers to a request for its feature report.
struct RelayStates {
    std::string serial;      ///< five characters
    std::uint8_t drawn = 0;  ///< bit 0: relay 1
};
/// Nine bytes with the id in front, or the eight alone, as the backends of hidapi and the id that was asked for give
/// them. Nothing for any other length.
std::optional<RelayStates> relay_states(ByteSpan report);

/// Commands of the MCP2221A (Microchip DS20005565, section 3.1): 64-byte reports without an id; what hidapi sends has a
/// zero in front. Pins are 0 … 3.
namespace mcp2221 {

inline constexpr std::size_t report_size = 64;
inline constexpr int pins = 4;

/// Set GPIO output values (3.1.11): pin `number` becomes an output of this level; the others stay as they are.
Bytes set_pin(int number, bool high);
/// Get GPIO values (3.1.12).
Bytes get_pins();
/// Get SRAM settings (3.1.14).
Bytes get_settings();
/// Set SRAM settings (3.1.13): pin `number` is given to its GPIO, an output of this level. The other pins keep their
/// duty, level and direction, and the converters their reference voltages, as the answers say.
/// @param settings answer to get_settings(), of a length that is_answer() has checked
/// @param pins_now answer to get_pins(), likewise
Bytes give_to_gpio(ByteSpan settings, ByteSpan pins_now, int number, bool high);

/// A whole report that answers the command, and says that it was carried out.
bool is_answer(ByteSpan report, std::uint8_t command);
/// The level that an answer to get_pins() tells of an output; nothing where the pin is an input or not given to its
/// GPIO.
std::optional<bool> output_level(ByteSpan answer, int number);

}  // namespace mcp2221

}  // namespace skyloop::inline wire
