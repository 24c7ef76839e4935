/// What the receiver measures.
/// Navigation messages as they are received.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

/// One signal of one satellite, as tracked.
struct Observation {
    SatelliteId satellite;
    Signal signal = Signal::l1;
    Hertz carrier;                        ///< nominal
    DbHz cn0;                             ///< as the receiver estimates it
    std::optional<Metres> pseudorange;    ///< while the code is locked
    std::optional<double> carrier_phase;  ///< cycles, growing with the range; while the phase is locked
    std::optional<Hertz> doppler;         ///< positive when the range shrinks
    bool half_cycle_resolved = true;      ///< of the phase
    bool slipped = false;                 ///< the count of cycles broke since the epoch before
    Seconds lock_time;                    ///< since the phase was locked, or broke
    Metres pseudorange_deviation;         ///< 1 σ by the receiver's own knowledge of its loops
    double carrier_phase_deviation = 0;   ///< cycles
    Hertz doppler_deviation;
    /// How skew the peak of correlation is, by wide correlators: 0 of a clean signal; nothing where it is not measured.
    std::optional<double> correlation_distortion{};
    bool called_unhealthy = false;  ///< the satellite sends just now that it is not to be used
};

/// All signals that are tracked at one instant, ascending by satellite, then signal. The same instant for all of them.
struct Observations {
    GpsTime receive_time;        ///< as the receiver's own clock shows it
    bool clock_was_set = false;  ///< the receiver moved its clock by whole milliseconds since the epoch before
    std::vector<Observation> signals;
};

/// One subframe, string or page of one signal, in words as a u-blox receiver hands them out (RXM-SFRBX).
struct Subframe {
    SatelliteId satellite;
    Signal signal = Signal::l1;
    GpsTime end;                ///< when its last bit was sent
    int frequency_channel = 0;  ///< of GLONASS
    std::vector<std::uint32_t> words;
    std::optional<Ephemeris> record{};  ///< that is whole with this part: the others were received before it
};

}  // namespace skyloop::inline world
