#include <gtest/gtest.h>

#include "firmware/messages/field_values.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_services.hpp"
#include "ubx_reports.hpp"

namespace skyloop::firmware {
namespace {

Observation tracked_signal(SatelliteId satellite, Signal signal, int channel = 0) {
    Observation o;
    o.satellite = satellite;
    o.signal = signal;
    o.carrier = carrier_frequency(signal, channel);
    o.cn0 = DbHz(41.4);
    o.pseudorange = Metres(22'345'678.9);
    o.carrier_phase = 117'426'581.25;
    o.doppler = Hertz(-1234.5);
    o.lock_time = Seconds(12.3456);
    o.pseudorange_deviation = Metres(0.32);
    o.carrier_phase_deviation = 0.011;
    o.doppler_deviation = Hertz(0.13);
    return o;
}

// RECEIVER.md 5.6.
TEST(SatelliteNumbers, FollowTheTable) {
    EXPECT_EQ(gnss_id(Constellation::qzss), 5);
    EXPECT_EQ(gnss_id(Constellation::glonass), 6);
    EXPECT_EQ(sv_id({Constellation::sbas, 23}), 123);
    EXPECT_EQ(sv_id({Constellation::beidou, 63}), 63);
    EXPECT_EQ(ubx_single_number({Constellation::galileo, 36}), 246);
    EXPECT_EQ(ubx_single_number({Constellation::beidou, 5}), 163);
    EXPECT_EQ(ubx_single_number({Constellation::beidou, 6}), 33);
    EXPECT_EQ(ubx_single_number({Constellation::beidou, 37}), 64);
    EXPECT_FALSE(ubx_single_number({Constellation::beidou, 38}));
    EXPECT_EQ(ubx_single_number({Constellation::qzss, 1}), 193);
    EXPECT_EQ(ubx_single_number({Constellation::glonass, 24}), 88);
    EXPECT_EQ(ubx_single_number({Constellation::sbas, 20}), 120);
}

TEST(SatelliteNumbers, NameSignals) {
    EXPECT_EQ(signal_id({Constellation::gps, 3}, Signal::l2), 3);
    EXPECT_EQ(signal_id({Constellation::qzss, 3}, Signal::l2), 5);
    EXPECT_EQ(signal_id({Constellation::galileo, 3}, Signal::e5b), 6);
    EXPECT_EQ(signal_id({Constellation::galileo, 3}, Signal::l5), 4);
    EXPECT_EQ(signal_id({Constellation::beidou, 20}, Signal::b1i), 0);
    EXPECT_EQ(signal_id({Constellation::beidou, 3}, Signal::b1i), 1);
    EXPECT_EQ(signal_id({Constellation::beidou, 20}, Signal::e5b), 2);
    EXPECT_EQ(signal_id({Constellation::beidou, 20}, Signal::b1i, true), 5);
    EXPECT_EQ(signal_id({Constellation::glonass, 3}, Signal::g2), 2);
    EXPECT_EQ(frequency_id({Constellation::glonass, 3}, Signal::g1, carrier_frequency(Signal::g1, -7)), 0);
    EXPECT_EQ(frequency_id({Constellation::glonass, 3}, Signal::g2, carrier_frequency(Signal::g2, 6)), 13);
    EXPECT_EQ(frequency_id({Constellation::gps, 3}, Signal::l1, carrier_frequency(Signal::l1)), 0);
}

TEST(NavSatMessage, HasTheTypicalFlags) {
    UbxReport m9(9);
    m9.state.epoch.fix.satellites[0].residual = Metres(-1.26);
    const auto m = m9.report<NavSat>();
    ASSERT_EQ(m.satellites.size(), 12u);
    EXPECT_EQ(m.version, 1);
    EXPECT_EQ(m.satellites[0].flags, 0x191Fu);  // RECEIVER.md 3.1
    EXPECT_EQ(m.satellites[0].cno, 31);
    EXPECT_EQ(m.satellites[0].elev, 8);
    EXPECT_EQ(m.satellites[0].azim, 11);
    EXPECT_EQ(m.satellites[0].pr_res, -13);
    EXPECT_EQ(m.satellites[3].flags, 0x1911u);  // not tracked
    EXPECT_EQ(m.satellites[3].cno, 0);
    EXPECT_EQ(m.satellites[8].gnss_id, 2);
}

TEST(NavSatMessage, TellsWhatItDoesNotKnow) {
    UbxReport m9(9);
    m9.state.time.leap_seconds = false;
    auto& satellites = m9.state.epoch.fix.satellites;
    satellites[0].has_ephemeris = false;
    satellites[0].used = false;
    satellites[0].azimuth = satellites[0].elevation = Angle();
    satellites[1].has_ephemeris = false;
    satellites[1].used = false;
    satellites[2].healthy = false;
    auto m = m9.report<NavSat>();
    EXPECT_EQ(m.satellites[0].elev, -91);
    EXPECT_EQ(m.satellites[0].azim, 0);
    EXPECT_EQ(m.satellites[0].flags, 0x07u);
    EXPECT_EQ(m.satellites[1].flags, 0x217u);  // by almanac
    EXPECT_EQ(m.satellites[2].flags, 0x92Fu);
    m9.state.position_known = false;
    m = m9.report<NavSat>();
    for (const NavSatItem& item : m.satellites)
        EXPECT_EQ(item.elev, -91);
}

TEST(NavSatMessage, NamesTheCorrections) {
    UbxReport m9(9);
    m9.state.epoch.fix.type = FixType::dgnss;
    EXPECT_EQ(m9.report<NavSat>().satellites[0].flags, 0x191Fu | 0x00010040u);
    m9.state.corrections.state = CorrectionState::rtk_fixed;
    m9.state.epoch.fix.type = FixType::rtk_fixed;
    EXPECT_EQ(m9.report<NavSat>().satellites[0].flags, 0x191Fu | 0x00320040u);
}

TEST(NavSatMessage, IsSortedAndCountsTo255) {
    UbxReport m9(9);
    m9.state.epoch.fix.satellites.clear();
    for (int i = 0; i < 300; ++i)
        m9.state.epoch.fix.satellites.push_back({{Constellation::gps, 300 - i}, Angle(), Angle(), std::nullopt});
    const auto m = m9.report<NavSat>();
    ASSERT_EQ(m.satellites.size(), 255u);
    EXPECT_EQ(m.satellites[0].sv_id, 1);
    EXPECT_EQ(m.satellites[254].sv_id, 255);
}

TEST(NavSvinfoMessage, NumbersChannels) {
    UbxReport m8(8);
    const auto m = m8.report<NavSvinfo>();
    EXPECT_EQ(m.global_flags, 4);
    ASSERT_EQ(m.channels.size(), 12u);
    EXPECT_EQ(m.channels[0].chn, 0);
    EXPECT_EQ(m.channels[0].flags, 0x0D);
    EXPECT_EQ(m.channels[0].quality, 7);
    EXPECT_EQ(m.channels[3].chn, 255);
    EXPECT_EQ(m.channels[4].chn, 3);
    EXPECT_EQ(m.channels[8].sv_id, 211);
    m8.state.epoch.fix.satellites[0].healthy = false;
    EXPECT_EQ(m8.report<NavSvinfo>().channels[0].flags, 0x1D);
    EXPECT_EQ(UbxReport(7).report<NavSvinfo>().global_flags, 3);
}

TEST(NavOrbMessage, TellsHealthAndVisibility) {
    UbxReport m9(9);
    auto& satellites = m9.state.epoch.fix.satellites;
    satellites[1].elevation = Angle::degrees(2);
    satellites[2].elevation = Angle::degrees(-3);
    satellites[4].healthy = false;
    const auto m = m9.report<NavOrb>();
    EXPECT_EQ(m.satellites[0].sv_flag, 0x0D);
    EXPECT_EQ(m.satellites[1].sv_flag, 0x09);
    EXPECT_EQ(m.satellites[2].sv_flag, 0x05);
    EXPECT_EQ(m.satellites[4].sv_flag & 3, 2);
    EXPECT_EQ(m.satellites[0].eph >> 5, 1);
    m9.start_cold(3);
    EXPECT_TRUE(m9.report<NavOrb>().satellites.empty());
}

TEST(NavSbasMessage, NamesTheStrongestSatellite) {
    UbxReport m8(8);
    EXPECT_EQ(m8.report<NavSbas>().geo, 0);
    add_satellites(m8.state.epoch.fix, Constellation::sbas, 23, 3);
    m8.state.epoch.fix.satellites[12].used = m8.state.epoch.fix.satellites[13].used = false;
    m8.state.epoch.fix.type = FixType::dgnss;
    const auto m = m8.report<NavSbas>();
    EXPECT_EQ(m.geo, 125);
    EXPECT_EQ(m.mode, 1);
    EXPECT_EQ(m.service, 3);
    EXPECT_EQ(m.satellites.size(), 10u);
}

TEST(NavSbasMessage, TellsOfTheSatellitesThatAreCorrected) {
    UbxReport m9(9);
    Fix& fix = m9.state.epoch.fix;
    add_satellites(fix, Constellation::sbas, 23, 3);
    fix.type = FixType::dgnss;
    fix.sbas_source = {Constellation::sbas, 23};
    fix.satellites[0].sbas = AppliedSbas{4, Metres(-1.25), Metres(3.5)};
    const auto m = m9.report<NavSbas>();
    EXPECT_EQ(m.geo, 123);
    ASSERT_EQ(m.satellites.size(), 1u);
    EXPECT_EQ(m.satellites[0].sv_id, sv_id(fix.satellites[0].id));
    EXPECT_EQ(m.satellites[0].udre, 4);
    EXPECT_EQ(m.satellites[0].prc.raw, -125);
    EXPECT_EQ(m.satellites[0].ic.raw, 350);
    // Of NAV-SAT and NAV-SIG that one alone has corrections, too.
    const auto list = m9.report<NavSat>().satellites;
    EXPECT_EQ(list[0].flags & 0x10040, 0x10040u);
    EXPECT_EQ(list[1].flags & 0x10040, 0u);
    const auto signals = m9.report<NavSig>().signals;
    EXPECT_EQ(signals[0].corr_source, 1);
    EXPECT_EQ(signals[0].iono_model, 2);
    EXPECT_EQ(signals[1].corr_source, 0);
    EXPECT_EQ(signals[1].iono_model, 2) << "the grid is for all";
}

TEST(NavSigMessage, ComesFromTheSatellitesOfAModelThatMeasuresNothing) {
    UbxReport m9(9);
    const auto m = m9.report<NavSig>();
    ASSERT_EQ(m.signals.size(), 12u);
    EXPECT_EQ(m.signals[0].flags, 0x29);  // RECEIVER.md 3.1
    EXPECT_EQ(m.signals[0].iono_model, 1);
    EXPECT_EQ(m.signals[0].quality, 7);
    EXPECT_EQ(m.signals[3].flags, 0x01);
    EXPECT_EQ(m.signals[3].quality, 1);
    m9.state.epoch.fix.type = FixType::dgnss;
    EXPECT_EQ(m9.report<NavSig>().signals[0].flags, 0x169);
    EXPECT_EQ(m9.report<NavSig>().signals[0].corr_source, 1);
    EXPECT_EQ(m9.report<NavSig>().signals[0].iono_model, 2);
    m9.state.corrections.state = CorrectionState::rtk_float;
    m9.state.epoch.fix.type = FixType::rtk_float;
    EXPECT_EQ(m9.report<NavSig>().signals[0].flags, 0xF9);
    EXPECT_EQ(m9.report<NavSig>().signals[0].corr_source, 4);
}

TEST(NavSigMessage, ListsEverySignal) {
    UbxReport f9(9);
    auto& signals = f9.state.epoch.observations.signals;
    signals = {tracked_signal({Constellation::gps, 1}, Signal::l1), tracked_signal({Constellation::gps, 1}, Signal::l2),
               tracked_signal({Constellation::gps, 2}, Signal::l1)};
    signals[1].carrier_phase = std::nullopt;
    signals[2].pseudorange = std::nullopt;
    const auto m = f9.report<NavSig>();
    ASSERT_EQ(m.signals.size(), 13u);
    EXPECT_EQ(m.signals[0].sig_id, 0);
    EXPECT_EQ(m.signals[1].sig_id, 3);
    EXPECT_EQ(m.signals[0].iono_model, 8);
    EXPECT_EQ(m.signals[0].quality, 7);
    EXPECT_EQ(m.signals[1].quality, 4);
    EXPECT_EQ(m.signals[2].quality, 3);
    EXPECT_EQ(m.signals[2].flags, 0x01);
}

TEST(NavSigMessage, TakesL5OfGpsForUnhealthyUntilThatIsOverridden) {
    UbxReport f10(10);
    constexpr std::uint32_t l5_as_healthy_as_l1 = 0x10320001;
    f10.state.epoch.observations.signals = {tracked_signal({Constellation::gps, 1}, Signal::l1),
                                            tracked_signal({Constellation::gps, 1}, Signal::l5)};
    f10.config.set(in_ram, l5_as_healthy_as_l1, 0);
    auto m = f10.report<NavSig>();
    EXPECT_EQ(m.signals[0].flags, 0x29);
    EXPECT_EQ(m.signals[0].iono_model, 1);
    EXPECT_EQ(m.signals[1].sig_id, 7);
    EXPECT_EQ(m.signals[1].flags, 0x02);
    EXPECT_EQ(m.signals[1].quality, 7);
    f10.config.set(in_ram, l5_as_healthy_as_l1, 1);
    m = f10.report<NavSig>();
    EXPECT_EQ(m.signals[0].iono_model, 8);
    EXPECT_EQ(m.signals[1].flags, 0x29);
}

TEST(NavSigMessage, CallsB1iB1cWhereThatIsConfigured) {
    UbxReport m10(10);
    m10.state.epoch.fix.satellites.clear();
    add_satellites(m10.state.epoch.fix, Constellation::beidou, 20, 1);
    EXPECT_EQ(m10.report<NavSig>().signals[0].sig_id, 0);
    m10.config.set(in_ram, 0x10310022, 1);
    m10.config.set(in_ram, 0x1031000D, 0);
    m10.config.set(in_ram, 0x1031000F, 1);
    EXPECT_EQ(m10.report<NavSig>().signals[0].sig_id, 5);
}

}  // namespace
}  // namespace skyloop::firmware
