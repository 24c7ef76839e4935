#include "firmware/core/corrections.hpp"

#include <gtest/gtest.h>

#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

const GpsTime power_on = to_gps_time(2300, 1000.0);
GpsTime second(double s) { return advanced(power_on, Seconds(s)); }

Bytes observations_of(int station, int number = 1077) {
    return encode(Rtcm3MsmHeader{number, station, 1000, false, 0, 1, 1u << 30, {true}});
}
Bytes position_of(int station) { return encode(Rtcm3Station{station, {1, 2, 3}, std::nullopt}); }

CorrectionAbility rtk_ability() {
    CorrectionAbility ability;
    ability.rtk = true;
    return ability;
}

// A base that sends at every whole second of first … last, then the state at `asked`.
void hear(CorrectionInput& input, int first, int last, int station = 7) {
    for (int s = first; s <= last; ++s) {
        input.take(position_of(station), second(s));
        input.take(observations_of(station), second(s));
    }
}

CorrectionState state_at(const CorrectionInput& input, double s, const CorrectionLimits& limits = {}) {
    return input.status(second(s), limits).state;
}

TEST(CorrectionInput, AnswersEveryMessage) {
    CorrectionInput input(rtk_ability());
    // version 2, message used, subtype 0, station 7, 1077
    EXPECT_EQ(input.take(observations_of(7), power_on).rtcm,
              encode_frame({0x02, 0x32}, Bytes{2, 4, 0, 0, 7, 0, 0x35, 0x04}));
    // A kind of observations that is not taken: MSM 1 of GPS.
    EXPECT_EQ(input.take(observations_of(7, 1071), power_on).rtcm,
              encode_frame({0x02, 0x32}, Bytes{2, 2, 0, 0, 7, 0, 0x2F, 0x04}));
    // 4072.1: the subtype stands where the station does.
    EXPECT_EQ(input.take(encode_rtcm3(Bytes{0xFE, 0x80, 0x01}), power_on).rtcm,
              encode_frame({0x02, 0x32}, Bytes{2, 4, 1, 0, 0xFF, 0xFF, 0xE8, 0x0F}));
    // A real one goes on with the station, 0.
    EXPECT_EQ(input.take(encode_rtcm3(Bytes{0xFE, 0x80, 0x01, 0x00, 0x00, 0x00, 0x15}), power_on).rtcm,
              encode_frame({0x02, 0x32}, Bytes{2, 4, 1, 0, 0, 0, 0xE8, 0x0F}));
    // An ephemeris and a space state have no station.
    EXPECT_EQ(input.take(encode_rtcm3(Bytes{0x3F, 0xB0, 0x50, 0, 0}), power_on).rtcm,
              encode_frame({0x02, 0x32}, Bytes{2, 2, 0, 0, 0xFF, 0xFF, 0xFB, 0x03}));
    EXPECT_EQ(input.take(encode_rtcm3(Bytes{0x42, 0x40, 0x50, 0, 0}), power_on).rtcm,
              encode_frame({0x02, 0x32}, Bytes{2, 2, 0, 0, 0xFF, 0xFF, 0x24, 0x04}));
    EXPECT_EQ(input.take(encode_rtcm3({}), power_on).rtcm,
              encode_frame({0x02, 0x32}, Bytes{2, 2, 0, 0, 0xFF, 0xFF, 0, 0}));
}

// RXM-COR: version 1, no Eb/N0, and of the status: protocol, errors, use, station, and what of the rest is valid.
TEST(CorrectionInput, TellsTheStatusOfEveryMessage) {
    CorrectionInput input(rtk_ability());
    const auto frame = [](std::uint32_t status, std::uint16_t type, std::uint8_t subtype) {
        const auto byte = [](std::uint32_t v, int shift) { return static_cast<std::uint8_t>(v >> shift & 0xFF); };
        return encode_frame({0x02, 0x34}, Bytes{1, 0, 0, 0, byte(status, 0), byte(status, 8), byte(status, 16),
                                                byte(status, 24), byte(type, 0), byte(type, 8), subtype, 0});
    };
    constexpr std::uint32_t plain = 1u << 28, known = 1u << 27, subtype = 1u << 26, type = 1u << 25,
                            none = 0xFFFFu << 9;
    constexpr std::uint32_t used = 2u << 7, not_used = 1u << 7, error_free = 1u << 5, erroneous = 2u << 5, rtcm3 = 1;
    EXPECT_EQ(input.take(observations_of(7), power_on).cor,
              frame(plain | known | type | 7u << 9 | used | error_free | rtcm3, 1077, 0));
    EXPECT_EQ(input.take(observations_of(7, 1071), power_on).cor,
              frame(plain | type | 7u << 9 | not_used | error_free | rtcm3, 1071, 0));
    input.take(position_of(7), power_on);
    EXPECT_EQ(input.take(observations_of(8), power_on).cor,
              frame(plain | known | type | 8u << 9 | not_used | error_free | rtcm3, 1077, 0));
    EXPECT_EQ(input.take(encode_rtcm3(Bytes{0xFE, 0x80, 0x01}), power_on).cor,
              frame(plain | known | subtype | type | none | used | error_free | rtcm3, 4072, 1));
    EXPECT_EQ(input.take(encode_rtcm3({}), power_on).cor, frame(plain | none | not_used | error_free | rtcm3, 0, 0))
        << "a frame without a kind";
    EXPECT_EQ(CorrectionInput::answer_to_damaged().cor, frame(none | not_used | erroneous | rtcm3, 0, 0));
}

TEST(CorrectionInput, TellsOfADamagedFrame) {
    EXPECT_EQ(CorrectionInput::answer_to_damaged().rtcm,
              encode_frame({0x02, 0x32}, Bytes{2, 1, 0, 0, 0xFF, 0xFF, 0, 0}));
}

TEST(CorrectionInput, NeedsObservationsAndPositionOfOneStation) {
    CorrectionInput input(rtk_ability());
    EXPECT_EQ(state_at(input, 0), CorrectionState::none);
    EXPECT_FALSE(input.status(power_on, CorrectionLimits{}).age);
    input.take(observations_of(7), second(0));
    EXPECT_EQ(state_at(input, 1), CorrectionState::none);
    input.take(position_of(8), second(1));
    input.take(observations_of(7), second(1));
    EXPECT_EQ(state_at(input, 2), CorrectionState::none);
    input.take(position_of(7), second(2));
    EXPECT_EQ(state_at(input, 2), CorrectionState::differential);
    EXPECT_EQ(input.status(second(2), CorrectionLimits{}).station, 7);
    EXPECT_EQ(input.status(second(2), CorrectionLimits{}).age, Seconds(1));
}

TEST(CorrectionInput, GoesFromDifferentialToFloatToFixed) {
    CorrectionInput input(rtk_ability());
    hear(input, 0, 30);
    EXPECT_EQ(state_at(input, 1), CorrectionState::differential);
    EXPECT_EQ(state_at(input, 4.9), CorrectionState::differential);
    EXPECT_EQ(state_at(input, 5), CorrectionState::rtk_float);
    EXPECT_EQ(state_at(input, 14.9), CorrectionState::rtk_float);
    EXPECT_EQ(state_at(input, 15), CorrectionState::rtk_fixed);
    input.reset();
    EXPECT_EQ(state_at(input, 31), CorrectionState::none);
    hear(input, 31, 60);
    EXPECT_EQ(state_at(input, 60), CorrectionState::rtk_fixed);
}

TEST(CorrectionInput, WithoutRtkItStaysDifferential) {
    CorrectionInput input;
    hear(input, 0, 60);
    EXPECT_EQ(state_at(input, 60), CorrectionState::differential);
}

TEST(CorrectionInput, ModeTwoLimitsToFloat) {
    CorrectionInput input(rtk_ability());
    hear(input, 0, 60);
    EXPECT_EQ(state_at(input, 60, {Seconds(60), true}), CorrectionState::rtk_float);
}

TEST(CorrectionInput, ComesBackStepByStepWithAge) {
    CorrectionInput input(rtk_ability());
    hear(input, 0, 30);
    EXPECT_EQ(state_at(input, 45), CorrectionState::rtk_fixed);
    EXPECT_EQ(state_at(input, 45.1), CorrectionState::rtk_float);
    EXPECT_EQ(state_at(input, 90), CorrectionState::rtk_float);
    EXPECT_EQ(state_at(input, 90.1), CorrectionState::none);
    EXPECT_EQ(state_at(input, 50.1, {Seconds(20), false}), CorrectionState::none);
    EXPECT_EQ(input.status(second(90.5), CorrectionLimits{}).age, Seconds(60.5));
}

TEST(CorrectionInput, BeginsAnewAfterASilence) {
    CorrectionInput input(rtk_ability());
    hear(input, 0, 30);
    hear(input, 50, 80);
    EXPECT_EQ(state_at(input, 50), CorrectionState::differential);
    EXPECT_EQ(state_at(input, 55), CorrectionState::rtk_float);
    EXPECT_EQ(state_at(input, 64.9), CorrectionState::rtk_float);
    EXPECT_EQ(state_at(input, 65), CorrectionState::rtk_fixed);
}

TEST(CorrectionInput, AShortSilenceCostsNothing) {
    CorrectionInput input(rtk_ability());
    hear(input, 0, 30);
    hear(input, 40, 41);
    EXPECT_EQ(state_at(input, 41), CorrectionState::rtk_fixed);
}

TEST(CorrectionInput, FollowsOneStation) {
    CorrectionInput input(rtk_ability());
    hear(input, 0, 20, 7);
    // Another one beside it is not used …
    EXPECT_EQ(input.take(observations_of(8), second(21)).rtcm[7], 2);
    EXPECT_EQ(input.status(second(21), CorrectionLimits{}).station, 7);
    EXPECT_EQ(state_at(input, 21), CorrectionState::rtk_fixed);
    // … but takes its place when it is silent.
    hear(input, 31, 40, 8);
    EXPECT_EQ(input.status(second(31), CorrectionLimits{}).station, 8);
    EXPECT_EQ(state_at(input, 32), CorrectionState::differential);
}

// What a receiver that measures gets: two systems at one instant, from the message on that says that it is the last.
TEST(CorrectionInput, PutsTheStationTogether) {
    CorrectionInput input(rtk_ability());
    const auto told = [](int number, std::uint32_t epoch, bool more, double range_m) {
        Rtcm3MsmCell cell;
        cell.satellite = 5;
        cell.range_m = range_m;
        cell.phase_range_m = range_m + 0.25;
        cell.wavelength_m = 0.19;
        cell.lock_s = 12;
        cell.satellite_info = 9;  // of GLONASS channel 2
        return encode(Rtcm3MsmObservations{number, 7, epoch, more, {cell}});
    };
    const CorrectionLimits limits{Seconds(20), false};
    input.take(position_of(7), second(0));
    // 1001 s of the week of GPS; of GLONASS the same instant in Moscow, with 18 leap seconds.
    const std::uint32_t moscow = (1001 + 3 * 3600 - 18) * 1000;
    input.take(told(1077, 1'001'000, true, 2.1e7), second(1.2));
    EXPECT_FALSE(input.usable(second(1.2), limits).reference) << "more is to come";
    input.take(told(1087, moscow, false, 2.2e7), second(1.3));
    const Corrections corrections = input.usable(second(1.3), limits);
    ASSERT_TRUE(corrections.reference);
    EXPECT_EQ(corrections.at_most, CorrectionState::rtk_fixed);
    EXPECT_EQ(corrections.differential_timeout, Seconds(20));
    EXPECT_EQ(corrections.float_timeout, Seconds(20));
    EXPECT_EQ(corrections.fixed_timeout, Seconds(15));
    const ReferenceStation& station = *corrections.reference;
    EXPECT_EQ(station.id, 7);
    EXPECT_NEAR(station.position->vector().y(), 2e-4, 1e-9);
    EXPECT_FALSE(station.glonass_biases_known);
    EXPECT_EQ(station.epoch.time, second(1));
    ASSERT_EQ(station.epoch.signals.size(), 2u);
    const Observation &gps = station.epoch.signals[0], &glonass = station.epoch.signals[1];
    EXPECT_EQ(to_string(gps.satellite) + to_string(glonass.satellite), "G05R05");
    EXPECT_NEAR(gps.pseudorange->value(), 2.1e7, 1e-3);
    EXPECT_NEAR(*gps.carrier_phase * speed_of_light / gps.carrier.value(), 2.1e7 + 0.25, 1e-3);
    EXPECT_EQ(glonass.carrier, carrier_frequency(Signal::g1, 2));
    EXPECT_GT(gps.lock_time, Seconds(6));
    EXPECT_EQ(input.status(second(3), limits).age, Seconds(2)) << "of the data, not of the message";

    input.take(encode(Rtcm3GlonassBiases{7, true, {}}), second(1.4));
    input.take(told(1077, 1'002'000, false, 2.1e7), second(2.2));
    EXPECT_TRUE(input.usable(second(2.2), limits).reference->glonass_biases_known);
    EXPECT_EQ(input.usable(second(2.2), {Seconds(20), true}).at_most, CorrectionState::rtk_float);
}

}  // namespace
}  // namespace skyloop::firmware
