// How configuration and state show in sentences (RECEIVER.md 4.9, 5.2 to 5.7).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "receiver/protocol/ubx_mon.hpp"
#include "sample_reports.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using enum Constellation;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

constexpr std::uint8_t gga_id = 0, gll_id = 1, gsa_id = 2, gsv_id = 3, rmc_id = 4, vtg_id = 5, grs_id = 6, gst_id = 7,
                       zda_id = 8, gbs_id = 9, dtm_id = 10, gns_id = 13, ths_id = 14, vlw_id = 15;
constexpr std::uint8_t pubx_class = 0xF1;

SampleReceiver four_systems(NmeaVersion version = NmeaVersion::v4_10) {
    SampleReceiver receiver(sample_board(version, {gps, sbas, galileo, beidou, glonass}));
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(fix, gps, 1, 6);
    add_satellites(fix, galileo, 1, 3);
    add_satellites(fix, glonass, 1, 3);
    receiver.set(fix);
    return receiver;
}

SampleReceiver without_fix(NmeaVersion version, std::vector<Constellation> systems) {
    SampleReceiver receiver(sample_board(version, std::move(systems)));
    Fix fix = sample_fix("2023-06-28T14:56:22Z", 0, 0, 0);
    fix.type = FixType::none;
    receiver.set(fix);
    return receiver;
}

// The row of table 5.4 for a kind of fix: status, quality, navMode, posMode of RMC, posMode of GLL and VTG.
std::string flags_of(FixType type, bool within_limits) {
    SampleReceiver receiver = four_systems();
    Fix fix = receiver.state.epoch.fix;
    fix.type = type;
    receiver.set(fix);
    receiver.state.fix_ok = receiver.state.fix_ok && within_limits;
    const auto rmc = messages_of_kind<Rmc>(receiver.message(rmc_id)).at(0);
    const auto gll = messages_of_kind<Gll>(receiver.message(gll_id)).at(0);
    const auto vtg = messages_of_kind<Vtg>(receiver.message(vtg_id)).at(0);
    EXPECT_EQ(rmc.valid, gll.valid);
    EXPECT_EQ(gll.mode, vtg.mode);
    std::string out = rmc.valid ? "A" : "V";
    out += std::to_string(messages_of_kind<Gga>(receiver.message(gga_id)).at(0).quality);
    out += std::to_string(messages_of_kind<Gsa>(receiver.message(gsa_id)).at(0).fix_mode);
    return out + static_cast<char>(*rmc.mode) + static_cast<char>(*gll.mode);
}

TEST(NmeaFixFlags, FollowTable5_4) {
    EXPECT_EQ(flags_of(FixType::none, true), "V01NN");
    EXPECT_EQ(flags_of(FixType::time_only, true), "V01NN");
    EXPECT_EQ(flags_of(FixType::fix_3d, false), "V01NN");
    EXPECT_EQ(flags_of(FixType::dead_reckoning, false), "V62NN");
    EXPECT_EQ(flags_of(FixType::dead_reckoning, true), "A62EE");
    EXPECT_EQ(flags_of(FixType::fix_2d, true), "A12AA");
    EXPECT_EQ(flags_of(FixType::fix_3d, true), "A13AA");
    EXPECT_EQ(flags_of(FixType::dgnss, true), "A23DD");
    EXPECT_EQ(flags_of(FixType::rtk_float, true), "A53FD");
    EXPECT_EQ(flags_of(FixType::rtk_fixed, true), "A43RD");
}

TEST(NmeaFixFlags, SayOfEachSystemThatIsOnThatItIsReckoned) {
    const auto reckoned = [](NmeaVersion version, std::vector<Constellation> systems) {
        SampleReceiver receiver(sample_board(version, std::move(systems)));
        Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
        fix.type = FixType::dead_reckoning;
        receiver.set(fix);
        return receiver.line(gns_id);
    };
    EXPECT_THAT(reckoned(NmeaVersion::v4_10, {gps, sbas, galileo, beidou, glonass}), HasSubstr(",EEEE,00,"));
    EXPECT_THAT(reckoned(NmeaVersion::v4_10, {gps, galileo}), HasSubstr(",ENEN,00,"));
    EXPECT_THAT(reckoned(NmeaVersion::v4_0, {gps, glonass}), HasSubstr(",EE,00,"));
}

// RECEIVER.md 5.5, byte for byte.
TEST(NmeaWithoutAFix, SaysWhatReceiversSay) {
    const SampleReceiver m9 = without_fix(NmeaVersion::v4_10, {gps, sbas, galileo, beidou, glonass});
    EXPECT_EQ(m9.line(rmc_id), "$GNRMC,,V,,,,,,,,,,N,V*37\r\n");
    EXPECT_EQ(m9.line(vtg_id), "$GNVTG,,,,,,,,,N*2E\r\n");
    EXPECT_EQ(m9.line(gga_id), "$GNGGA,,,,,,0,00,99.99,,,,,,*56\r\n");
    EXPECT_EQ(m9.line(gll_id), "$GNGLL,,,,,,V,N*7A\r\n");
    EXPECT_EQ(m9.line(zda_id), "$GNZDA,,,,,00,00*56\r\n");
    ASSERT_THAT(m9.message(gsa_id), SizeIs(4));
    EXPECT_EQ(m9.message(gsa_id).at(0), "$GNGSA,A,1,,,,,,,,,,,,,99.99,99.99,99.99,1*33\r\n");
    EXPECT_THAT(m9.message(gsv_id), ElementsAre("$GPGSV,1,1,00,0*65\r\n", "$GLGSV,1,1,00,0*79\r\n",
                                                "$GAGSV,1,1,00,0*74\r\n", "$GBGSV,1,1,00,0*77\r\n"));
    EXPECT_THAT(m9.line(gns_id), StartsWith("$GNGNS,,,,,,NNNN,00,99.99,,,,,V*"));
    const SampleReceiver m8 = without_fix(NmeaVersion::v4_0, {gps, sbas, qzss, glonass});
    EXPECT_EQ(m8.line(rmc_id), "$GNRMC,,V,,,,,,,,,,N*4D\r\n");
    EXPECT_THAT(m8.message(gsv_id), ElementsAre("$GPGSV,1,1,00*79\r\n", "$GLGSV,1,1,00*65\r\n"));
    EXPECT_EQ(m8.message(gsa_id).at(0), "$GNGSA,A,1,,,,,,,,,,,,,99.99,99.99,99.99*2E\r\n");
    EXPECT_THAT(m8.line(gns_id), StartsWith("$GNGNS,,,,,,NN,00,99.99,,,,*"));
    SampleReceiver m10 = without_fix(NmeaVersion::v4_11, {gps, sbas, galileo, beidou, qzss});
    m10.board.maker = MakerKind::ublox;
    m10.board.identity.generation = 10;
    ASSERT_THAT(m10.message(gsv_id), SizeIs(4));
    EXPECT_EQ(m10.message(gsv_id).at(0), "$GPGSV,1,1,00,1*64\r\n");
    EXPECT_EQ(m10.message(gsv_id).at(3), "$GQGSV,1,1,00,0*64\r\n");
}

TEST(NmeaWithoutAFix, TellsTimeAndDateAsSoonAsItKnowsThem) {
    SampleReceiver receiver = without_fix(NmeaVersion::v4_0, {gps, glonass});
    receiver.state.time.time = true;
    EXPECT_THAT(receiver.line(rmc_id), StartsWith("$GNRMC,145622.00,V,,,,,,,,,,N*"));
    receiver.state.time.date = true;
    EXPECT_THAT(receiver.line(rmc_id), StartsWith("$GNRMC,145622.00,V,,,,,,,280623,,,N*"));
    EXPECT_THAT(receiver.line(gst_id), StartsWith("$GNGST,145622.00,,,,,,,*"));
    EXPECT_THAT(receiver.line(gbs_id), StartsWith("$GNGBS,145622.00,,,,,,,*"));
}

TEST(NmeaStyles, MediaTekLeavesZerosWithoutAFix) {
    BoardProfile board = sample_board(NmeaVersion::v2_3, {gps});
    board.style.zeros_without_fix = board.style.unknown_date_is_1980 = true;
    board.style.satellites_padded = false;
    board.style.speed_decimals = 2;
    board.time_decimals = 3;
    SampleReceiver receiver(board);
    Fix fix = sample_fix("2023-06-28T14:56:22Z", 0, 0, 0);
    fix.type = FixType::none;
    receiver.set(fix);
    // As captures of the MT3339's family have it, but for the time.
    EXPECT_THAT(receiver.line(gga_id), StartsWith("$GPGGA,235946.000,,,,,0,0,,,M,,M,,*"));
    EXPECT_THAT(receiver.line(rmc_id), StartsWith("$GPRMC,235946.000,V,,,,,0.00,0.00,050180,,,N*"));
    EXPECT_EQ(receiver.line(gsa_id), "$GPGSA,A,1,,,,,,,,,,,,,,,*1E\r\n");
    EXPECT_THAT(receiver.line(vtg_id), StartsWith("$GPVTG,0.00,T,,M,0.00,N,0.00,K,N*"));
}

TEST(NmeaFilters, LetInvalidValuesThrough) {
    SampleReceiver receiver = without_fix(NmeaVersion::v4_0, {gps, glonass});
    receiver.config.set(in_ram, key::nmea_out_invtime, 1);
    receiver.config.set(in_ram, key::nmea_out_invdate, 1);
    // What the receiver counts from, in NAV-PVT as well: the week of CFG-NAVSPG-WKNROLLOVER.
    EXPECT_THAT(receiver.line(rmc_id), StartsWith("$GNRMC,000000.00,V,,,,,,,020820,"));
    receiver.config.set(in_ram, key::nmea_out_invfix, 1);
    EXPECT_THAT(receiver.line(rmc_id), StartsWith("$GNRMC,000000.00,V,,,,,,,"));  // none was ever known
    receiver.state.position_known = true;
    receiver.state.epoch.fix.position = Geodetic::degrees(47, 8, 500);
    EXPECT_THAT(receiver.line(rmc_id), StartsWith("$GNRMC,000000.00,V,4700.00000,N,00800.00000,E,"));
}

TEST(NmeaFilters, KeepPositionsBeyondTheLimitsToThemselves) {
    SampleReceiver receiver = four_systems();
    receiver.state.fix_ok = false;
    receiver.state.position_known = true;
    EXPECT_THAT(receiver.line(gll_id), StartsWith("$GNGLL,,,,,120000.00,V,N*"));
    // Satellites and DOP are told all the same (capture of a NEO-6M that searches).
    EXPECT_THAT(receiver.line(gga_id), StartsWith("$GNGGA,120000.00,,,,,0,11,1.10,,,,,,*"));
    receiver.config.set(in_ram, key::nmea_out_mskfix, 1);
    EXPECT_THAT(receiver.line(gll_id), StartsWith("$GNGLL,4700.00000,N,00800.00000,E,120000.00,V,N*"));
}

TEST(NmeaFilters, TakeSystemsOut) {
    SampleReceiver receiver = four_systems();
    receiver.config.set(in_ram, key::nmea_filt_gal, 1);
    EXPECT_THAT(receiver.message(gsa_id), SizeIs(3));
    for (const Gsv& page : messages_of_kind<Gsv>(receiver.message(gsv_id)))
        EXPECT_NE(page.talker, "GA");
    receiver.config.set(in_ram, key::nmea_out_onlygps, 1);
    EXPECT_THAT(receiver.message(gsa_id), SizeIs(1));
    EXPECT_THAT(receiver.line(gga_id), StartsWith("$GPGGA,"));
    EXPECT_EQ(messages_of_kind<Gga>(receiver.message(gga_id)).at(0).satellites_used, 5);
}

TEST(NmeaFilters, FreezeTheCourse) {
    SampleReceiver receiver = four_systems();
    receiver.state.course = Angle::degrees(12.34);
    receiver.state.course_is_frozen = true;
    EXPECT_THAT(receiver.line(vtg_id), StartsWith("$GNVTG,,T,"));
    receiver.config.set(in_ram, key::nmea_out_frozencog, 1);
    EXPECT_THAT(receiver.line(vtg_id), StartsWith("$GNVTG,12.34,T,"));
    receiver.config.set(in_ram, key::nmea_out_frozencog, 0);
    receiver.board.style.course_always = true;
    EXPECT_THAT(receiver.line(vtg_id), StartsWith("$GNVTG,12.34,T,"));
}

TEST(NmeaConfiguration, ChoosesTheVersion) {
    SampleReceiver receiver = four_systems();
    const auto ends = [&](std::uint64_t version) {
        receiver.config.set(in_ram, key::nmea_protver, version);
        const std::string line = receiver.line(rmc_id);
        return line.substr(1, 2) + line.substr(line.find(",050324") + 7, line.find('*') - line.find(",050324") - 7);
    };
    EXPECT_EQ(ends(21), "GP,,");
    EXPECT_EQ(ends(23), "GN,,,A");
    EXPECT_EQ(ends(40), "GN,,,A");
    EXPECT_EQ(ends(41), "GN,,,A,V");
    EXPECT_EQ(ends(42), "GN,,,A,V");
}

TEST(NmeaConfiguration, SetsPrecisionAndCompatibility) {
    SampleReceiver receiver = four_systems();
    receiver.config.set(in_ram, key::nmea_highprec, 1);
    EXPECT_THAT(receiver.line(gga_id), HasSubstr(",4700.0000000,N,00800.0000000,E,1,11,1.10,478.630,M,21.370,M,,*"));
    EXPECT_GT(receiver.line(gga_id).size(), 82U);
    receiver.config.set(in_ram, key::nmea_limit82, 1);
    EXPECT_LE(receiver.line(gga_id).size(), 82U);
    EXPECT_LE(receiver.line(gns_id).size(), 82U);
    receiver.config.set(in_ram, key::nmea_compat, 1);
    Fix fix = receiver.state.epoch.fix;
    fix.time += std::chrono::microseconds(217'100);
    receiver.set(fix);
    EXPECT_THAT(receiver.line(zda_id), StartsWith("$GNZDA,120000.220,05,03,2024,00,00*"));
}

TEST(NmeaConfiguration, ChoosesTalkersAndNumbers) {
    SampleReceiver receiver = four_systems(NmeaVersion::v4_0);
    EXPECT_THAT(receiver.message(gsv_id).at(3), StartsWith("$GAGSV,1,1,03,,"));
    receiver.config.set(in_ram, key::nmea_svnumbering, 1);
    EXPECT_THAT(receiver.message(gsv_id).at(3), StartsWith("$GAGSV,1,1,03,301,"));
    receiver.config.set(in_ram, key::nmea_gsv_talker, 1);
    EXPECT_THAT(receiver.message(gsv_id).at(3), StartsWith("$GNGSV,1,1,03,301,"));
    receiver.config.set(in_ram, key::nmea_gsv_talker, 0);
    receiver.config.set(in_ram, key::nmea_bds_talker, 'B' | 'D' << 8);
    EXPECT_EQ(receiver.message(gsv_id).back(), Sentence("BDGSV,1,1,00").finish());
    receiver.config.set(in_ram, key::nmea_bds_talker, 0);
    receiver.board.style.beidou_talker = "BD";
    EXPECT_EQ(receiver.message(gsv_id).back(), Sentence("BDGSV,1,1,00").finish());
    receiver.config.set(in_ram, key::nmea_maxsvs, 4);
    EXPECT_THAT(receiver.message(gsv_id).at(0), StartsWith("$GPGSV,1,1,04,"));
    receiver.config.set(in_ram, key::navspg_fixmode, 2);
    EXPECT_THAT(receiver.message(gsa_id).at(0), StartsWith("$GNGSA,M,3,"));
}

TEST(NmeaConfiguration, CountsConsideredSatellites) {
    SampleReceiver receiver = four_systems();
    SatelliteStatus& rejected = receiver.state.epoch.fix.satellites.at(3);
    ASSERT_FALSE(rejected.used);
    rejected.residual = Metres(80);
    EXPECT_EQ(messages_of_kind<Gga>(receiver.message(gga_id)).at(0).satellites_used, 12);
    // A satellite below the mask is not weighed at all, whatever its residual.
    receiver.config.set(in_ram, key::navspg_min_elev, static_cast<std::uint8_t>(rejected.elevation.deg() + 1));
    EXPECT_EQ(messages_of_kind<Gga>(receiver.message(gga_id)).at(0).satellites_used, 11);
    receiver.config.set(in_ram, key::navspg_min_elev, 5);
    receiver.config.set(in_ram, key::nmea_consider, 0);
    EXPECT_EQ(messages_of_kind<Gga>(receiver.message(gga_id)).at(0).satellites_used, 11);
}

Observation tracked(SatelliteId id, Signal signal, double cn0) {
    Observation o;
    o.satellite = id;
    o.signal = signal;
    o.cn0 = DbHz(cn0);
    o.lock_time = Seconds(12.7);
    return o;
}

// G01 on two signals, G02 on one, G04 only in view; E01 on E5b and E1.
SampleReceiver two_signals(NmeaVersion version) {
    SampleReceiver receiver(sample_board(version, {gps, galileo}));
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(fix, gps, 1, 4);
    add_satellites(fix, galileo, 1, 1);
    receiver.set(fix);
    receiver.state.epoch.observations.signals = {
        tracked({gps, 1}, Signal::l1, 45), tracked({gps, 1}, Signal::l2, 38), tracked({gps, 2}, Signal::l1, 41),
        tracked({galileo, 1}, Signal::l1, 44), tracked({galileo, 1}, Signal::e5b, 43)};
    return receiver;
}

TEST(NmeaGsvGroups, AreOneForEachSignalSince4_10) {
    const auto newer = two_signals(NmeaVersion::v4_11).message(gsv_id);
    ASSERT_THAT(newer, SizeIs(5));
    EXPECT_THAT(newer[0], StartsWith("$GPGSV,1,1,02,01,08,011,45,02,25,048,41,1*"));
    EXPECT_THAT(newer[1], StartsWith("$GPGSV,1,1,01,01,08,011,38,6*"));
    EXPECT_THAT(newer[2], StartsWith("$GPGSV,1,1,02,03,43,085,,04,60,122,,0*"));
    EXPECT_THAT(newer[3], StartsWith("$GAGSV,1,1,01,01,08,011,43,2*"));
    EXPECT_THAT(newer[4], StartsWith("$GAGSV,1,1,01,01,08,011,44,7*"));
    const auto older = two_signals(NmeaVersion::v4_10).message(gsv_id);
    ASSERT_THAT(older, SizeIs(4));
    EXPECT_THAT(older[0], StartsWith("$GPGSV,1,1,04,01,08,011,45,02,25,048,41,03,43,085,,04,60,122,,1*"));
    EXPECT_THAT(older[1], StartsWith("$GPGSV,1,1,04,01,08,011,38,02,25,048,,03,43,085,,04,60,122,,6*"));
    EXPECT_THAT(two_signals(NmeaVersion::v4_0).message(gsv_id), SizeIs(2));
}

TEST(NmeaGsvGroups, LeaveUnknownDirectionsEmpty) {
    SampleReceiver receiver(sample_board(NmeaVersion::v4_0, {gps}));
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    fix.type = FixType::none;
    SatelliteStatus fresh;
    fresh.id = {gps, 9};
    fresh.has_ephemeris = false;
    fresh.cn0 = DbHz(33);
    fix.satellites = {fresh};
    receiver.set(fix);
    EXPECT_EQ(receiver.line(gsv_id), Sentence("GPGSV,1,1,01,09,,,33").finish());
}

TEST(NmeaCorrections, AreToldWithAgeAndStation) {
    SampleReceiver receiver = four_systems();
    receiver.state.epoch.fix.type = FixType::rtk_fixed;
    EXPECT_THAT(receiver.line(gga_id), HasSubstr(",M,,0000*"));
    receiver.state.corrections = {CorrectionState::rtk_fixed, Seconds(0.04), 41, {}};
    EXPECT_THAT(receiver.line(gga_id), HasSubstr(",M,0.0,0041*"));
    EXPECT_THAT(receiver.line(gns_id), HasSubstr(",RRRN,11,1.10,478.6,21.4,0.0,0041,V*"));
    receiver.state.epoch.fix.type = FixType::fix_3d;
    EXPECT_THAT(receiver.line(gga_id), HasSubstr(",M,,*"));
    receiver.board.style.station_field = "0000";
    EXPECT_THAT(receiver.line(gga_id), HasSubstr(",M,,0000*"));
}

TEST(NmeaOthers, TellErrorsResidualsDistanceAndHeading) {
    SampleReceiver receiver = four_systems();
    EXPECT_THAT(receiver.line(gbs_id), StartsWith("$GNGBS,120000.00,2.6,2.0,5.0,,,,,,*"));
    EXPECT_EQ(receiver.line(dtm_id), Sentence("GNDTM,W84,,0.0,N,0.0,E,0.0,W84").finish());
    receiver.state.epoch.fix.satellites[0].residual = Metres(-1.25);
    receiver.state.epoch.fix.satellites[2].residual = Metres(0.51);
    ASSERT_THAT(receiver.message(grs_id), SizeIs(4));
    EXPECT_THAT(receiver.message(grs_id).at(0), StartsWith("$GNGRS,120000.00,1,-1.2,,0.5,,,,,,,,,,1,1*"));
    receiver.state.odometer_m = 1852;
    receiver.state.odometer_total_m = 18520;
    EXPECT_EQ(receiver.line(vlw_id), Sentence("GNVLW,,N,,N,10.000,N,1.000,N").finish());
    EXPECT_EQ(receiver.line(ths_id), Sentence("GNTHS,,V").finish());
    RelativePosition relative;
    relative.north_m = -1;
    relative.east_m = -1;
    receiver.state.epoch.relative = relative;
    EXPECT_EQ(receiver.line(ths_id), Sentence("GNTHS,225.00,A").finish());
    receiver.board.style.gst_ellipse = false;
    EXPECT_THAT(receiver.line(gst_id), StartsWith("$GNGST,120000.00,3.0,,,,2.6,2.0,5.0*"));
    EXPECT_THAT(receiver.message(0x77), IsEmpty());
}

TEST(NmeaOfMediaTek, CountsFrom1980UntilItKnowsTheTime) {
    SampleReceiver receiver = without_fix(NmeaVersion::v2_3, {gps});
    receiver.board.style.unknown_date_is_1980 = true;
    receiver.board.time_decimals = 3;
    receiver.state.since_start = Seconds(1.2);
    EXPECT_THAT(receiver.line(rmc_id), StartsWith("$GPRMC,235947.200,V,,,,,,,050180,,,N*"));
    receiver.state.since_start = Seconds(15);
    EXPECT_THAT(receiver.line(rmc_id), StartsWith("$GPRMC,000001.000,V,,,,,,,060180,,,N*"));
    receiver.state.time.time = true;
    EXPECT_THAT(receiver.line(rmc_id), StartsWith("$GPRMC,000001.000,V,,,,,,,060180,,,N*")) << "the date is to come";
    receiver.state.time.date = true;
    EXPECT_THAT(receiver.line(rmc_id), testing::Not(HasSubstr("0180")));
}

TEST(NmeaPubx, TellsPositionSatellitesAndTime) {
    SampleReceiver receiver = four_systems();
    Fix& fix = receiver.state.epoch.fix;
    fix.velocity.down = -0.25;
    fix.clock_bias = Metres(speed_of_light * 1e-6);
    fix.clock_drift = MetresPerSecond(speed_of_light * -50e-9);
    EXPECT_THAT(receiver.line(0, pubx_class),
                StartsWith("$PUBX,00,120000.00,4700.00000,N,00800.00000,E,500.000,G3,3.3,5.0,45.000,77.78,-0.250,,1.10,"
                           "1.69,1.31,11,0,0*"));
    EXPECT_THAT(receiver.line(3, pubx_class),
                StartsWith("$PUBX,03,12,1,U,011,08,31,064,2,U,048,25,33,064,3,U,085,43,36,064,4,e,122,60,,000,"));
    // 5 March 2024 is the Tuesday of GPS week 2304.
    EXPECT_EQ(receiver.line(4, pubx_class),
              Sentence("PUBX,04,120000.00,050324,216000.00,2304,18,1000,-50.000,16").finish());
    receiver.state.time.leap_seconds = false;
    EXPECT_THAT(receiver.line(4, pubx_class), HasSubstr(",2304,18D,"));
    EXPECT_THAT(two_signals(NmeaVersion::v4_11).line(3, pubx_class), StartsWith("$PUBX,03,05,1,U,011,08,31,012,"));
    EXPECT_THAT(receiver.message(5, pubx_class), IsEmpty());
}

TEST(NmeaPubx, HasAFormWithoutPosition) {
    SampleReceiver receiver = without_fix(NmeaVersion::v4_0, {gps});
    EXPECT_THAT(
        receiver.line(0, pubx_class),
        StartsWith("$PUBX,00,,0000.00000,N,00000.00000,E,0.000,NF,5303356,3750039,0.000,0.00,0.000,,99.99,99.99,"
                   "99.99,0,0,0*"));
    receiver.state.epoch.fix.type = FixType::time_only;
    EXPECT_THAT(receiver.line(0, pubx_class), HasSubstr(",TT,"));
    receiver.set(sample_fix("2024-03-05T12:00:00Z", 47, 8, 500));
    receiver.state.epoch.fix.type = FixType::rtk_fixed;
    receiver.state.corrections = {CorrectionState::rtk_fixed, Seconds(1.4), 1, {}};
    EXPECT_THAT(receiver.line(0, pubx_class), HasSubstr(",D3,3.3,5.0,45.000,77.78,0.000,1,1.10,"));
}

TEST(TextMessages, FollowTheMasksOfTheirPort) {
    SampleReceiver receiver(sample_board(NmeaVersion::v4_0, {gps, glonass}));
    const auto texts = [&](int level) { return make_text_message(level, "PGRM inv format", receiver.context()); };
    ASSERT_THAT(texts(1), SizeIs(1));
    EXPECT_EQ(to_string(texts(1).at(0)), "$GNTXT,01,01,01,PGRM inv format*2A\r\n");
    EXPECT_THAT(texts(3), IsEmpty());
    EXPECT_THAT(texts(7), SizeIs(1));
    EXPECT_THAT(texts(9), IsEmpty());
    receiver.config.set(in_ram, key::inf_ubx(PortId::uart1), 0x0F);
    ASSERT_THAT(texts(1), SizeIs(2));
    EXPECT_EQ(texts(1).at(1),
              encode_frame(InfWarning{{'P', 'G', 'R', 'M', ' ', 'i', 'n', 'v', ' ', 'f', 'o', 'r', 'm', 'a', 't'}}));
    EXPECT_THAT(texts(3), SizeIs(1));
    receiver.config.set(in_ram, key::out_protocol(PortId::uart1, 2), 0);
    EXPECT_THAT(texts(1), SizeIs(1));
    receiver.config.set(in_ram, key::out_protocol(PortId::uart1, 1), 0);
    EXPECT_THAT(texts(1), IsEmpty());
}

TEST(TextMessages, AreWholeSentencesOfMediaTek) {
    SampleReceiver receiver(sample_board(NmeaVersion::v2_3, {gps}));
    receiver.config.set(in_ram, key::inf_nmea(PortId::uart1), 0);
    EXPECT_EQ(to_string(make_text_message(2, "$PMTK011,MTKGPS", receiver.context()).at(0)), "$PMTK011,MTKGPS*08\r\n");
    EXPECT_EQ(to_string(make_text_message(2, "$PMTK010,001", receiver.context()).at(0)), "$PMTK010,001*2E\r\n");
}

}  // namespace
}  // namespace skyloop::firmware
