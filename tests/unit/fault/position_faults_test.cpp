// Each fault of the solution in the client's bytes, UBX and NMEA alike, and its end.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "receiver/protocol/ubx_services.hpp"
#include "receiver_bench.hpp"
#include "run/fault/command.hpp"

namespace skyloop {
namespace {

using fault_test::Given;
using fault_test::make_fault;
using fault_test::ReceiverBench;

// Minutes of latitude of a GGA whose degrees are two digits.
double gga_minutes(const ReceiverBench& bench) { return std::stod(bench.sentence("GGA")[2].substr(2)); }

// Nothing of a fault is left: the solution is what it was before, field by field.
void expect_no_residue(ReceiverBench& bench, const NavPvt& before) {
    bench.end();
    bench.forget();
    const NavPvt after = bench.next();
    EXPECT_EQ(after.lat, before.lat);
    EXPECT_EQ(after.lon, before.lon);
    EXPECT_EQ(after.height, before.height);
    EXPECT_EQ(after.vel_n, before.vel_n);
    EXPECT_EQ(after.vel_e, before.vel_e);
    EXPECT_EQ(after.vel_d, before.vel_d);
    EXPECT_EQ(after.h_acc, before.h_acc);
    EXPECT_EQ(after.fix_type, before.fix_type);
    EXPECT_EQ(after.flags, before.flags);
    EXPECT_EQ(after.num_sv, before.num_sv);
    EXPECT_EQ(bench.all<NavPvt>().size(), 1U);
}

TEST(PositionFaults, StepsByItsVectorTimesItsStrength) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    const double minutes = gga_minutes(bench);
    bench.begin("position_step", {{"east_m", 30.0}, {"north_m", 40.0}, {"up_m", -5.0}}, 0.5);
    const auto error = ReceiverBench::error(bench.next()).vector();
    EXPECT_NEAR(error.x(), 15, 0.02);
    EXPECT_NEAR(error.y(), 20, 0.02);
    EXPECT_NEAR(error.z(), -2.5, 0.02);
    EXPECT_NEAR(gga_minutes(bench) - minutes, 20 / 1852.9, 2e-5) << "and in NMEA";
    expect_no_residue(bench, before);
}

TEST(PositionFaults, AComponentThatIsGivenStandsAlone) {
    const auto error_of = [](const std::string& kind, const ParameterMap& parameters) {
        ReceiverBench bench;
        bench.begin(kind, parameters);
        bench.next();
        const NavPvt pvt = bench.next();
        const auto error = ReceiverBench::error(pvt).vector();
        return std::array<double, 4>{error.x(), error.y(), double(pvt.vel_e), double(pvt.vel_n)};
    };
    const auto still = error_of("height_bias", {});
    const auto step = error_of("position_step", {{"east_m", 100.0}});
    EXPECT_NEAR(step[0], 100, 0.02);
    EXPECT_NEAR(step[1], 0, 0.02);
    EXPECT_NEAR(error_of("position_step", {})[1], 50, 0.02);
    EXPECT_NEAR(error_of("biased_good_dop", {{"up_m", 3.0}})[1], 0, 0.02);
    EXPECT_NEAR(error_of("position_ramp", {{"east_mps", 5.0}})[1], 0, 0.02);
    EXPECT_GT(error_of("position_ramp", {})[1], 0.9);
    const auto biased = error_of("velocity_bias", {{"east_mps", 1.0}});
    EXPECT_EQ(biased[2] - still[2], 1000);
    EXPECT_EQ(biased[3], still[3]);
    EXPECT_EQ(error_of("velocity_bias", {})[3] - still[3], 2000);
}

TEST(PositionFaults, ALongStepFollowsTheGround) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("position_step", {{"east_m", 6000.0}, {"north_m", 8000.0}});
    const NavPvt away = bench.next();
    EXPECT_NEAR(away.height, before.height, 1) << "mm; the tangent plane is 7.8 m above the ground there";
    const auto error = ReceiverBench::error(away).vector();
    EXPECT_NEAR(error.x(), 6000, 8);
    EXPECT_NEAR(error.y(), 8000, 8);
    EXPECT_NEAR(error.z(), -10e3 * 10e3 / 2 / 6.38e6, 0.1);
    expect_no_residue(bench, before);
}

TEST(PositionFaults, RampsUpToItsLimit) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("position_ramp", {{"north_mps", 3.0}, {"most_m", 10.0}, {"velocity_too", true}});
    const NavPvt first = bench.next(), second = bench.next();
    EXPECT_NEAR(ReceiverBench::error(first).vector().y(), 0.3, 0.02) << "a tenth of a second after its start";
    EXPECT_NEAR(ReceiverBench::error(second).vector().y(), 3.3, 0.02);
    EXPECT_EQ(second.vel_n, 13000);
    bench.wait(6);
    const NavPvt late = bench.last<NavPvt>();
    EXPECT_NEAR(ReceiverBench::error(late).vector().y(), 10, 0.02);
    EXPECT_EQ(late.vel_n, 10000) << "the error no longer grows";
    expect_no_residue(bench, before);
}

TEST(PositionFaults, DriftsTheSameWayWithTheSameSeedAndFartherWithTime) {
    const auto path = [] {
        ReceiverBench bench;
        bench.begin("drift", {{"horizontal_m_per_sqrt_s", 2.0}});
        std::vector<double> north;
        for (int i = 0; i < 60; ++i)
            north.push_back(ReceiverBench::error(bench.next()).vector().y());
        return north;
    };
    const std::vector<double> north = path();
    EXPECT_EQ(north, path());
    EXPECT_NEAR(north.front(), 0, 0.02) << "it begins at the true place";
    double squares = 0;
    for (std::size_t i = 1; i < north.size(); ++i)
        squares += (north[i] - north[i - 1]) * (north[i] - north[i - 1]);
    EXPECT_NEAR(std::sqrt(squares / 59), 2, 0.6) << "a step of 2 m in a second";
}

TEST(PositionFaults, WandersWithinItsDeviation) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("wander", {{"horizontal_m", 5.0}, {"correlation_time_s", 1.0}});
    double squares = 0;
    for (int i = 0; i < 200; ++i) {
        const double north = ReceiverBench::error(bench.next()).vector().y();
        squares += north * north;
    }
    EXPECT_NEAR(std::sqrt(squares / 200), 5, 1.0);
    expect_no_residue(bench, before);
}

TEST(PositionFaults, BiasesVelocityAndHeight) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("velocity_bias", {{"east_mps", 10.0}, {"north_mps", 0.0}, {"up_mps", 1.0}});
    const NavPvt biased = bench.next();
    EXPECT_EQ(biased.vel_e, 10000);
    EXPECT_EQ(biased.vel_d, -1000);
    EXPECT_EQ(biased.g_speed, 14142);
    EXPECT_EQ(biased.head_mot, 4500000);
    EXPECT_EQ(biased.lat, before.lat);
    EXPECT_NEAR(std::stod(bench.sentence("RMC")[7]), 14.142 / 0.514444, 0.01);
    expect_no_residue(bench, before);
    bench.begin("height_bias", {{"height_m", 30.0}});
    const NavPvt high = bench.next();
    EXPECT_EQ(high.height - before.height, 30000);
    EXPECT_EQ(high.h_msl - before.h_msl, 30000);
    EXPECT_NEAR(std::stod(bench.sentence("GGA")[9]), before.h_msl * 1e-3 + 30, 0.06);
    expect_no_residue(bench, before);
}

TEST(PositionFaults, LiesOffWithAGoodDop) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("biased_good_dop", {{"north_m", 80.0}, {"hdop", 0.5}, {"accuracy_m", 0.7}});
    const NavPvt biased = bench.next();
    EXPECT_NEAR(ReceiverBench::error(biased).vector().y(), 80, 0.05);
    EXPECT_EQ(biased.h_acc, 700U);
    EXPECT_LT(biased.p_dop, before.p_dop / 2);
    EXPECT_EQ(bench.sentence("GGA")[8], "0.50");
    expect_no_residue(bench, before);
}

TEST(PositionFaults, ScalesAccuracies) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("accuracy_scale", {{"factor", 0.1}});
    EXPECT_EQ(bench.next().h_acc, before.h_acc / 10);
    expect_no_residue(bench, before);
}

TEST(PositionFaults, FreezesWhileTimeGoesOn) {
    ReceiverBench bench;
    bench.wait(1);
    bench.begin("freeze");
    const NavPvt first = bench.next();
    bench.fix().position = Geodetic::degrees(47.5, 8.5, 600);
    bench.fix().velocity = {};
    const NavPvt later = bench.next();
    EXPECT_EQ(later.i_tow, first.i_tow + 1000);
    EXPECT_EQ(later.lat, first.lat);
    EXPECT_EQ(later.height, first.height);
    EXPECT_EQ(later.vel_n, first.vel_n);
    EXPECT_EQ(bench.receiver().state().epoch.fix.position.latitude, Angle::degrees(47)) << "polls say the same";
    bench.end();
    EXPECT_EQ(bench.next().lat, 475000000) << "the true place, at once";
}

TEST(PositionFaults, ClaimsAnotherTypeOfFix) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("wrong_fix_type", {{"type", std::string("rtk_fixed")}});
    const NavPvt claimed = bench.next();
    EXPECT_EQ(claimed.flags >> 6, 2);
    EXPECT_EQ(bench.sentence("GGA")[6], "4");
    expect_no_residue(bench, before);
    bench.begin("wrong_fix_type", {{"type", std::string("none")}});
    EXPECT_EQ(bench.next().fix_type, 0);
    EXPECT_EQ(bench.sentence("GGA")[6], "0");
    expect_no_residue(bench, before);
}

TEST(PositionFaults, ReportsZeroZeroWithTheFlagOfAFix) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("zero_position");
    const NavPvt zero = bench.next();
    EXPECT_EQ(zero.lat, 0);
    EXPECT_EQ(zero.lon, 0);
    EXPECT_EQ(zero.fix_type, 3);
    EXPECT_EQ(zero.flags & 1, 1);
    EXPECT_EQ(bench.sentence("GGA")[2], "0000.00000");
    EXPECT_EQ(bench.sentence("GGA")[6], "1");
    expect_no_residue(bench, before);
}

TEST(PositionFaults, SendsAStalePositionWithQualityZero) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("stale_position");
    bench.wait(1);
    bench.fix().position = Geodetic::degrees(47.5, 8.5, 600);
    const NavPvt stale = bench.next();
    EXPECT_EQ(stale.lat, before.lat);
    EXPECT_EQ(stale.fix_type, 0);
    EXPECT_EQ(stale.flags & 1, 0);
    EXPECT_EQ(bench.sentence("GGA")[6], "0");
    EXPECT_EQ(bench.sentence("GGA")[2], "4700.00000") << "the place is there all the same";
    EXPECT_EQ(bench.sentence("RMC")[2], "V");
    bench.fix().position = Geodetic::degrees(47, 8, 500);
    expect_no_residue(bench, before);
}

TEST(PositionFaults, FallsFromFixedToFloatWithAStep) {
    ReceiverBench bench;
    bench.fix().type = FixType::rtk_fixed;
    const NavPvt before = bench.next();
    bench.begin("rtk_transition", {{"east_m", 0.5}, {"north_m", 0.0}, {"up_m", 1.0}});
    const NavPvt floating = bench.next();
    EXPECT_EQ(before.flags >> 6, 2);
    EXPECT_EQ(floating.flags >> 6, 1);
    EXPECT_NEAR(ReceiverBench::error(floating).vector().x(), 0.5, 0.02);
    EXPECT_EQ(floating.height - before.height, 1000);
    EXPECT_EQ(bench.sentence("GGA")[6], "5");
    expect_no_residue(bench, before);
}

TEST(PositionFaults, TheVectorBetweenTheAntennasFallsWithTheFix) {
    ReceiverBench bench;
    bench.fix().type = FixType::rtk_fixed;
    bench.relative() = RelativePosition{0, 1, 0, Metres(0.01), true, true, 5};
    bench.wait(1);
    EXPECT_EQ(bench.last<NavRelposned>().flags >> 3 & 3U, 2U);
    bench.begin("rtk_transition", {{"east_m", 0.5}, {"north_m", 0.0}, {"up_m", 0.0}, {"accuracy_m", 0.6}});
    bench.wait(1);
    const auto floating = bench.last<NavRelposned>();
    EXPECT_EQ(floating.flags >> 3 & 3U, 1U);
    EXPECT_EQ(floating.rel_pos[1], 150) << "cm";
    EXPECT_NEAR(floating.acc[1], 0.6e4 / std::sqrt(2.0), 1);
    EXPECT_EQ(floating.flags & 0x100U, 0U) << "no heading without whole ambiguities";
    bench.end();
    bench.begin("rtk_transition", {{"to", std::string("dgnss")}});
    bench.wait(1);
    EXPECT_EQ(bench.last<NavRelposned>().flags & 4U, 0U);
    bench.end();
    bench.wait(1);
    EXPECT_EQ(bench.last<NavRelposned>().flags >> 3 & 3U, 2U);
}

// Of what follows from the type nothing contradicts it.
TEST(PositionFaults, TheVectorBetweenTheAntennasIsThatOfTheClaimedType) {
    ReceiverBench bench;
    bench.fix().type = FixType::rtk_fixed;
    bench.relative() = RelativePosition{0, 1, 0, Metres(0.01), true, true, 5};
    const auto relative_flags = [&](const std::string& kind, const Given& given) {
        bench.begin(kind, given);
        bench.wait(1);
        bench.end();
        return bench.last<NavRelposned>().flags & 0x13FU;
    };
    const auto claimed = [&](const char* type) {
        return relative_flags("wrong_fix_type", {{"type", std::string(type)}});
    };
    EXPECT_EQ(claimed("rtk_fixed"), 0x137U);
    EXPECT_EQ(claimed("rtk_float"), 0x2FU) << "floating, and no heading";
    EXPECT_EQ(claimed("3d"), 0x01U);
    EXPECT_EQ(claimed("none"), 0U);
    EXPECT_EQ(relative_flags("stale_position", {}), 0U);
    bench.wait(1);
    EXPECT_EQ(bench.last<NavRelposned>().flags & 0x13FU, 0x137U);
}

TEST(PositionFaults, UsesNoSatellitesWhereItClaimsNoFixOrReckonsOn) {
    ReceiverBench bench;
    bench.wait(1);
    const auto used = [&] { return bench.receiver().state().epoch.fix.satellites_used(); };
    EXPECT_EQ(used(), 12);
    for (const char* type : {"none", "dead_reckoning"}) {
        bench.begin("wrong_fix_type", {{"type", std::string(type)}});
        bench.wait(1);
        EXPECT_EQ(used(), 0) << type;
        EXPECT_EQ(bench.last<NavPvt>().num_sv, 0) << type;
        bench.end();
        bench.wait(1);
        EXPECT_EQ(used(), 12);
    }
}

TEST(PositionFaults, LosesAndFlipsTheHeading) {
    ReceiverBench bench;
    bench.fix().type = FixType::rtk_fixed;
    bench.relative() = RelativePosition{0, 1, 0, Metres(0.01), true, true, 5};
    bench.wait(1);
    EXPECT_EQ(bench.last<NavRelposned>().rel_pos_heading, 9000000);
    bench.begin("heading_flipped");
    bench.wait(1);
    EXPECT_EQ(bench.last<NavRelposned>().rel_pos_heading, 27000000);
    bench.end();
    bench.begin("heading_lost");
    bench.wait(1);
    EXPECT_EQ(bench.last<NavRelposned>().flags & 4U, 0U);
    bench.end();
    bench.wait(1);
    EXPECT_EQ(bench.last<NavRelposned>().rel_pos_heading, 9000000);
}

TEST(PositionFaults, MisreportsTheNumberOfSatellites) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    EXPECT_EQ(before.num_sv, 12);
    for (const int count : {0, 5, 14, 30}) {
        bench.begin("satellites_misreported", {{"count", static_cast<double>(count)}});
        EXPECT_EQ(bench.next().num_sv, count);
        EXPECT_EQ(std::stoi(bench.sentence("GGA")[7]), std::min(count, 12)) << "NMEA counts to 12";
        expect_no_residue(bench, before);
    }
}

TEST(PositionFaults, MisreportsTheSameNumberWhereConsideredSatellitesAreCounted) {
    ReceiverBench bench;
    for (SatelliteStatus& s : bench.fix().satellites)
        if (s.cn0) s.residual = Metres(0.3);
    CfgValset consider;
    consider.layers = 1;
    consider.pairs = {{firmware::find_config_key("CFG-NMEA-CONSIDER")->id, 1}};
    bench.send(consider);
    const NavPvt before = bench.next();
    bench.begin("satellites_misreported", {{"count", 5.0}});
    EXPECT_EQ(bench.next().num_sv, 5);
    EXPECT_EQ(bench.sentence("GGA")[7], "05") << "as many as NAV-PVT says";
    expect_no_residue(bench, before);
}

TEST(PositionFaults, MisreportsMoreSatellitesThanOneSystemHas) {
    ReceiverBench bench;
    std::erase_if(bench.fix().satellites, [](const auto& s) { return s.id.constellation != Constellation::gps; });
    bench.begin("satellites_misreported", {{"count", 40.0}});
    EXPECT_EQ(bench.next().num_sv, 40);
}

TEST(PositionFaults, DropsEpochs) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("dropped_epochs", {{"probability", 0.5}});
    bench.forget();
    bench.wait(100);
    const std::size_t heard = bench.all<NavPvt>().size();
    EXPECT_GT(heard, 30U);
    EXPECT_LT(heard, 70U);
    EXPECT_EQ(bench.sentences(), 2 * heard) << "of an epoch all or nothing";
    expect_no_residue(bench, before);
}

TEST(PositionFaults, DuplicatesEpochs) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("duplicated_epochs");
    bench.forget();
    bench.wait(2);
    const std::vector<NavPvt> heard = bench.all<NavPvt>();
    ASSERT_EQ(heard.size(), 4U);
    EXPECT_EQ(heard[0].i_tow, heard[1].i_tow);
    EXPECT_EQ(heard[0].i_tow + 1000, heard[2].i_tow);
    expect_no_residue(bench, before);
}

TEST(PositionFaults, ReordersEpochs) {
    ReceiverBench bench;
    bench.begin("reordered_epochs", {{"probability", 0.5}, {"delay_s", 1.5}});
    bench.wait(50);
    bench.end();
    bench.wait(3);
    const std::vector<NavPvt> heard = bench.all<NavPvt>();
    EXPECT_EQ(heard.size(), 53U) << "none is missing";
    int backwards = 0;
    for (std::size_t i = 1; i < heard.size(); ++i)
        backwards += heard[i].i_tow < heard[i - 1].i_tow ? 1 : 0;
    EXPECT_GT(backwards, 3);
    EXPECT_EQ(heard.back().i_tow, heard[heard.size() - 2].i_tow + 1000);
}

}  // namespace
}  // namespace skyloop
