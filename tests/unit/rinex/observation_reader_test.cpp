#include "world/rinex/observation_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/time/utc_time.hpp"
#include "observation_text.hpp"

namespace skyloop::test {
namespace {

using ::testing::HasSubstr;

const GpsTime noon = gps_calendar_time(2024, 3, 5, 12, 0, 0);
constexpr SatelliteId g07{Constellation::gps, 7};

ObservationFile read_or_fail(std::string_view text) {
    auto file = read_observations(text, "a.obs");
    EXPECT_TRUE(file) << (file ? "" : file.error().message);
    return file ? *file : ObservationFile{};
}
std::string error_of(std::string_view text) {
    const auto file = read_observations(text, "a.obs");
    return file ? "" : file.error().message;
}

TEST(ObservationReader, ReadsVersion3) {
    const std::string text =
        observation_header("3.04",
                           label_line("BASE 1", "MARKER NAME") +
                               label_line("  3774710.6090  -596674.3489  5089490.7357", "APPROX POSITION XYZ") +
                               label_line("        1.0530        0.0020        0.0030", "ANTENNA: DELTA H/E/N") +
                               types_line("G    4 C1C L1C D1C S1C") + types_line("R    2 C1C L1C") +
                               label_line("     0.500", "INTERVAL") + label_line("  1 R03  5", "GLONASS SLOT / FRQ #") +
                               label_line("    18    18  2185     7", "LEAP SECONDS")) +
        epoch_line(0.25, 2) + "R03" + observed(20000000.125, ' ', '6') + observed(107000000.25, '3', '6') + "\nG 7" +
        observed(21000000.5) + observed(110000000.75, '1', '7') + observed(-1234.5) + observed(45.25) + "\n";
    const ObservationFile file = read_or_fail(text);
    EXPECT_EQ(file.version, 3.04);
    EXPECT_EQ(file.marker, "BASE 1");
    EXPECT_EQ(file.approximate_position->vector(), Eigen::Vector3d(3774710.6090, -596674.3489, 5089490.7357));
    EXPECT_EQ(file.antenna_delta.height.value(), 1.053);
    EXPECT_EQ(file.antenna_delta.east.value(), 0.002);
    EXPECT_EQ(file.antenna_delta.north.value(), 0.003);
    EXPECT_EQ(file.interval->value(), 0.5);
    EXPECT_EQ(file.leap_seconds, 18);
    EXPECT_EQ(file.glonass_channels, (std::map<int, int>{{3, 5}}));
    EXPECT_TRUE(file.warnings.empty());
    ASSERT_EQ(file.epochs.size(), 1u);
    EXPECT_EQ(file.epochs[0].receive_time, noon + std::chrono::milliseconds(250));
    ASSERT_EQ(file.epochs[0].signals.size(), 2u);
    const Observation& g = file.epochs[0].signals[0];
    EXPECT_EQ(g.satellite, g07);
    EXPECT_EQ(g.pseudorange->value(), 21000000.5);
    EXPECT_EQ(g.carrier_phase, 110000000.75);
    EXPECT_EQ(g.doppler->value(), -1234.5);
    EXPECT_EQ(g.cn0.value(), 45.25);
    EXPECT_TRUE(g.slipped && g.half_cycle_resolved);
    const Observation& r = file.epochs[0].signals[1];
    EXPECT_EQ(to_string(r.satellite), "R03");
    EXPECT_TRUE(r.slipped && !r.half_cycle_resolved);
    EXPECT_EQ(r.cn0.value(), 39) << "strength digit 6: 36 to 41 dB-Hz";
    EXPECT_EQ(r.carrier.value(), 1602e6 + 5 * 562.5e3);
    EXPECT_FALSE(r.doppler);
}

// To a run's last day.
TEST(ObservationReader, ReadsTheYearsThatARunMayHave) {
    const auto epochs_of = [](std::string_view date) {
        const std::string text = observation_header("3.04", types_line("G    1 C1C")) + "> " + std::string(date) +
                                 " 12 00  0.0000000  0  1\nG 7" + observed(21000000.5) + "\n";
        const auto file = read_observations(text, "a.obs");
        return file ? file->epochs.size() : 0;
    };
    for (const char* date : {"1980 01 06", "2099 12 31", "2100 01 01", "2269 12 30"})
        EXPECT_EQ(epochs_of(date), 1u) << date;
    for (const char* date : {"1979 12 31", "2270 01 01"})
        EXPECT_EQ(epochs_of(date), 0u) << date;
}

TEST(ObservationReader, TakesTheFirstCodeThatHasAPseudorange) {
    const std::string text = observation_header("3.04", types_line("G    6 C1W L1W C1C L1C C2W C2L")) +
                             epoch_line(0, 2) + "G07" + observed(1e7) + observed(5) + observed(2e7) + observed(6) +
                             observed(3e7) + observed(4e7) + "\nG08" + observed(1e7) + observed(5) + not_observed() +
                             observed(6) + observed(3e7) + "\n";
    const ObservationFile file = read_or_fail(text);
    const auto& s = file.epochs.at(0).signals;
    ASSERT_EQ(s.size(), 4u);
    EXPECT_EQ(s[0].pseudorange->value(), 2e7);
    EXPECT_EQ(s[0].carrier_phase, 6);
    EXPECT_EQ(s[1].signal, Signal::l2);
    EXPECT_EQ(s[1].pseudorange->value(), 4e7);
    EXPECT_EQ(s[2].pseudorange->value(), 1e7);
    EXPECT_EQ(s[2].carrier_phase, 5);
    EXPECT_EQ(s[3].pseudorange->value(), 3e7);
}

TEST(ObservationReader, FindsB1IInEveryVersion) {
    for (const auto& [version, types] : {std::pair("3.01", "C    1 C2I"), std::pair("3.02", "C    1 C1I"),
                                         std::pair("3.02", "C    1 C1X"), std::pair("3.04", "C    1 C2X")}) {
        const ObservationFile file =
            read_or_fail(observation_header(version, types_line(types)) + epoch_line(0, 1) + "C11" + observed(2e7));
        ASSERT_EQ(file.epochs.at(0).signals.size(), 1u) << version << types;
        EXPECT_EQ(file.epochs[0].signals[0].signal, Signal::b1i);
    }
    // From 3.03 on C1X is B1C.
    EXPECT_TRUE(
        read_or_fail(observation_header("3.04", types_line("C    1 C1X")) + epoch_line(0, 1) + "C11" + observed(2e7))
            .epochs.at(0)
            .signals.empty());
}

TEST(ObservationReader, ReadsVersion2WithContinuedLines) {
    std::string list, rows;
    for (int i = 1; i <= 14; ++i) {
        list += fmt::format("{}{:02}", i == 1 ? ' ' : 'G', i);
        if (i == 12) list += "\n" + std::string(32, ' ');
        rows += observed(110000000.0 + i, '1', '5') + not_observed() + observed(2e7) + observed(3e7 + i) +
                (i == 3 ? observed(0) : observed(2e7 + i)) + "\n" + observed(40.0 + i) + "\n";
    }
    const ObservationFile file =
        read_or_fail(observation_header("2.11", types_line_2("     6    L1    L2    P1    P2    C1    S1"), 'G') +
                     epoch_line_2(0, 14, list) + rows + epoch_line_2(1, 1, "G07") + "\n" + observed(33) + "\n");
    ASSERT_EQ(file.epochs.size(), 2u);
    const auto& s = file.epochs[0].signals;
    ASSERT_EQ(s.size(), 28u);
    EXPECT_EQ(s[0].satellite, (SatelliteId{Constellation::gps, 1}));
    EXPECT_EQ(s[0].pseudorange->value(), 2e7 + 1);
    EXPECT_EQ(s[1].signal, Signal::l2);
    EXPECT_EQ(s[1].pseudorange->value(), 3e7 + 1);
    EXPECT_EQ(s[4].pseudorange->value(), 2e7) << "C1 is 0, so P1";
    EXPECT_EQ(s[26].cn0.value(), 54);
    EXPECT_TRUE(s[26].slipped);
    EXPECT_TRUE(file.epochs[1].signals.empty()) << "a strength alone is no measurement";
}

TEST(ObservationReader, FollowsEvents) {
    const std::string g = "G07" + observed(2e7) + observed(1e8) + "\n";
    const std::string text = observation_header("3.04", types_line("G    2 C1C L1C")) + epoch_line(0, 1) + g +
                             epoch_line(1, 1) + g + ">                              3  1\n" +
                             label_line("NEXT", "MARKER NAME") +  //
                             epoch_line(2, 1, 1) + g + epoch_line(3, 1) + g + epoch_line(3.5, 1, 6) + "G07\n" +
                             ">                              4  1\n" + types_line("G    2 L1C C1C") + epoch_line(4, 1) +
                             "G07" + observed(1e8) + observed(2e7) + "\n";
    const ObservationFile file = read_or_fail(text);
    ASSERT_EQ(file.epochs.size(), 5u);
    EXPECT_EQ(file.events, 2);
    EXPECT_EQ(file.marker, "NEXT");
    std::vector<bool> slipped;
    std::vector<double> lock;
    for (const Observations& epoch : file.epochs) {
        ASSERT_EQ(epoch.signals.size(), 1u);
        EXPECT_EQ(epoch.signals[0].pseudorange->value(), 2e7);
        slipped.push_back(epoch.signals[0].slipped);
        lock.push_back(epoch.signals[0].lock_time.value());
    }
    EXPECT_EQ(slipped, (std::vector<bool>{false, false, true, false, true})) << "power failure; slip record";
    EXPECT_EQ(lock, (std::vector<double>{0, 1, 0, 1, 0}));
    EXPECT_TRUE(file.warnings.empty()) << file.warnings[0];
}

TEST(ObservationReader, KnowsTimeSystems) {
    const auto time_of = [](std::string_view system) {
        const std::string first = fmt::format("  2024     3     5    12     0    0.0000000     {}", system);
        return read_or_fail(
                   observation_header("3.04", types_line("G    1 C1C") + label_line(first, "TIME OF FIRST OBS")) +
                   epoch_line(0, 0))
            .epochs.at(0)
            .receive_time;
    };
    EXPECT_EQ(time_of("GPS"), noon);
    EXPECT_EQ(time_of("GAL"), noon);
    EXPECT_EQ(time_of("BDT"), noon + std::chrono::seconds(14));
    EXPECT_EQ(time_of("GLO"), noon + std::chrono::seconds(18));
}

TEST(ObservationReader, DividesByScaleFactors) {
    const ObservationFile file = read_or_fail(
        observation_header("3.04", types_line("G    2 C1C L1C") + label_line("G  100  1 L1C", "SYS / SCALE FACTOR")) +
        epoch_line(0, 1) + "G07" + observed(2e7) + observed(1e9));
    EXPECT_EQ(file.epochs.at(0).signals.at(0).pseudorange->value(), 2e7);
    EXPECT_EQ(file.epochs.at(0).signals.at(0).carrier_phase, 1e7);
}

TEST(ObservationReader, ScaleFactorsNameTheirTypes) {
    const auto scaled = [](const std::string& factor) {
        return read_or_fail(
            observation_header("3.04", types_line("G    2 C1C L1C") + label_line(factor, "SYS / SCALE FACTOR")) +
            epoch_line(0, 1) + "G07" + observed(2e7) + observed(1e9));
    };
    EXPECT_EQ(scaled("G  10  1 C1C").epochs.at(0).signals.at(0).pseudorange->value(), 2e6);
    EXPECT_EQ(scaled("G   10").epochs.at(0).signals.at(0).carrier_phase, 1e8);
    const ObservationFile strange = scaled("G   10   2 C5Q");
    EXPECT_EQ(strange.epochs.at(0).signals.at(0).pseudorange->value(), 2e7);
    ASSERT_EQ(strange.warnings.size(), 2u);
    EXPECT_NE(strange.warnings[0].find("found 1 observation types; expected as many as their count"),
              std::string::npos);
    EXPECT_NE(strange.warnings[1].find("found 'C5Q'; expected an observation type of gps"), std::string::npos);
}

TEST(ObservationReader, AnEpochThatRanAheadCostsNoOther) {
    const std::string good = "G07" + observed(2e7) + observed(1e8) + "\n";
    const std::string head = observation_header("3.04", types_line("G    2 C1C L1C"));
    const ObservationFile middle = read_or_fail(head + epoch_line(0, 1) + good + epoch_line(50, 1) + good +
                                                epoch_line(2, 1) + good + epoch_line(3, 1) + good);
    EXPECT_EQ(middle.epochs.size(), 3u);
    EXPECT_EQ(middle.skipped.unordered, 1u);
    const ObservationFile first = read_or_fail(head + epoch_line(50, 1) + good + epoch_line(1, 1) + good +
                                               epoch_line(2, 1) + good + epoch_line(3, 1) + good);
    EXPECT_EQ(first.epochs.size(), 2u);  // the one that went back costs itself, too
    EXPECT_EQ(difference(first.epochs[1].receive_time, first.epochs[0].receive_time), Seconds(1));
    ASSERT_FALSE(first.warnings.empty());
}

TEST(ObservationReader, CountsWhatItPassesOver) {
    const std::string good = "G07" + observed(2e7) + observed(1e8) + "\n";
    const std::string text = observation_header("3.04", types_line("G    2 C1C L1C")) + epoch_line(0, 1) + good +  //
                             epoch_line(1, 3) + good + good + "E05" + observed(2e7) + "\n" +  // 6: repeated, undeclared
                             epoch_line(2, 1) + "G07  2000x000.000  " + observed(1e8) + "\n" +  // 10
                             epoch_line(3, 2) + good +                                          // 12
                             "> 2024 13 05 12 00  4.0000000  0  1\n" + good + epoch_line(1, 1) + good +
                             epoch_line(5, 1) + good;
    const ObservationFile file = read_or_fail(text);
    EXPECT_EQ(file.epochs.size(), 5u);
    EXPECT_EQ(file.skipped, (SkippedObservations{1, 1, 1, 2, 1}));
    ASSERT_EQ(file.warnings.size(), 5u);
    EXPECT_EQ(
        file.warnings[0],
        "a.obs:14: found '> 2024 13 05 12 00  4.0000000  0  1'; expected the first line of an epoch with time, flag "
        "and count; epoch skipped");
    EXPECT_EQ(file.warnings[3],
              "a.obs:8: found 'G07'; expected each satellite once an epoch; satellite skipped, and 1 "
              "more likewise");
    EXPECT_EQ(file.warnings[4],
              "a.obs:11: found '2000x000.000'; expected a pseudorange in metres of G07; taken as not measured");
    EXPECT_FALSE(file.epochs[2].signals.at(0).pseudorange);
}

TEST(ObservationReader, RefusesOtherFiles) {
    EXPECT_EQ(error_of(""),
              "a.obs:1: found an empty file; expected observations (RINEX 2.00-2.12, 3.00-3.05 or "
              "4.00-4.02)");
    EXPECT_EQ(error_of(label_line("3.0                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE")),
              "a.obs:1: found the end of the file within the header; expected a whole compact RINEX file");
    EXPECT_THAT(error_of(label_line("     3.04           N: GNSS NAV DATA    M", "RINEX VERSION / TYPE")),
                HasSubstr("a.obs:1: found file type 'N'"));
    EXPECT_THAT(error_of(label_line("     5.00           OBSERVATION DATA    M", "RINEX VERSION / TYPE")),
                HasSubstr("found RINEX version '5.00'"));
    EXPECT_THAT(error_of("hello\n"), HasSubstr("a.obs:1: found 'hello'; expected a RINEX header"));
    EXPECT_THAT(error_of(observation_header("3.04", "")), HasSubstr("a.obs:2: found the end of the header; expected "
                                                                    "'SYS / # / OBS TYPES' before it"));
    EXPECT_THAT(error_of(observation_header("3.04", types_line("G    1 C1C"))), HasSubstr("no epoch"));
    EXPECT_THAT(error_of(observation_header("3.04", types_line("G    1 C1C")).substr(0, 100)),
                HasSubstr("the end of the file within the header"));
    EXPECT_EQ(read_observation_file("/nowhere/a.obs").error().code, ErrorCode::outside);
}

TEST(ObservationReader, WarnsOfTypesThatAreMissing) {
    const ObservationFile file = read_or_fail(observation_header("3.04", types_line("G    3 C1C L1C")) +
                                              epoch_line(0, 1) + "G07" + observed(2e7));
    ASSERT_EQ(file.warnings.size(), 1u);
    EXPECT_EQ(file.warnings[0], "a.obs: found 2 observation types of gps; expected the 3 announced");
}

}  // namespace
}  // namespace skyloop::test
