// UBX messages as they come, put together epoch by epoch.
#include "receiver/observed/ubx_epochs.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "receiver/protocol/ubx_inertial.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop {
namespace {

template <class Message>
UbxEpochs::Taken take_message(UbxEpochs& epochs, const Message& message) {
    const Bytes frame = encode_frame(message);
    return epochs.take(*parse_frame(frame));
}

TEST(UbxEpochs, JoinMessagesOfOneTimeInAnyOrder) {
    UbxEpochs epochs;
    NavVelned extreme;
    extreme.i_tow = 200;
    extreme.vel_n = std::numeric_limits<std::int32_t>::max();
    extreme.vel_d = -12;
    EXPECT_FALSE(epochs.epoch());
    EXPECT_EQ(take_message(epochs, NavTimeutc{.i_tow = 100}).part, UbxEpochs::says_utc);
    const auto next = take_message(epochs, extreme);
    EXPECT_EQ(next.part, UbxEpochs::says_velocity);
    ASSERT_TRUE(next.ended);
    EXPECT_FALSE(next.ended->is_solution);
    take_message(epochs, NavSol{.i_tow = 200, .gps_fix = 3, .flags = 0xDD, .num_sv = 9});
    take_message(epochs, NavPosllh{.i_tow = 200, .lon = -5, .lat = 10});
    EXPECT_FALSE(take_message(epochs, NavPosllh{.i_tow = 200, .lon = -6, .lat = 10}).ended);
    take_message(epochs, NavTimeutc{.i_tow = 200, .year = 2026, .month = 1, .day = 1, .valid = 0xF3});
    const auto whole = epochs.epoch();
    ASSERT_TRUE(whole && whole->place && whole->velocity);
    EXPECT_NEAR(whole->place->longitude.deg(), -6e-7, 1e-12);
    EXPECT_EQ(whole->type, FixType::fix_3d);
    EXPECT_EQ(whole->satellites_used, 9);
    EXPECT_FALSE(whole->utc_s) << "UTC is not known yet";
    EXPECT_NEAR(whole->velocity->north, 21474836.47, 1e-6);
    EXPECT_NEAR(whole->velocity->down, -0.12, 1e-12);
    EXPECT_EQ(whole->time, to_gps_time(0, 0.2));
    EXPECT_FALSE(whole->dated);
}

TEST(UbxEpochs, RefuseWrongLengthsAndTimes) {
    UbxEpochs epochs;
    NavPvt late;
    late.i_tow = 604'800'000;
    EXPECT_TRUE(take_message(epochs, late).is_senseless);
    const Bytes frame = encode_frame(NavTimeutc::message_id, {});
    EXPECT_TRUE(epochs.take(*parse_frame(frame)).is_senseless);
    EXPECT_FALSE(epochs.epoch());
}

// The one message of receivers with inertial sensors that has everything.
TEST(UbxEpochs, ReadNavPvat) {
    UbxEpochs epochs;
    NavPvat pvat{.i_tow = 216'018'000, .valid = 7, .year = 2024, .month = 3, .day = 5, .hour = 12};
    pvat.fix_type = 4, pvat.flags = 0x1D, pvat.num_sv = 11, pvat.lat = 470000000, pvat.lon = 80000000;
    pvat.height = 500000, pvat.vel_ned = {1000, 2000, -3000}, pvat.angle = {100000, 200000, 9000000};
    EXPECT_EQ(take_message(epochs, pvat).part, UbxEpochs::says_solution);
    const auto epoch = epochs.end();
    ASSERT_TRUE(epoch && epoch->place && epoch->velocity && epoch->attitude);
    EXPECT_TRUE(epoch->dated);
    EXPECT_EQ(epoch->time, to_gps_time(2304, 216018.0));
    EXPECT_NEAR(epoch->place->height.above_ellipsoid.value(), 500, 1e-9);
    EXPECT_EQ(epoch->velocity->down, -3);
    EXPECT_NEAR(epoch->attitude->yaw().deg(), 90, 1e-9);
    EXPECT_EQ(epoch->type, FixType::fix_3d);
    EXPECT_EQ(epoch->utc_s, 1709640000.0);
}

// What the second says of the place replaces what the first one said.
TEST(UbxEpochs, ASecondSolutionOfOneTimeIsTakenAnew) {
    UbxEpochs epochs;
    NavPvt pvt;
    pvt.i_tow = 1000, pvt.fix_type = 3, pvt.flags = 1, pvt.lat = 5;
    take_message(epochs, pvt);
    EXPECT_TRUE(epochs.epoch()->place);
    pvt.flags3 = 1;
    take_message(epochs, pvt);
    EXPECT_FALSE(epochs.epoch()->place);
}

}  // namespace
}  // namespace skyloop
