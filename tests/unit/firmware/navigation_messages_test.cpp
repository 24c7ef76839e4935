#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/geo/local_frame.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_services.hpp"
#include "ubx_reports.hpp"

namespace skyloop::firmware {
namespace {

TEST(NavPvtMessage, SaysWhatTheFixIs) {
    const UbxReport m9(9);
    const auto pvt = m9.report<NavPvt>();
    EXPECT_EQ(pvt.i_tow, 218981521u);  // Tuesday 12:49:41.521 GPS
    EXPECT_EQ(pvt.year, 2024);
    EXPECT_EQ(pvt.month, 3);
    EXPECT_EQ(pvt.day, 5);
    EXPECT_EQ(pvt.hour, 12);
    EXPECT_EQ(pvt.minute, 49);
    EXPECT_EQ(pvt.second, 23);
    EXPECT_EQ(pvt.nano, 521000000);
    EXPECT_EQ(pvt.valid, 0x37);
    EXPECT_EQ(pvt.t_acc, 25u);
    EXPECT_EQ(pvt.fix_type, 3);
    EXPECT_EQ(pvt.flags, 0x01);
    EXPECT_EQ(pvt.flags2, 0xEA);
    EXPECT_EQ(pvt.num_sv, 9);
    EXPECT_EQ(pvt.lon, 87654322);
    EXPECT_EQ(pvt.lat, 471234568);
    EXPECT_EQ(pvt.height, 512346);
    EXPECT_EQ(pvt.h_msl, 490976);
    EXPECT_EQ(pvt.h_acc, 3300u);
    EXPECT_EQ(pvt.v_acc, 5040u);
    EXPECT_EQ(pvt.vel_n, 3000);
    EXPECT_EQ(pvt.vel_e, 4001);
    EXPECT_EQ(pvt.vel_d, -1250);
    EXPECT_EQ(pvt.g_speed, 5001);
    EXPECT_EQ(pvt.head_mot, 5313000);
    EXPECT_EQ(pvt.s_acc, 250u);
    EXPECT_EQ(pvt.head_acc, 150000u);
    EXPECT_EQ(pvt.p_dop, 202);
    EXPECT_EQ(pvt.flags3, 0);
    EXPECT_NE(pvt.reserved, 0u);
    ASSERT_TRUE(pvt.vehicle);
    EXPECT_EQ(pvt.vehicle->head_veh, pvt.head_mot);
}

TEST(NavPvtMessage, IsShorterBeforeM8) {
    const UbxReport old(7), m8(8);
    EXPECT_FALSE(old.report<NavPvt>().vehicle);
    EXPECT_EQ(old.report<NavPvt>().flags2, 0);
    EXPECT_TRUE(m8.report<NavPvt>().vehicle);
}

// RECEIVER.md 4.10, the column of a receiver that never had a fix.
TEST(NavPvtMessage, HasTheValuesOfAReceiverWithoutAnyFix) {
    UbxReport m9(9);
    m9.start_cold(19.0);
    const auto pvt = m9.report<NavPvt>();
    EXPECT_EQ(pvt.fix_type, 0);
    EXPECT_EQ(pvt.flags, 0);
    EXPECT_EQ(pvt.lon, 0);
    EXPECT_EQ(pvt.lat, 0);
    EXPECT_EQ(pvt.height, 0);
    EXPECT_EQ(pvt.h_msl, -17000);
    EXPECT_EQ(pvt.h_acc, 4294967295u);
    EXPECT_EQ(pvt.v_acc, 3750000128u);
    EXPECT_EQ(pvt.vel_n, 0);
    EXPECT_EQ(pvt.g_speed, 0);
    EXPECT_EQ(pvt.head_mot, 0);
    EXPECT_EQ(pvt.head_acc, 18000000u);
    EXPECT_EQ(pvt.s_acc, 20000u);
    EXPECT_EQ(pvt.p_dop, 9999);
    EXPECT_EQ(pvt.num_sv, 0);
    EXPECT_EQ(pvt.t_acc, 4294967295u);
    EXPECT_EQ(pvt.flags3 & 1, 1);
    EXPECT_EQ(pvt.valid, 0xF0);
    EXPECT_EQ(pvt.flags2, 0x24);  // as a captured ZED-F9P
}

// M9N 4.04 counts from 2020-08-02, the start of its reference week (RECEIVER.md 4.9).
TEST(NavPvtMessage, CountsFromTheReferenceWeekBeforeItKnowsTheTime) {
    UbxReport m9(9);
    m9.start_cold(19.0);
    m9.config.set(in_ram, key::navspg_wknrollover, 2117);
    const auto pvt = m9.report<NavPvt>();
    EXPECT_EQ(pvt.year, 2020);
    EXPECT_EQ(pvt.month, 8);
    EXPECT_EQ(pvt.day, 2);
    EXPECT_EQ(pvt.hour, 0);
    EXPECT_EQ(pvt.second, 19);
    EXPECT_EQ(pvt.i_tow, 19000u);
}

// RECEIVER.md 4.10, the column of a lost fix.
TEST(NavPvtMessage, KeepsThePlaceOfALostFix) {
    UbxReport m8(8);
    m8.lose_fix();
    const auto pvt = m8.report<NavPvt>();
    EXPECT_EQ(pvt.fix_type, 0);
    EXPECT_EQ(pvt.flags, 0);
    EXPECT_EQ(pvt.valid, 0x37);
    EXPECT_EQ(pvt.lat, 471234568);
    EXPECT_EQ(pvt.h_acc, 3300u);
    EXPECT_EQ(pvt.vel_n, 3000);
    EXPECT_EQ(pvt.p_dop, 9999);
    EXPECT_EQ(pvt.num_sv, 0);
    EXPECT_EQ(pvt.flags3 & 1, 0);
}

TEST(NavPvtMessage, TellsTheStepsOfTimeApart) {
    UbxReport m9(9);
    m9.state.time.leap_seconds = false;
    m9.state.time.confirmed = false;
    EXPECT_EQ(m9.report<NavPvt>().valid, 0xF3);
    EXPECT_EQ(m9.report<NavPvt>().flags2, 0x2A);
    m9.state.time.date = false;
    EXPECT_EQ(m9.report<NavPvt>().valid, 0xF2);
    m9.state.time = {true, true, true, true, Seconds(1)};
    EXPECT_EQ(m9.report<NavPvt>().t_acc, 1000000000u);
    m9.config.set(in_ram, key::navspg_utcstandard, 6);
    EXPECT_EQ(m9.report<NavPvt>().valid, 0x67);
}

TEST(NavPvtMessage, NamesTheStandardOfTheOnlySystem) {
    UbxReport m9(9);
    m9.state.epoch.fix.satellites.clear();
    add_satellites(m9.state.epoch.fix, Constellation::glonass, 1, 6);
    EXPECT_EQ(m9.report<NavPvt>().valid, 0x67);
    m9.state.epoch.fix.satellites.clear();
    add_satellites(m9.state.epoch.fix, Constellation::galileo, 1, 6);
    EXPECT_EQ(m9.report<NavPvt>().valid, 0x57);
}

TEST(NavPvtMessage, TellsFloatFromFixed) {
    UbxReport f9(9);
    f9.state.corrections = {CorrectionState::differential, Seconds(1.5), 12, {}};
    f9.state.epoch.fix.type = FixType::dgnss;
    EXPECT_EQ(f9.report<NavPvt>().flags, 0x03);
    EXPECT_EQ(f9.report<NavPvt>().flags3, 2 << 1);
    f9.state.epoch.fix.type = FixType::rtk_float;
    EXPECT_EQ(f9.report<NavPvt>().flags, 0x43);
    f9.state.epoch.fix.type = FixType::rtk_fixed;
    EXPECT_EQ(f9.report<NavPvt>().flags, 0x83);
    EXPECT_EQ(f9.report<NavPvt>().fix_type, 3);
    f9.state.fix_ok = false;
    EXPECT_EQ(f9.report<NavPvt>().flags, 0x82);
}

// RECEIVER.md 3.1, lastCorrectionAge.
TEST(NavPvtMessage, CodesTheAgeOfCorrections) {
    UbxReport f9(9);
    const double ages[] = {0, 0.99, 1, 2, 4.9, 5, 10, 15, 20, 30, 45, 60, 90, 120, 1e9};
    const int codes[] = {1, 1, 2, 3, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 12};
    for (std::size_t i = 0; i < std::size(ages); ++i) {
        f9.state.corrections.age = Seconds(ages[i]);
        EXPECT_EQ(f9.report<NavPvt>().flags3 >> 1, codes[i]) << ages[i];
    }
}

TEST(NavPvtMessage, FreezesTheCourse) {
    UbxReport m9(9);
    m9.state.course_is_frozen = true;
    EXPECT_EQ(m9.report<NavPvt>().head_mot, 5313000);
    EXPECT_EQ(m9.report<NavPvt>().head_acc, 18000000u);
    m9.state.course = Angle::degrees(359.999999);
    EXPECT_LT(m9.report<NavPvt>().head_mot, 36000000);
    m9.state.course = std::nullopt;
    EXPECT_EQ(m9.report<NavPvt>().head_mot, 0);
}

// Nothing overflows: UBSan looks on.
TEST(NavPvtMessage, StaysInTheRangesOfItsFields) {
    UbxReport m9(9);
    Fix& fix = m9.state.epoch.fix;
    fix.horizontal_accuracy = Metres(1e9);
    fix.vertical_accuracy = Metres(std::numeric_limits<double>::infinity());
    fix.position.height.above_ellipsoid = Metres(-1e12);
    fix.velocity.north = std::numeric_limits<double>::quiet_NaN();
    fix.dop.pdop = 1e6;
    fix.course_accuracy = Angle::degrees(1e9);
    m9.state.time.accuracy = Seconds(1e9);
    const auto pvt = m9.report<NavPvt>();
    EXPECT_EQ(pvt.h_acc, 4294967295u);
    EXPECT_EQ(pvt.v_acc, 4294967295u);
    EXPECT_EQ(pvt.height, std::numeric_limits<std::int32_t>::min());
    EXPECT_EQ(pvt.vel_n, 0);
    EXPECT_EQ(pvt.p_dop, 9999);
    EXPECT_EQ(pvt.head_acc, 18000000u);
    EXPECT_EQ(pvt.t_acc, 4294967295u);
    EXPECT_EQ(m9.report<NavHpposllh>().h_acc, 4294967295u);
    EXPECT_EQ(m9.report<NavHpposecef>().p_acc, 4294967295u);
    EXPECT_EQ(m9.report<NavPl>().pl_pos[2], 4294967295u);
    EXPECT_GT(m9.report<NavCov>().pos_cov[0], 1e16f);
}

TEST(NavSolutionMessages, AgreeOnThePlace) {
    const UbxReport f9(9);
    const auto place = f9.report<NavPosllh>();
    EXPECT_EQ(place.lon, 87654322);
    EXPECT_EQ(place.h_msl, 490976);
    EXPECT_EQ(place.v_acc, 5040u);
    const auto fine = f9.report<NavHpposllh>();
    EXPECT_EQ(fine.flags, 0);
    EXPECT_EQ(std::int64_t{fine.lon} * 100 + fine.lon_hp, 8765432199);
    EXPECT_EQ(std::int64_t{fine.lat} * 100 + fine.lat_hp, 47123456789);
    EXPECT_EQ(fine.height * 10 + fine.height_hp, 5123456);
    EXPECT_EQ(fine.h_msl * 10 + fine.h_msl_hp, 4909756);
    EXPECT_EQ(fine.h_acc, 33000u);
    const Eigen::Vector3d ecef = to_ecef(f9.state.epoch.fix.position).vector();
    const auto earth = f9.report<NavPosecef>();
    const auto fine_earth = f9.report<NavHpposecef>();
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(earth.ecef[i], ecef[static_cast<Eigen::Index>(i)] * 100, 0.51);
        EXPECT_NEAR(fine_earth.ecef[i] + fine_earth.ecef_hp[i] / 100.0, ecef[static_cast<Eigen::Index>(i)] * 100,
                    0.006);
    }
    EXPECT_EQ(earth.p_acc, 602u);
    EXPECT_EQ(fine_earth.p_acc, 60243u);
}

TEST(NavSolutionMessages, RoundNegativeNumbersAsPvtDoes) {
    UbxReport f9(9);
    f9.state.epoch.fix.position = Geodetic::degrees(-33.1234567891, -70.00000000051, -0.0005);
    const auto fine = f9.report<NavHpposllh>();
    EXPECT_EQ(fine.lat, f9.report<NavPvt>().lat);
    EXPECT_EQ(fine.lat, -331234568);
    EXPECT_EQ(fine.lat_hp, 11);
    EXPECT_EQ(fine.lon, -700000000);
    EXPECT_EQ(fine.lon_hp, -1);
    EXPECT_EQ(fine.height * 10 + fine.height_hp, -5);
}

TEST(NavSolutionMessages, AgreeOnTheVelocity) {
    const UbxReport m8(8);
    const auto local = m8.report<NavVelned>();
    EXPECT_EQ(local.vel_n, 300);
    EXPECT_EQ(local.vel_d, -125);
    EXPECT_EQ(local.g_speed, 500u);
    EXPECT_EQ(local.speed, 515u);
    EXPECT_EQ(local.heading, 5313000);
    EXPECT_EQ(local.s_acc, 25u);
    EXPECT_EQ(local.c_acc, 150000u);
    const auto earth = m8.report<NavVelecef>();
    EXPECT_NEAR(std::hypot(earth.ecef_v[0], earth.ecef_v[1], earth.ecef_v[2]), 515.5, 1.0);
    EXPECT_EQ(m8.report<NavSol>().ecef_v, earth.ecef_v);
    EXPECT_EQ(earth.s_acc, 25u);
}

TEST(NavSolutionMessages, HaveTheBytesOfCapturedReceiversWithoutAnyFix) {
    UbxReport f9(9);
    f9.start_cold(19.0);
    EXPECT_EQ(f9.report<NavPosecef>().ecef, (std::array<std::int32_t, 3>{637813700, 0, 0}));
    EXPECT_EQ(f9.report<NavHpposllh>().flags, 1);
    EXPECT_EQ(f9.report<NavHpposllh>().h_acc, 4294967295u);
    EXPECT_EQ(f9.report<NavHpposecef>().p_acc, 4294967295u);
    EXPECT_EQ(f9.report<NavVelned>().s_acc, 2000u);
    EXPECT_EQ(f9.report<NavVelned>().c_acc, 18000000u);
    const auto dop = f9.report<NavDop>();
    for (const std::uint16_t value :
         {dop.g_dop.raw, dop.p_dop.raw, dop.t_dop.raw, dop.v_dop.raw, dop.h_dop.raw, dop.n_dop.raw, dop.e_dop.raw})
        EXPECT_EQ(value, 9999);
    EXPECT_EQ(f9.report<NavStatus>().flags, 0x40);
    EXPECT_EQ(f9.report<NavStatus>().ttff, 0u);
    EXPECT_EQ(f9.report<NavStatus>().msss, 19000u);
    const auto covariance = f9.report<NavCov>();
    EXPECT_FLOAT_EQ(covariance.pos_cov[0], 1.40625e13f);
    EXPECT_FLOAT_EQ(covariance.vel_cov[5], 400);
}

TEST(NavSolMessage, HasTheFlagsOfM8) {
    UbxReport m8(8);
    EXPECT_EQ(m8.report<NavSol>().flags, 0xDD);
    EXPECT_EQ(m8.report<NavSol>().gps_fix, 3);
    EXPECT_EQ(m8.report<NavSol>().week, 2304);
    EXPECT_EQ(m8.report<NavSol>().num_sv, 9);
    EXPECT_EQ(m8.report<NavSol>().p_dop, 202);
    m8.state.epoch.fix.type = FixType::dgnss;
    EXPECT_EQ(m8.report<NavSol>().flags, 0xDF);
}

TEST(NavStatusMessage, TellsSpoofingAndTheFirstFix) {
    UbxReport m8(8);
    EXPECT_EQ(m8.report<NavStatus>().flags, 0xDD);
    EXPECT_EQ(m8.report<NavStatus>().flags2, 0x08);
    EXPECT_EQ(m8.report<NavStatus>().ttff, 26500u);
    m8.state.monitors.spoofing = SpoofingIndication::several;
    m8.state.epoch.fix.type = FixType::rtk_fixed;
    EXPECT_EQ(m8.report<NavStatus>().flags2, 0x98);
    EXPECT_EQ(m8.report<NavStatus>().fix_stat, 0x03);
}

TEST(NavDopMessage, KeepsTimeInATimeOnlySolution) {
    UbxReport f9(9);
    EXPECT_EQ(f9.report<NavDop>().h_dop, 110);
    f9.state.epoch.fix.type = FixType::time_only;
    EXPECT_EQ(f9.report<NavDop>().t_dop, 131);
    EXPECT_EQ(f9.report<NavDop>().g_dop, 131) << "there is no place in it";
    EXPECT_EQ(f9.report<NavDop>().p_dop, 9999);
    EXPECT_EQ(f9.report<NavPvt>().fix_type, 5);
    EXPECT_EQ(f9.report<NavPvt>().num_sv, 9);
}

TEST(NavDopMessage, ShowsDopsThatNobodyKnowsAsTheWorst) {
    UbxReport m9(9);
    Dop& dop = m9.state.epoch.fix.dop;
    m9.state.epoch.fix.type = FixType::fix_2d;
    dop.gdop = dop.pdop = dop.vdop = std::numeric_limits<double>::quiet_NaN();
    const auto m = m9.report<NavDop>();
    EXPECT_EQ(m.g_dop, 9999);
    EXPECT_EQ(m.p_dop, 9999);
    EXPECT_EQ(m.v_dop, 9999);
    EXPECT_EQ(m.h_dop, 110);
    EXPECT_EQ(m9.report<NavPvt>().p_dop, 9999);
}

TEST(NavCovMessage, SplitsTheAccuracies) {
    const UbxReport m9(9);
    const auto m = m9.report<NavCov>();
    EXPECT_NEAR(m.pos_cov[0] + m.pos_cov[3], 3.3 * 3.3, 1e-3);
    EXPECT_NEAR(m.pos_cov[5], 5.04 * 5.04, 1e-3);
    EXPECT_LT(m.pos_cov[1] * m.pos_cov[1], m.pos_cov[0] * m.pos_cov[3]);
    EXPECT_NE(m.pos_cov[1], 0);
    EXPECT_NEAR(m.vel_cov[0] + m.vel_cov[3] + m.vel_cov[5], 0.25 * 0.25, 2e-3);
}

TEST(NavOdoMessage, RoundsToMetres) {
    UbxReport m9(9);
    m9.state.odometer_m = 12.6;
    m9.state.odometer_total_m = 1e12;
    m9.state.odometer_deviation_m = 0.4;
    const auto m = m9.report<NavOdo>();
    EXPECT_EQ(m.distance, 13u);
    EXPECT_EQ(m.total_distance, 4294967295u);
    EXPECT_EQ(m.distance_std, 0u);
}

TEST(NavRelposnedMessage, IsFlagOneAndZerosWithoutABase) {
    const UbxReport f9(9), m8p(8);
    const auto m = f9.report<NavRelposned>();
    EXPECT_EQ(m.version, 1);
    EXPECT_EQ(m.flags, 1u);
    EXPECT_EQ(m.rel_pos, (std::array<std::int32_t, 3>{0, 0, 0}));
    EXPECT_EQ(m.acc_heading, 0u);
    EXPECT_EQ(m8p.report<NavRelposned0>().version, 0);
    EXPECT_EQ(m8p.report<NavRelposned0>().flags, 1u);
}

TEST(NavRelposnedMessage, GivesTheVectorOfAMovingBase) {
    UbxReport f9(9);
    f9.state.epoch.fix.type = FixType::rtk_fixed;
    f9.state.epoch.relative = RelativePosition{-0.30004, 0.40007, -0.0123, Metres(0.01), true, true, 77, Metres(0.02)};
    const auto m = f9.report<NavRelposned>();
    EXPECT_EQ(m.ref_station_id, 77);
    EXPECT_EQ(m.rel_pos[0] * 100 + m.rel_pos_hp[0], -3000);
    EXPECT_EQ(m.rel_pos[1] * 100 + m.rel_pos_hp[1], 4001);
    EXPECT_EQ(m.rel_pos[2] * 100 + m.rel_pos_hp[2], -123);
    EXPECT_EQ(m.rel_pos_length * 100 + m.rel_pos_length_hp, 5002);
    EXPECT_NEAR(m.rel_pos_heading * 1e-5, 126.868, 1e-2);
    EXPECT_EQ(m.acc[1], 100u);
    EXPECT_NEAR(m.acc_heading * 1e-5, 1.146, 1e-2);
    EXPECT_EQ(m.flags, 0x137u);
    f9.state.epoch.relative->fixed = false;
    f9.state.epoch.relative->base_moves = false;
    EXPECT_EQ(f9.report<NavRelposned>().flags, 0x0Fu);
}

TEST(NavRelposnedMessage, GivesTheVectorFromTheStationOfTheCorrections) {
    UbxReport f9(9);
    Fix& fix = f9.state.epoch.fix;
    const Displacement<Enu> to_base(-30, 40, 2);
    const Position<Ecef> base = to_ecef(fix.position) + LocalFrame(fix.position).to_ecef(to_base);
    f9.state.corrections = {CorrectionState::rtk_fixed, Seconds(1), 12, base};
    fix.type = FixType::rtk_fixed;
    fix.horizontal_accuracy = Metres(0.014);
    const auto m = f9.report<NavRelposned>();
    EXPECT_EQ(m.flags, 0x17u);
    EXPECT_EQ(m.ref_station_id, 12);
    EXPECT_NEAR(m.rel_pos[0], -4000, 1);  // cm, by the base's own north
    EXPECT_NEAR(m.rel_pos[1], 3000, 1);
    EXPECT_NEAR(m.rel_pos[2], 200, 1);
    EXPECT_NEAR(m.rel_pos_length, 5004, 1);
    EXPECT_EQ(m.acc[0], 99u);  // 0.1 mm
    fix.type = FixType::rtk_float;
    EXPECT_EQ(f9.report<NavRelposned>().flags, 0x0Fu);
    fix.type = FixType::dgnss;
    EXPECT_EQ(f9.report<NavRelposned>().flags, 0x07u);
    f9.state.corrections.base.reset();
    EXPECT_EQ(f9.report<NavRelposned>().flags, 0x01u) << "observations alone tell no place";
}

TEST(NavDopMessage, IsUnknownWhileItGoesOnWithoutSatellites) {
    UbxReport m8(8);
    EXPECT_LT(m8.report<NavDop>().p_dop, 9999);
    m8.state.epoch.fix.type = FixType::dead_reckoning;
    for (SatelliteStatus& s : m8.state.epoch.fix.satellites)
        s.used = false;
    EXPECT_EQ(m8.report<NavDop>().p_dop, 9999);
    EXPECT_EQ(m8.report<NavPvt>().p_dop, 9999);
    EXPECT_EQ(m8.report<NavSol>().p_dop, 9999);
}

TEST(NavHpposecefMessage, IsValidOfAFixedBase) {
    UbxReport f9(9);
    f9.state.epoch.fix.type = FixType::time_only;
    EXPECT_EQ(f9.report<NavHpposecef>().flags, 1);
    f9.config.set(in_ram, key::tmode_mode, 2);
    f9.state.epoch.fix.horizontal_accuracy = f9.state.epoch.fix.vertical_accuracy = Metres(0.01);
    EXPECT_EQ(f9.report<NavHpposecef>().flags, 0);
    const auto covariance = f9.report<NavCov>();
    EXPECT_NEAR(covariance.pos_cov[0] + covariance.pos_cov[3], 1e-4, 1e-9);
    EXPECT_NEAR(covariance.pos_cov[5], 1e-4, 1e-9);
    EXPECT_EQ(covariance.vel_cov[0], 0);
}

TEST(NavSvinMessage, ShowsTheMeanUntilTheSurveyIsDone) {
    UbxReport f9(9);
    EXPECT_EQ(f9.report<NavSvin>().active, 0);
    Fix fix = f9.state.epoch.fix;
    fix.horizontal_accuracy = Metres(0.3);
    fix.vertical_accuracy = Metres(0.4);
    f9.state.survey.emplace(SurveyLimits{Seconds(9), Metres(0.5)}, fix.time);
    EXPECT_EQ(f9.report<NavSvin>().active, 1);
    EXPECT_EQ(f9.report<NavSvin>().mean_acc, 0xFFFFFFFFu);
    f9.state.survey->take(fix, true);
    fix.time = advanced(fix.time, Seconds(8.9));
    f9.state.survey->take(fix, false);
    const auto under_way = f9.report<NavSvin>();
    EXPECT_EQ(under_way.active, 1);
    EXPECT_EQ(under_way.valid, 0);
    EXPECT_EQ(under_way.dur, 8u);
    EXPECT_EQ(under_way.obs, 1u);
    EXPECT_EQ(under_way.mean_acc, 5000u);
    const Eigen::Vector3d at = to_ecef(fix.position).vector();
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(under_way.mean[i] * 1e-2 + under_way.mean_hp[i] * 1e-4, at[static_cast<Eigen::Index>(i)], 1e-4);
    fix.time = advanced(fix.time, Seconds(1));
    f9.state.survey->take(fix, true);
    EXPECT_EQ(f9.report<NavSvin>().valid, 1);
    EXPECT_EQ(f9.report<NavSvin>().active, 0);
    EXPECT_EQ(f9.report<NavSvin>().obs, 2u);
}

TEST(NavDgpsMessage, ListsTheCorrectedSatellites) {
    UbxReport m8(8);
    EXPECT_EQ(m8.report<NavDgps>().age, 999999);
    EXPECT_TRUE(m8.report<NavDgps>().satellites.empty());
    m8.state.corrections = {CorrectionState::differential, Seconds(2.5), 5, {}};
    EXPECT_EQ(m8.report<NavDgps>().age, 2500);
    EXPECT_EQ(m8.report<NavDgps>().base_id, 5);
    EXPECT_EQ(m8.report<NavDgps>().satellites.size(), 9u);
}

TEST(NavServiceMessages, CarryTheEpoch) {
    const UbxReport m8(8);
    EXPECT_EQ(m8.report<NavEoe>().i_tow, 218981521u);
    EXPECT_EQ(m8.report<NavGeofence>().i_tow, 218981521u);
    EXPECT_EQ(m8.report<NavAopstatus>().i_tow, 218981521u);
    EXPECT_EQ(m8.report<NavSlas>().i_tow, 218981521u);
    EXPECT_EQ(m8.report<NavPl>().pl_pos_valid, 1);
    EXPECT_NEAR(m8.report<NavPl>().pl_pos[2], 5.33 * 5040, 1);
    EXPECT_TRUE(m8.frames({0x01, 0x7F}).empty());
}

}  // namespace
}  // namespace skyloop::firmware
