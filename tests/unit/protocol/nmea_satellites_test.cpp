#include "receiver/protocol/nmea_satellites.hpp"

#include <gtest/gtest.h>

#include <array>

namespace skyloop {
namespace {

using enum Constellation;
using enum NmeaVersion;
constexpr auto strict = NmeaNumbering::strict;
constexpr auto extended = NmeaNumbering::extended;

struct NumberCase {
    SatelliteId satellite;
    NmeaVersion version;
    NmeaNumbering numbering;
    std::optional<int> number;
};

// RECEIVER.md 5.6, first table.
TEST(NmeaSatelliteNumber, FollowsTheTable) {
    const NumberCase cases[] = {
        {{gps, 1}, v4_0, strict, 1},        {{gps, 32}, v4_11, strict, 32},      {{gps, 33}, v4_11, extended, {}},
        {{gps, 0}, v4_11, strict, {}},      {{sbas, 20}, v4_0, strict, 33},      {{sbas, 38}, v4_10, strict, 51},
        {{sbas, 51}, v4_0, strict, 64},     {{sbas, 52}, v4_10, strict, {}},     {{sbas, 58}, v4_0, extended, 158},
        {{galileo, 5}, v4_0, strict, {}},   {{galileo, 5}, v4_0, extended, 305}, {{galileo, 36}, v4_10, strict, 36},
        {{galileo, 37}, v4_10, strict, {}}, {{beidou, 1}, v2_3, strict, {}},     {{beidou, 37}, v4_0, extended, 437},
        {{beidou, 63}, v4_11, strict, 63},  {{qzss, 3}, v4_0, strict, {}},       {{qzss, 3}, v4_0, extended, 195},
        {{qzss, 3}, v4_10, strict, {}},     {{qzss, 3}, v4_10, extended, 195},   {{qzss, 10}, v4_11, strict, 10},
        {{glonass, 1}, v4_0, strict, 65},   {{glonass, 24}, v4_11, strict, 88},  {{glonass, 33}, v4_11, strict, {}},
        {{navic, 2}, v4_11, strict, 2},     {{navic, 2}, v4_0, extended, {}},
    };
    for (const NumberCase& c : cases)
        EXPECT_EQ(nmea_satellite_number(c.satellite, c.version, c.numbering), c.number)
            << to_string(c.satellite) << " version " << static_cast<int>(c.version);
}

// RECEIVER.md 5.6, signal ids.
TEST(NmeaSignalId, FollowsTheTable) {
    struct SignalCase {
        Constellation constellation;
        Signal signal;
        NmeaVersion version;
        int id;
    };
    const SignalCase cases[] = {
        {gps, Signal::l1, v4_10, 1},      {gps, Signal::l2, v4_10, 6},     {gps, Signal::l5, v4_11, 8},
        {sbas, Signal::l1, v4_10, 1},     {galileo, Signal::l1, v4_10, 7}, {galileo, Signal::l5, v4_11, 1},
        {galileo, Signal::e5b, v4_10, 2}, {beidou, Signal::b1i, v4_10, 1}, {beidou, Signal::e5b, v4_10, 3},
        {beidou, Signal::e5b, v4_11, 11}, {beidou, Signal::l1, v4_11, 3},  {beidou, Signal::l5, v4_11, 5},
        {beidou, Signal::b3i, v4_11, 8},  {glonass, Signal::g1, v4_10, 1}, {glonass, Signal::g2, v4_10, 3},
        {qzss, Signal::l1, v4_11, 1},     {qzss, Signal::l2, v4_11, 6},    {qzss, Signal::l5, v4_11, 8},
        {navic, Signal::l5, v4_11, 1},    {galileo, Signal::e6, v4_11, 0},
    };
    for (const SignalCase& c : cases)
        EXPECT_EQ(nmea_signal_id(c.constellation, c.signal, c.version), c.id)
            << constellation_name(c.constellation) << ' ' << static_cast<int>(c.signal);
}

TEST(NmeaSystem, ListsSbasWithGpsAndQzssAloneOnlyIn4_11) {
    EXPECT_EQ(nmea_system(sbas, v4_11), nmea_system(gps, v4_11));
    EXPECT_EQ(nmea_system(qzss, v4_10), nmea_system(gps, v4_10));
    EXPECT_EQ(nmea_system(qzss, v4_11), (NmeaSystem{"GQ", 5, 1}));
    EXPECT_EQ(nmea_system(glonass, v4_0), (NmeaSystem{"GL", 2, 1}));
    EXPECT_EQ(nmea_system(galileo, v4_10), (NmeaSystem{"GA", 3, 7}));
    EXPECT_EQ(nmea_system(beidou, v4_10), (NmeaSystem{"GB", 4, 1}));
}

TEST(SatelliteFromNmea, InvertsTheNumbers) {
    int checked = 0;
    for (const Constellation c : {gps, sbas, galileo, beidou, qzss, glonass, navic})
        for (int n = 1; n <= 63; ++n)
            for (const NmeaVersion version : {v2_3, v4_0, v4_10, v4_11})
                for (const NmeaNumbering numbering : {strict, extended}) {
                    const SatelliteId satellite{c, n};
                    const auto number = nmea_satellite_number(satellite, version, numbering);
                    if (!number) continue;
                    const NmeaSystem system = nmea_system(c, version);
                    EXPECT_EQ(satellite_from_nmea(*number, system.talker), satellite) << *number << system.talker;
                    EXPECT_EQ(satellite_from_nmea(*number, "GN", system.system_id), satellite) << *number;
                    ++checked;
                }
    EXPECT_GT(checked, 800);
}

TEST(SatelliteFromNmea, KnowsVendorTalkersAndRefusesOtherNumbers) {
    EXPECT_EQ(satellite_from_nmea(5, "BD"), (SatelliteId{beidou, 5}));
    EXPECT_EQ(satellite_from_nmea(219, "GP"), (SatelliteId{beidou, 19}));
    EXPECT_EQ(satellite_from_nmea(0, "GP"), std::nullopt);
    EXPECT_EQ(satellite_from_nmea(120, "GN"), std::nullopt);
    EXPECT_EQ(satellite_from_nmea(-3, "GL"), std::nullopt);
}

// RECEIVER.md 5.6, second column.
TEST(SingleByteNumber, FollowsTheTable) {
    EXPECT_EQ(single_byte_number({gps, 32}), 32);
    EXPECT_EQ(single_byte_number({sbas, 20}), 120);
    EXPECT_EQ(single_byte_number({galileo, 36}), 246);
    EXPECT_EQ(single_byte_number({beidou, 1}), 159);
    EXPECT_EQ(single_byte_number({beidou, 6}), 33);
    EXPECT_EQ(single_byte_number({beidou, 37}), 64);
    EXPECT_EQ(single_byte_number({beidou, 38}), std::nullopt);
    EXPECT_EQ(single_byte_number({qzss, 10}), 202);
    EXPECT_EQ(single_byte_number({glonass, 24}), 88);
    EXPECT_EQ(single_byte_number({navic, 1}), std::nullopt);
}

TEST(SingleByteNumber, IsInverted) {
    int satellites = 0;
    for (int number = 0; number < 256; ++number)
        if (const auto satellite = single_byte_satellite(number)) {
            EXPECT_EQ(single_byte_number(*satellite), number);
            ++satellites;
        }
    EXPECT_EQ(satellites, 32 + 39 + 36 + 37 + 10 + 32);
}

}  // namespace
}  // namespace skyloop
