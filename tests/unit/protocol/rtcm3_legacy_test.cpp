#include "receiver/protocol/rtcm3_legacy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/core/bytes.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

Bytes legacy_from_hex(std::string_view hex) {
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    return bytes;
}

// The first observations in gpsd's rtcm3.bndm.log, of a Leica GRX1200+GNSS in Oregon. What they say is what RTKLIB's
// convbin 2.4.3 makes of them.
const Bytes real_1004 = legacy_from_hex(
    "d300953ec1167d8aac029144cec517ffffe011343fa33f15ec0681a17ea420004600996dfd15f89a00284f60cee680001004"
    "db6fe9bfc8380140c05cfb73ffe6c026577f897ed7280ab4c26469a0014201132bf8bfedb7006538af16ddfff6a008f8dfcc"
    "7f7fd402f016b9b8afffb3004ea7ff2bfde310134f2345a1bffdf0026d47f937ee9280a0182fa08ffff5201427bfd6bf95b4"
    "04e0abe70c");
const Bytes real_1012 = legacy_from_hex(
    "d3009a3f4116242106048a84ae3db37fff68028837fbfff534012060c63abba00025008729feb3fca2405f94169a4efbffec"
    "8026982000800000000106dd0a3afff22009e89001fffe8c0482a5a481c4c0026c021c87f5afe656017ab09236871000aa00"
    "8729ff07fd95c05f086ddad7a3ffe60028867f31fdec1010a58e68c33d00069008725fe5bfbe0c05f0665fe3f8fffd0c0269"
    "f7f36fdfee011e0c0445");

constexpr double l1_wavelength = speed_of_light / 1575.42e6, l2_wavelength = speed_of_light / 1227.60e6;

Rtcm3LegacyObservables legacy_of(ByteSpan frame) {
    const auto message = parse_rtcm3(frame);
    EXPECT_TRUE(message);
    const auto observables = decode_legacy(*message);
    EXPECT_TRUE(observables);
    return observables.value_or(Rtcm3LegacyObservables());
}

TEST(Rtcm3Legacy, ReadsRealObservablesOfGps) {
    const Rtcm3LegacyObservables m = legacy_of(real_1004);
    EXPECT_EQ(m.number, 1004);
    EXPECT_EQ(m.station, 278);
    EXPECT_EQ(m.epoch, (6 * 86400 + 2 * 3600 + 16 * 60) * 1000u);
    EXPECT_TRUE(m.more);
    ASSERT_EQ(m.satellites.size(), 9u);
    const Rtcm3LegacySatellite& g17 = m.satellites[0];
    EXPECT_EQ(g17.satellite, 17);
    EXPECT_NEAR(*g17.l1.range_m, 20521395.844, 6e-4);
    EXPECT_NEAR(*g17.l1.phase_range_m / l1_wavelength, 107840663.022, 6e-4);
    EXPECT_EQ(g17.l1.code, 0);
    EXPECT_EQ(g17.l1.cno_dbhz, 52);
    ASSERT_TRUE(g17.l2);
    EXPECT_NEAR(*g17.l2->range_m, 20521388.404, 6e-4);
    EXPECT_NEAR(*g17.l2->phase_range_m / l2_wavelength, 84031654.802, 6e-4);
    EXPECT_EQ(g17.l2->code, 3) << "correlated, without a key; RTKLIB: 2W";
    EXPECT_EQ(g17.l2->cno_dbhz, 52);
    const Rtcm3LegacySatellite& g06 = m.satellites[8];
    EXPECT_EQ(g06.satellite, 6);
    EXPECT_NEAR(*g06.l1.range_m, 24014609.580, 6e-4);
    EXPECT_NEAR(*g06.l2->phase_range_m / l2_wavelength, 98335797.843, 6e-4);
    EXPECT_EQ(g06.l2->cno_dbhz, 39);
}

TEST(Rtcm3Legacy, ReadsRealObservablesOfGlonass) {
    const Rtcm3LegacyObservables m = legacy_of(real_1012);
    EXPECT_EQ(m.number, 1012);
    EXPECT_EQ(m.epoch, (2 * 3600 + 16 * 60 - 18 + 3 * 3600) * 1000u) << "UTC + 3 h";
    EXPECT_FALSE(m.more);
    ASSERT_EQ(m.satellites.size(), 9u);
    const Rtcm3LegacySatellite& r20 = m.satellites[0];
    EXPECT_EQ(r20.satellite, 20);
    EXPECT_EQ(r20.frequency_channel, 2);
    EXPECT_NEAR(*r20.l1.range_m, 24225832.740, 6e-4);
    EXPECT_NEAR(*r20.l1.phase_range_m / (speed_of_light / (1602e6 + 2 * 562.5e3)), 129546414.676, 6e-4);
    EXPECT_NEAR(*r20.l2->range_m, 24225831.440, 6e-4);
    EXPECT_NEAR(*r20.l2->phase_range_m / (speed_of_light / (1246e6 + 2 * 437.5e3)), 100758316.857, 6e-4);
    const Rtcm3LegacySatellite& r12 = m.satellites[1];
    EXPECT_EQ(r12.frequency_channel, -1);
    const Rtcm3LegacySatellite& r10 = m.satellites[2];
    EXPECT_EQ(r10.satellite, 10);
    EXPECT_FALSE(r10.l2) << "it tracks this one on L1 alone";
}

TEST(Rtcm3Legacy, WritesRealObservablesAsTheyCame) {
    EXPECT_EQ(encode(legacy_of(real_1004)), real_1004);
    EXPECT_EQ(encode(legacy_of(real_1012)), real_1012);
}

Rtcm3LegacySatellite legacy_satellite(double range) {
    Rtcm3LegacySatellite s;
    s.satellite = 7;
    s.frequency_channel = -7;
    s.l1 = {1, range, range + 3.25, l1_wavelength, 400, 44.3};
    s.l2 = Rtcm3LegacyCarrier{0, range + 4.5, range - 2.5, l2_wavelength, 30, 38.8};
    return s;
}

TEST(Rtcm3Legacy, EveryMessageTellsWhatItHasFieldsFor) {
    constexpr double range = 22145739.3983;
    for (const int number : {1001, 1002, 1003, 1004, 1009, 1010, 1011, 1012}) {
        const bool whole = number % 2 == 0, both = number == 1003 || number == 1004 || number >= 1011;
        EXPECT_TRUE(is_legacy_observables(number));
        EXPECT_EQ(is_extended_legacy(number), whole) << number;
        Rtcm3LegacyObservables m{number, 4095, 86'399'123, true, {legacy_satellite(range)}, true, 5};
        const Bytes frame = encode(m);
        const Rtcm3LegacyObservables read = legacy_of(frame);
        EXPECT_EQ(read.number, number);
        EXPECT_EQ(read.epoch, m.epoch);
        EXPECT_TRUE(read.divergence_free);
        EXPECT_EQ(read.smoothing_interval, 5);
        ASSERT_EQ(read.satellites.size(), 1u) << number;
        const Rtcm3LegacySatellite& s = read.satellites[0];
        const double modulus = legacy_range_modulus_m(number);
        EXPECT_NEAR(*s.l1.range_m, whole ? range : std::fmod(range, modulus), 0.0101) << number;
        EXPECT_NEAR(*s.l1.phase_range_m, (whole ? range : std::fmod(range, modulus)) + 3.25, 3e-4) << number;
        EXPECT_EQ(s.l1.code, 1);
        EXPECT_EQ(s.l1.lock_s, 392) << "table 3.4-2: steps of 16 s";
        EXPECT_EQ(s.l1.cno_dbhz, whole ? 44.25 : 0);
        EXPECT_EQ(s.frequency_channel, number >= 1009 ? -7 : 0);
        ASSERT_EQ(s.l2.has_value(), both) << number;
        if (!both) continue;
        EXPECT_NEAR(*s.l2->range_m - *s.l1.range_m, 4.5, 0.0201);
        EXPECT_NEAR(*s.l2->phase_range_m - *s.l1.phase_range_m, -5.75, 6e-4);
        EXPECT_EQ(s.l2->lock_s, 30);
    }
}

TEST(Rtcm3Legacy, LockTimesAreTheLeastOfTheirIndicator) {
    // Table 3.4-2 at both ends of its rows.
    constexpr std::array<std::array<double, 2>, 11> times{{{0.9, 0},
                                                           {23, 23},
                                                           {25.9, 24},
                                                           {71, 70},
                                                           {72, 72},
                                                           {167, 164},
                                                           {359, 352},
                                                           {743, 728},
                                                           {744, 744},
                                                           {936.5, 936},
                                                           {5000, 937}}};
    for (const auto& [put, read] : times) {
        Rtcm3LegacyObservables m{1004, 0, 0, false, {legacy_satellite(2.1e7)}, false, 0};
        m.satellites[0].l1.lock_s = put;
        EXPECT_EQ(legacy_of(encode(m)).satellites.at(0).l1.lock_s, read) << put;
    }
}

TEST(Rtcm3Legacy, FarPhasesComeNearerByCyclesThatNobodyKnows) {
    Rtcm3LegacyObservables m{1004, 0, 0, false, {legacy_satellite(2.1e7)}, false, 0};
    m.satellites[0].l1.phase_range_m = 2.1e7 + 123456.789;
    const double read = *legacy_of(encode(m)).satellites.at(0).l1.phase_range_m;
    EXPECT_LT(std::abs(read - 2.1e7), 263);
    const double rollovers = (2.1e7 + 123456.789 - read) / (1500 * l1_wavelength);
    EXPECT_NEAR(rollovers, std::round(rollovers), 2e-6);
}

TEST(Rtcm3Legacy, RangesWithoutAPhaseServeL2Alone) {
    Rtcm3LegacyObservables m{1004, 0, 0, false, {legacy_satellite(2.1e7)}, false, 0};
    m.satellites[0].l1.phase_range_m.reset();
    m.satellites[0].l2->phase_range_m.reset();
    const Rtcm3LegacySatellite s = legacy_of(encode(m)).satellites.at(0);
    EXPECT_FALSE(s.l1.range_m) << "DF012 says so";
    EXPECT_FALSE(s.l1.phase_range_m);
    EXPECT_NEAR(*s.l2->range_m, 2.1e7 + 4.5, 0.0201);
    EXPECT_FALSE(s.l2->phase_range_m);
}

TEST(Rtcm3Legacy, WhatTheFieldsHaveNoRoomForIsLeftOut) {
    Rtcm3LegacyObservables m{1012, 0, 0, false, {legacy_satellite(2.1e7), legacy_satellite(7.7e7)}, false, 0};
    m.satellites[0].l2 = Rtcm3LegacyCarrier{3, 2.1e7 + 170, {}, l2_wavelength, 30, 40};
    const Bytes frame = encode(m);
    const Rtcm3LegacyObservables read = legacy_of(frame);
    ASSERT_EQ(read.satellites.size(), 1u);
    EXPECT_FALSE(read.satellites[0].l2);
    EXPECT_EQ(encode(read), frame);
}

TEST(Rtcm3Legacy, RangesJustBelowAWholeMillisecondBeginTheNext) {
    const double range = 70 * speed_of_light * 1e-3 - 1e-3;
    const Rtcm3LegacyObservables m{1002, 0, 0, false, {legacy_satellite(range)}, false, 0};
    EXPECT_NEAR(*legacy_of(encode(m)).satellites.at(0).l1.range_m, range, 0.0101);
}

TEST(Rtcm3Legacy, RefusesWhatIsNone) {
    EXPECT_TRUE(encode(Rtcm3LegacyObservables{1004, 0, 0, false, {}, false, 0}).empty());
    EXPECT_TRUE(encode(Rtcm3LegacyObservables{1005, 0, 0, false, {legacy_satellite(2e7)}, false, 0}).empty());
    Rtcm3LegacySatellite nothing;
    EXPECT_TRUE(encode(Rtcm3LegacyObservables{1004, 0, 0, false, {nothing}, false, 0}).empty());
    const auto message = parse_rtcm3(real_1004);
    for (std::size_t size = 0; size < message->payload.size() - 1; ++size)
        EXPECT_FALSE(decode_legacy({1004, {}, 0, message->payload.first(size)})) << size;
    EXPECT_FALSE(decode_legacy({1005, {}, 0, message->payload}));
    // Five bits count the satellites.
    Rtcm3LegacyObservables many{1004, 0, 0, false, std::vector(40, legacy_satellite(2e7)), false, 0};
    EXPECT_EQ(legacy_of(encode(many)).satellites.size(), 31u);
}

}  // namespace
}  // namespace skyloop
