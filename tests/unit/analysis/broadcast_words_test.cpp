// Almanacs, octets that mend, CNAV and F/NAV of real receivers, taken apart and put together again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "../../support/oracle_table.hpp"
#include "../../support/page_bits.hpp"
#include "../../support/real_frames.hpp"
#include "world/gnss/broadcast_cnav.hpp"
#include "world/gnss/broadcast_galileo.hpp"
#include "world/gnss/broadcast_glonass.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop {
namespace {

using test::PageBits;
using test::real_frames;
using test::RealFrame;

constexpr double half_turn = std::numbers::pi;
constexpr const char* besancon_log = "receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.ubx.gz";
constexpr const char* besancon_nav = "receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.nav.gz";

// Records by their satellites.
class Told : public NavigationSource {
public:
    std::map<SatelliteId, Ephemeris> records;
    [[nodiscard]] std::vector<SatelliteId> satellites() const override { return {}; }
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime) const override {
        const auto found = records.find(satellite);
        return found == records.end() ? std::nullopt : std::optional(found->second);
    }
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return none_; }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return std::nullopt; }
    [[nodiscard]] std::string description() const override { return "told"; }

private:
    BroadcastIonosphere none_;
};

// How often the octets of the words 1 to 4 and 17 to 20 are a word of the code: at α¹ … α⁶⁰ of GF(256) with
// x⁸ + x⁴ + x³ + x² + 1 the polynomial that they are is 0 (OS SIS ICD 2.1, 5.1.13 and annex E). Of words 1 to 4 the
// last octet has the highest power, of 17 to 20 likewise; the type and two bits of the issue are one octet.
bool is_code_word(std::map<int, PageBits>& words) {
    std::vector<std::uint8_t> octets;
    const auto add = [&octets](std::uint64_t octet) { octets.push_back(static_cast<std::uint8_t>(octet)); };
    for (int word = 17; word <= 20; ++word) {
        add(words[word].field(6, 8));
        for (std::size_t at = 16; at < 128; at += 8)
            add(words[word].field(at, 8));
    }
    add(words[1].field(0, 6) << 2 | words[1].field(14, 2));
    add(words[1].field(6, 8));
    for (int word = 1; word <= 4; ++word)
        for (std::size_t at = 16; at < 128; at += 8)
            add(words[word].field(at, 8));
    const auto product = [](unsigned a, unsigned b) {
        unsigned result = 0;
        for (; b != 0; b >>= 1, a = a << 1 ^ ((a & 0x80) != 0 ? 0x11Du : 0u))
            if ((b & 1) != 0) result ^= a;
        return result;
    };
    unsigned root = 1;
    for (int power = 1; power <= 60; ++power) {
        root = product(root, 2);
        unsigned value = 0;
        for (auto octet = octets.rbegin(); octet != octets.rend(); ++octet)
            value = product(value, root) ^ *octet;
        if (value != 0) return false;
    }
    return octets.size() == 118;
}

TEST(BroadcastWords, OctetsThatMendAreOfTheCodeThatSatellitesUse) {
    SKYLOOP_REQUIRE_SHARED(log, besancon_log);
    std::map<int, std::map<int, PageBits>> heard;
    int real = 0, broken = 0;
    for (const RealFrame& frame : real_frames(log)) {
        if (frame.gnss != 2 || frame.words.size() != 8) continue;
        const PageBits word = test::inav_word_of(frame.words);
        auto& words = heard[frame.sv];
        words[static_cast<int>(word.field(0, 6))] = word;
        if (word.field(0, 6) != 20 || !words.contains(17) || !words.contains(18) || !words.contains(19)) continue;
        bool one_issue = words[17].field(14, 2) == words[20].field(14, 2);
        for (int of = 1; of <= 4; ++of)
            one_issue = one_issue && words.contains(of) && words[of].field(6, 10) == words[1].field(6, 10) &&
                        words[of].field(14, 2) == words[20].field(14, 2);
        if (!one_issue) continue;
        ++(is_code_word(words) ? real : broken);
    }
    EXPECT_GT(real, 40) << "so the rule is the right one";
    EXPECT_LE(broken, 2);
}

TEST(BroadcastWords, OurOctetsAreOfThatCode) {
    KeplerEphemeris r;
    r.satellite = {Constellation::galileo, 12};
    r.toe = r.toc = to_gps_time(2363, 600.0 * 700);
    r.sqrt_a = 5440.6123;
    r.e = 0.00023;
    r.m0 = 1.2345;
    r.omega0 = -2.1;
    r.i0 = 0.977;
    r.omega = 0.321;
    r.af0 = -1.2e-4;
    const BroadcastIonosphere none;
    for (const int issue : {93, 94, 95, 96}) {
        r.iode = issue;
        std::map<int, PageBits> words;
        for (const int word : {1, 2, 3, 4, 17, 18, 19, 20}) {
            const InavWords pages = inav_pages({r, none, LeapSeconds::announced()}, word, r.toe);
            words[word] = test::inav_word_of({pages.begin(), pages.end()});
            EXPECT_EQ(words[word].field(0, 6), static_cast<unsigned>(word));
            EXPECT_EQ(words[word].field(14, 2), static_cast<unsigned>(issue) % 4);
        }
        EXPECT_TRUE(is_code_word(words)) << issue;
        words[3].words[2] ^= 1;
        EXPECT_FALSE(is_code_word(words));
    }
}

// Of each satellite number, axis, e, ω, δi, Ω0, Ω̇, M0, af0, af1 and health, word and place (OS SIS ICD, tables 52 to
// 55).
using FieldPlaces = std::array<std::pair<int, std::size_t>, 11>;
constexpr std::array<FieldPlaces, 3> almanac_places{
    {{{{7, 22}, {7, 28}, {7, 41}, {7, 52}, {7, 68}, {7, 79}, {7, 95}, {7, 106}, {8, 10}, {8, 26}, {8, 39}}},
     {{{8, 43}, {8, 49}, {8, 62}, {8, 73}, {8, 89}, {8, 100}, {8, 116}, {9, 22}, {9, 38}, {9, 54}, {9, 67}}},
     {{{9, 71}, {9, 77}, {9, 90}, {9, 101}, {9, 117}, {10, 10}, {10, 26}, {10, 37}, {10, 53}, {10, 69}, {10, 82}}}}};

KeplerEphemeris real_almanac(std::map<int, PageBits>& words, const FieldPlaces& at, GpsTime reference) {
    KeplerEphemeris a;
    const auto scaled = [&](std::size_t i, int width, int exponent) {
        return words[at[i].first].scaled(at[i].second, width, exponent);
    };
    a.satellite = {Constellation::galileo, static_cast<int>(words[at[0].first].field(at[0].second, 6))};
    a.toe = a.toc = reference;
    a.sqrt_a = std::sqrt(29.6e6) + scaled(1, 13, -9);
    a.e = words[at[2].first].positive(at[2].second, 11, -16);
    a.omega = half_turn * scaled(3, 16, -15);
    a.i0 = 56 * half_turn / 180 + half_turn * scaled(4, 11, -14);
    a.omega0 = half_turn * scaled(5, 16, -15);
    a.omega_dot = half_turn * scaled(6, 11, -33);
    a.m0 = half_turn * scaled(7, 16, -15);
    a.af0 = scaled(8, 16, -19);
    a.af1 = scaled(9, 13, -38);
    const auto health = static_cast<int>(words[at[10].first].field(at[10].second, 4));
    a.health = (health >> 2) << 7 | (health & 3) << 1;
    return a;
}

// All but issue, time and GPS's offset, which a run chooses itself.
void expect_same_almanac(const PageBits& made, const PageBits& real, int word) {
    const std::size_t from = word == 7 || word == 9 ? 22 : 10, to = word == 10 ? 86 : 128;
    for (std::size_t at = from; at < to; ++at)
        ASSERT_EQ(made.field(at, 1), real.field(at, 1)) << "word " << word << " bit " << at;
}

TEST(BroadcastWords, AlmanacsOfGalileoComeBack) {
    SKYLOOP_REQUIRE_SHARED(log, besancon_log);
    std::map<int, PageBits> words;
    const BroadcastIonosphere none;
    const KeplerEphemeris sender;
    int compared = 0, absent = 0;
    double tow = 0;
    for (const RealFrame& frame : real_frames(log)) {
        if (frame.gnss != 2 || frame.sv != 8 || frame.words.size() != 8) continue;
        const PageBits real = test::inav_word_of(frame.words);
        const int word = static_cast<int>(real.field(0, 6));
        if (word == 6) tow = static_cast<double>(real.field(105, 20));
        if (word < 7 || word > 10) continue;
        words[word] = real;
        if (word != 10 || words.size() < 4) continue;
        // Word 6 came four seconds before the start of word 10.
        const GpsTime start = to_gps_time(2363, tow + 4), reference(start.time_since_epoch());
        Told told;
        for (const FieldPlaces& at : almanac_places) {
            const KeplerEphemeris almanac = real_almanac(words, at, reference);
            if (almanac.satellite.number != 0) told.records[almanac.satellite] = almanac;
            absent += almanac.satellite.number == 0 ? 1 : 0;
        }
        for (auto& [number, real_word] : words) {
            // Told at the reference of the run's own batch, nothing is carried along.
            for (auto& [satellite, any] : told.records) {
                auto& record = std::get<KeplerEphemeris>(any);
                const InavWords probe =
                    inav_pages({sender, none, LeapSeconds::announced(), &told}, 7, start + std::chrono::seconds(2));
                const PageBits head = test::inav_word_of({probe.begin(), probe.end()});
                record.toe = record.toc = to_gps_time(2363, 600.0 * static_cast<double>(head.field(12, 10)));
            }
            const InavWords ours =
                inav_pages({sender, none, LeapSeconds::announced(), &told}, number, start + std::chrono::seconds(2));
            expect_same_almanac(test::inav_word_of({ours.begin(), ours.end()}), real_word, number);
            if (HasFatalFailure()) return;
            ++compared;
        }
        words.clear();
    }
    EXPECT_GT(compared, 30);
    EXPECT_GT(absent, 0);
}

// All of message 11; its last seven bits are reserved, and real satellites fill them.
TEST(BroadcastWords, CnavOrbitsOfRealSatellitesComeBack) {
    SKYLOOP_REQUIRE_SHARED(log, "serial/ublox-x20p.log");
    int compared = 0;
    for (const RealFrame& frame : real_frames(log)) {
        if (frame.gnss != 0 || (frame.signal != 4 && frame.signal != 6)) continue;
        const PageBits m{frame.words};
        if (m.field(14, 6) != 11) continue;
        const Signal signal = frame.signal == 4 ? Signal::l2 : Signal::l5;
        KeplerEphemeris r;
        r.satellite = {Constellation::gps, frame.sv};
        r.toe = to_gps_time(2408, 300.0 * static_cast<double>(m.field(38, 11)));
        r.omega0 = half_turn * m.scaled(49, 33, -32);
        r.i0 = half_turn * m.scaled(82, 33, -32);
        r.omega_dot = half_turn * (-2.6e-9 + m.scaled(115, 17, -44));
        r.idot = half_turn * m.scaled(132, 15, -44);
        r.cis = m.scaled(147, 16, -30);
        r.cic = m.scaled(163, 16, -30);
        r.crs = m.scaled(179, 24, -8);
        r.crc = m.scaled(203, 24, -8);
        r.cus = m.scaled(227, 21, -30);
        r.cuc = m.scaled(248, 21, -30);
        EXPECT_NEAR(r.i0 * 57.29578, 55, 3) << "so the places are right";
        const GpsTime end = to_gps_time(2408, 6.0 * static_cast<double>(m.field(20, 17)));
        EXPECT_EQ(cnav_type_ending(signal, end), 11);
        const BroadcastIonosphere none;
        const CnavWords ours = cnav_message({r, none, LeapSeconds::announced()}, 11, signal, end);
        const PageBits made{{ours.begin(), ours.end()}};
        for (std::size_t at = 0; at < 269; ++at)
            ASSERT_EQ(made.field(at, 1), m.field(at, 1)) << "bit " << at;
        EXPECT_EQ(made.field(300, 20), m.field(300, 20)) << "what follows";
        ++compared;
    }
    EXPECT_GE(compared, 4);
}

// SISA, table 96.
double accuracy_of(double index) {
    if (index < 50) return 0.01 * index;
    if (index < 75) return 0.5 + 0.02 * (index - 50);
    if (index < 100) return 1 + 0.04 * (index - 75);
    return 2 + 0.16 * (index - 100);
}

TEST(BroadcastWords, FnavPagesOfRealSatellitesComeBack) {
    SKYLOOP_REQUIRE_SHARED(log, "serial/ublox-x20p.log");
    std::map<int, int> compared;
    for (const RealFrame& frame : real_frames(log)) {
        if (frame.gnss != 2 || frame.signal != 3) continue;
        const PageBits p{frame.words};
        const auto page = static_cast<int>(p.field(0, 6));
        if (page > 2) continue;
        KeplerEphemeris r;
        r.satellite = {Constellation::galileo, frame.sv};
        r.message = NavigationMessage::fnav;
        r.iode = static_cast<int>(p.field(page == 1 ? 12 : 6, 10));
        BroadcastIonosphere ionosphere;
        const GpsTime start = to_gps_time(2408, static_cast<double>(p.field(page == 1 ? 167 : 194, 20)));
        if (page == 1) {
            r.toc = to_gps_time(2408, 60.0 * static_cast<double>(p.field(22, 14)));
            r.af0 = p.scaled(36, 31, -34);
            r.af1 = p.scaled(67, 21, -46);
            r.af2 = p.scaled(88, 6, -59);
            r.accuracy_m = accuracy_of(static_cast<double>(p.field(94, 8)));
            r.tgd = p.scaled(143, 10, -32);
            ionosphere.galileo = std::array{p.positive(102, 11, -2), p.scaled(113, 11, -8), p.scaled(124, 14, -15)};
        } else {
            r.m0 = half_turn * p.scaled(16, 32, -31);
            r.omega_dot = half_turn * p.scaled(48, 24, -43);
            r.e = p.positive(72, 32, -33);
            r.sqrt_a = p.positive(104, 32, -19);
            r.omega0 = half_turn * p.scaled(136, 32, -31);
            r.idot = half_turn * p.scaled(168, 14, -43);
            EXPECT_NEAR(r.sqrt_a, 5440.6, 0.1);
        }
        const GpsTime end = start + std::chrono::seconds(10);
        EXPECT_EQ(fnav_page_ending(r.satellite, end), page);
        const FnavWords ours = fnav_page({r, ionosphere, LeapSeconds::announced()}, page, end);
        const PageBits made{{ours.begin(), ours.end()}};
        const std::size_t told = page == 1 ? 188 : 238;  // the spare bits of page 1 are filled
        for (std::size_t at = 0; at < told; ++at)
            ASSERT_EQ(made.field(at, 1), p.field(at, 1)) << "page " << page << " bit " << at;
        ++compared[page];
    }
    EXPECT_GE(compared[1], 2);
    EXPECT_GE(compared[2], 2);
}

// As satellites told it on 2018-10-15, against what follows from their own records of that evening.
TEST(BroadcastWords, GlonassAlmanacsAreNearTheRealOnes) {
    SKYLOOP_REQUIRE_SHARED(log, "receivers/galway_20181015_m8p_static/base-20181015-1654.ubx.gz");
    SKYLOOP_REQUIRE_SHARED(nav, "receivers/galway_20181015_m8p_static/galway.nav");
    const auto file = read_navigation_file(nav);
    ASSERT_TRUE(file.has_value());
    std::map<int, std::pair<PageBits, PageBits>> real;  // by the number that they are about
    std::map<int, PageBits> before;
    for (const RealFrame& frame : real_frames(log)) {
        if (frame.gnss != 6 || frame.words.size() != 4) continue;
        const PageBits s{frame.words};
        const auto string = static_cast<int>(s.field(1, 4));
        if (string < 6 || string > 15) continue;
        if (string % 2 == 0) before[frame.sv] = s;
        const auto even = before.find(frame.sv);
        if (string % 2 == 0 || even == before.end()) continue;
        if (even->second.field(1, 4) + 1 != s.field(1, 4) || even->second.words[3] != s.words[3]) continue;
        real[static_cast<int>(even->second.field(8, 5))] = {even->second, s};
    }
    const auto magnitude = [](const PageBits& s, std::size_t at, int width, int exponent) {
        const double value = s.positive(at + 1, width - 1, exponent);
        return s.field(at, 1) != 0 ? -value : value;
    };
    int compared = 0;
    for (const Ephemeris& any : file->records) {
        const auto* record = std::get_if<GlonassEphemeris>(&any);
        if (!record || !real.contains(record->satellite.number)) continue;
        const auto& [even, odd] = real[record->satellite.number];
        const auto ours = glonass_almanac(*record, record->toe, LeapSeconds::announced());
        ASSERT_TRUE(ours);
        // The real one is of the day, or of the day before, whose node comes some 14 s earlier in 17 orbits of 8 days.
        EXPECT_NEAR(ours->inclination, half_turn * (63 / 180.0 + magnitude(even, 44, 18, -20)), 2e-4);
        EXPECT_NEAR(ours->draconic_period, 43200 + magnitude(odd, 42, 22, -9), 1);
        EXPECT_NEAR(ours->eccentricity, even.positive(62, 15, -20), 3e-4);
        EXPECT_NEAR(ours->node_time, odd.positive(21, 21, -5), 20) << to_string(record->satellite);
        EXPECT_NEAR(std::remainder(ours->node_longitude - half_turn * magnitude(even, 23, 21, -20), 2 * half_turn), 0,
                    2e-3)
            << to_string(record->satellite);
        EXPECT_NEAR(ours->time_correction, magnitude(even, 13, 10, -18), 1e-5);
        ++compared;
    }
    EXPECT_GE(compared, 5);
}

}  // namespace
}  // namespace skyloop
