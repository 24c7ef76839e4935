/// Settings of a terminal line, as <asm/termbits.h> knows them: any speed (termios2, BOTHER).
/// What may be said of a serial line behind its name.
#pragma once

// <termios.h> knows no speeds beside its constants and cannot be included together with termios2.
#include <asm/termbits.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/bytes.hpp"
#include "wire/transport/serial.hpp"

namespace skyloop::inline wire {

inline constexpr std::uint32_t lowest_baud = 50, highest_baud = 12'000'000;  // bit/s

/// A speed in bit/s, from lowest_baud to highest_baud; nothing for anything else.
std::optional<std::uint32_t> read_baud(std::string_view text);
/// Reads "8N1", "rtscts" or both, with a comma between, into `format`. Gives nothing when all was understood; else what
/// is wrong, for a sentence.
std::string read_line_options(std::string_view text, SerialFormat& format);

/// No echo, no line editing, no translation, 8N1, modem lines ignored: bytes as on a wire. Reads give what is there;
/// none there is an error (EAGAIN), so that an end of file means a hang-up (termios(3), VMIN).
void make_raw(termios2& settings);
/// @param baud bit/s; clients that know no BOTHER read the usual ones back as what they are
void put_speed(termios2& settings, std::uint32_t baud);
/// Data bits, parity, stop bits and RTS/CTS.
void put_format(termios2& settings, const SerialFormat& format);
/// What put_format() puts is there.
bool has_format(const termios2& settings, const SerialFormat& format);

}  // namespace skyloop::inline wire
