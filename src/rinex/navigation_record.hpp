/// One LNAV ephemeris in RINEX text.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "fields.hpp"
#include "skyloop/gnss/ephemeris.hpp"

namespace skyloop::rinex {

/// Lines of an LNAV ephemeris of GPS or QZSS: the epoch with the clock, then seven of four fields.
inline constexpr std::size_t lnav_lines = 8;

/// Why a record cannot be used.
struct Defect {
    int line = 0;
    int column = 0;  ///< from 1
    std::string found;
    std::string expected;
};

/// Where the fields of a version stand.
struct RecordLayout {
    std::size_t epoch = 0;        ///< column of the year
    std::size_t epoch_width = 0;  ///< of the whole epoch
    std::size_t clock = 0;        ///< column of the first clock field
    std::size_t orbit = 0;        ///< column of the first field of the other lines
};
constexpr RecordLayout layout_of_version(int major) {
    return major == 2 ? RecordLayout{3, 19, 22, 3} : RecordLayout{4, 19, 23, 4};
}

/// True for a line on which a record begins: the lines that continue one begin with spaces.
bool begins_record(std::string_view line, int major);

/// The satellite that a record's first line names, or nothing.
std::optional<SatelliteId> record_satellite(std::string_view line, int major);

/// Reads the lines of one record.
tl::expected<KeplerEphemeris, Defect> read_lnav_record(SatelliteId satellite, std::span<const Line, lnav_lines> lines,
                                                       int major);

}  // namespace skyloop::rinex
