#include "world/gnss/carried_almanac.hpp"

#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"

namespace skyloop {

KeplerEphemeris carried_almanac(const KeplerEphemeris& record, GpsTime time) {
    const double passed = difference(time, record.toe).value();
    // The node's longitude counts from the start of the week.
    const auto weeks = static_cast<double>(week_and_tow(record.toe).week - week_and_tow(time).week);
    const double turned = earth_rotation_rate * static_cast<double>(seconds_per_week) * weeks;
    const double motion = std::sqrt(gravitational_constant_gps) / std::pow(record.sqrt_a, 3) + record.delta_n;
    const auto circle = [](double angle) { return std::remainder(angle, 2 * std::numbers::pi); };
    KeplerEphemeris carried = record;
    carried.toe = carried.toc = time;
    carried.i0 = record.i0 + record.idot * passed;
    carried.omega0 = circle(record.omega0 + record.omega_dot * passed + turned);
    carried.m0 = circle(record.m0 + motion * passed);
    carried.af0 = record.af0 + record.af1 * difference(time, record.toc).value();
    return carried;
}

}  // namespace skyloop
