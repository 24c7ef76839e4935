// What a caller says of its vehicle is where the receiver finds itself.
#include <array>
#include <cmath>
#include <limits>

#include "led_run.hpp"
#include "skyloop/geo/geoid.hpp"
#include "skyloop/geo/local_frame.hpp"
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
    std::vector<std::string> told;
    sky_create_info info = led_info(nullptr);
    info.log_user = &told;
    info.log = [](void* user, std::int32_t level, const char* sentence) {
        if (level == SKY_LOG_WARNING) static_cast<std::vector<std::string>*>(user)->emplace_back(sentence);
    };
    LedRun run(info, ideal_scenario);
    fly_circle(run, 2 * led_s, 20 * led_ms);
    told.clear();
    run.advance(3 * led_s);
    EXPECT_TRUE(told.empty());
    run.advance(10 * led_s);
    ASSERT_EQ(told.size(), 1U);
    EXPECT_NE(told[0].find("nothing was said of it since 2000000000 ns"), std::string::npos) << told[0];
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
