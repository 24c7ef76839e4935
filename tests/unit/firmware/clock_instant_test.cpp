#include "firmware/core/navigation_state.hpp"

#include <gtest/gtest.h>

#include "base/geo/local_frame.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

NavigationState flying_state(double clock_ahead_s) {
    NavigationState state;
    state.ever_had_fix = true;
    Fix& fix = state.epoch.fix;
    fix.type = FixType::fix_3d;
    fix.position = {Angle::degrees(47), Angle::degrees(8), {Metres(500)}};
    fix.velocity = {200, -100, -20};
    fix.clock_bias = Metres(speed_of_light * clock_ahead_s);
    return state;
}

Eigen::Vector3d carried_by(NavigationState& state) {
    const LocalFrame before(state.epoch.fix.position);
    carry_to_clock_instant(state);
    return before.to_enu(to_ecef(state.epoch.fix.position)).vector();
}

// A clock that is ahead calls an instant whole that is still to come.
TEST(ClockInstant, CarriesThePositionBackWhereTheClockIsAhead) {
    NavigationState state = flying_state(400e-6);
    const Eigen::Vector3d enu = carried_by(state);
    EXPECT_NEAR(enu.x(), 0.04, 1e-6);
    EXPECT_NEAR(enu.y(), -0.08, 1e-6);
    EXPECT_NEAR(enu.z(), -0.008, 1e-6);
}

TEST(ClockInstant, LeavesWholeMillisecondsAside) {
    NavigationState state = flying_state(-4.1e-3);
    EXPECT_EQ(clock_ahead(state), Nanoseconds(-100'000));
    EXPECT_NEAR(carried_by(state).y(), 0.02, 1e-6);
}

TEST(ClockInstant, LeavesAPositionWithoutASolvedClock) {
    NavigationState state = flying_state(400e-6);
    state.only_place_known = true;
    EXPECT_EQ(clock_ahead(state), Nanoseconds(0));
    const Angle latitude = state.epoch.fix.position.latitude;
    carry_to_clock_instant(state);
    EXPECT_EQ(state.epoch.fix.position.latitude, latitude);
}

}  // namespace
}  // namespace skyloop::firmware
