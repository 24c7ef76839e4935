/// Which satellites stand above the antenna.
#pragma once

#include <optional>
#include <vector>

#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/earlier_records.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

/// The true orbit and clock of a satellite against those of its record.
struct RecordError {
    Metres range;  ///< by how much the true range is longer than the record tells, satellite clock included
    MetresPerSecond range_rate;  ///< its derivative
};

/// One satellite above the horizon, seen with light time and Earth rotation.
struct SatelliteInView {
    SatelliteId id;
    Angle azimuth;  ///< 0 … 360°
    Angle elevation;
    Metres range;                ///< geometric, in the frame of the reception instant
    MetresPerSecond range_rate;  ///< derivative of the light-time range, receiver motion included
    Seconds travel_time;
    Position<Ecef> position_at_transmission;  ///< in the ECEF frame of the transmission instant
    Velocity<Ecef> velocity_at_transmission;
    Seconds clock_bias;          ///< satellite clock − GPST, relativity included
    double clock_drift = 0;      ///< s/s
    TransmittedSignals signals;  ///< the first one first; may be empty where only directions matter
    GpsTime toe;
    int iode = 0;
    bool healthy = true;
    EarlierRecords earlier_records;  ///< for models whose orbits are not quite those of the broadcast
    /// By precise products, of the satellite's centre of mass; nothing: they do not tell of it. Then nothing of
    /// `earlier_records` is left, for it does not step.
    std::optional<RecordError> record_error{};
    /// Of the first signal; 0 for a satellite without signals.
    [[nodiscard]] Seconds group_delay() const { return signals.empty() ? Seconds(0) : signals.front().group_delay; }
};

/// All satellites above the horizon at one instant, healthy or not, ascending by id.
struct SkyView {
    std::vector<SatelliteInView> satellites;
};

}  // namespace skyloop::inline world
