// Navigation messages without a receiver to compare with: pages of the whole system, time, and records that do not fit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "world/gnss/broadcast_beidou.hpp"
#include "world/gnss/broadcast_cnav.hpp"
#include "world/gnss/broadcast_galileo.hpp"
#include "world/gnss/broadcast_glonass.hpp"
#include "world/gnss/broadcast_lnav.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop {
namespace {

std::uint32_t page_data(const LnavWords& words, std::size_t word) { return words[word - 1] >> 6 & 0xFFFFFF; }

std::int64_t complement(std::uint32_t value, int width) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(value) << (64 - width)) >> (64 - width);
}

// A subframe of a ZED-F9P's log, word by word.
TEST(BroadcastLnav, WordsOfARealSubframe) {
    const LnavWords real{0x22c03d38, 0x1b626b0c, 0x3fe74766, 0x9b39e17a, 0x8000c9dc,
                         0x15fc6484, 0x06850998, 0x0e397a36, 0xbfea5a74, 0x04fd9090};
    LnavData data{};
    for (std::size_t i = 0; i < 10; ++i)
        data[i] = real[i] >> 6 & 0xFFFFFF;
    EXPECT_EQ(lnav_words(data), real);
}

TEST(BroadcastLnav, PageEighteenTellsIonosphereAndLeapSeconds) {
    class WithIonosphere : public NominalConstellation {
    public:
        [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return ionosphere_; }

    private:
        BroadcastIonosphere ionosphere_{
            KlobucharCoefficients{{std::ldexp(12, -30), std::ldexp(-8, -27), std::ldexp(-1, -24), std::ldexp(2, -24)},
                                  {std::ldexp(44, 11), std::ldexp(-3, 14), std::ldexp(-2, 16), std::ldexp(7, 16)}}};
    } source;
    // Page 18 is that of the eighteenth frame of 30 s; subframe 4 ends 24 s after its start.
    const GpsTime end = to_gps_time(2023, 750.0 * 100 + 17 * 30 + 24);
    const LnavWords words = lnav_system_subframe({&source, LeapSeconds::announced()}, 4, end);
    EXPECT_EQ(page_data(words, 3) >> 16, 0x78u);  // data 01, page 56
    EXPECT_EQ(page_data(words, 3) & 0xFFFF, 0x0CF8u);
    EXPECT_EQ(page_data(words, 4), 0xFF022Cu);
    EXPECT_EQ(page_data(words, 5), 0xFDFE07u);
    EXPECT_EQ(page_data(words, 8) & 0xFF, 2023u & 0xFF);
    // 18 s since the end of Saturday 2016-12-31, week 1929.
    EXPECT_EQ(page_data(words, 9), (18u << 16 | (1929u & 0xFF) << 8 | 7u));
    EXPECT_EQ(page_data(words, 10) >> 16, 18u);
}

TEST(BroadcastLnav, AlmanacsGiveTheOrbitsOfTheRecords) {
    const NominalConstellation source;
    for (int number : {1, 12, 24}) {
        const GpsTime end = to_gps_time(2023, 750.0 * 700 + (number - 1) * 30 + 30);
        const LnavWords words = lnav_system_subframe({&source, LeapSeconds::announced()}, 5, end);
        ASSERT_EQ(page_data(words, 3) >> 16, 0x40u + static_cast<std::uint32_t>(number));
        constexpr double semicircle = std::numbers::pi;
        KeplerEphemeris almanac;
        almanac.satellite = {Constellation::gps, number};
        almanac.message = NavigationMessage::almanac;
        almanac.e = std::ldexp(page_data(words, 3) & 0xFFFF, -21);
        almanac.toe = almanac.toc = to_gps_time(2023, 4096.0 * (page_data(words, 4) >> 16));
        const auto inclination = static_cast<double>(complement(page_data(words, 4) & 0xFFFF, 16));
        almanac.i0 = semicircle * (0.3 + std::ldexp(inclination, -19));
        almanac.omega_dot = semicircle * std::ldexp(static_cast<double>(complement(page_data(words, 5) >> 8, 16)), -38);
        EXPECT_EQ(page_data(words, 5) & 0xFF, 0u);
        almanac.sqrt_a = std::ldexp(page_data(words, 6), -11);
        const auto circle = [&words](std::size_t word) {
            return semicircle * std::ldexp(static_cast<double>(complement(page_data(words, word), 24)), -23);
        };
        almanac.omega0 = circle(7);
        almanac.omega = circle(8);
        almanac.m0 = circle(9);
        const auto record = source.record(almanac.satellite, end);
        ASSERT_TRUE(record);
        const Eigen::Vector3d there = satellite_state(almanac, end).position.vector();
        const Eigen::Vector3d apart = there - satellite_state(*record, end).position.vector();
        EXPECT_LT(apart.norm(), 2000) << number;  // δi has steps of 160 m, Ω̇ of 600 m over a day
    }
}

TEST(BroadcastLnav, HealthPagesTellWhoIsThere) {
    const NominalConstellation source;
    const LnavWords words = lnav_system_subframe({&source, LeapSeconds::announced()}, 5, to_gps_time(2023, 750.0 * 3));
    EXPECT_EQ(page_data(words, 3) >> 16, 0x40u + 51);
    for (std::size_t word = 4; word <= 9; ++word)
        EXPECT_EQ(page_data(words, word), 0u);
    const LnavWords second =
        lnav_system_subframe({&source, LeapSeconds::announced()}, 4, to_gps_time(2023, 750.0 * 3 - 6));
    EXPECT_EQ(page_data(second, 3) >> 16, 0x40u + 63);
}

// Two quasi-zenith satellites and a geostationary one beside GPS.
class WithQzss : public NominalConstellation {
public:
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return ionosphere_; }
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override {
        if (satellite.constellation != Constellation::qzss) return NominalConstellation::ephemeris(satellite, time);
        if (satellite.number != 2 && satellite.number != 4 && satellite.number != 7) return std::nullopt;
        KeplerEphemeris r;
        r.satellite = satellite;
        r.toe = r.toc = to_gps_time(2023, 750.0 * 100);
        r.sqrt_a = 6493;
        r.e = satellite.number == 7 ? 0.0002 : 0.075;
        r.i0 = satellite.number == 7 ? 0.0014 : 0.713;
        r.health = satellite.number == 4 ? 0b100000 : 1;  // L1C/B alone does not count
        r.accuracy_m = satellite.number == 2 ? 8192 : 2;  // that none is predicted, the index tells beside the health
        return r;
    }

private:
    BroadcastIonosphere ionosphere_ = [] {
        BroadcastIonosphere both{KlobucharCoefficients{{std::ldexp(12, -30)}, {}}};
        both.qzss = KlobucharCoefficients{{std::ldexp(11, -30), std::ldexp(-2, -27)}, {std::ldexp(50, 11)}};
        return both;
    }();
};

LnavWords qzss_page(int subframe, int page) {
    static const WithQzss source;
    const GpsTime end = to_gps_time(2023, 750.0 * 100 + (page - 1) * 30 + (subframe == 4 ? 24 : 30));
    return lnav_system_subframe({&source, LeapSeconds::announced(), Constellation::qzss}, subframe, end);
}

TEST(BroadcastLnav, QzssTellsItsOwnIonosphere) {
    const LnavWords words = qzss_page(4, 18);
    EXPECT_EQ(page_data(words, 3), 0xC0u << 16 | 56u << 16 | 11u << 8 | 0xFE);  // data 11, page 56
    EXPECT_EQ(page_data(words, 4) & 0xFF, 50u);
    EXPECT_EQ(page_data(words, 10) >> 16, 18u);
}

TEST(BroadcastLnav, QzssTellsItsOwnAlmanacs) {
    const LnavWords zenith = qzss_page(5, 2), stationary = qzss_page(5, 7);
    EXPECT_EQ(page_data(zenith, 3) >> 16, 0xC0u + 2);
    EXPECT_NEAR(std::ldexp(page_data(zenith, 3) & 0xFFFF, -21), 0.075 - 0.06, 1e-6);
    EXPECT_NEAR(std::ldexp(static_cast<double>(complement(page_data(zenith, 4) & 0xFFFF, 16)), -19),
                0.713 / std::numbers::pi - 0.25, 2e-6);
    EXPECT_EQ(page_data(stationary, 3) >> 16, 0xC0u + 7);
    EXPECT_NEAR(std::ldexp(page_data(stationary, 3) & 0xFFFF, -21), 0.0002, 1e-6);
    EXPECT_NEAR(std::ldexp(page_data(stationary, 4) & 0xFFFF, -19), 0.0014 / std::numbers::pi, 2e-6);
    // Of GPS's pages none: dummies of QZSS are there.
    for (const auto& [subframe, page] : {std::pair{5, 1}, {5, 12}, {4, 2}, {4, 25}})
        EXPECT_EQ(page_data(qzss_page(subframe, page), 3), 0xC0AAAAu) << subframe << ' ' << page;
}

TEST(BroadcastLnav, QzssTellsItsOwnHealth) {
    const LnavWords words = qzss_page(5, 25);
    EXPECT_EQ(page_data(words, 3) >> 16, 0xC0u + 51);
    EXPECT_EQ(page_data(words, 4), 0xFC0FFFu);  // 1 … 4: not there, well, not there, ill
    EXPECT_EQ(page_data(words, 5), 0xFFF03Fu);
}

// Of QZSS a flag, as RINEX has it, or hours beyond two; of GPS hours beyond four.
TEST(BroadcastLnav, FitIntervalIsAFlag) {
    const auto flag = [](Constellation of, double fit) {
        KeplerEphemeris r;
        r.satellite = {of, 2};
        r.fit_interval_h = fit;
        return page_data(lnav_ephemeris_subframe(r, 2, to_gps_time(2300, 12.0)), 10) >> 7 & 1;
    };
    EXPECT_EQ(flag(Constellation::gps, 0), 0u);
    EXPECT_EQ(flag(Constellation::gps, 1), 0u);
    EXPECT_EQ(flag(Constellation::gps, 4), 0u);
    EXPECT_EQ(flag(Constellation::gps, 6), 1u);
    EXPECT_EQ(flag(Constellation::qzss, 0), 0u);
    EXPECT_EQ(flag(Constellation::qzss, 1), 1u);
    EXPECT_EQ(flag(Constellation::qzss, 2), 0u);
    EXPECT_EQ(flag(Constellation::qzss, 4), 1u);
}

TEST(BroadcastLnav, QzssHasL2cAlone) {
    KeplerEphemeris r;
    r.satellite = {Constellation::qzss, 2};
    LnavWords words = lnav_ephemeris_subframe(r, 1, to_gps_time(2300, 6.0));
    EXPECT_EQ(page_data(words, 3) >> 12 & 3, 2u);
    EXPECT_EQ(page_data(words, 4) >> 23, 1u);
    r.satellite.constellation = Constellation::gps;
    words = lnav_ephemeris_subframe(r, 1, to_gps_time(2300, 6.0));
    EXPECT_EQ(page_data(words, 3) >> 12 & 3, 1u);
    EXPECT_EQ(page_data(words, 4) >> 23, 0u);
}

// Bits of a string are numbered from 85 down to 1.
std::uint32_t bit_of(const GlonassWords& string, int number) {
    const auto at = static_cast<std::size_t>(85 - number);
    return string[at / 32] >> (31 - at % 32) & 1;
}

TEST(BroadcastGlonass, CheckBitsAreAHammingCode) {
    const GlonassWords ours = glonass_string({}, 5, to_gps_time(2023, 150000.0 + 18), LeapSeconds::announced());
    unsigned places = 0, ones = 0, place = 2;
    const auto bit = [&ours](int number) { return bit_of(ours, number); };
    for (int number = 9; number <= 85; ++number) {
        do
            ++place;
        while (std::has_single_bit(place));
        places ^= bit(number) != 0 ? place : 0;
    }
    for (int number = 1; number <= 85; ++number)
        ones += bit(number);
    for (int number = 1; number <= 7; ++number)
        EXPECT_EQ(bit(number), places >> (number - 1) & 1) << number;
    EXPECT_EQ(ones % 2, 0u);
}

// As seven satellites did in the capture of a NEO-M8P (receivers/galway_20181015_m8p_static).
TEST(BroadcastGlonass, TellsANewTimeOfReferenceOnceAndTheAlmanacsOfAFrame) {
    const LeapSeconds& leap = LeapSeconds::announced();
    const GpsTime half_hour = to_gps_time(2023, 151200.0 + 18);
    for (int frame = 0; frame < 10; ++frame) {
        const GpsTime begin = half_hour + frame * std::chrono::seconds(30);
        const GlonassWords first = glonass_string({}, 1, begin + std::chrono::seconds(2), leap);
        EXPECT_EQ(bit_of(first, 77), frame == 0 ? 1U : 0U) << "P1 of frame " << frame;
        EXPECT_EQ(bit_of(first, 78), 0U);
        const GlonassWords third = glonass_string({}, 3, begin + std::chrono::seconds(6), leap);
        EXPECT_EQ(bit_of(third, 80), frame % 5 == 4 ? 0U : 1U) << "P3 of frame " << frame;
    }
}

TEST(BroadcastGlonass, StringsFollowTheMoscowDay) {
    const LeapSeconds& leap = LeapSeconds::announced();
    // 18 s after a whole half minute of GPS time one of GLONASS begins.
    const GpsTime frame = to_gps_time(2023, 150000.0 + 18);
    EXPECT_EQ(glonass_string_ending(frame, leap), 15);
    EXPECT_EQ(glonass_string_ending(frame + std::chrono::seconds(2), leap), 1);
    EXPECT_FALSE(glonass_string_ending(frame + std::chrono::seconds(1), leap));
    EXPECT_FALSE(glonass_string_ending(frame + std::chrono::milliseconds(2500), leap));
}

TEST(BroadcastMessages, TakeWhateverARecordHolds) {
    const double worst[] = {0,
                            1e300,
                            -1e300,
                            std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity()};
    const BroadcastIonosphere none;
    for (const double value : worst) {
        KeplerEphemeris r;
        for (double KeplerEphemeris::*field :
             {&KeplerEphemeris::sqrt_a, &KeplerEphemeris::e, &KeplerEphemeris::i0, &KeplerEphemeris::idot,
              &KeplerEphemeris::omega0, &KeplerEphemeris::omega, &KeplerEphemeris::omega_dot, &KeplerEphemeris::m0,
              &KeplerEphemeris::delta_n, &KeplerEphemeris::cuc, &KeplerEphemeris::crs, &KeplerEphemeris::af0,
              &KeplerEphemeris::af1, &KeplerEphemeris::af2, &KeplerEphemeris::tgd, &KeplerEphemeris::accuracy_m})
            r.*field = value;
        r.iode = r.iodc = r.health = -1;
        GlonassEphemeris g;
        g.position_m = g.velocity_mps = g.acceleration_mps2 = {value, value, value};
        g.clock_bias = g.clock_drift = g.group_delay_l2 = g.accuracy_m = value;
        const GpsTime end = to_gps_time(2023, 600.0);
        for (int i = 1; i <= 3; ++i) {
            const LnavWords words = lnav_ephemeris_subframe(r, i, end);
            EXPECT_EQ(words[0] >> 22, 0x8Bu);
            // It ends in 00, which stands inverted where the word before ends in 1.
            EXPECT_TRUE((words[9] & 3) == 0 || (words[9] & 3) == 3);
            EXPECT_EQ(d1_subframe(r, std::nullopt, i, end)[0] >> 19, 0b11100010010u);
        }
        for (int i = 1; i <= 5; ++i)
            EXPECT_EQ(glonass_string(g, i, end, LeapSeconds::announced())[0] >> 27, static_cast<std::uint32_t>(i));
        for (int page = 1; page <= d2_page_count; ++page)
            EXPECT_EQ(d2_page(r, std::nullopt, page, end)[0] >> 19, 0b11100010010u);
        for (int type : {10, 11, 30, 33})
            EXPECT_EQ(cnav_message({r, none, LeapSeconds::announced()}, type, Signal::l5, end)[0] >> 24, 0x8Bu);
        for (int page = 1; page <= 6; ++page)
            EXPECT_EQ(fnav_page({r, none, LeapSeconds::announced()}, page, end)[0] >> 26,
                      static_cast<std::uint32_t>(page));
        EXPECT_FALSE(glonass_almanac(g, end, LeapSeconds::announced()));
        for (int i : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 16, 17, 18, 19, 20, 63})
            EXPECT_EQ(inav_pages({r, none, LeapSeconds::announced()}, i, end)[0] >> 24, static_cast<std::uint32_t>(i));
    }
}

// E1-B has its words a second later than E5b-I, in another order (OS SIS ICD, tables 37 and 38).
TEST(BroadcastInav, WordsFollowTheSubframe) {
    const GpsTime start = to_gps_time(2300, 3000.0);
    const auto second = [start](int count) { return start + std::chrono::seconds(count); };
    std::vector<int> e1, e5b;
    for (int pair = 1; pair <= 15; ++pair) {
        e1.push_back(inav_word_ending(Signal::l1, second(2 * pair + 1)).value());
        e5b.push_back(inav_word_ending(Signal::e5b, second(2 * pair)).value());
    }
    EXPECT_EQ(e1, (std::vector{2, 4, 6, 7, 8, 17, 19, 16, 0, 0, 1, 3, 5, 0, 16}));
    EXPECT_EQ(e5b, (std::vector{1, 3, 5, 7, 8, 0, 0, 0, 0, 0, 2, 4, 6, 0, 0}));
    // As a receiver in Besançon heard them: in the other half of a minute the words that come by turns.
    e1.clear();
    for (int pair = 16; pair <= 30; ++pair)
        e1.push_back(inav_word_ending(Signal::l1, second(2 * pair + 1)).value());
    EXPECT_EQ(e1, (std::vector{2, 4, 6, 9, 10, 18, 20, 16, 0, 0, 1, 3, 5, 0, 16}));
    EXPECT_FALSE(inav_word_ending(Signal::l1, second(2)));
    EXPECT_FALSE(inav_word_ending(Signal::e5b, second(1)));
    EXPECT_FALSE(inav_word_ending(Signal::l1, second(1) + std::chrono::milliseconds(500)));
}

// The last word of E1-B of a week ends a second into the next.
TEST(BroadcastInav, WordsOverTheTurnOfAWeek) {
    EXPECT_EQ(inav_word_ending(Signal::l1, to_gps_time(2300, 1.0)), 16);
    EXPECT_EQ(inav_word_ending(Signal::l1, to_gps_time(2300, 3.0)), 2);
    EXPECT_EQ(inav_word_ending(Signal::e5b, to_gps_time(2300, 2.0)), 1);
}

// A field of a word, which lies across the border of the pages: even bits 2 … 113, then odd ones from 2 on.
std::uint32_t inav_field(const InavWords& pages, int first, int width) {
    std::uint32_t value = 0;
    for (int place = first; place < first + width; ++place) {
        const int at = place < 112 ? place + 2 : place - 112 + 128 + 2;
        value = value << 1 | (pages[static_cast<std::size_t>(at / 32)] >> (31 - at % 32) & 1);
    }
    return value;
}

// Δt_LS, WN_LSF, DN and Δt_LSF of word 6 (OS SIS ICD 2.0, table 45): the leap second of Saturday 2016-12-31, in GST
// week 905, is announced half a year before and told of ever after.
TEST(BroadcastInav, AnnouncesLeapSeconds) {
    const BroadcastIonosphere none;
    const KeplerEphemeris record;
    const auto told = [&](const UtcTime& when) {
        const GpsTime end = to_gps_time(when, LeapSeconds::announced());
        const InavWords pages = inav_pages({record, none, LeapSeconds::announced()}, 6, end);
        std::vector<std::uint32_t> fields;
        for (const auto& [first, width] : {std::pair(62, 8), std::pair(86, 8), std::pair(94, 3), std::pair(97, 8)})
            fields.push_back(inav_field(pages, first, width));
        return fields;
    };
    EXPECT_EQ(told({2016, 12, 1, 0, 0, 0}), (std::vector<std::uint32_t>{17, 905 % 256, 7, 18}));
    EXPECT_EQ(told({2024, 3, 1, 0, 0, 0}), (std::vector<std::uint32_t>{18, 905 % 256, 7, 18}));
    EXPECT_EQ(told({2016, 5, 1, 0, 0, 0}), (std::vector<std::uint32_t>{17, 1851 - 1024 - 768, 3, 17}));
}

// As a ZED-F9P in Besançon received them: the times of the words on E1-B are odd, word 5 at 25 s of 30, word 6 at 5 s.
TEST(BroadcastInav, TimesOfE1AreOdd) {
    const BroadcastIonosphere none;
    const KeplerEphemeris record;
    int told = 0;
    for (int second = 1; second <= 60; ++second) {
        const GpsTime end = to_gps_time(2300, 3000.0 + second);
        const std::optional<int> word = inav_word_ending(Signal::l1, end);
        if (word != 5 && word != 6) continue;
        const InavWords pages = inav_pages({record, none, LeapSeconds::announced()}, *word, end);
        const std::uint32_t tow = inav_field(pages, *word == 5 ? 85 : 105, 20);
        EXPECT_EQ(tow % 30, *word == 5 ? 25u : 5u);
        ++told;
    }
    EXPECT_EQ(told, 4);
}

}  // namespace
}  // namespace skyloop
