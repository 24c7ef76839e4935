/// What reaches the antenna.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/units.hpp"
#include "world/flow/earlier_records.hpp"
#include "world/gnss/dop.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

/// One carrier of a satellite as it reaches the antenna.
struct SignalArrival {
    Signal signal = Signal::l1;
    Hertz carrier;
    Seconds group_delay;         ///< of the satellite's hardware against its clock
    Decibels relative_power;     ///< C/N0 over that of the satellite's first signal
    bool arrives = true;         ///< false: nothing of this signal reaches the antenna
    Metres satellite_antenna{};  ///< what its phase centre adds to the range from the centre of mass
    Metres receiver_antenna{};   ///< what the receiver's adds to the range to its reference point
};

/// One ray beside the one that is tracked: reflected, or bent around an edge. What is tracked is the direct ray, or the
/// strongest one when the direct one is blocked.
struct Echo {
    SkyDirection from;            ///< as the antenna hears it; elevations below 0 too
    Metres excess;                ///< over the tracked ray; below 0 when that is not the first one to arrive
    MetresPerSecond excess_rate;  ///< its derivative
    double amplitude = 0;         ///< at the antenna's output and the first carrier, over that of the tracked ray
    Angle phase;                  ///< by which it lags behind the tracked ray, beside what the excess does
    int reflections = 0;
};

/// One satellite's signals as they reach the antenna: what delayed them and what weakened them, each cause by itself.
struct Arrival {
    SatelliteId id;
    SkyDirection direction;                              ///< where the satellite stands
    Metres range;                                        ///< geometric
    MetresPerSecond range_rate;                          ///< of the geometric range
    Seconds clock_bias;                                  ///< satellite clock − GPST, as broadcast
    double clock_drift = 0;                              ///< s/s
    InplaceVector<SignalArrival, most_signals> signals;  ///< the first one first

    bool line_of_sight = true;
    int paths = 1;                     ///< rays that arrive; 0: the satellite is hidden
    int reflections = 0;               ///< of the tracked ray
    Metres excess_path;                ///< of the tracked ray over the direct one
    MetresPerSecond excess_rate;       ///< its derivative
    bool echoes_known = false;         ///< `echoes` is all multipath that there is: a scene tells it; else what a
                                       ///< receiver has anyway comes to it
    std::vector<Echo> echoes;          ///< strongest first
    Metres signal_in_space_error;      ///< of orbit and clock against the broadcast, in the range
    MetresPerSecond range_rate_error;  ///< its derivative
    /// What of that makes up for a change of the broadcast record, with its rate and with changes that it leaves alone:
    /// range and clock step by the opposite, and the signal goes on.
    EarlierRecords earlier_records;
    /// What the tides of the solid Earth add to the range, too slowly for the Doppler, as phase centres do.
    Metres solid_tide{};
    double wind_up = 0;  ///< cycles by which the antennas' turning against each other advances every carrier's phase
    Metres false_range;  ///< what false signals add to the range, and a base station does not see
    MetresPerSecond false_range_rate;  ///< its derivative
    bool called_unhealthy = false;     ///< the satellite sends that it is not to be used, whatever its record says
    /// A fault leaves too little of it for a sensor model, which has no loops that could lose it.
    bool cut_off = false;
    Metres iono_delay;                ///< of the code of the first signal; the carrier is advanced by as much
    Metres false_iono_delay;          ///< what of that faults have added
    MetresPerSecond false_iono_rate;  ///< its derivative, along a fault's ramps
    Metres tropo_delay;
    Decibels free_space_loss;
    Decibels gas_loss;
    Decibels cloud_loss;
    Decibels rain_loss;
    Decibels foliage_loss;
    Decibels shadowing_loss;  ///< of the tracked ray by surroundings that no scene describes; below 0: a gain
    Decibels direct_loss;     ///< what obstacles take of it from the direct ray; the rest is fading
    bool shadowed = false;    ///< they stand before the direct ray
    Decibels iono_loss;
    Decibels reflection_loss;            ///< of the tracked ray, by reflections and at edges
    Decibels antenna_gain;               ///< of the receiving antenna in this direction, dBic
    Decibels power_offset;               ///< of this satellite against the nominal power, with what changes in time
    Decibels interference_loss;          ///< of C/N0, by jamming
    double amplitude_scintillation = 0;  ///< S4 at the first signal
    Angle phase_scintillation;           ///< 1 σ, at the first signal
    /// P_rec of the link budget of sensor models, before faults; nothing for a hidden satellite and of the modern
    /// model.
    std::optional<DecibelWatts> received_power{};
    std::optional<DbHz>
        cn0;  ///< of the first signal; nothing until a link budget has been made, or for a hidden satellite
};

/// How a satellite is received, by its tracked ray.
enum class Reception : std::uint8_t { line_of_sight, shadowed, reflected, blocked };
inline constexpr std::array reception_names{"line_of_sight", "shadowed", "reflected", "blocked"};

/// Shadowed: by obstacles, or by 3 dB of foliage. Blocked: nothing arrives, or 40 dB less.
inline Reception reception_of(const Arrival& arrival) {
    constexpr Decibels thick_foliage{3}, next_to_nothing{40};
    if (arrival.paths == 0 || arrival.shadowing_loss >= next_to_nothing) return Reception::blocked;
    if (!arrival.line_of_sight) return Reception::reflected;
    return arrival.shadowed || arrival.foliage_loss >= thick_foliage ? Reception::shadowed : Reception::line_of_sight;
}

/// One arrival for each satellite of the SkyView, in its order.
struct Arrivals {
    std::vector<Arrival> satellites;
    MetresPerSecond antenna_speed;  ///< over the ground
};

}  // namespace skyloop::inline world
