/// The blocks of RINEX 4 that are not ephemerides.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "fields.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::rinex {

/// "> EPH G02 LNAV"; of coefficients of a whole system "> ION G   LNAV", too.
struct BlockHead {
    std::string_view type;  ///< "EPH", "ION", "STO", "EOP"
    std::optional<Constellation> system;
    std::optional<SatelliteId> satellite;
    std::string_view message;  ///< "LNAV", "INAV", "D1D2", …
};
BlockHead block_head(std::string_view line);

/// The message that brings ephemerides of this name, of those that are read.
std::optional<NavigationMessage> message_of_block(const BlockHead& head);

/// True for a block of ionosphere coefficients that is read.
bool is_read_ionosphere(const BlockHead& head);

/// Takes the coefficients of an ION block, unless the system already has some (RINEX 4.00, tables 33 to 36).
/// False when the block is damaged.
bool take_ionosphere(const BlockHead& head, std::span<const Line> lines, BroadcastIonosphere& ionosphere);

/// Reads an STO block (RINEX 4.00, table 31), or nothing when it is damaged.
std::optional<TimeSystemCorrection> read_time_offset(std::span<const Line> lines);

}  // namespace skyloop::rinex
