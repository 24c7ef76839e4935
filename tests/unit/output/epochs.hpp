/// Epochs of a receiver that drives north, as observers see them.
#pragma once

#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "firmware/core/navigation_state.hpp"
#include "run/fault/run_observer.hpp"

namespace skyloop::test {

/// One epoch. Its truth stands 2 m south of the fix and as high.
struct SampleEpoch {
    explicit SampleEpoch(Seconds after_start = Seconds(0)) {
        const GpsTime start = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
        trace.truth.time = advanced(start, after_start);
        trace.truth.geodetic = Geodetic::degrees(47, 8, 500);
        trace.truth.position = to_ecef(trace.truth.geodetic);
        const LocalFrame frame(trace.truth.geodetic);
        trace.truth.velocity = frame.to_ecef(Velocity<Enu>(Eigen::Vector3d(1, 12, -0.5)));
        SatelliteInView view;
        view.id = {Constellation::gps, 7};
        view.azimuth = Angle::degrees(123.45);
        view.elevation = Angle::degrees(45);
        trace.sky.satellites = {view};

        Fix& fix = state.epoch.fix;
        fix.time = trace.truth.time;
        fix.type = FixType::fix_3d;
        fix.position = to_geodetic(frame.to_ecef(Position<Enu>(Eigen::Vector3d(0, 2, 0))));
        fix.geoid_undulation = Metres(48);
        fix.velocity = {12, 1, 0.5};
        fix.speed = MetresPerSecond(12.04);
        fix.dop = {1.5, 1.3, 0.8, 1.0, 0.7, 0.5, 0.6};
        fix.horizontal_accuracy = Metres(1.25);
        fix.vertical_accuracy = Metres(2.5);
        fix.speed_accuracy = MetresPerSecond(0.1);
        fix.satellites = {{view.id, view.azimuth, view.elevation, DbHz(44.5), true}};
        state.course = Angle::degrees(4.76);
        state.fix_ok = true;
        state.time = {true, true, true, true, Seconds(1e-8)};
        leaves = advanced(fix.time, Seconds(0.05));
    }
    [[nodiscard]] EpochSeen seen(std::size_t station = 0) const {
        return {trace.truth.time, station, trace, state, Nanoseconds(0), leaves};
    }

    Trace trace{};
    firmware::NavigationState state{};
    std::optional<GpsTime> leaves;
};

}  // namespace skyloop::test
