/// RINEX navigation files that are written.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "world/gnss/ephemeris.hpp"
#include "world/gnss/navigation_source.hpp"

namespace skyloop {

/// What stands before the records.
struct NavigationTextHeader {
    BroadcastIonosphere ionosphere;
    std::optional<int> leap_seconds;  ///< GPST − UTC, s
    std::string program = "skyloop";  ///< with its version
    GpsTime date;                     ///< of the file
};

/// The header of a RINEX 3.04 mixed navigation file. Ionosphere coefficients have five digits, as the format has.
std::string navigation_header_text(const NavigationTextHeader& header);

/// One record of that file (RINEX 3.04, tables A6 to A18), thirteen digits a number: Galileo I/NAV with data sources
/// 517, F/NAV with 258 and the week as GPS counts it, BeiDou in BDT, GLONASS in UTC and kilometres. An almanac is
/// written as an ephemeris of its system. Version 3.04 has no place for GLONASS' Δτ_n and accuracy.
/// @param sent when it was broadcast first; nothing: toe stands for it
std::string navigation_record_text(const Ephemeris& record, std::optional<GpsTime> sent = std::nullopt);

/// A whole file: the records in the order given.
std::string navigation_text(std::span<const Ephemeris> records, const NavigationTextHeader& header);

}  // namespace skyloop
