/// RINEX navigation files that are written.
/// RINEX observation files that are written while a receiver runs.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/geo/frames.hpp"
#include "world/flow/observations.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

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

/// What must be known before the first epoch.
struct ObservationHeader {
    Position<Ecef> approximate_position;                   ///< of the antenna
    std::map<Constellation, std::vector<Signal>> signals;  ///< that may occur; others are left out of the epochs
    Seconds interval{1};                                   ///< between epochs; 0: not told
    GpsTime first_epoch;                                   ///< also the date of the file
    std::map<int, int> glonass_channels;                   ///< frequency channel by slot
    std::optional<int> leap_seconds;                       ///< GPST − UTC, s; nothing: as announced at first_epoch
    std::string program = "skyloop";                       ///< with its version
    std::string marker = "SKYLOOP";
    std::string receiver;
    std::string receiver_version;
    std::string antenna;
};

/// Writes RINEX 3.04 mixed observation text: code, phase, Doppler and strength (C L D S) of each declared signal,
/// epochs in GPST. The text is complete after each epoch, and depends on nothing but what is given.
class ObservationWriter {
public:
    /// Signals that a system does not send are dropped.
    explicit ObservationWriter(ObservationHeader header);

    /// The lines up to END OF HEADER.
    [[nodiscard]] std::string header() const;
    /// One epoch, flag 0: receive_time rounded to 100 ns, metres and cycles and Hz to 0.001, blank where not measured
    /// or wider than the format. The phase carries the loss-of-lock indicator (1 slipped, 2 half cycle unresolved),
    /// phase and code the strength digit (RINEX 3.04, 5.7 and tables 9, A3).
    [[nodiscard]] std::string epoch(const Observations& observations) const;

private:
    [[nodiscard]] std::string system_lines() const;
    [[nodiscard]] std::string glonass_lines() const;
    [[nodiscard]] std::optional<std::size_t> place(const Observation& observation) const;

    ObservationHeader header_;
};

}  // namespace skyloop::inline world
