// Orbits that messages besides the legacy ones tell, taken apart by the tables of the interface documents.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "support/four_systems.hpp"
#include "support/page_bits.hpp"
#include "world/gnss/broadcast_beidou.hpp"
#include "world/gnss/broadcast_cnav.hpp"
#include "world/gnss/broadcast_galileo.hpp"
#include "world/gnss/broadcast_glonass.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop {
namespace {

using test::PageBits;

constexpr double semicircle = std::numbers::pi;

KeplerEphemeris awkward_record(SatelliteId satellite, GpsTime toe) {
    KeplerEphemeris r;
    r.satellite = satellite;
    r.toe = r.toc = toe;
    r.sqrt_a = 6493.123456;
    r.e = 0.000712345;
    r.i0 = 0.09876543;
    r.idot = -1.234e-10;
    r.omega0 = -2.7654321;
    r.omega = 3.0123456;
    r.omega_dot = -7.654e-9;
    r.m0 = -1.3456789;
    r.delta_n = 4.321e-9;
    r.cuc = 1.234e-6;
    r.cus = -5.432e-6;
    r.crc = 123.4;
    r.crs = -56.7;
    r.cic = -3.21e-8;
    r.cis = 4.56e-8;
    r.af0 = -3.456e-4;
    r.af1 = -2.345e-11;
    r.af2 = 0;
    r.tgd = 5.4e-9;
    r.tgd2 = -3.2e-9;
    r.iode = 17;
    r.iodc = 21;
    r.accuracy_m = 2;
    return r;
}

// The field of a D2 page by the bits of its 150 as figure 5-14 numbers them from 0: several pieces, joined.
class D2Page {
public:
    explicit D2Page(const D1Words& words) {
        for (const std::uint32_t word : words)
            for (int bit = 29; bit >= 0; --bit)
                bits_.push_back(word >> bit & 1);
    }
    [[nodiscard]] std::uint64_t field(std::initializer_list<std::pair<std::size_t, std::size_t>> pieces) const {
        std::uint64_t value = 0;
        for (const auto& [at, width] : pieces)
            for (std::size_t i = at; i < at + width; ++i)
                value = value << 1 | bits_[i];
        return value;
    }

private:
    std::vector<std::uint32_t> bits_;
};

double of_complement(std::uint64_t raw, int width) {
    return static_cast<double>(static_cast<std::int64_t>(raw << (64 - width)) >> (64 - width));
}

TEST(BroadcastD2, TenPagesTellTheRecord) {
    // 14 s late: BeiDou's week. The reference times are whole 8 s there.
    const GpsTime begin = to_gps_time(2300, 30 * 700.0 + 14);
    const KeplerEphemeris r = awkward_record({Constellation::beidou, 3}, to_gps_time(2300, 8.0 * 2700 + 14));
    const KlobucharCoefficients k{{std::ldexp(12, -30), std::ldexp(-8, -27), std::ldexp(-1, -24), std::ldexp(2, -24)},
                                  {std::ldexp(44, 11), std::ldexp(-3, 14), std::ldexp(-2, 16), std::ldexp(7, 16)}};
    std::vector<D2Page> p;
    for (int page = 1; page <= d2_page_count; ++page) {
        const GpsTime end = begin + 3 * (page - 1) * std::chrono::seconds(1) + d2_subframe_length;
        ASSERT_EQ(d2_page_ending(end), page);
        EXPECT_FALSE(d2_page_ending(end + d2_subframe_length));
        p.emplace_back(d2_page(r, k, page, end));
        EXPECT_EQ(p.back().field({{0, 11}}), 0b11100010010u);
        EXPECT_EQ(p.back().field({{15, 3}}), 1u);
        EXPECT_EQ(p.back().field({{18, 8}, {30, 12}}), 30u * 700 + 3 * static_cast<unsigned>(page - 1));
        EXPECT_EQ(p.back().field({{42, 4}}), static_cast<unsigned>(page));
    }
    const auto& [p1, p2, p3, p4] = std::tie(p[0], p[1], p[2], p[3]);
    EXPECT_EQ(p1.field({{46, 1}}), 0u);
    EXPECT_EQ(p1.field({{47, 5}}), 21u);
    EXPECT_EQ(p1.field({{60, 4}}), 0u);
    EXPECT_EQ(p1.field({{64, 13}}), 2300u - 1356);
    EXPECT_EQ(p1.field({{77, 5}, {90, 12}}), 2700u);
    EXPECT_NEAR(of_complement(p1.field({{102, 10}}), 10) * 1e-10, r.tgd, 0.5e-10);
    EXPECT_NEAR(of_complement(p1.field({{120, 10}}), 10) * 1e-10, r.tgd2, 0.5e-10);
    EXPECT_EQ(p2.field({{46, 6}, {60, 2}}), 12u);
    EXPECT_EQ(p2.field({{62, 8}}), 0xF8u);
    EXPECT_EQ(p2.field({{78, 4}, {90, 4}}), 2u);
    EXPECT_EQ(p2.field({{94, 8}}), 44u);
    EXPECT_EQ(p2.field({{110, 2}, {120, 6}}), 0xFEu);
    EXPECT_EQ(p2.field({{126, 8}}), 7u);
    EXPECT_NEAR(std::ldexp(of_complement(p3.field({{100, 12}, {120, 12}}), 24), -33), r.af0, std::ldexp(1, -34));
    const std::uint64_t af1 = p3.field({{132, 4}}) << 18 | p4.field({{46, 6}, {60, 12}});
    EXPECT_NEAR(std::ldexp(of_complement(af1, 22), -50), r.af1, std::ldexp(1, -51));
    EXPECT_EQ(p4.field({{91, 5}}), 17u);
    EXPECT_NEAR(semicircle * std::ldexp(of_complement(p4.field({{96, 16}}), 16), -43), r.delta_n, 2e-13);
    const std::uint64_t cuc = p4.field({{120, 14}}) << 4 | p[4].field({{46, 4}});
    EXPECT_NEAR(std::ldexp(of_complement(cuc, 18), -31), r.cuc, std::ldexp(1, -32));
    EXPECT_NEAR(semicircle * std::ldexp(of_complement(p[4].field({{50, 2}, {60, 22}, {90, 8}}), 32), -31), r.m0, 1e-9);
    EXPECT_NEAR(std::ldexp(of_complement(p[4].field({{98, 14}, {120, 4}}), 18), -31), r.cus, std::ldexp(1, -32));
    const std::uint64_t e = p[4].field({{124, 10}}) << 22 | p[5].field({{46, 6}, {60, 16}});
    EXPECT_NEAR(std::ldexp(static_cast<double>(e), -33), r.e, std::ldexp(1, -34));
    EXPECT_NEAR(std::ldexp(static_cast<double>(p[5].field({{76, 6}, {90, 22}, {120, 4}})), -19), r.sqrt_a, 1e-6);
    const std::uint64_t cic = p[5].field({{124, 10}}) << 8 | p[6].field({{46, 6}, {60, 2}});
    EXPECT_NEAR(std::ldexp(of_complement(cic, 18), -31), r.cic, std::ldexp(1, -32));
    EXPECT_NEAR(std::ldexp(of_complement(p[6].field({{62, 18}}), 18), -31), r.cis, std::ldexp(1, -32));
    EXPECT_EQ(p[6].field({{80, 2}, {90, 15}}), 2700u);
    const std::uint64_t i0 = p[6].field({{105, 7}, {120, 14}}) << 11 | p[7].field({{46, 6}, {60, 5}});
    EXPECT_NEAR(semicircle * std::ldexp(of_complement(i0, 32), -31), r.i0, 1e-9);
    EXPECT_NEAR(std::ldexp(of_complement(p[7].field({{65, 17}, {90, 1}}), 18), -6), r.crc, 1.0 / 128);
    EXPECT_NEAR(std::ldexp(of_complement(p[7].field({{91, 18}}), 18), -6), r.crs, 1.0 / 128);
    const std::uint64_t drift = p[7].field({{109, 3}, {120, 16}}) << 5 | p[8].field({{46, 5}});
    EXPECT_NEAR(semicircle * std::ldexp(of_complement(drift, 24), -43), r.omega_dot, 2e-13);
    EXPECT_NEAR(semicircle * std::ldexp(of_complement(p[8].field({{51, 1}, {60, 22}, {90, 9}}), 32), -31), r.omega0,
                1e-9);
    const std::uint64_t omega = p[8].field({{99, 13}, {120, 14}}) << 5 | p[9].field({{46, 5}});
    EXPECT_NEAR(semicircle * std::ldexp(of_complement(omega, 32), -31), r.omega, 1e-9);
    EXPECT_NEAR(semicircle * std::ldexp(of_complement(p[9].field({{51, 1}, {60, 13}}), 14), -43), r.idot, 2e-13);
}

// CRC-24Q as a division, which the message with its checksum leaves without a rest.
std::uint32_t rest_of(const PageBits& bits, std::size_t count) {
    std::uint32_t rest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        rest = rest << 1 | static_cast<std::uint32_t>(bits.field(i, 1));
        if ((rest & 0x1000000) != 0) rest ^= 0x1864CFB;
    }
    return rest;
}

PageBits cnav_bits(const KeplerEphemeris& r, int type, Signal signal, GpsTime end) {
    const BroadcastIonosphere ionosphere{KlobucharCoefficients{{std::ldexp(12, -30)}, {std::ldexp(44, 11)}}};
    const CnavWords words = cnav_message({r, ionosphere, LeapSeconds::announced()}, type, signal, end);
    const PageBits bits{{words.begin(), words.end()}};
    EXPECT_EQ(rest_of(bits, 300), 0u) << type;
    EXPECT_EQ(bits.field(0, 8), 0x8Bu);
    EXPECT_EQ(bits.field(8, 6), static_cast<unsigned>(r.satellite.number));
    EXPECT_EQ(bits.field(14, 6), static_cast<unsigned>(type));
    EXPECT_EQ(bits.field(20, 17) * std::chrono::seconds(6), week_and_tow(end).tow);
    return bits;
}

// Figures 30-1 and 30-2; bits are numbered from 0 here.
TEST(BroadcastCnav, TellsTheOrbitOfTheRecord) {
    KeplerEphemeris r = awkward_record({Constellation::gps, 24}, to_gps_time(2300, 7200.0 * 9));
    r.sqrt_a = 5153.7;
    r.e = 0.0123;
    const GpsTime end = to_gps_time(2300, 7200.0 * 9 + 600);
    const PageBits one = cnav_bits(r, 10, Signal::l5, end), two = cnav_bits(r, 11, Signal::l2, end);
    EXPECT_EQ(one.field(38, 13), 2300u);
    EXPECT_EQ(one.field(51, 3), 0u);
    EXPECT_EQ(one.field(54, 11), 9u * 24);
    EXPECT_EQ(one.field(70, 11), 9u * 24);
    EXPECT_NEAR(26559710 + one.scaled(81, 26, -9), r.sqrt_a * r.sqrt_a, 0.001);
    EXPECT_NEAR(semicircle * one.scaled(132, 17, -44), r.delta_n, 1e-13);
    EXPECT_NEAR(semicircle * one.scaled(172, 33, -32), r.m0, 4e-10);
    EXPECT_NEAR(one.positive(205, 33, -34), r.e, 3e-11);
    EXPECT_NEAR(semicircle * one.scaled(238, 33, -32), r.omega, 4e-10);
    EXPECT_EQ(two.field(38, 11), 9u * 24);
    EXPECT_NEAR(semicircle * two.scaled(49, 33, -32), r.omega0, 4e-10);
    EXPECT_NEAR(semicircle * two.scaled(82, 33, -32), r.i0, 4e-10);
    EXPECT_NEAR(semicircle * (-2.6e-9 + two.scaled(115, 17, -44)), r.omega_dot, 1e-13);
    EXPECT_NEAR(semicircle * two.scaled(132, 15, -44), r.idot, 1e-13);
    EXPECT_NEAR(two.scaled(147, 16, -30), r.cis, 5e-10);
    EXPECT_NEAR(two.scaled(163, 16, -30), r.cic, 5e-10);
    EXPECT_NEAR(two.scaled(179, 24, -8), r.crs, 0.002);
    EXPECT_NEAR(two.scaled(203, 24, -8), r.crc, 0.002);
    EXPECT_NEAR(two.scaled(227, 21, -30), r.cus, 5e-10);
    EXPECT_NEAR(two.scaled(248, 21, -30), r.cuc, 5e-10);
}

// Figures 30-3 and 30-6.
TEST(BroadcastCnav, TellsClockDelaysAndUtc) {
    KeplerEphemeris r = awkward_record({Constellation::gps, 24}, to_gps_time(2300, 7200.0 * 9));
    r.accuracy_m = 0.5;
    const GpsTime end = to_gps_time(2300, 7200.0 * 9 + 600);
    const PageBits delays = cnav_bits(r, 30, Signal::l2, end), utc = cnav_bits(r, 33, Signal::l5, end);
    for (const PageBits* m : {&delays, &utc}) {
        EXPECT_EQ(m->scaled(49, 5, 0), -4);  // up to 0.6 m
        EXPECT_EQ(m->field(60, 11), 9u * 24);
        EXPECT_NEAR(m->scaled(71, 26, -35), r.af0, 2e-11);
        EXPECT_NEAR(m->scaled(97, 20, -48), r.af1, 2e-15);
    }
    const double ratio = std::pow(1575.42 / 1227.6, 2), step = std::ldexp(1, -36) + 1e-15;
    EXPECT_NEAR(delays.scaled(127, 13, -35), r.tgd, step);
    EXPECT_NEAR(delays.scaled(140, 13, -35), 0, step);
    EXPECT_NEAR(delays.scaled(153, 13, -35), (1 - ratio) * r.tgd, step);
    EXPECT_NEAR(delays.scaled(166, 13, -35), r.tgd, step) << "of L5 no delay is sent";
    EXPECT_EQ(delays.field(192, 8), 12u);
    EXPECT_EQ(delays.field(224, 8), 44u);
    EXPECT_EQ(utc.field(163, 8), 18u);
    EXPECT_EQ(utc.field(187, 13), 2300u);
    EXPECT_EQ(utc.field(200, 13), 1929u);
    EXPECT_EQ(utc.field(213, 4), 7u);
    EXPECT_EQ(utc.field(217, 8), 18u);
}

// An X20P in 2026: on L5 message 33 ended with 588792 s, 10, 11 and 30 each 6 s after the one before; on L2C 11 did.
TEST(BroadcastCnav, MessagesFollowInTheOrderOfTheCapture) {
    const auto type = [](Signal signal, double tow) { return cnav_type_ending(signal, to_gps_time(2408, tow)); };
    EXPECT_EQ(type(Signal::l5, 588792), 33);
    EXPECT_EQ(type(Signal::l5, 588798), 10);
    EXPECT_EQ(type(Signal::l5, 588804), 11);
    EXPECT_EQ(type(Signal::l5, 588810), 30);
    EXPECT_EQ(type(Signal::l2, 588792), 11);
    EXPECT_EQ(type(Signal::l2, 588804), 30);
    EXPECT_EQ(type(Signal::l2, 588816), 33);
    EXPECT_FALSE(type(Signal::l2, 588798));
    EXPECT_FALSE(type(Signal::l5, 588799));
    const KeplerEphemeris r = awkward_record({Constellation::gps, 9}, to_gps_time(2408, 590400.0));
    // The last 20 bits are the beginning of message 11, as in the capture.
    EXPECT_EQ(cnav_bits(r, 10, Signal::l5, to_gps_time(2408, 588798.0)).field(300, 20), 0x8B24Bu);
}

// Almanacs of all satellites in twelve minutes of E1-B, and what the orbits are.
TEST(BroadcastInav, AlmanacsOfAllSatellites) {
    const test::FourSystems source;
    const BroadcastIonosphere none;
    const KeplerEphemeris sender;
    std::map<int, KeplerEphemeris> told;
    std::map<int, PageBits> words;
    const GpsTime begin = to_gps_time(2300, 720.0 * 30 - 360);
    for (int second = 2; second <= 720; ++second) {
        const GpsTime end = begin + std::chrono::seconds(second + 1);
        const auto word = inav_word_ending(Signal::l1, end);
        if (!word || *word < 7 || *word > 10) continue;
        const InavWords pages = inav_pages({sender, none, LeapSeconds::announced(), &source}, *word, end);
        words[*word] = test::inav_word_of({pages.begin(), pages.end()});
        if (*word != 10) continue;
        const auto& [w7, w8, w9, w10] = std::tie(words[7], words[8], words[9], words[10]);
        for (const PageBits* w : {&w8, &w9, &w10})
            ASSERT_EQ(w->field(6, 4), w7.field(6, 4)) << "of one issue";
        const GpsTime reference = to_gps_time(2300, 600.0 * static_cast<double>(w7.field(12, 10)));
        EXPECT_EQ(w7.field(10, 2), 0u) << "week 1276 of GST, modulo 4";
        // Number, axis, e, ω, δi, Ω0, Ω̇, M0, af0, af1 of the three satellites (tables 52 to 55), word and place.
        const std::array<std::array<std::pair<const PageBits*, std::size_t>, 10>, 3> places{{{{{&w7, 22},
                                                                                               {&w7, 28},
                                                                                               {&w7, 41},
                                                                                               {&w7, 52},
                                                                                               {&w7, 68},
                                                                                               {&w7, 79},
                                                                                               {&w7, 95},
                                                                                               {&w7, 106},
                                                                                               {&w8, 10},
                                                                                               {&w8, 26}}},
                                                                                             {{{&w8, 43},
                                                                                               {&w8, 49},
                                                                                               {&w8, 62},
                                                                                               {&w8, 73},
                                                                                               {&w8, 89},
                                                                                               {&w8, 100},
                                                                                               {&w8, 116},
                                                                                               {&w9, 22},
                                                                                               {&w9, 38},
                                                                                               {&w9, 54}}},
                                                                                             {{{&w9, 71},
                                                                                               {&w9, 77},
                                                                                               {&w9, 90},
                                                                                               {&w9, 101},
                                                                                               {&w9, 117},
                                                                                               {&w10, 10},
                                                                                               {&w10, 26},
                                                                                               {&w10, 37},
                                                                                               {&w10, 53},
                                                                                               {&w10, 69}}}}};
        for (const auto& at : places) {
            KeplerEphemeris a;
            a.satellite = {Constellation::galileo, static_cast<int>(at[0].first->field(at[0].second, 6))};
            a.message = NavigationMessage::almanac;
            a.toe = a.toc = reference;
            const auto scaled = [&at](std::size_t i, int width, int exponent) {
                return at[i].first->scaled(at[i].second, width, exponent);
            };
            a.sqrt_a = std::sqrt(29.6e6) + scaled(1, 13, -9);
            a.e = at[2].first->positive(at[2].second, 11, -16);
            a.omega = semicircle * scaled(3, 16, -15);
            a.i0 = 56 * semicircle / 180 + semicircle * scaled(4, 11, -14);
            a.omega0 = semicircle * scaled(5, 16, -15);
            a.omega_dot = semicircle * scaled(6, 11, -33);
            a.m0 = semicircle * scaled(7, 16, -15);
            a.af0 = scaled(8, 16, -19);
            a.af1 = scaled(9, 13, -38);
            if (a.satellite.number != 0) told[a.satellite.number] = a;
        }
        EXPECT_EQ(w10.field(86, 28), 0u) << "GPS time";
    }
    ASSERT_EQ(told.size(), 36u) << "the source has an orbit for every number";
    for (const auto& [number, almanac] : told) {
        const auto record = source.ephemeris({Constellation::galileo, number}, almanac.toe);
        const SatelliteState is = satellite_state(*record, almanac.toe), said = satellite_state(almanac, almanac.toe);
        // Half steps of 16 bits of angles are 1.4 km each, of the axis 5.3 m.
        EXPECT_LT((is.position.vector() - said.position.vector()).norm(), 4000) << number;
        EXPECT_NEAR(is.clock_bias, said.clock_bias, 1e-6) << number;
    }
}

// Word 16 by the user algorithm: an ellipse from the start of the subframe on, one second late.
TEST(BroadcastInav, TheReducedRecordIsGoodToSomeMetres) {
    const test::FourSystems source;
    const BroadcastIonosphere none;
    for (int number = 1; number <= 24; ++number) {
        const GpsTime reference = to_gps_time(2300, 30.0 * 911 + 1), end = reference + std::chrono::seconds(16);
        KeplerEphemeris record = std::get<KeplerEphemeris>(*source.ephemeris({Constellation::galileo, number}, end));
        record.cuc = -3e-6;
        record.cus = 7e-6;
        record.crc = 180;
        record.crs = -60;
        record.delta_n = 3e-9;
        record.e = 0.0004;
        record.i0 = 0.971 + 0.001 * number;
        ASSERT_EQ(inav_word_ending(Signal::l1, end), 16);
        const InavWords pages = inav_pages({record, none, LeapSeconds::announced(), &source}, 16, end);
        const PageBits w = test::inav_word_of({pages.begin(), pages.end()});
        KeplerEphemeris r;
        r.satellite = record.satellite;
        r.message = NavigationMessage::inav;
        r.toe = r.toc = reference;
        r.sqrt_a = std::sqrt(29.6e6 + w.scaled(6, 5, 8));
        r.e = std::hypot(w.scaled(11, 13, -22), w.scaled(24, 13, -22));
        r.omega = std::atan2(w.scaled(24, 13, -22), w.scaled(11, 13, -22));
        r.i0 = 56 * semicircle / 180 + semicircle * w.scaled(37, 17, -22);
        r.omega0 = semicircle * w.scaled(54, 23, -22);
        r.m0 = semicircle * w.scaled(77, 23, -22) - r.omega;
        r.af0 = w.scaled(100, 22, -26);
        r.af1 = w.scaled(122, 6, -35);
        for (int later = 0; later <= 600; later += 60) {
            const GpsTime then = reference + std::chrono::seconds(later);
            const SatelliteState is = satellite_state(record, then), said = satellite_state(r, then);
            EXPECT_LT((is.position.vector() - said.position.vector()).norm(), 25) << number << " after " << later;
            const double clock = is.clock_bias - is.relativistic_bias - said.clock_bias + said.relativistic_bias;
            EXPECT_NEAR(clock, 0, 1e-8) << number << " after " << later;
        }
    }
}

TEST(BroadcastInav, TheDummyWordAlternates) {
    const BroadcastIonosphere none;
    const KeplerEphemeris record;
    const InavWords pages = inav_pages({record, none, LeapSeconds::announced()}, 63, to_gps_time(2300, 3.0));
    const PageBits word = test::inav_word_of({pages.begin(), pages.end()});
    EXPECT_EQ(word.field(0, 32), 0xFD55'5555u);
    EXPECT_EQ(word.field(96, 32), 0x5555'5555u);
}

// F/NAV pages 1 to 4 (tables 31 to 34).
TEST(BroadcastFnav, PagesTellTheRecord) {
    KeplerEphemeris r = awkward_record({Constellation::galileo, 11}, to_gps_time(2300, 600.0 * 77));
    r.message = NavigationMessage::inav;
    r.sqrt_a = 5440.6;
    const BroadcastIonosphere none;
    const GpsTime begin = to_gps_time(2300, 50.0 * 910);
    std::map<int, PageBits> pages;
    for (int count = 1; count <= 10; ++count) {
        const GpsTime end = begin + std::chrono::seconds(10 * count);
        const auto page = fnav_page_ending(r.satellite, end);
        ASSERT_TRUE(page);
        EXPECT_FALSE(fnav_page_ending(r.satellite, end + std::chrono::seconds(1)));
        const FnavWords words = fnav_page({r, none, LeapSeconds::announced()}, *page, end);
        pages[*page] = {{words.begin(), words.end()}};
        EXPECT_EQ(pages[*page].field(0, 6), static_cast<unsigned>(*page));
        EXPECT_EQ(rest_of(pages[*page], 238), 0u) << *page;
        if (count == 1) {
            EXPECT_EQ(pages[1].field(167, 20), 50u * 910);
        }
    }
    ASSERT_EQ(pages.size(), 6u) << "in 100 s";
    EXPECT_EQ(pages[1].field(6, 6), 11u);
    EXPECT_EQ(pages[1].field(12, 10), 17u);
    EXPECT_EQ(pages[1].field(22, 14), 770u);
    // Against I/NAV's: af0 − BGD(E1, E5b) = af0' − BGD(E1, E5a).
    EXPECT_NEAR(pages[1].scaled(36, 31, -34), r.af0 - r.tgd2 + r.tgd, 3e-11);
    EXPECT_NEAR(pages[1].scaled(67, 21, -46), r.af1, 1e-14);
    EXPECT_NEAR(pages[1].scaled(143, 10, -32), r.tgd, 2e-10);
    EXPECT_EQ(pages[1].field(155, 12), 2300u - 1024);
    EXPECT_NEAR(semicircle * pages[2].scaled(16, 32, -31), r.m0, 1e-9);
    EXPECT_NEAR(semicircle * pages[2].scaled(48, 24, -43), r.omega_dot, 2e-13);
    EXPECT_NEAR(pages[2].positive(72, 32, -33), r.e, 1e-10);
    EXPECT_NEAR(pages[2].positive(104, 32, -19), r.sqrt_a, 1e-6);
    EXPECT_NEAR(semicircle * pages[2].scaled(136, 32, -31), r.omega0, 1e-9);
    EXPECT_NEAR(semicircle * pages[2].scaled(168, 14, -43), r.idot, 2e-13);
    EXPECT_NEAR(semicircle * pages[3].scaled(16, 32, -31), r.i0, 1e-9);
    EXPECT_NEAR(semicircle * pages[3].scaled(48, 32, -31), r.omega, 1e-9);
    EXPECT_NEAR(semicircle * pages[3].scaled(80, 16, -43), r.delta_n, 2e-13);
    EXPECT_NEAR(pages[3].scaled(96, 16, -29), r.cuc, 1e-9);
    EXPECT_NEAR(pages[3].scaled(112, 16, -29), r.cus, 1e-9);
    EXPECT_NEAR(pages[3].scaled(128, 16, -5), r.crc, 0.016);
    EXPECT_NEAR(pages[3].scaled(144, 16, -5), r.crs, 0.016);
    EXPECT_EQ(pages[3].field(160, 14), 770u);
    EXPECT_NEAR(pages[4].scaled(16, 16, -29), r.cic, 1e-9);
    EXPECT_NEAR(pages[4].scaled(32, 16, -29), r.cis, 1e-9);
    EXPECT_EQ(pages[4].field(104, 8), 18u);
    EXPECT_EQ(pages[4].field(189, 20), 50u * 910 + 80) << "of the second time";
}

}  // namespace
}  // namespace skyloop
