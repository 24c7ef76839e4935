/// What several logs of a Unicore receiver share.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "firmware/core/navigation_state.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::firmware {

/// The number of a kind of solution by its word.
std::uint32_t unicore_type_number(std::string_view word);
/// The kind of the position; 0 without one.
std::uint32_t unicore_type(const NavigationState& state);
/// Satellites that are tracked.
std::uint8_t tracked_satellites(const Fix& fix);

/// 1 σ along north, east and up, of a position or a velocity.
struct UnicoreDeviations {
    double north = 0, east = 0, up = 0;
};
UnicoreDeviations position_deviations(const Fix& fix);
UnicoreDeviations velocity_deviations(const Fix& fix);

/// The vector from this antenna, the master, to the other one of the pair, the slave.
struct OtherAntenna {
    double length = 0, heading_deg = 0, pitch_deg = 0;  ///< metres; heading 0 … 360 from true north
    double heading_std_deg = 0, pitch_std_deg = 0;      ///< 1 σ
    bool fixed = false;                                 ///< the ambiguities are whole numbers
};
/// Nothing without a pair.
std::optional<OtherAntenna> other_antenna(const ReportContext& context);

/// A satellite's number where all systems share one row: GLONASS from 38, Galileo from 71, BeiDou from 161, QZSS from
/// 193, SBAS as its PRN. Of GLONASS from RTKLIB; of Galileo and BeiDou inferred from one log of a UM982 in Huntsville.
std::uint16_t unicore_prn(SatelliteId id);

/// The station of the corrections in the solution, and their age, s; nothing and 0 without.
void put_unicore_station(const NavigationState& state, std::array<char, 4>& to);
float unicore_age(const NavigationState& state);

}  // namespace skyloop::firmware
