#include <gtest/gtest.h>

#include "receiver/protocol/ubx_raw.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "ubx_reports.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

Observation raw_signal(SatelliteId satellite, Signal signal, double pseudorange_m) {
    Observation o;
    o.satellite = satellite;
    o.signal = signal;
    o.carrier = carrier_frequency(signal);
    o.cn0 = DbHz(41.4);
    o.pseudorange = Metres(pseudorange_m);
    o.carrier_phase = 117'426'581.25;
    o.doppler = Hertz(-1234.5);
    o.lock_time = Seconds(12.3456);
    o.pseudorange_deviation = Metres(0.32);
    o.carrier_phase_deviation = 0.0119;
    o.doppler_deviation = Hertz(0.128);
    return o;
}

UbxReport measured() {
    UbxReport f9(9);
    f9.state.epoch.observations.receive_time = to_gps_time({2304, 218981521ms});
    f9.state.epoch.observations.signals = {raw_signal({Constellation::gps, 1}, Signal::l1, 22'345'678.9),
                                           raw_signal({Constellation::gps, 1}, Signal::l2, 22'345'680.1),
                                           raw_signal({Constellation::galileo, 2}, Signal::e5b, 25e6)};
    return f9;
}

TEST(RxmRawxMessage, IsInTheTimeOfTheReceiver) {
    UbxReport f9 = measured();
    auto m = f9.report<RxmRawx>();
    EXPECT_DOUBLE_EQ(m.rcv_tow, 218981.521);
    EXPECT_EQ(m.week, 2304);
    EXPECT_EQ(m.leap_s, 18);
    EXPECT_EQ(m.rec_stat, 1);
    EXPECT_EQ(m.version, 1);
    f9.state.time.leap_seconds = false;
    f9.state.epoch.observations.clock_was_set = true;
    EXPECT_EQ(f9.report<RxmRawx>().rec_stat, 2);
}

// Ranges and phases are those of the whole millisecond that the receiver's clock has just passed: the satellite comes
// nearer or goes, 200 µs long.
TEST(RxmRawxMessage, MeasuresAtWholeMillisecondsOfTheReceiversClock) {
    UbxReport f9 = measured();
    f9.state.epoch.observations.receive_time += 200us;
    const auto m = f9.report<RxmRawx>();
    EXPECT_DOUBLE_EQ(m.rcv_tow, 218981.521);
    const Observation& l1 = f9.state.epoch.observations.signals.front();
    const double cycles = -1234.5 * 200e-6;
    EXPECT_NEAR(m.measurements[0].cp_mes, *l1.carrier_phase + cycles, 1e-6);
    EXPECT_NEAR(m.measurements[0].pr_mes, l1.pseudorange->value() + cycles * 299792458.0 / l1.carrier.value(), 1e-6);
    f9.state.epoch.observations.receive_time -= 400us;
    const auto before = f9.report<RxmRawx>();
    EXPECT_DOUBLE_EQ(before.rcv_tow, m.rcv_tow);
    EXPECT_NEAR(before.measurements[0].cp_mes, *l1.carrier_phase - cycles, 1e-6);
}

// As a ZED-F9P at a cold start: its own count, no week and no measurement until the time and the date are known.
TEST(RxmRawxMessage, CountsAndMeasuresNothingUntilTheDateIsKnown) {
    UbxReport f9 = measured();
    f9.state.since_start = Seconds(19);
    f9.state.epoch.observations.clock_was_set = true;
    const TimeKnowledge known = f9.state.time;
    for (const bool time : {false, true}) {
        f9.state.time = {.time = time};
        const auto m = f9.report<RxmRawx>();
        EXPECT_DOUBLE_EQ(m.rcv_tow, 19) << time;
        EXPECT_EQ(m.week, 0) << time;
        EXPECT_EQ(m.leap_s, 18) << time;
        EXPECT_EQ(m.rec_stat, 0) << time;
        EXPECT_TRUE(m.measurements.empty()) << time;
    }
    f9.state.time = known;
    EXPECT_EQ(f9.report<RxmRawx>().week, 2304);
    EXPECT_EQ(f9.report<RxmRawx>().measurements.size(), 3u);
}

TEST(RxmRawxMessage, CodesDeviationsAndTracking) {
    UbxReport f9 = measured();
    auto& signals = f9.state.epoch.observations.signals;
    signals[1].carrier_phase = std::nullopt;
    signals[2].half_cycle_resolved = false;
    signals[2].lock_time = Seconds(1000);
    signals.push_back(raw_signal({Constellation::glonass, 5}, Signal::g1, 2e7));
    signals.back().carrier = carrier_frequency(Signal::g1, -4);
    signals.push_back(raw_signal({Constellation::glonass, 6}, Signal::g1, 2e7));
    signals.back().pseudorange = std::nullopt;
    const auto m = f9.report<RxmRawx>();
    ASSERT_EQ(m.measurements.size(), 4u);
    const RxmRawxItem& first = m.measurements[0];
    EXPECT_DOUBLE_EQ(first.pr_mes, 22'345'678.9);
    EXPECT_DOUBLE_EQ(first.cp_mes, 117'426'581.25);
    EXPECT_FLOAT_EQ(first.do_mes, -1234.5f);
    EXPECT_EQ(first.cno, 41);
    EXPECT_EQ(first.locktime, 12346);
    EXPECT_EQ(first.pr_stdev, 5);  // 0.01·2^5 = 0.32 m
    EXPECT_EQ(first.cp_stdev, 3);  // 0.004·3 cycles
    EXPECT_EQ(first.do_stdev, 6);  // 0.002·2^6 = 0.128 Hz
    EXPECT_EQ(first.trk_stat, 0x07);
    EXPECT_EQ(m.measurements[1].sig_id, 3);
    EXPECT_EQ(m.measurements[1].cp_stdev, 15);
    EXPECT_EQ(m.measurements[1].trk_stat, 0x01);
    EXPECT_EQ(m.measurements[1].locktime, 0);
    EXPECT_EQ(m.measurements[2].trk_stat, 0x03);
    EXPECT_EQ(m.measurements[2].locktime, 64500);
    EXPECT_EQ(m.measurements[2].sig_id, 6);
    EXPECT_EQ(m.measurements[3].freq_id, 3);
}

TEST(RxmRawxMessage, HasPhasesOfGeostationaryBeidouHalfACycleLower) {
    UbxReport f9 = measured();
    auto& signals = f9.state.epoch.observations.signals;
    signals.clear();
    for (const int number : {1, 5, 6, 58, 59})
        signals.push_back(raw_signal({Constellation::beidou, number}, Signal::b1i, 3.8e7));
    const auto m = f9.report<RxmRawx>();
    ASSERT_EQ(m.measurements.size(), 5u);
    for (const std::size_t geostationary : {0U, 1U, 4U})
        EXPECT_DOUBLE_EQ(m.measurements[geostationary].cp_mes, 117'426'580.75);
    for (const std::size_t other : {2U, 3U})
        EXPECT_DOUBLE_EQ(m.measurements[other].cp_mes, 117'426'581.25);
}

TEST(RxmRawxMessage, IsEmptyForAModelThatMeasuresNothing) {
    const UbxReport m8(8);
    EXPECT_TRUE(m8.report<RxmRawx>().measurements.empty());
    EXPECT_DOUBLE_EQ(m8.report<RxmRawx>().rcv_tow, 218981.521);
}

// G20 of a captured ZED-F9P (fw 1.11): RAWX gives 66.69534 ms of travel, MEASX 710 chips and 1018/1024.
TEST(RxmMeasxMessage, HasTheCodePhaseOfTheTravelTime) {
    UbxReport f9 = measured();
    const double travel_ms = 66.0 + (710 + 1018 / 1024.0) / 1023;
    f9.state.epoch.observations.signals = {
        raw_signal({Constellation::gps, 20}, Signal::l1, travel_ms * 299792.458 + 0.05),
        raw_signal({Constellation::galileo, 4}, Signal::l1, 87.34205 * 299792.458)};
    const auto m = f9.report<RxmMeasx>();
    EXPECT_EQ(m.gps_tow, 218981521u);
    EXPECT_EQ(m.gal_tow, m.gps_tow);
    EXPECT_EQ(m.bds_tow, 218967521u);
    EXPECT_EQ(m.glo_tow, 218981521u + 10782000u);
    EXPECT_EQ(m.flags, 2);
    ASSERT_EQ(m.satellites.size(), 2u);
    EXPECT_EQ(m.satellites[0].whole_chips, 710);
    EXPECT_EQ(m.satellites[0].frac_chips, 1018);
    EXPECT_NEAR(m.satellites[0].code_phase / 2097152.0, 0.69501, 1e-4);
    EXPECT_EQ(m.satellites[0].int_code_phase, 0);
    EXPECT_NEAR(m.satellites[0].doppler_hz * 0.2, -1234.5, 0.11);
    EXPECT_NEAR(m.satellites[0].doppler_ms * 0.04, -234.92, 0.03);
    EXPECT_EQ(m.satellites[0].pseu_range_rms_err, 0);
    EXPECT_EQ(m.satellites[1].int_code_phase, 3);
    EXPECT_EQ(m.satellites[1].whole_chips, 3418);
}

TEST(RxmMeasxMessage, TellsHowSkewThePeakOfCorrelationIs) {
    UbxReport f9 = measured();
    auto& signals = f9.state.epoch.observations.signals;
    signals.clear();
    for (int n = 1; n <= 4; ++n)
        signals.push_back(raw_signal({Constellation::gps, n}, Signal::l1, 22'345'678.9));
    signals[1].correlation_distortion = 0.01;
    signals[2].correlation_distortion = 0.1;
    signals[3].correlation_distortion = 0.3;
    const auto m = f9.report<RxmMeasx>();
    ASSERT_EQ(m.satellites.size(), 4u);
    EXPECT_EQ(m.satellites[0].mpath_indic, 1) << "not looked for";
    EXPECT_EQ(m.satellites[1].mpath_indic, 1);
    EXPECT_EQ(m.satellites[2].mpath_indic, 2);
    EXPECT_EQ(m.satellites[3].mpath_indic, 3);
}

TEST(RxmSfrbxMessage, HasOneFrameForEachSubframe) {
    UbxReport f9(9);
    EXPECT_TRUE(f9.frames(RxmSfrbx::message_id).empty());
    f9.state.epoch.subframes = {{{Constellation::gps, 2}, Signal::l1, {}, 0, {0x22C00E18, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
                                {{Constellation::glonass, 9}, Signal::g1, {}, -2, {1, 2, 3, 4}}};
    const auto frames = f9.frames(RxmSfrbx::message_id);
    ASSERT_EQ(frames.size(), 2u);
    const auto gps = decode_payload<RxmSfrbx>(parse_frame(frames[0])->payload);
    ASSERT_TRUE(gps);
    EXPECT_EQ(gps->words.size(), 10u);
    EXPECT_EQ(gps->words[0], 0x22C00E18u);
    EXPECT_EQ(gps->version, 2);
    EXPECT_EQ(gps->chn, 1);
    const auto glonass = decode_payload<RxmSfrbx>(parse_frame(frames[1])->payload);
    ASSERT_TRUE(glonass);
    EXPECT_EQ(glonass->freq_id, 5);
}

TEST(RxmSfrbxMessage, NamesTheSignalThatCarriesTheData) {
    UbxReport f9(9);
    f9.state.epoch.subframes = {{{Constellation::galileo, 3}, Signal::l1, {}, 0, {1, 2, 3, 4, 5, 6, 7, 8}},
                                {{Constellation::galileo, 3}, Signal::e5b, {}, 0, {1, 2, 3, 4, 5, 6, 7, 8}},
                                {{Constellation::gps, 2}, Signal::l1, {}, 0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}},
                                {{Constellation::beidou, 20}, Signal::b1i, {}, 0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}};
    std::vector<int> signals;
    for (const Bytes& frame : f9.frames(RxmSfrbx::message_id))
        signals.push_back(decode_payload<RxmSfrbx>(parse_frame(frame)->payload)->sig_id);
    EXPECT_EQ(signals, (std::vector<int>{1, 5, 0, 0})) << "E1-B, E5b-I, L1 C/A and B1I D1: no pilots";
}

// B1C lasts 10 ms (BDS-SIS-ICD-B1C-1.0), B2a has 10.23 Mchip/s, and neither carries D1.
TEST(RxmMeasxMessage, CountsTheChipsOfB1cAndB2a) {
    UbxReport f10(10);
    f10.config = ConfigStore([&] {
        ConfigValues values = factory_config(f10.board);
        values[0x1031000D] = 0;
        values[0x1031000F] = 1;
        values[0x10310022] = 1;
        return values;
    }());
    f10.state.epoch.observations.signals = {
        raw_signal({Constellation::beidou, 20}, Signal::b1i, 87.5 * 299792.458 + 0.05),
        raw_signal({Constellation::beidou, 20}, Signal::l5, 87.5 * 299792.458 + 0.05)};
    const auto m = f10.report<RxmMeasx>();
    ASSERT_EQ(m.satellites.size(), 2u);
    EXPECT_EQ(m.satellites[0].int_code_phase, 7);
    EXPECT_EQ(m.satellites[0].whole_chips, 7672) << "of a code of 10 ms";
    EXPECT_EQ(m.satellites[1].int_code_phase, 0);
    EXPECT_EQ(m.satellites[1].whole_chips, 5115);
    f10.state.epoch.subframes = {{{Constellation::beidou, 20}, Signal::b1i, {}, 0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}};
    EXPECT_TRUE(f10.frames(RxmSfrbx::message_id).empty());
}

TEST(RxmSfrbxMessage, HasTheNinthWordOfOlderFirmwareForGalileoAlone) {
    UbxReport f9(9);
    f9.state.epoch.subframes = {{{Constellation::galileo, 3}, Signal::l1, {}, 0, {1, 2, 3, 4, 5, 6, 7, 8}},
                                {{Constellation::glonass, 9}, Signal::g1, {}, -2, {1, 2, 3, 4}}};
    const auto words = [&f9](std::size_t frame) {
        return decode_payload<RxmSfrbx>(parse_frame(f9.frames(RxmSfrbx::message_id).at(frame))->payload)->words;
    };
    EXPECT_EQ(words(0), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8}));
    f9.board.galileo_words = 9;
    EXPECT_EQ(words(0), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8, 0}));
    EXPECT_EQ(words(1).size(), 4u);
}

TEST(RxmSvsiMessage, TellsWhatIsKnown) {
    UbxReport m8(8);
    m8.state.epoch.fix.satellites[1].has_ephemeris = false;
    const auto m = m8.report<RxmSvsi>();
    EXPECT_EQ(m.num_vis, 12);
    EXPECT_EQ(m.satellites[0].sv_flag, 0x71);  // as captured
    EXPECT_EQ(m.satellites[1].sv_flag, 0x5F);
}

}  // namespace
}  // namespace skyloop::firmware
