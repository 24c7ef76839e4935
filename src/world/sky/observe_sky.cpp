#include "world/sky/observe_sky.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/geo/local_frame.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/earth_turn.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/signal.hpp"
#include "world/sky/light_time.hpp"

namespace skyloop {
namespace {

// A signal on its way from a satellite to the antenna.
struct SignalPath {
    SatelliteState transmitter;  // at transmission, in the frame of that instant
    Position<Ecef> seen_at;      // the transmitter's place in the frame of the reception instant
    Metres range;
    Seconds travel_time;
};

// About what a signal takes from a navigation satellite: 67 to 90 ms.
constexpr Seconds usual_travel_time(0.075);

// Below this by a rough look a satellite is below the horizon by an exact one.
constexpr double sure_to_be_down_deg = -0.1;

// The soonest that a satellite can stand on the horizon: seen from the ground none climbs faster than a degree in a
// minute, which the angular speed of an orbit of 11 h, 0.55° a minute, stays far below. A jump of the antenna of 10 km
// turns the horizon by 0.1°.
Seconds time_until_rise(Angle rough_elevation) {
    constexpr double margin_deg = 0.3;
    return Seconds(60 * std::max(0.0, -rough_elevation.deg() - margin_deg));
}

EcefMotion motion_of(const SatelliteState& state) { return {state.position, state.velocity}; }

// From the satellite's state the usual travel time ago.
SignalPath signal_path(const Ephemeris& ephemeris, const SatelliteState& usually, const TruthState& truth) {
    SignalPath path;
    path.travel_time = usual_travel_time;
    path.transmitter = usually;
    // By Newton's method: two steps reach the last bit, for the speed of a satellite changes by 1e-9 of that of light
    // in a second.
    for (int pass = 0; pass < 5; ++pass) {
        if (pass > 0) path.transmitter = satellite_state(ephemeris, truth.time, -path.travel_time);
        path.seen_at = in_reception_frame(path.transmitter.position, path.travel_time);
        path.range = (path.seen_at - truth.position).length();
        const Seconds travel_time(path.range.value() / speed_of_light);
        const Seconds error = travel_time - path.travel_time;
        if (std::abs(error.value()) < 1e-15) {
            path.travel_time = travel_time;
            break;
        }
        const MetresPerSecond slope = light_time_slope(motion_of(path.transmitter), truth.position, path.travel_time);
        path.travel_time += error / (1 - slope.value() / speed_of_light);
    }
    return path;
}

RecordRay ray_of(const SignalPath& path, const TruthState& truth) {
    return {path.seen_at.vector() - truth.position.vector(),
            turned_by(path.transmitter.velocity.vector(), path.travel_time.value()) - truth.velocity.vector(),
            path.travel_time};
}

SatelliteInView in_view(const Ephemeris& record, const SignalPath& path, const LookAngles& look,
                        const TruthState& truth) {
    SatelliteInView seen;
    seen.id = satellite_of(record);
    seen.azimuth = look.azimuth;
    seen.elevation = look.elevation;
    seen.range = path.range;
    seen.range_rate =
        light_time_range_rate(motion_of(path.transmitter), {truth.position, truth.velocity}, path.travel_time);
    seen.travel_time = path.travel_time;
    seen.position_at_transmission = path.transmitter.position;
    seen.velocity_at_transmission = path.transmitter.velocity;
    seen.clock_bias = Seconds(path.transmitter.clock_bias);
    seen.clock_drift = path.transmitter.clock_drift;
    seen.signals = transmitted_signals(record);
    seen.toe = toe_of(record);
    seen.iode = iode_of(record);
    seen.healthy = is_healthy(record);
    return seen;
}

}  // namespace

void SkyObserver::begin(const TruthState& truth, const NavigationSource& source) {
    constexpr double far_m = 10000;
    const Nanoseconds passed = truth.time - last_time_;
    const bool jumped = passed < Nanoseconds(0) || (truth.position - looked_from_).length().value() > far_m;
    if (satellites_.empty())
        for (const SatelliteId id : source.satellites())
            satellites_.push_back({id, truth.time});
    last_time_ = truth.time;
    if (!jumped) return;
    looked_from_ = truth.position;
    for (Satellite& satellite : satellites_)
        satellite.look_again = truth.time;
}

SkyView SkyObserver::observe(const TruthState& truth, const NavigationSource& source) {
    begin(truth, source);
    const LocalFrame local(truth.geodetic);
    SkyView sky;
    sky.satellites.reserve(satellites_.size() / 2);
    for (Satellite& satellite : satellites_) {
        if (truth.time < satellite.look_again) continue;
        const std::optional<Ephemeris> record = source.ephemeris(satellite.id, truth.time);
        if (!record) continue;
        const auto* glonass = std::get_if<GlonassEphemeris>(&*record);
        const Ephemeris orbit = glonass ? Ephemeris(carried_.at(*glonass, truth.time)) : *record;
        // A look without light time tells most: half of the satellites stand far below the horizon, and in a tenth of a
        // second a satellite moves by less than a kilometre.
        const SatelliteState usually = satellite_state(orbit, truth.time, -usual_travel_time);
        const Angle rough = local.look_angles(usually.position).elevation;
        if (rough.deg() < sure_to_be_down_deg) {
            satellite.look_again = advanced(truth.time, time_until_rise(rough));
            continue;
        }
        const SignalPath path = signal_path(orbit, usually, truth);
        // The usual convention, and that of the reference scenes: directions leave out the Earth's rotation during the
        // light time. It would turn them by less than 0.0004°.
        const LookAngles look = local.look_angles(path.transmitter.position);
        if (look.elevation.rad() < 0) continue;
        sky.satellites.push_back(in_view(*record, path, look, truth));
        sky.satellites.back().earlier_records = changes_.at(*record, source, truth.time, ray_of(path, truth));
    }
    return sky;
}

SkyView observe_sky(const TruthState& truth, const NavigationSource& source) {
    SkyObserver observer;
    return observer.observe(truth, source);
}

}  // namespace skyloop
