/// The keys of each part of a board file (boards/README.md).
#pragma once

#include "firmware/board_profile.hpp"
#include "table_reader.hpp"

namespace skyloop {

/// All keys of a file's top table.
void read_board_keys(TableReader& top, firmware::BoardProfile& board);

/// [nmea]
void read_board_nmea(TableReader& nmea, firmware::BoardProfile& board);
/// [ubx]
void read_board_ubx(TableReader& ubx, firmware::BoardProfile& board);
/// Makes the items of CFG-MSGOUT absent whose message the board does not send: the rate of nothing.
void leave_out_rates_of_others(firmware::BoardProfile& board);
/// [config]; reads it after everything that decides what a value may be.
void read_board_config(TableReader& config, firmware::BoardProfile& board);
/// `signal_conflicts` of [navigation].
void read_signal_conflicts(TableReader& navigation, firmware::BoardProfile& board);

/// The bytes that pairs of hexadecimal digits write, blanks among them left aside; nothing for any other text.
std::optional<Bytes> bytes_of_hex(std::string_view text);

}  // namespace skyloop
