/// A path that callers of the C library can tell.
#pragma once

#include <cmath>
#include <cstdint>

#include "skyloop.h"

namespace skyloop::test {

/// On a circle of 100 m at 10 m/s round the origin.
inline sky_truth truth_on_circle(std::int64_t time) {
    sky_truth truth{};
    truth.struct_size = sizeof truth;
    truth.fields = SKY_POS_LOCAL_NED | SKY_VEL;
    truth.sim_time_ns = time;
    const double turned = 0.1e-9 * static_cast<double>(time);
    truth.pos[0] = 100 * std::cos(turned);
    truth.pos[1] = 100 * std::sin(turned);
    truth.vel_ned[0] = -10 * std::sin(turned);
    truth.vel_ned[1] = 10 * std::cos(turned);
    return truth;
}

}  // namespace skyloop::test
