#include "skyloop/sky/observe_sky.hpp"

#include <cmath>
#include <optional>

#include "skyloop/geo/local_frame.hpp"
#include "skyloop/gnss/constants.hpp"
#include "skyloop/gnss/orbit.hpp"
#include "skyloop/gnss/signal.hpp"
#include "skyloop/sky/light_time.hpp"

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

SignalPath signal_path(const Ephemeris& ephemeris, const TruthState& truth) {
    SignalPath path;
    path.travel_time = usual_travel_time;
    // Each pass shrinks the error by v/c, 1e-5: from 0.1 s of travel time four passes reach the last bit.
    for (int pass = 0; pass < 5; ++pass) {
        path.transmitter = satellite_state(ephemeris, truth.time, -path.travel_time);
        path.seen_at = in_reception_frame(path.transmitter.position, path.travel_time);
        path.range = (path.seen_at - truth.position).length();
        const Seconds travel_time(path.range.value() / speed_of_light);
        const bool settled = std::abs((travel_time - path.travel_time).value()) < 1e-15;
        path.travel_time = travel_time;
        if (settled) break;
    }
    return path;
}

std::optional<SatelliteInView> in_view(const Ephemeris& record, const TruthState& truth, const LocalFrame& local) {
    const Ephemeris ephemeris = carried_to(record, truth.time - to_nanoseconds(usual_travel_time));
    // Half of the satellites stand far below the horizon, and one look without light time tells so: in a tenth of a
    // second a satellite moves by less than a kilometre.
    const SatelliteState rough = satellite_state(ephemeris, truth.time, -usual_travel_time);
    if (local.to_enu(rough.position).vector().z() < -1000) return std::nullopt;

    const SignalPath path = signal_path(ephemeris, truth);
    // The usual convention, and that of the reference scenes: directions leave out the Earth's rotation during the
    // light time. It would turn them by less than 0.0004°.
    const LookAngles look = local.look_angles(path.transmitter.position);
    if (!(look.elevation.rad() >= 0)) return std::nullopt;

    SatelliteInView seen;
    seen.id = satellite_of(record);
    seen.azimuth = look.azimuth;
    seen.elevation = look.elevation;
    seen.range = path.range;
    seen.range_rate = light_time_range_rate({path.transmitter.position, path.transmitter.velocity},
                                            {truth.position, truth.velocity}, path.travel_time);
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

SkyView observe_sky(const TruthState& truth, const NavigationSource& source) {
    const LocalFrame local(truth.geodetic);
    SkyView sky;
    for (const SatelliteId satellite : source.satellites()) {
        const std::optional<Ephemeris> ephemeris = source.ephemeris(satellite, truth.time);
        if (!ephemeris) continue;
        if (const std::optional<SatelliteInView> seen = in_view(*ephemeris, truth, local))
            sky.satellites.push_back(*seen);
    }
    return sky;
}

}  // namespace skyloop
