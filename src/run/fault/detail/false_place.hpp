/// What false signals make of the ranges to the satellites.
#pragma once

#include <map>
#include <optional>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop::inline run {

/// Where an antenna is, or is made to believe that it is, and how it moves.
struct AntennaMotion {
    Position<Ecef> position;
    Velocity<Ecef> velocity;
};

/// A range and its derivative.
struct RangeAndRate {
    Metres range;
    MetresPerSecond rate;
};

/// Range from a satellite of the sky, as an antenna elsewhere would see it at the same instant: the light time is
/// solved for that place, with the satellite moved along its velocity (MODELS.md 3.4). Good to a millimetre for places
/// within 100 km of the antenna whose sky this is.
RangeAndRate light_time_range(const SatelliteInView& satellite, const AntennaMotion& antenna);

/// What is to be added to a range for the false place to come out.
RangeAndRate false_range(const SatelliteInView& satellite, const AntennaMotion& told, const TruthState& truth);

/// A way from 0 to `distance` that begins and ends at rest: it speeds up, keeps its speed, slows down.
struct SmoothWay {
    Metres distance;
    MetresPerSecond speed;    ///< at most
    double acceleration = 1;  ///< m/s², of both ends
    [[nodiscard]] Metres after(Seconds time) const;
};

/// Rates of values that are known at the epochs alone: the change since the epoch before.
///
/// State: the last value of each satellite.
class RateOfChange {
public:
    /// 0 at the first epoch of a satellite: a step has no rate.
    MetresPerSecond of(SatelliteId satellite, Metres value, GpsTime now);

private:
    struct Last {
        Metres value;
        GpsTime at;
    };
    std::map<SatelliteId, Last> last_;
};

}  // namespace skyloop::inline run
