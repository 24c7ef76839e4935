/// Frames of Unicore's N4 receivers (UM980, UM982): logs in ASCII and binary, and the answers to commands.
///
/// A log as text is `#NAME,idle,GPS,FINE,week,tow_ms,version,0,leap,delay_ms;body*crc`, as bytes a head of 24 from AA
/// 44 B5 on. Both end in the same CRC-32. Answers (`$command`, `$CONFIG`, `$devicename`, `#MODE`) end in an exclusive
/// or that, unlike NMEA's, covers their first character. Sources: captures of UM980 and UM982 in jclark/satpulse
/// (gps/testdata/packets/unicore), examples of sparkfun/SparkFun_Unicore_GNSS_Arduino_Library, each recomputed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"

namespace skyloop::inline receiver {

inline constexpr std::uint8_t unicore_sync_1 = 0xAA, unicore_sync_2 = 0x44, unicore_sync_3 = 0xB5;
inline constexpr std::size_t unicore_head_size = 24, unicore_crc_size = 4;

/// What stands before every log.
struct UnicoreHeader {
    int cpu_idle_percent = 97;
    bool time_known = true;    ///< FINE, else UNKNOWN
    int week = 0;              ///< of GPS, not wrapped
    std::uint32_t tow_ms = 0;  ///< of the epoch
    std::uint32_t version = 0;
    int leap_seconds = 18;  ///< GPST − UTC
    int delay_ms = 0;       ///< from the epoch to the output
    bool operator==(const UnicoreHeader&) const = default;
};

/// CRC-32 with the reflected polynomial 0xEDB88320, start 0 and nothing at the end: of text between `#` and `*`, of
/// binary from the sync bytes on.
std::uint32_t unicore_crc(ByteSpan bytes);
/// The exclusive or of all characters of an answer before its `*`, the first among them.
std::uint8_t unicore_answer_checksum(std::string_view answer);

/// "#NAME,…;body*crc\r\n".
std::string unicore_log_line(std::string_view name, const UnicoreHeader& header, std::string_view body);
/// An answer with its checksum in two upper-case digits and the line end. @param answer from `$` or `#` on
std::string unicore_answer_line(std::string_view answer);
/// The whole frame. Empty for a payload of more than 65535 bytes.
Bytes encode_unicore_frame(std::uint16_t id, const UnicoreHeader& header, ByteSpan payload);

/// One checked frame; the payload lives as long as the bytes that were parsed.
struct UnicoreFrameView {
    std::uint16_t id = 0;
    UnicoreHeader header;
    ByteSpan payload;
};
/// Bytes of the frame that begins here, by its head; nothing when none does or the head is not whole.
std::optional<std::size_t> unicore_frame_size(ByteSpan bytes);
/// Reads exactly one frame; nothing when sync, length or CRC do not hold.
std::optional<UnicoreFrameView> parse_unicore_frame(ByteSpan bytes);

/// One checked line; its views live as long as the text that was parsed.
struct UnicoreLineView {
    char lead = '#';                           ///< or '$'
    std::string_view name;                     ///< "BESTNAVA", "command"
    std::vector<std::string_view> head;        ///< of a log, what follows its name
    std::vector<std::string_view> fields;      ///< of the body; of answers what follows the name
    std::optional<UnicoreHeader> header = {};  ///< of a log whose head can be read
};
/// Reads one line, with or without its line end: a log with its CRC, or an answer with its checksum, of `$` lines
/// `$command`, `$CONFIG` and `$devicename` alone. Nothing for every other line. Text between quotation marks is one
/// field, and keeps them.
std::optional<UnicoreLineView> parse_unicore_line(std::string_view line);

}  // namespace skyloop::inline receiver
