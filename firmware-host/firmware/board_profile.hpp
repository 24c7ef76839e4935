/// What distinguishes one receiver model from another, as data.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "skyloop/base/units.hpp"
#include "skyloop/gnss/satellite.hpp"

namespace skyloop::firmware {

/// Layout variants of NMEA 0183 (RECEIVER.md 5.2).
enum class NmeaVersion { v2_3, v4_0, v4_10, v4_11 };

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
    std::uint32_t baud = 9600;                 ///< of UART1 at the factory
    std::uint32_t transmit_buffer_bytes = 4096;
    std::vector<Constellation> constellations; ///< enabled at the factory
    double default_rate_hz = 1;
    double max_rate_hz = 10;
    Angle elevation_mask = Angle::degrees(5);
    NmeaVersion nmea_version = NmeaVersion::v4_0;
    std::string main_talker;                   ///< "GP", "GN", …; empty: by the enabled constellations
    int coordinate_decimals = 5;               ///< digits of the minutes of latitude and longitude
    int time_decimals = 2;
    int max_listed_satellites = 12;            ///< numSV of GGA stops here (12 in strict NMEA)
    std::vector<SentenceRate> sentences;       ///< factory output
    Seconds solution_latency{0.05};            ///< from the epoch instant to the first byte of its output
};

}  // namespace skyloop::firmware
