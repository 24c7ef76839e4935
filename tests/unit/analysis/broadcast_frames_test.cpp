// Our subframes, strings and pages against those that real receivers have handed out, bit by bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "../../support/oracle_table.hpp"
#include "../../support/page_bits.hpp"
#include "../../support/real_frames.hpp"
#include "base/core/bytes.hpp"
#include "world/gnss/broadcast_beidou.hpp"
#include "world/gnss/broadcast_galileo.hpp"
#include "world/gnss/broadcast_glonass.hpp"
#include "world/gnss/broadcast_lnav.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop {
namespace {

using test::PageBits;
using test::real_frames;
using test::RealFrame;

constexpr const char* galway_frames = "receivers/galway_20181015_m8p_static/base-20181015-1654.ubx.gz";
constexpr const char* galway_records = "receivers/galway_20181015_m8p_static/galway.nav";
constexpr const char* besancon_frames = "receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.ubx.gz";
constexpr const char* besancon_records = "receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.nav.gz";

std::uint32_t lnav_data(std::uint32_t word) { return word >> 6 & 0xFFFFFF; }

// The bits of data that a record tells, by subframe 1 … 3 and word 1 … 10.
std::uint32_t told_bits(int subframe, std::size_t word) {
    if (word == 0) return 0xFF0000;
    if (word == 1) return 0xFFFF9C;  // without alert, anti-spoofing and the two bits that parity needs
    if (word == 9) return subframe == 2 ? 0xFFFF80 : 0xFFFFFC;
    if (subframe != 1) return 0xFFFFFF;
    if (word == 2) return 0xFFCFFF;  // without the code on L2
    if (word < 6) return 0;
    return word == 6 ? 0xFF : 0xFFFFFF;
}

TEST(BroadcastFrames, ParityAndRegisterOfEveryRealLnavFrame) {
    SKYLOOP_REQUIRE_SHARED(galway, galway_frames);
    SKYLOOP_REQUIRE_SHARED(f9p, "serial/ublox-zed-f9p-sfrbx.log");
    SKYLOOP_REQUIRE_SHARED(x20p, "serial/ublox-x20p.log");
    int count = 0, damaged = 0;
    for (const auto& path : {galway, f9p, x20p}) {
        for (const RealFrame& frame : real_frames(path)) {
            if (frame.gnss != 0 || frame.signal != 0 || frame.words.size() != 10) continue;
            LnavData data{};
            std::transform(frame.words.begin(), frame.words.end(), data.begin(), lnav_data);
            const LnavWords ours = lnav_words(data);
            damaged += std::equal(ours.begin(), ours.end(), frame.words.begin()) ? 0 : 1;
            ++count;
        }
    }
    EXPECT_GT(count, 4000);
    EXPECT_LE(damaged, 2);  // that were received with a wrong bit
}

// Subframes of records that stand in the file, against those that were received.
int compare_lnav(const std::filesystem::path& frames, const std::filesystem::path& records, std::int64_t week) {
    const auto file = read_navigation_file(records);
    EXPECT_TRUE(file.has_value());
    int count = 0;
    for (const RealFrame& frame : real_frames(frames)) {
        if (frame.gnss != 0 || frame.words.size() != 10) continue;
        const std::uint32_t how = lnav_data(frame.words[1]);
        const int subframe = static_cast<int>(how >> 2 & 7);
        if (subframe > 3) continue;
        const GpsTime end = to_gps_time(week, 6.0 * (how >> 7));
        const std::uint32_t issue = subframe == 1   ? lnav_data(frame.words[7]) >> 16
                                    : subframe == 2 ? lnav_data(frame.words[2]) >> 16
                                                    : lnav_data(frame.words[9]) >> 16;
        for (const Ephemeris& any : file->records) {
            const auto* record = std::get_if<KeplerEphemeris>(&any);
            if (!record || record->satellite != SatelliteId{Constellation::gps, frame.sv}) continue;
            if (record->iode != static_cast<int>(issue)) continue;
            const LnavWords ours = lnav_ephemeris_subframe(*record, subframe, end);
            for (std::size_t i = 0; i < 10; ++i)
                EXPECT_EQ((lnav_data(ours[i]) ^ lnav_data(frame.words[i])) & told_bits(subframe, i), 0u)
                    << to_string(record->satellite) << " subframe " << subframe << " word " << i + 1;
            ++count;
            break;
        }
        if (testing::Test::HasFailure()) break;
    }
    return count;
}

TEST(BroadcastFrames, LnavEphemeridesAreThoseThatWereReceived) {
    SKYLOOP_REQUIRE_SHARED(galway, galway_frames);
    SKYLOOP_REQUIRE_SHARED(records, galway_records);
    EXPECT_GT(compare_lnav(galway, records, 2023), 1500);
}

TEST(BroadcastFrames, LnavEphemeridesOfAnotherReceiver) {
    SKYLOOP_REQUIRE_SHARED(besancon, besancon_frames);
    SKYLOOP_REQUIRE_SHARED(records, besancon_records);
    EXPECT_GT(compare_lnav(besancon, records, 2363), 50);
}

// E1-B: words 1 to 4 whole, of 5 what a record and the header tell; the checksum of every pair of pages.
TEST(BroadcastFrames, InavWordsAreThoseThatWereReceived) {
    SKYLOOP_REQUIRE_SHARED(besancon, besancon_frames);
    SKYLOOP_REQUIRE_SHARED(records, besancon_records);
    const auto file = read_navigation_file(records);
    ASSERT_TRUE(file.has_value());
    std::map<int, int> compared;
    for (const RealFrame& frame : real_frames(besancon)) {
        if (frame.gnss != 2 || frame.words.size() != 8) continue;
        const PageBits real{frame.words};
        const int word = static_cast<int>(real.field(2, 6));
        if (word < 1 || word > 4) continue;
        for (const Ephemeris& any : file->records) {
            const auto* record = std::get_if<KeplerEphemeris>(&any);
            if (!record || record->message != NavigationMessage::inav) continue;
            if (record->satellite != SatelliteId{Constellation::galileo, frame.sv}) continue;
            if (record->iode != static_cast<int>(real.field(8, 10))) continue;
            const InavWords ours = inav_pages({*record, file->ionosphere, LeapSeconds::announced()}, word, record->toe);
            const PageBits made{{ours.begin(), ours.end()}};
            const int width = word == 3 ? 112 : 110;  // the last bits of the others are spare
            for (int bit = 0; bit < 112; ++bit)
                EXPECT_EQ(made.field(2 + static_cast<std::size_t>(bit), 1),
                          real.field(2 + static_cast<std::size_t>(bit), 1))
                    << "word " << word << " bit " << bit << " of " << width;
            EXPECT_EQ(made.field(130, word == 3 ? 16 : 14), real.field(130, word == 3 ? 16 : 14)) << word;
            ++compared[word];
            break;
        }
        if (HasFailure()) break;
    }
    for (int word = 1; word <= 4; ++word)
        EXPECT_GT(compared[word], 10) << word;
}

TEST(BroadcastFrames, InavChecksumHoldsAsReceiversSeeIt) {
    SKYLOOP_REQUIRE_SHARED(besancon, besancon_frames);
    const auto checksum = [](const PageBits& page) {
        std::uint32_t value = 0;
        const auto add = [&value](std::uint64_t bit) {
            value ^= static_cast<std::uint32_t>(bit) << 23;
            value = (value & 0x800000) != 0 ? (value << 1 ^ 0x1864CFB) & 0xFFFFFF : value << 1;
        };
        for (std::size_t i = 0; i < 114; ++i)
            add(page.field(i, 1));
        for (std::size_t i = 128; i < 210; ++i)
            add(page.field(i, 1));
        return value;
    };
    int good = 0;
    for (const RealFrame& frame : real_frames(besancon)) {
        if (frame.gnss != 2 || frame.words.size() != 8) continue;
        const PageBits page{frame.words};
        good += checksum(page) == page.field(210, 24) ? 1 : 0;
    }
    EXPECT_GT(good, 2900);  // so the rule above is the right one
    const KeplerEphemeris record;
    const BroadcastIonosphere none;
    for (int word = 0; word <= 6; ++word) {
        const InavWords ours = inav_pages({record, none, LeapSeconds::announced()}, word, to_gps_time(2300, 8.0));
        const PageBits page{{ours.begin(), ours.end()}};
        EXPECT_EQ(checksum(page), page.field(210, 24)) << word;
    }
}

// A Hamming code of its own making: every bit of the string by the tables of the ICD is tested through real strings.
GlonassEphemeris record_of_strings(const std::array<PageBits, 4>& strings, int sv) {
    const auto signed_field = [](const PageBits& s, int high, int width) {
        const auto raw = s.field(static_cast<std::size_t>(85 - high), width);
        const auto magnitude = static_cast<double>(raw & ((std::uint64_t{1} << (width - 1)) - 1));
        return (raw >> (width - 1) & 1) != 0 ? -magnitude : magnitude;
    };
    GlonassEphemeris r;
    r.satellite = {Constellation::glonass, sv};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        r.velocity_mps[axis] = 1000 * std::ldexp(signed_field(strings[axis], 64, 24), -20);
        r.acceleration_mps2[axis] = 1000 * std::ldexp(signed_field(strings[axis], 40, 5), -30);
        r.position_m[axis] = 1000 * std::ldexp(signed_field(strings[axis], 35, 27), -11);
    }
    // t_b, quarter hours of the Moscow Monday 2018-10-15.
    r.toe = to_gps_time(2023, 86400.0 - 3 * 3600 + 18 + 900.0 * static_cast<double>(strings[1].field(85 - 76, 7)));
    r.clock_drift = std::ldexp(signed_field(strings[2], 79, 11), -40);
    r.clock_bias = -std::ldexp(signed_field(strings[3], 80, 22), -30);
    r.group_delay_l2 = std::ldexp(signed_field(strings[3], 58, 5), -30);
    return r;
}

// What a record does not tell is taken from the real string, and the check bits must then be those of the real one.
TEST(BroadcastFrames, GlonassStringsAreThoseThatWereReceived) {
    SKYLOOP_REQUIRE_SHARED(galway, galway_frames);
    std::map<int, std::array<PageBits, 4>> heard;
    std::map<int, unsigned> complete;
    // t_k of string 1 and the counters tell when: Monday 2018-10-15, GPS week 2023.
    int compared = 0, same_check = 0;
    for (const RealFrame& frame : real_frames(galway)) {
        if (frame.gnss != 6 || frame.words.size() != 4 || frame.sv == 255) continue;
        const PageBits real{frame.words};
        const int string = static_cast<int>(real.field(1, 4));
        if (string < 1 || string > 4) continue;
        if (string == 1) complete[frame.sv] = 0;
        heard[frame.sv][static_cast<std::size_t>(string - 1)] = real;
        complete[frame.sv] |= 1u << string;
        if (complete[frame.sv] != 0b11110) continue;
        const auto& strings = heard[frame.sv];
        const GlonassEphemeris record = record_of_strings(strings, frame.sv);
        for (int s = 1; s <= 4; ++s) {
            const auto& words = strings[static_cast<std::size_t>(s - 1)].words;
            const double of_week = 150.0 * ((words[3] >> 16) - 1) + 30.0 * ((words[3] & 0xFFFF) - 1) + 2.0 * s;
            const GpsTime end = to_gps_time(2023, of_week - 3 * 3600 + 18);
            EXPECT_EQ(glonass_string_ending(end, LeapSeconds::announced()), s);
            const GlonassWords ours = glonass_string(record, s, end, LeapSeconds::announced());
            EXPECT_EQ(ours[3], words[3]);
            const PageBits made{{ours.begin(), ours.end()}};
            // x, x', x'' and number; of string 1 the time, of string 2 t_b, of string 4 the clock, day and slot.
            std::vector<std::pair<int, int>> fields{{85, 5}};
            if (s < 4) fields.insert(fields.end(), {{64, 56}});
            if (s == 1) fields.push_back({76, 12});
            if (s == 2) fields.push_back({77, 8});
            if (s == 4) fields.insert(fields.end(), {{80, 27}, {26, 18}});
            for (const auto& [high, width] : fields)
                EXPECT_EQ(made.field(static_cast<std::size_t>(85 - high), width),
                          PageBits{words}.field(static_cast<std::size_t>(85 - high), width))
                    << "string " << s << " from bit " << high << " of R" << frame.sv;
            const bool same = std::equal(words.begin(), words.end(), ours.begin());
            same_check += same ? 1 : 0;
            ++compared;
        }
        complete[frame.sv] = 0;
        if (HasFailure()) break;
    }
    EXPECT_GT(compared, 2000);
    EXPECT_GT(same_check, 100);  // whole strings, check bits among them
}

// BeiDou D1 of three real subframes, taken apart by the tables of the ICD and put together again.
TEST(BroadcastFrames, D1SubframesOfARealSatelliteComeBack) {
    SKYLOOP_REQUIRE_SHARED(f9p, "serial/ublox-zed-f9p-sfrbx.log");
    std::array<PageBits, 3> subframes;
    for (const RealFrame& frame : real_frames(f9p)) {
        if (frame.gnss != 3 || frame.signal != 0 || frame.sv != 29 || frame.words.size() != 10) continue;
        // The information without parity: 26 bits of the first word, 22 of the others.
        BitWriter bits;
        bits.put(frame.words[0] >> 4, 26);
        for (std::size_t i = 1; i < 10; ++i)
            bits.put(frame.words[i] >> 8, 22);
        const auto number = bits.field(15, 3);
        if (number >= 1 && number <= 3) subframes[number - 1] = {bits.words()};
        if (number < 1 || number > 3) continue;
        subframes[number - 1].words.insert(subframes[number - 1].words.end(), frame.words.begin(), frame.words.end());
    }
    for (const PageBits& s : subframes)
        ASSERT_EQ(s.words.size(), 17u);
    const auto number = [](std::uint64_t raw, int width) {
        return static_cast<double>(static_cast<std::int64_t>(raw << (64 - width)) >> (64 - width));
    };
    const auto& [s1, s2, s3] = subframes;
    const double semicircle = std::numbers::pi;
    const std::int64_t week = 1356 + static_cast<std::int64_t>(s1.field(48, 13));
    KeplerEphemeris r;
    r.satellite = {Constellation::beidou, 29};
    r.message = NavigationMessage::d1;
    r.health = static_cast<int>(s1.field(38, 1));
    r.iodc = static_cast<int>(s1.field(39, 5));
    EXPECT_EQ(s1.field(44, 4), 0u);
    r.accuracy_m = 2;
    r.toc = to_gps_time(week, 8.0 * static_cast<double>(s1.field(61, 17)) + 14);
    r.tgd = 1e-10 * number(s1.field(78, 10), 10);
    r.tgd2 = 1e-10 * number(s1.field(88, 10), 10);
    KlobucharCoefficients c;
    for (std::size_t i = 0; i < 4; ++i) {
        c.alpha[i] = std::ldexp(number(s1.field(98 + 8 * i, 8), 8), std::array{-30, -27, -24, -24}[i]);
        c.beta[i] = std::ldexp(number(s1.field(130 + 8 * i, 8), 8), std::array{11, 14, 16, 16}[i]);
    }
    r.af2 = std::ldexp(number(s1.field(162, 11), 11), -66);
    r.af0 = std::ldexp(number(s1.field(173, 24), 24), -33);
    r.af1 = std::ldexp(number(s1.field(197, 22), 22), -50);
    r.iode = static_cast<int>(s1.field(219, 5));
    r.delta_n = semicircle * std::ldexp(number(s2.field(38, 16), 16), -43);
    r.cuc = std::ldexp(number(s2.field(54, 18), 18), -31);
    r.m0 = semicircle * std::ldexp(number(s2.field(72, 32), 32), -31);
    r.e = std::ldexp(static_cast<double>(s2.field(104, 32)), -33);
    r.cus = std::ldexp(number(s2.field(136, 18), 18), -31);
    r.crc = std::ldexp(number(s2.field(154, 18), 18), -6);
    r.crs = std::ldexp(number(s2.field(172, 18), 18), -6);
    r.sqrt_a = std::ldexp(static_cast<double>(s2.field(190, 32)), -19);
    r.toe = to_gps_time(week, 8.0 * static_cast<double>(s2.field(222, 2) << 15 | s3.field(38, 15)) + 14);
    r.i0 = semicircle * std::ldexp(number(s3.field(53, 32), 32), -31);
    r.cic = std::ldexp(number(s3.field(85, 18), 18), -31);
    r.omega_dot = semicircle * std::ldexp(number(s3.field(103, 24), 24), -43);
    r.cis = std::ldexp(number(s3.field(127, 18), 18), -31);
    r.idot = semicircle * std::ldexp(number(s3.field(145, 14), 14), -43);
    r.omega0 = semicircle * std::ldexp(number(s3.field(159, 32), 32), -31);
    r.omega = semicircle * std::ldexp(number(s3.field(191, 32), 32), -31);
    EXPECT_NEAR(r.sqrt_a * r.sqrt_a, 27.9e6, 1e5);  // a MEO, so the places above are right
    EXPECT_NEAR(r.i0 * 57.29578, 55, 3);
    for (int subframe = 1; subframe <= 3; ++subframe) {
        const auto& words = subframes[static_cast<std::size_t>(subframe - 1)].words;
        const double sow = static_cast<double>(subframes[static_cast<std::size_t>(subframe - 1)].field(18, 20));
        const D1Words ours = d1_subframe(r, c, subframe, to_gps_time(week, sow + 14 + 6));
        for (std::size_t i = 0; i < 10; ++i) {
            // Four bits of the first word are reserved, one of subframe 3.
            const std::uint32_t told = i == 0 ? 0x3FF87FF0 : ~0u;
            EXPECT_EQ((ours[i] ^ words[7 + i]) & told, 0u) << "subframe " << subframe << " word " << i + 1;
        }
    }
}

}  // namespace
}  // namespace skyloop
