/// What distinguishes one receiver model from another, as data.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "skyloop/base/units.hpp"
#include "skyloop/gnss/satellite.hpp"
#include "skyloop/protocol/nmea_satellites.hpp"
#include "skyloop/protocol/nmea_version.hpp"

namespace skyloop::firmware {

/// Sentences that a receiver can send periodically, in the order in which they leave within one epoch.
enum class NmeaSentence { rmc, vtg, gga, gsa, gsv, gll, gst, zda };
inline constexpr std::string_view nmea_sentence_names[] = {"RMC", "VTG", "GGA", "GSA", "GSV", "GLL", "GST", "ZDA"};

/// A sentence and every how many epochs it is sent.
struct SentenceRate {
    NmeaSentence sentence;
    int every_epochs = 1;
};

/// One receiver model (boards/receivers/*.toml; every key in boards/README.md).
struct BoardProfile {
    std::string name;
    std::string description;
    std::uint32_t baud = 9600;  ///< of UART1 at the factory
    std::uint32_t transmit_buffer_bytes = 4096;
    std::vector<Constellation> constellations;  ///< enabled at the factory
    double default_rate_hz = 1;
    double max_rate_hz = 10;
    Angle elevation_mask = Angle::degrees(5);
    NmeaVersion nmea_version = NmeaVersion::v4_0;
    NmeaNumbering satellite_numbering = NmeaNumbering::strict;
    std::string main_talker;      ///< "GP", "GN", …; empty: by the enabled constellations
    int coordinate_decimals = 5;  ///< digits of the minutes of latitude and longitude
    int time_decimals = 2;
    int max_listed_satellites = 12;         ///< numSV of GGA stops here (12 in strict NMEA)
    MetresPerSecond course_min_speed{0.1};  ///< slower than this, the course is left empty
    std::vector<SentenceRate> sentences;    ///< factory output
    bool overflow_notice = false;           ///< a TXT says that messages did not fit into the transmit buffer
    Seconds solution_latency{0.05};         ///< from the epoch instant to the first byte of its output
};

}  // namespace skyloop::firmware
