/// How NMEA 0183 names systems, satellites and signals (RECEIVER.md 5.6).
/// Layout variants of NMEA 0183.
#pragma once

#include <optional>
#include <string_view>

#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline receiver {

/// Which fields the sentences have and how satellites are numbered (RECEIVER.md 5.2).
enum class NmeaVersion { v2_1, v2_3, v3_0, v4_0, v4_10, v4_11 };

/// A group of satellites that GSA and GSV report together.
struct NmeaSystem {
    std::string_view talker;  ///< "GP"
    int system_id = 1;        ///< 1 GPS and SBAS, 2 GLONASS, 3 Galileo, 4 BeiDou, 5 QZSS, 6 NavIC
    int l1_signal_id = 1;     ///< of the system's open signal on L1 (NavIC: L5)
    bool operator==(const NmeaSystem&) const = default;
};

/// The group of a constellation. SBAS is listed with GPS, and so is QZSS before version 4.11.
NmeaSystem nmea_system(Constellation constellation, NmeaVersion version);

/// The id of a signal in GSV, GRS and GBS since version 4.10; 0 for a signal that has none. BeiDou's B2I changed with
/// version 4.11.
int nmea_signal_id(Constellation constellation, Signal signal, NmeaVersion version);

/// What satellites have numbers: those of the standard alone, or the receiver maker's additions too.
enum class NmeaNumbering { strict, extended };

/// The number of a satellite in GSA and GSV, or nothing where the version has none for it.
std::optional<int> nmea_satellite_number(SatelliteId satellite, NmeaVersion version, NmeaNumbering numbering);

/// The satellite that a number means beside the talker of its GSV sentence, or, with talker GN, the system id of its
/// GSA sentence (0 where there is none). Nothing for numbers outside every table.
std::optional<SatelliteId> satellite_from_nmea(int number, std::string_view talker, int system_id = 0);

/// A satellite's number in one byte, as u-blox counts in PUBX,03 and NAV-SVINFO (RECEIVER.md 5.6), or nothing where it
/// has none.
std::optional<int> single_byte_number(SatelliteId satellite);
/// The satellite of such a number.
std::optional<SatelliteId> single_byte_satellite(int number);

}  // namespace skyloop::inline receiver
