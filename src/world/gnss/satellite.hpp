/// Which satellite.
#pragma once

#include <array>
#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace skyloop::inline world {

/// Satellite systems, in the order in which receivers list them.
enum class Constellation { gps, sbas, galileo, beidou, qzss, glonass, navic };

/// "gps", "galileo", … as scenario and board files write them, in the order of Constellation.
inline constexpr std::array<std::string_view, 7> constellation_names{"gps",  "sbas",    "galileo", "beidou",
                                                                     "qzss", "glonass", "navic"};

/// One satellite: its system and its number as RINEX writes it (QZSS J01…, SBAS S20… = PRN − 100).
struct SatelliteId {
    Constellation constellation = Constellation::gps;
    int number = 0;
    auto operator<=>(const SatelliteId&) const = default;
};

/// The RINEX letter: G S E C J R I.
char rinex_letter(Constellation constellation);
/// One of constellation_names.
std::string_view constellation_name(Constellation constellation);
/// "GPS", "Galileo", … as people write it.
std::string_view constellation_title(Constellation constellation);
std::optional<Constellation> constellation_from_letter(char letter);
std::optional<Constellation> constellation_from_name(std::string_view name);

/// "G07".
std::string to_string(SatelliteId satellite);
/// Reads "G07" or "G 7".
std::optional<SatelliteId> parse_satellite(std::string_view text);

}  // namespace skyloop::inline world
