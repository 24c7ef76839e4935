// BeiDou's almanacs as D1 and D2 tell them, taken apart by table 5-14 and figures 5-11 and 5-12 of the B1I ICD 3.0.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "support/page_bits.hpp"
#include "world/gnss/broadcast_beidou.hpp"
#include "world/gnss/nominal_sky.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop {
namespace {

using test::PageBits;
using namespace std::chrono_literals;

// The 224 bits of information: 26 of the first word, 22 of each other.
PageBits information_of(const D1Words& words) {
    std::vector<bool> bits;
    for (std::size_t i = 0; i < words.size(); ++i)
        for (int bit = 29; bit >= (i == 0 ? 4 : 8); --bit)
            bits.push_back((words[i] >> bit & 1) != 0);
    PageBits packed;
    packed.words.resize(7);
    for (std::size_t i = 0; i < bits.size(); ++i)
        if (bits[i]) packed.words[i / 32] |= 1u << (31 - i % 32);
    return packed;
}

struct HeardAlmanac {
    KeplerEphemeris orbit;
    std::uint64_t extension = 0;  // AmEpID or AmID
};

// @param week that of BDT in which it was heard
HeardAlmanac almanac_of(const PageBits& page, std::int64_t week, bool stationary) {
    constexpr double half_circle = std::numbers::pi;
    HeardAlmanac heard{{}, page.field(222, 2)};
    KeplerEphemeris& a = heard.orbit;
    a.satellite = {Constellation::beidou, 30};  // whose orbit is reckoned without a tilt
    a.sqrt_a = page.positive(46, 24, -11);
    a.af1 = page.scaled(70, 11, -38);
    a.af0 = page.scaled(81, 11, -20);
    a.omega0 = half_circle * page.scaled(92, 24, -23);
    a.e = page.positive(116, 17, -21);
    a.i0 = half_circle * ((stationary ? 0 : 0.3) + page.scaled(133, 16, -19));
    const double toa = page.positive(149, 8, 12);
    a.omega_dot = half_circle * page.scaled(157, 17, -38);
    a.omega = half_circle * page.scaled(174, 24, -23);
    a.m0 = half_circle * page.scaled(198, 24, -23);
    a.toe = a.toc = to_gps_time(week + 1356, toa + 14);
    return heard;
}

struct Heard {
    std::map<int, HeardAlmanac> almanacs;           // by satellite
    std::map<std::pair<int, int>, PageBits> pages;  // by subframe and page
};

const NominalSky sky({Constellation::beidou});
const LeapSeconds leap_seconds = LeapSeconds::announced();
// The first frame of 36 minutes of BDT.
const GpsTime first_frame = to_gps_time(2300, 14 + 36 * 60 * 100.0);

bool is_geo(int number) { return is_beidou_geo({Constellation::beidou, number}); }

void keep(Heard& heard, const PageBits& page, int number, GpsTime at) {
    constexpr int last = 63;  // the third extension has six empty pages behind it
    if (number <= last) heard.almanacs[number] = almanac_of(page, bdt_week_and_tow(at).week, is_geo(number));
}

Heard hear_d1() {
    Heard heard;
    for (int frame = 0; frame < 72; ++frame)
        for (const int subframe : {4, 5}) {
            const GpsTime start = first_frame + frame * 30s + (subframe - 1) * 6s;
            const PageBits page = information_of(d1_system_subframe({&sky, leap_seconds}, subframe, start + 6s));
            EXPECT_EQ(page.field(0, 11), 0b11100010010u);
            EXPECT_EQ(page.field(15, 3), static_cast<unsigned>(subframe));
            EXPECT_EQ(static_cast<double>(page.field(18, 20)), bdt_week_and_tow(start).tow_seconds());
            const int number = static_cast<int>(page.field(39, 7));
            EXPECT_EQ(number, frame % 24 + 1);
            if (subframe == 4) keep(heard, page, number, start);
            if (subframe == 5 && number <= 6) keep(heard, page, 24 + number, start);
            if (subframe == 5 && number >= 11 && number <= 23)
                keep(heard, page, std::array{31, 44, 57}[page.field(222, 2) - 1] + number - 11, start);
            heard.pages[{subframe, number}] = page;
        }
    return heard;
}

void expect_orbits(const Heard& heard) {
    int stationary = 0, moving = 0;
    for (const SatelliteId id : sky.satellites()) {
        ASSERT_TRUE(heard.almanacs.contains(id.number)) << id.number;
        const HeardAlmanac& almanac = heard.almanacs.at(id.number);
        ++(is_geo(id.number) ? stationary : moving);
        for (const auto later : {-1h, 0h, 2h}) {
            const GpsTime t = first_frame + later;
            const SatelliteState is = satellite_state(almanac.orbit, t),
                                 was = satellite_state(*sky.ephemeris(id, t), t);
            // δi has steps of 167 m; harmonic terms are left out.
            EXPECT_LT((is.position - was.position).length().value(), 8000) << id.number << " " << later.count();
        }
    }
    EXPECT_GE(stationary, 7);
    EXPECT_GE(moving, 36);
}

TEST(BeidouAlmanac, D1TellsTheWholeSkyInThreeTimesTwelveMinutes) {
    const Heard heard = hear_d1();
    EXPECT_EQ(heard.almanacs.size(), 63u);
    expect_orbits(heard);
    EXPECT_EQ(heard.almanacs.at(1).extension, 3u) << "there are expanded ones";
    EXPECT_EQ(heard.almanacs.at(25).extension, 3u);
    EXPECT_EQ(heard.almanacs.at(63).orbit.sqrt_a, 0) << "nobody";
}

TEST(BeidouAlmanac, D2TellsItInThreeTimesSixMinutes) {
    Heard heard;
    int told = 0;
    for (int frame = 0; frame < 360; ++frame) {
        const GpsTime start = first_frame + frame * 3s;
        for (const auto other : {600ms, 1200ms, 1800ms, 2400ms})
            ASSERT_FALSE(d2_system_subframe_ending({&sky, leap_seconds}, start + other));
        const auto words = d2_system_subframe_ending({&sky, leap_seconds}, start + 3s);
        if (!words) continue;
        ++told;
        const PageBits page = information_of(*words);
        EXPECT_EQ(page.field(15, 3), 5u);
        EXPECT_EQ(static_cast<double>(page.field(18, 20)), bdt_week_and_tow(start).tow_seconds());
        const int number = static_cast<int>(page.field(39, 7));
        EXPECT_EQ(number, frame % 120 + 1);
        if (number >= 37 && number <= 60) keep(heard, page, number - 36, start);
        if (number >= 95 && number <= 100) keep(heard, page, number - 70, start);
        if (number >= 103 && number <= 115)
            keep(heard, page, std::array{31, 44, 57}[page.field(222, 2) - 1] + number - 103, start);
    }
    EXPECT_EQ(told, 3 * (2 + 24 + 6 + 2 + 13 + 1));
    EXPECT_EQ(heard.almanacs.size(), 63u);
    expect_orbits(heard);
}

TEST(BeidouAlmanac, HealthWeekAndUtc) {
    const Heard heard = hear_d1();
    const PageBits first = heard.pages.at({5, 7}), rest = heard.pages.at({5, 8}), utc = heard.pages.at({5, 10}),
                   last = heard.pages.at({5, 24});
    for (int number = 1; number <= 30; ++number) {
        const bool there = sky.ephemeris({Constellation::beidou, number}, first_frame).has_value();
        const std::uint64_t told = number <= 19 ? first.field(46 + 9 * static_cast<std::size_t>(number - 1), 9)
                                                : rest.field(46 + 9 * static_cast<std::size_t>(number - 20), 9);
        EXPECT_EQ(told, there ? 0u : 511u) << number;
    }
    EXPECT_EQ(rest.field(145, 8), static_cast<unsigned>(bdt_week_and_tow(first_frame).week % 256));
    EXPECT_EQ(static_cast<double>(rest.field(153, 8)) * 4096, 217088) << "25 minutes later";
    EXPECT_EQ(last.field(163, 2), 3u);
    // The seventeenth leap second since 1980 … the eighteenth: four of BDT since 2017-01-01, which began in BDT week
    // 573.
    EXPECT_EQ(utc.field(46, 8), 4u);
    EXPECT_EQ(utc.field(54, 8), 4u);
    EXPECT_EQ(utc.field(62, 8), 573u % 256);
    EXPECT_EQ(utc.field(126, 8), 6u) << "Saturday";
}

}  // namespace
}  // namespace skyloop
