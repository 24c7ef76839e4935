#include "firmware/core/navigation_state.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {

Nanoseconds clock_ahead(const NavigationState& state) {
    if (!estimates_known(state)) return Nanoseconds(0);
    constexpr double millisecond_ns = 1e6, nanoseconds = 1e9;
    const double bias_ns = state.epoch.fix.clock_bias.value() / speed_of_light * nanoseconds;
    // A whole half would belong to another millisecond.
    constexpr std::int64_t nearly_half = 499'999;
    return Nanoseconds(
        std::clamp<std::int64_t>(std::llround(std::remainder(bias_ns, millisecond_ns)), -nearly_half, nearly_half));
}

void carry_to_clock_instant(NavigationState& state) {
    Fix& fix = state.epoch.fix;
    const Nanoseconds ahead = clock_ahead(state);
    if (!fix.has_position() || ahead == Nanoseconds(0)) return;
    fix.position = carried(fix.position, fix.velocity, Seconds(std::chrono::duration<double>(-ahead).count()));
}

// A range that shrinks was longer before.
Observation carried(const Observation& measured, Seconds past) {
    Observation then = measured;
    if (!measured.doppler) return then;
    const double cycles = past.value() * measured.doppler->value();
    if (then.pseudorange) *then.pseudorange += Metres(cycles * speed_of_light / measured.carrier.value());
    if (then.carrier_phase) *then.carrier_phase += cycles;
    return then;
}

void tell_given_place(NavigationState& state) {
    if (state.epoch.fix.type != FixType::time_only) return;
    state.epoch.fix.type = FixType::fix_3d;
    state.place_given = true;
}

Geodetic carried(const Geodetic& from, const VelocityNed& velocity, Seconds time) {
    const double t = time.value();
    return to_geodetic(
        LocalFrame(from).to_ecef(Position<Enu>{velocity.east * t, velocity.north * t, -velocity.down * t}));
}

}  // namespace skyloop::firmware
