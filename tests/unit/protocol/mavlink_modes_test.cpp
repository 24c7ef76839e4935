#include "receiver/protocol/mavlink.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace skyloop {
namespace {

constexpr std::uint8_t fixed_wing = 1, quadrotor = 2, ground_rover = 10, quadplane = 20, ground_control = 6;

std::string mode_of(std::uint8_t autopilot, std::uint8_t type, std::uint32_t custom_mode, std::uint8_t base_mode = 1) {
    MavlinkHeartbeat beat;
    beat.autopilot = autopilot;
    beat.type = type;
    beat.custom_mode = custom_mode;
    beat.base_mode = base_mode;
    return mavlink_mode_name(beat);
}

TEST(MavlinkModes, OneNumberIsAnotherModeOnAnotherVehicle) {
    EXPECT_EQ(mode_of(3, quadrotor, 3), "AUTO");
    EXPECT_EQ(mode_of(3, fixed_wing, 10), "AUTO");
    EXPECT_EQ(mode_of(3, ground_rover, 10), "AUTO");
    EXPECT_EQ(mode_of(3, fixed_wing, 3), "TRAINING");
    EXPECT_EQ(mode_of(3, ground_rover, 3), "STEERING");
    EXPECT_EQ(mode_of(3, quadplane, 19), "QLOITER");
    EXPECT_EQ(mode_of(3, quadrotor, 8), "") << "ArduCopter has no mode 8";
}

TEST(MavlinkModes, Px4HasSubmodesOfAuto) {
    EXPECT_EQ(mode_of(12, quadrotor, 3U << 16), "POSCTL");
    EXPECT_EQ(mode_of(12, fixed_wing, 4U << 16 | 4U << 24), "AUTO.MISSION");
    EXPECT_EQ(mode_of(12, fixed_wing, 4U << 16 | 99U << 24), "AUTO");
    EXPECT_EQ(mode_of(12, fixed_wing, 99U << 16), "");
}

TEST(MavlinkModes, WithoutACustomModeThereIsNoName) {
    EXPECT_EQ(mode_of(3, quadrotor, 3, 0), "");
    EXPECT_EQ(mode_of(3, ground_control, 3), "");
    EXPECT_EQ(mode_of(8, quadrotor, 3), "");
}

TEST(MavlinkModes, NamesAreMatchedWithTheirSubmodes) {
    EXPECT_TRUE(is_mavlink_mode("AUTO", "auto"));
    EXPECT_TRUE(is_mavlink_mode("AUTO.RTL", "AUTO"));
    EXPECT_TRUE(is_mavlink_mode("AUTO.RTL", "Auto.Rtl"));
    EXPECT_FALSE(is_mavlink_mode("AUTO", "AUTO.RTL"));
    EXPECT_FALSE(is_mavlink_mode("AUTOTUNE", "AUTO"));
    EXPECT_FALSE(is_mavlink_mode("AUTO", ""));
    EXPECT_FALSE(is_mavlink_mode("", "AUTO"));
}

TEST(MavlinkModes, AllNamesAreListedOnce) {
    const auto& names = mavlink_mode_names();
    EXPECT_THAT(names, testing::IsSupersetOf({"AUTO", "AUTO.MISSION", "FBWA", "POSCTL", "STEERING"}));
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace skyloop
