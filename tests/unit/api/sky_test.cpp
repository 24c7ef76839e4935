// What stands above a receiver, and what an engine's rays find in the way.
#include <algorithm>
#include <cmath>
#include <limits>

#include "led_run.hpp"

namespace {

using namespace skyloop::test;

constexpr std::string_view measuring_scenario = "[run]\nseed = 4\n[[receiver]]\nboard = \"ublox-m9\"\n";

std::vector<sky_los> all_of(const std::vector<sky_sat>& satellites, std::uint8_t state) {
    std::vector<sky_los> all;
    for (const sky_sat& one : satellites) {
        sky_los los{};
        los.gnss_id = one.gnss_id;
        los.sv_id = one.sv_id;
        los.state = state;
        all.push_back(los);
    }
    return all;
}

sky_status tell(LedRun& run, const std::vector<sky_los>& los) {
    return sky_set_los(run, 0, los.data(), los.size(), sizeof(sky_los));
}

int used(const std::vector<sky_sat>& satellites) {
    return static_cast<int>(std::count_if(satellites.begin(), satellites.end(),
                                          [](const sky_sat& s) { return (s.flags & SKY_SAT_USED) != 0; }));
}

const sky_sat* find(const std::vector<sky_sat>& satellites, const sky_sat& wanted) {
    for (const sky_sat& one : satellites)
        if (one.gnss_id == wanted.gnss_id && one.sv_id == wanted.sv_id) return &one;
    return nullptr;
}

// The highest one that the receiver uses.
sky_sat highest_used(const std::vector<sky_sat>& satellites) {
    sky_sat best{};
    for (const sky_sat& one : satellites)
        if ((one.flags & SKY_SAT_USED) != 0 && one.el_deg > best.el_deg) best = one;
    return best;
}

TEST(LedSky, TellsDirectionsBeforeTheFirstEpochAndAfter) {
    LedRun run(measuring_scenario);
    const auto before = run.satellites();
    ASSERT_GT(before.size(), 6U);
    for (const sky_sat& one : before) {
        EXPECT_EQ(one.flags, SKY_SAT_HEALTHY);
        EXPECT_EQ(one.cn0_dbhz, 0);
        EXPECT_NEAR(std::hypot(one.los_ned[0], one.los_ned[1], one.los_ned[2]), 1, 1e-6);
        EXPECT_NEAR(std::asin(-one.los_ned[2]) * 180 / 3.14159265358979, one.el_deg, 1e-4);
        EXPECT_GE(one.el_deg, 0);
    }
    run.advance(2 * led_s);
    const auto after = run.satellites();
    ASSERT_EQ(after.size(), before.size());
    EXPECT_EQ(used(after), run.fix().satellites_used);
    EXPECT_GT(used(after), 4);
    const sky_sat best = highest_used(after);
    EXPECT_GT(best.cn0_dbhz, 30);
    EXPECT_EQ(best.flags, SKY_SAT_TRACKED | SKY_SAT_USED | SKY_SAT_HEALTHY | SKY_SAT_SEEN);
    EXPECT_NEAR(find(before, best)->az_deg, best.az_deg, 0.1);
}

// What is asked beyond the newest sample of a vehicle would be kept as shown.
TEST(LedSky, MayBeAskedBeforeTheFirstEpochWithoutChangingIt) {
    const auto first_fix = [](bool asked) {
        sky_create_info info = led_info(nullptr);
        info.start_utc = "2026-03-01T12:00:00.05Z";
        LedRun run(info, ideal_scenario);
        for (const std::int64_t time : {0 * led_ms, 100 * led_ms}) {
            sky_truth truth = truth_there(time, 46 + (time > 0 ? 1e-5 : 0), 30, 100);
            EXPECT_EQ(sky_set_truth(run, &truth), SKY_OK);
            run.advance(time + 40 * led_ms);
            if (asked) run.satellites();
        }
        run.advance(160 * led_ms);
        EXPECT_EQ(run.fix().epochs, 1U);
        return run.fix().lat_deg;
    };
    EXPECT_EQ(first_fix(true), first_fix(false));
}

TEST(LedSky, WhatIsBlockedIsNotUsed) {
    LedRun run(measuring_scenario);
    run.advance(2 * led_s);
    const auto sky = run.satellites();
    std::vector<sky_sat> east;
    std::copy_if(sky.begin(), sky.end(), std::back_inserter(east), [](const sky_sat& s) { return s.los_ned[1] > 0; });
    ASSERT_GT(used(east), 0);
    ASSERT_EQ(tell(run, all_of(east, SKY_LOS_BLOCKED)), SKY_OK);
    run.advance(6 * led_s);
    const auto walled = run.satellites();
    for (const sky_sat& one : east) {
        const sky_sat* now = find(walled, one);
        ASSERT_NE(now, nullptr);
        EXPECT_EQ(now->flags & (SKY_SAT_USED | SKY_SAT_SEEN), 0) << int{one.sv_id};
    }
    EXPECT_GE(used(walled), used(sky) - used(east)) << "others may take their place";
    EXPECT_LT(used(walled), used(sky));
    // What is taken back is as if it had never been said.
    ASSERT_EQ(tell(run, all_of(east, SKY_LOS_UNKNOWN)), SKY_OK);
    run.advance(20 * led_s);
    EXPECT_EQ(used(run.satellites()), used(sky));
}

TEST(LedSky, LeavesWeaken) {
    LedRun free(measuring_scenario), shaded(measuring_scenario);
    free.advance(2 * led_s);
    shaded.advance(2 * led_s);
    const sky_sat one = highest_used(shaded.satellites());
    auto los = all_of({one}, SKY_LOS_ATTENUATED);
    los[0].attenuation_db = 8;
    ASSERT_EQ(tell(shaded, los), SKY_OK);
    free.advance(5 * led_s);
    shaded.advance(5 * led_s);
    EXPECT_NEAR(find(shaded.satellites(), one)->cn0_dbhz, find(free.satellites(), one)->cn0_dbhz - 8, 2);
}

TEST(LedSky, AnEchoAloneIsTrackedOverItsLongerWay) {
    LedRun run("[model]\nname = \"baseline\"\n[model.baseline]\npreset = \"calibrated\"\n");
    run.advance(0);
    auto los = all_of(run.satellites(), SKY_LOS_BLOCKED);
    ASSERT_EQ(tell(run, los), SKY_OK);
    run.advance(led_s);
    EXPECT_LE(run.fix().type, SKY_FIX_DEAD_RECKONING);
    for (sky_los& one : los) {
        one.reflections = 2;
        one.excess_m[0] = 90;
        one.reflection_db[0] = -6;
        one.excess_m[1] = 30;
        one.reflection_db[1] = -3;
    }
    ASSERT_EQ(tell(run, los), SKY_OK);
    run.advance(2 * led_s);
    EXPECT_EQ(run.fix().type, SKY_FIX_3D);
    EXPECT_EQ(run.satellites()[0].flags & SKY_SAT_SEEN, 0);
}

TEST(LedSky, ReflectionsDisturbAMeasuringReceiver) {
    const auto error_with = [](bool reflected) {
        LedRun run(measuring_scenario);
        run.advance(2 * led_s);
        auto los = all_of(run.satellites(), SKY_LOS_CLEAR);
        for (std::size_t i = 0; i < los.size(); ++i) {
            los[i].reflections = reflected ? 1 : 0;
            los[i].excess_m[0] = 10 + 7.3F * static_cast<float>(i);
            los[i].reflection_db[0] = -3;
        }
        EXPECT_EQ(tell(run, los), SKY_OK);
        run.advance(60 * led_s);
        const sky_fix fix = run.fix();
        return std::hypot(fix.error_enu_m[0], fix.error_enu_m[1], fix.error_enu_m[2]);
    };
    EXPECT_GT(error_with(true), error_with(false));
}

TEST(LedSky, ASilentReceiverHasNoFix) {
    for (const char* fault : {R"("power_cut")", R"("dropped_epochs", "probability": 1)", R"("receiver_silent")"}) {
        LedRun run(measuring_scenario);
        run.advance(40 * led_s);
        (void)run.read();
        ASSERT_EQ(run.fix().ok, 1);
        const std::string command =
            std::string(R"({"command": "start_fault", "name": "dark", "kind": )") + fault + R"(, "for_s": 20})";
        ASSERT_EQ(sky_command(run, command.c_str()), SKY_OK) << run.last_error();
        run.advance(41500 * led_ms);
        EXPECT_EQ(run.fix().sim_time_ns, 40 * led_s) << fault << ": the last that left";
        EXPECT_EQ(run.fix().ok, 1) << fault;
        run.advance(45 * led_s);
        EXPECT_EQ(run.fix().type, SKY_FIX_NONE) << fault;
        EXPECT_EQ(run.fix().ok, 0) << fault;
        EXPECT_EQ(used(run.satellites()), 0) << fault;
        EXPECT_NE(run.query("status").find(R"("fix":{"type":"none","ok":false)"), std::string::npos)
            << run.query("status");
    }
}

TEST(LedSky, WhatCannotBeIsRefused) {
    LedRun run(measuring_scenario);
    run.advance(0);
    const sky_los good = all_of(run.satellites(), SKY_LOS_CLEAR)[0];
    const auto refused = [&](auto spoil) {
        sky_los los = good;
        spoil(los);
        return tell(run, {los});
    };
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(refused([](sky_los& l) { l.sv_id = 200; }), SKY_E_ARG);
    EXPECT_EQ(refused([](sky_los& l) { l.gnss_id = 99; }), SKY_E_ARG);
    EXPECT_EQ(refused([](sky_los& l) { l.state = 4; }), SKY_E_UNSUPPORTED);
    EXPECT_EQ(refused([](sky_los& l) { l.reflections = 5; }), SKY_E_RANGE);
    EXPECT_EQ(refused([&](sky_los& l) { l.reflections = 1, l.excess_m[0] = nan; }), SKY_E_RANGE);
    EXPECT_EQ(refused([](sky_los& l) { l.reflections = 1, l.excess_m[0] = -1; }), SKY_E_RANGE);
    EXPECT_EQ(refused([](sky_los& l) { l.reflections = 1, l.reflection_db[0] = 1; }), SKY_E_RANGE);
    EXPECT_EQ(refused([&](sky_los& l) { l.state = SKY_LOS_ATTENUATED, l.attenuation_db = nan; }), SKY_E_RANGE);
    EXPECT_EQ(sky_set_los(run, 0, &good, 1, sizeof good - 1), SKY_E_ARG);
    EXPECT_EQ(sky_set_los(run, 0, nullptr, 1, sizeof good), SKY_E_ARG);
    EXPECT_EQ(sky_set_los(run, 0, nullptr, 0, sizeof good), SKY_OK);
    EXPECT_EQ(sky_set_los(run, 0, &good, SIZE_MAX, sizeof good), SKY_E_ARG);
    EXPECT_EQ(sky_set_los(run, 9, &good, 1, sizeof good), SKY_E_ARG);
    EXPECT_EQ(sky_set_los(run, 9, nullptr, 0, sizeof good), SKY_E_ARG);
    EXPECT_EQ(sky_get_sats(run, 9, nullptr, 0, sizeof(sky_sat)), SKY_E_ARG);
    EXPECT_EQ(sky_get_sats(run, 0, nullptr, 3, sizeof(sky_sat)), SKY_E_ARG);
    EXPECT_GT(sky_get_sats(run, 0, nullptr, 0, sizeof(sky_sat)), 0);
}

// Elements of a later version are longer, and need not be aligned.
TEST(LedSky, WritesNothingBesideTheElementsAskedFor) {
    LedRun run(measuring_scenario);
    run.advance(0);
    constexpr std::size_t stride = sizeof(sky_sat) + 5;
    std::vector<unsigned char> room(3 * stride + 16, 0xAB);
    ASSERT_GT(sky_get_sats(run, 0, reinterpret_cast<sky_sat*>(room.data()), 3, stride), 3);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = sizeof(sky_sat); k < stride; ++k)
            EXPECT_EQ(room[i * stride + k], 0);
    EXPECT_TRUE(std::all_of(room.begin() + 3 * stride, room.end(), [](unsigned char c) { return c == 0xAB; }));
}

}  // namespace
