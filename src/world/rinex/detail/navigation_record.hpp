/// One ephemeris in RINEX text.
#pragma once

#include <tl/expected.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/time/gps_time.hpp"
#include "fields.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world::rinex {

/// Why a record cannot be used.
struct Defect {
    int line = 0;
    int column = 0;  ///< from 1
    std::string found;
    std::string expected;
};

/// Where the fields of a record stand.
enum class RecordLayout {
    legacy,   ///< as versions 2 and 3 have them
    cnav,     ///< of GPS and QZSS (RINEX 4.00, table A7)
    cnav2,    ///< likewise, with two more corrections of signals
    b_cnav,   ///< BeiDou B-CNAV1 and 2 (RINEX 4.00, tables A17 and A18)
    b_cnav3,  ///< BeiDou B-CNAV3 (table A19)
};

/// How many lines a record has: the epoch with the clock, then orbit lines of four fields.
struct RecordLength {
    std::size_t least = 8;
    std::size_t most = 8;
};
inline constexpr std::size_t longest_record = 10;
/// GLONASS records have a fifth line from version 3.05 on. The last line of modern ones tells the time of transmission,
/// which nobody needs.
constexpr RecordLength record_length(Constellation constellation, RecordLayout layout) {
    if (layout == RecordLayout::cnav || layout == RecordLayout::b_cnav3) return {8, 9};
    if (layout != RecordLayout::legacy) return {9, 10};
    if (constellation == Constellation::glonass) return {4, 5};
    if (constellation == Constellation::sbas) return {4, 4};
    return {8, 8};
}

/// What tells how a record is to be read.
struct RecordKind {
    SatelliteId satellite;
    int major = 3;                             ///< version
    std::optional<NavigationMessage> message;  ///< nothing: the record itself tells
    RecordLayout layout = RecordLayout::legacy;
};

/// True for a line on which a record begins: the lines that continue one begin with spaces.
bool begins_record(std::string_view line, int major);

/// The satellite that a record's first line names, or nothing. @param system of a version 2 file
std::optional<SatelliteId> record_satellite(std::string_view line, int major, Constellation system);

/// Reads the lines of one record.
tl::expected<Ephemeris, Defect> read_record(const RecordKind& kind, std::span<const Line> lines);

}  // namespace skyloop::inline world::rinex
