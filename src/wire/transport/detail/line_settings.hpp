/// Settings of a terminal line, as <asm/termbits.h> knows them: any speed (termios2, BOTHER).
#pragma once

// <termios.h> knows no speeds beside its constants and cannot be included together with termios2.
#include <asm/termbits.h>

#include <cstdint>

#include "wire/transport/serial.hpp"

namespace skyloop {

/// No echo, no line editing, no translation, 8N1, modem lines ignored: bytes as on a wire. Reads give what is there;
/// none there is an error (EAGAIN), so that an end of file means a hang-up (termios(3), VMIN).
void make_raw(termios2& settings);
/// @param baud bit/s; clients that know no BOTHER read the usual ones back as what they are
void put_speed(termios2& settings, std::uint32_t baud);
/// Data bits, parity, stop bits and RTS/CTS.
void put_format(termios2& settings, const SerialFormat& format);
/// What put_format() puts is there.
bool has_format(const termios2& settings, const SerialFormat& format);

}  // namespace skyloop
