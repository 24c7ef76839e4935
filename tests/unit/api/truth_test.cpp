// What a caller says of its vehicle is where the receiver finds itself.
#include <array>
#include <cmath>
#include <limits>

#include "base/geo/geoid.hpp"
#include "base/geo/local_frame.hpp"
#include "led_run.hpp"
#include "support/oracle_table.hpp"

namespace {

using namespace skyloop::test;

const skyloop::Geodetic there = skyloop::Geodetic::degrees(48.137, 11.575, 520);

sky_truth truth_at(std::uint32_t frame, const std::array<double, 3>& pos) {
    sky_truth truth{};
    truth.struct_size = sizeof truth;
    truth.fields = frame;
    for (std::size_t i = 0; i < 3; ++i)
        truth.pos[i] = pos[i];
    return truth;
}

void expect_there(LedRun& run) {
    const sky_fix fix = run.fix();
    EXPECT_EQ(fix.type, SKY_FIX_3D);
    EXPECT_EQ(fix.ok, 1);
    EXPECT_NEAR(fix.lat_deg, 48.137, 1e-8);
    EXPECT_NEAR(fix.lon_deg, 11.575, 1e-8);
    EXPECT_NEAR(fix.height_ellipsoid_m, 520, 1e-3);
    for (const double error : fix.error_enu_m)
        EXPECT_NEAR(error, 0, 1e-6);
}

sky_create_info info_with_origin() {
    sky_create_info info = led_info(nullptr);
    info.set = SKY_CREATE_ORIGIN;
    info.origin_lla[0] = 48;
    info.origin_lla[1] = 11.5;
    info.origin_lla[2] = 500;
    return info;
}

TEST(LedTruth, MayComeInEachFrame) {
    const auto ecef = skyloop::to_ecef(there).vector();
    const auto enu = skyloop::LocalFrame(skyloop::Geodetic::degrees(48, 11.5, 500)).to_enu(skyloop::to_ecef(there));
    const auto& local = enu.vector();
    const auto geoid = skyloop::Geoid::open(built_data() / "geoids/egm96-15.pgm");
    ASSERT_TRUE(geoid) << geoid.error().message;
    const double msl = 520 - geoid->undulation(there.latitude, there.longitude).value();
    EXPECT_GT(520 - msl, 40);  // the geoid lies 46 m above the ellipsoid there
    for (const sky_truth& truth :
         {truth_at(SKY_POS_ECEF, {ecef.x(), ecef.y(), ecef.z()}),
          truth_at(SKY_POS_LLA_ELLIPSOID, {48.137, 11.575, 520}), truth_at(SKY_POS_LLA_MSL, {48.137, 11.575, msl}),
          truth_at(SKY_POS_LOCAL_NED, {local.y(), local.x(), -local.z()})}) {
        SCOPED_TRACE(truth.fields);
        LedRun run(info_with_origin(), ideal_scenario);
        ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK) << run.last_error();
        run.advance(0);
        expect_there(run);
    }
}

void expect_at_origin(LedRun& run, double latitude) {
    sky_truth truth = truth_at(SKY_POS_LOCAL_NED, {0, 0, 0});
    ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK) << run.last_error();
    run.advance(0);
    EXPECT_NEAR(run.fix().lat_deg, latitude, 1e-8);
}

TEST(LedTruth, CountsLocalMetresFromWhereTheScenarioDoes) {
    LedRun told(
        "[model]\nname = \"ideal\"\n[trajectory]\nkind = \"live\"\nsource = \"udp-json:29990\"\n"
        "at = [47, 9, 400]\norigin = [48, 9, 400]\n[[receiver]]\n");
    expect_at_origin(told, 48);
    LedRun begins("[model]\nname = \"ideal\"\n[trajectory]\nkind = \"fixed\"\nat = [47, 9, 400]\n[[receiver]]\n");
    expect_at_origin(begins, 47);
    // The vehicle's place, not that of an antenna on its mast.
    LedRun beside(
        "[model]\nname = \"ideal\"\n[trajectory]\nkind = \"fixed\"\nat = [47, 9, 400]\n[[receiver]]\n"
        "antenna_offset_m = [0, 0, -2]\n");
    expect_at_origin(beside, 47);
    EXPECT_NEAR(beside.fix().height_ellipsoid_m, 402, 1e-3);
}

TEST(LedTruth, KeepsItsAttitudeWhereASampleTellsNone) {
    LedRun run("[model]\nname = \"ideal\"\n[[receiver]]\nrate_hz = 5\nantenna_offset_m = [2, 0, 0]\n");
    for (int i = 0; i <= 20; ++i) {
        sky_truth truth = truth_there(i * 50 * led_ms, 46, 30, 100);
        const double half = std::sqrt(0.5);
        if (i % 10 == 0) {  // looks east
            truth.fields |= SKY_ATT;
            truth.q_nb[0] = truth.q_nb[3] = half;
        }
        ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK);
        run.advance(i * 50 * led_ms);
        EXPECT_NEAR((run.fix().lon_deg - 30) * 111'320 * std::cos(46 / 57.29577951), 2, 0.02) << i;
        EXPECT_NEAR(run.fix().lat_deg, 46, 1e-7) << i;
    }
}

TEST(LedTruth, IsNotMovedByACommand) {
    LedRun run;
    constexpr const char* move = R"({"command": "move_to", "at": [10, 20]})";
    ASSERT_EQ(sky_command(run, move), SKY_OK);
    run.advance(0);
    EXPECT_NEAR(run.fix().lat_deg, 10, 1e-7);
    sky_truth truth = truth_there(led_s, 46, 30, 100);
    ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK);
    run.advance(led_s);
    EXPECT_NEAR(run.fix().lat_deg, 46, 1e-7);
    EXPECT_EQ(sky_command(run, move), SKY_E_UNSUPPORTED);
    EXPECT_EQ(run.last_error(), "move_to: sky_set_truth() says where vehicle 0 is");
}

TEST(LedTruth, AfterAMoveOfTheScenarioIsWhereAResetPutsIt) {
    LedRun run("[model]\nname = \"ideal\"\n[[receiver]]\n[[command]]\nkind = \"move_to\"\nat = [10, 20]\nat_s = 0.5\n");
    const auto latitude_with = [&](std::int64_t time, std::uint32_t more) {
        sky_truth truth = truth_there(time, 46, 30, 100);
        truth.fields |= more;
        EXPECT_EQ(sky_set_truth(run, &truth), SKY_OK);
        run.advance(time);
        return run.fix().lat_deg;
    };
    EXPECT_NEAR(latitude_with(0, 0), 46, 1e-7);
    EXPECT_NEAR(latitude_with(led_s, 0), 10, 1e-6);
    EXPECT_NEAR(latitude_with(2 * led_s, SKY_RESET), 46, 1e-7);
    EXPECT_NEAR(latitude_with(3 * led_s, SKY_RESET), 46, 1e-7);
}

TEST(LedTruth, IsInterpolatedBetweenSamplesAndLedOnBeyond) {
    LedRun run;
    fly_circle(run, 10 * led_s, 20 * led_ms);
    // Round the origin, which is the scenario's own place.
    const sky_fix fix = run.fix();
    EXPECT_EQ(fix.sim_time_ns, 10 * led_s);
    EXPECT_NEAR(fix.vel_ned[0], -10 * std::sin(1.0), 1e-3);
    EXPECT_NEAR(fix.vel_ned[1], 10 * std::cos(1.0), 1e-3);
    run.advance(10'200 * led_ms);
    EXPECT_NEAR(std::hypot(run.fix().vel_ned[0], run.fix().vel_ned[1]), 10, 0.5);
    run.advance(14 * led_s);
    EXPECT_NEAR(std::hypot(run.fix().vel_ned[0], run.fix().vel_ned[1]), 0, 1e-6);
}

TEST(LedTruth, ThatCeasesIsTold) {
    ToldSentences told(SKY_LOG_WARNING);
    sky_create_info info = led_info(nullptr);
    told.listen(info);
    LedRun run(info, ideal_scenario);
    fly_circle(run, 2 * led_s, 20 * led_ms);
    told.all.clear();
    run.advance(3 * led_s);
    EXPECT_TRUE(told.all.empty());
    run.advance(10 * led_s);
    EXPECT_EQ(told.all, std::vector<std::string>{
                            "vehicle 0 stands still at 3500000000 ns: nothing was said of it since 2000000000 ns"});
}

TEST(LedTruth, ThatJumpsIsThereAtOnce) {
    LedRun run;
    sky_truth truth = truth_there(0, 46, 30, 100);
    ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK);
    run.advance(led_s);
    truth = truth_there(led_s + 1, 47, 31, 100);
    truth.fields |= SKY_RESET;
    ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK);
    run.advance(1'200 * led_ms);
    EXPECT_NEAR(run.fix().lat_deg, 47, 1e-7);
    EXPECT_NEAR(std::hypot(run.fix().vel_ned[0], run.fix().vel_ned[1]), 0, 1e-3);
}

TEST(LedTruth, OfEachVehicleIsItsReceivers) {
    LedRun run(R"(
[model]
name = "ideal"
[[receiver]]
[[receiver]]
[receiver.trajectory]
kind = "fixed"
at = [10, 20, 30]
)");
    sky_truth truth = truth_there(0, 46, 30, 100);
    ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK);
    run.advance(0);
    EXPECT_NEAR(run.fix(0).lat_deg, 46, 1e-7);
    EXPECT_NEAR(run.fix(1).lat_deg, 10, 1e-7);
    truth = truth_there(led_s, -5, 100, 0);
    truth.vehicle = 2;
    ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK);
    run.advance(led_s);
    EXPECT_NEAR(run.fix(0).lat_deg, 46, 1e-7);
    EXPECT_NEAR(run.fix(1).lat_deg, -5, 1e-7);
    truth.vehicle = 1;
    EXPECT_EQ(sky_set_truth(run, &truth), SKY_E_ARG);
    EXPECT_NE(run.last_error().find("vehicle 1: no receiver rides on it"), std::string::npos) << run.last_error();
}

TEST(LedTruth, AnAntennaBesideTheVehicleIsBesideIt) {
    LedRun run("[model]\nname = \"ideal\"\n[[receiver]]\nantenna_offset_m = [2, 0, 0]\n");
    sky_truth truth = truth_there(0, 0, 30, 0);
    truth.vel_ned[0] = 10;  // looks north
    ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK);
    run.advance(0);
    EXPECT_NEAR(run.fix().lat_deg * 110'574, 2, 0.01);
}

struct BadTruth {
    const char* what;
    sky_status status;
    std::function<void(sky_truth&)> spoil;
};

TEST(LedTruth, ThatCannotBeIsRefused) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    const std::vector<BadTruth> cases{
        {"NaN place", SKY_E_RANGE, [&](sky_truth& t) { t.pos[1] = nan; }},
        {"infinite height", SKY_E_RANGE, [&](sky_truth& t) { t.pos[2] = inf; }},
        {"latitude", SKY_E_RANGE, [](sky_truth& t) { t.pos[0] = 90.5; }},
        {"huge longitude", SKY_E_RANGE, [](sky_truth& t) { t.pos[1] = 1e300; }},
        {"null island", SKY_E_RANGE, [](sky_truth& t) { t.pos[0] = t.pos[1] = 0; }},
        {"space", SKY_E_RANGE, [](sky_truth& t) { t.pos[2] = 2e6; }},
        {"NaN velocity", SKY_E_RANGE, [&](sky_truth& t) { t.vel_ned[2] = nan; }},
        {"too fast", SKY_E_RANGE, [](sky_truth& t) { t.vel_ned[0] = 20'000; }},
        {"long quaternion", SKY_E_RANGE, [](sky_truth& t) { t.fields |= SKY_ATT, t.q_nb[0] = 2; }},
        {"zero quaternion", SKY_E_RANGE, [](sky_truth& t) { t.fields |= SKY_ATT; }},
        {"hard acceleration", SKY_E_RANGE, [](sky_truth& t) { t.fields |= SKY_ACC, t.acc_ned[1] = 1000; }},
        {"fast turn", SKY_E_RANGE, [](sky_truth& t) { t.fields |= SKY_RATE, t.rate_frd[2] = -200; }},
        {"something reserved", SKY_E_UNSUPPORTED, [](sky_truth& t) { t.reserved = 7; }},
        {"infinite rate", SKY_E_RANGE, [&](sky_truth& t) { t.fields |= SKY_RATE, t.rate_frd[0] = -inf; }},
        {"centre of the Earth", SKY_E_RANGE,
         [](sky_truth& t) {
             t = truth_at(SKY_POS_ECEF, {0, 0, 0});
         }},
        {"far metres", SKY_E_RANGE,
         [](sky_truth& t) {
             t = truth_at(SKY_POS_LOCAL_NED, {1e200, 1e200, 0});
         }},
        {"no place", SKY_E_ARG, [](sky_truth& t) { t.fields = SKY_VEL; }},
        {"two places", SKY_E_ARG, [](sky_truth& t) { t.fields |= SKY_POS_ECEF; }},
        {"unknown field", SKY_E_UNSUPPORTED, [](sky_truth& t) { t.fields |= 1U << 20U; }},
        {"no vehicle", SKY_E_ARG, [](sky_truth& t) { t.vehicle = 4'000'000'000; }},
        {"short structure", SKY_E_ARG, [](sky_truth& t) { t.struct_size = sizeof t - 1; }},
        {"no size", SKY_E_ARG, [](sky_truth& t) { t.struct_size = 0; }},
        {"wild size", SKY_E_ARG, [](sky_truth& t) { t.struct_size = 0xCCCCCCCC; }},
        {"long ago", SKY_E_TIME, [](sky_truth& t) { t.sim_time_ns = -2 * led_s - 1; }},
        {"far ahead", SKY_E_TIME, [](sky_truth& t) { t.sim_time_ns = 2 * led_s + 1; }},
        {"the end of time", SKY_E_TIME, [](sky_truth& t) { t.sim_time_ns = INT64_MAX; }},
        {"the dawn of time", SKY_E_TIME, [](sky_truth& t) { t.sim_time_ns = INT64_MIN; }}};
    for (const BadTruth& one : cases) {
        SCOPED_TRACE(one.what);
        LedRun run;
        sky_truth truth = truth_there(0, 46, 30, 100);
        one.spoil(truth);
        EXPECT_EQ(sky_set_truth(run, &truth), one.status);
        EXPECT_FALSE(run.last_error().empty());
        run.advance(led_s);
        EXPECT_EQ(run.fix().type, SKY_FIX_3D);
    }
    LedRun run;
    EXPECT_EQ(sky_set_truth(run, nullptr), SKY_E_ARG);
}

TEST(LedTruth, ThatCannotBeIsToldWithItsBound) {
    LedRun run;
    const auto why = [&](const std::function<void(sky_truth&)>& spoil) {
        sky_truth truth = truth_there(0, 46, 30, 100);
        spoil(truth);
        EXPECT_EQ(sky_set_truth(run, &truth), SKY_E_RANGE);
        return run.last_error();
    };
    EXPECT_EQ(why([](sky_truth& t) { t.pos[2] = 2e6; }), "pos: height is 2e+06 m; expected -10 000 to 1 000 000");
    EXPECT_EQ(why([](sky_truth& t) { t.pos[2] = -2e4; }), "pos: height is -20000 m; expected -10 000 to 1 000 000");
    EXPECT_EQ(why([](sky_truth& t) { t.vel_ned[0] = 2e4; }), "the speed is 20000 m/s; expected less than 12 000");
    EXPECT_EQ(why([](sky_truth& t) { t.fields |= SKY_ACC, t.acc_ned[0] = -1500; }),
              "acc_ned is 1500 m/s²; expected less than 1000");
    EXPECT_EQ(why([](sky_truth& t) { t.fields |= SKY_RATE, t.rate_frd[0] = 250; }),
              "rate_frd is 250 rad/s; expected less than 200");
}

TEST(LedTruth, DoesNotGoBack) {
    LedRun run;
    sky_truth truth = truth_there(500 * led_ms, 46, 30, 100);
    ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK);
    ASSERT_EQ(sky_set_truth(run, &truth), SKY_OK);
    truth.sim_time_ns -= 1;
    EXPECT_EQ(sky_set_truth(run, &truth), SKY_E_TIME);
}

// A caller built for a later version, whose structures are longer.
TEST(LedTruth, OfALaterVersionIsUnderstoodAsFarAsItIsKnown) {
    struct Longer {
        sky_truth known{};
        double more[4]{1, 2, 3, 4};
    } truth;
    truth.known = truth_there(0, 48.137, 11.575, 520);
    truth.known.struct_size = sizeof truth;
    LedRun run;
    ASSERT_EQ(sky_set_truth(run, &truth.known), SKY_OK);
    struct LongerProgress {
        sky_progress known{};
        std::uint64_t more[2]{7, 7};
    } progress;
    progress.known.struct_size = sizeof progress;
    ASSERT_EQ(sky_advance(run, 0, &progress.known), SKY_OK);
    EXPECT_EQ(progress.known.struct_size, sizeof progress);
    EXPECT_EQ(progress.more[0], 0U);
    EXPECT_EQ(progress.more[1], 0U);
    expect_there(run);
}

}  // namespace
