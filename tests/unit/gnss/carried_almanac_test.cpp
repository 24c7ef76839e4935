#include "world/gnss/orbit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;

TEST(CarriedAlmanac, IsTheSameOrbitAndClock) {
    KeplerEphemeris almanac;
    almanac.satellite = {Constellation::gps, 5};
    almanac.message = NavigationMessage::almanac;
    almanac.toe = almanac.toc = to_gps_time(1886, 319488.0);
    almanac.sqrt_a = 5153.6;
    almanac.e = 0.0066;
    almanac.i0 = 0.989;
    almanac.omega0 = -0.56;
    almanac.omega = -1.78;
    almanac.omega_dot = -7.5e-9;
    almanac.m0 = 0.47;
    almanac.af0 = 9e-5;
    almanac.af1 = 3.6e-12;
    // Within the week, into the one before and into the one after next.
    for (const auto away : {-34h, 0h, 2h, -120h, 9 * 24h}) {
        const KeplerEphemeris carried = carried_almanac(almanac, almanac.toe + away);
        EXPECT_EQ(carried.toe, almanac.toe + away);
        EXPECT_EQ(carried.toc, carried.toe);
        EXPECT_LE(std::abs(carried.m0), 3.15);
        for (const auto offset : {-1h, 0h, 1h}) {
            const GpsTime t = carried.toe + offset;
            const SatelliteState is = satellite_state(carried, t), was = satellite_state(almanac, t);
            EXPECT_LT((is.position - was.position).length().value(), 1e-4) << away.count();
            EXPECT_NEAR(is.clock_bias, was.clock_bias, 1e-15) << away.count();
        }
    }
}

}  // namespace
}  // namespace skyloop::test
