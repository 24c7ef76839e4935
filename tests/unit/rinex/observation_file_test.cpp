#include "world/rinex/rinex_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"
#include "world/rinex/observation_reader.hpp"

namespace skyloop::test {
namespace {

const GpsTime first_instant = gps_calendar_time(2024, 3, 5, 12, 0, 0);

ObservationHeader two_systems() {
    ObservationHeader header;
    header.approximate_position = Position<Ecef>(3782096.1791, -2248555.9434, 4601986.9856);
    header.signals = {{Constellation::gps, {Signal::l1, Signal::l2}}, {Constellation::glonass, {Signal::g1}}};
    header.first_epoch = first_instant;
    header.interval = Seconds(0.2);
    header.program = "skyloop 9.9.9";
    header.receiver = "ublox-f9p";
    for (int slot = 1; slot <= 9; ++slot)
        header.glonass_channels[slot] = slot - 5;
    return header;
}

Observation measured(Constellation system, int number, Signal signal) {
    Observation o;
    o.satellite = {system, number};
    o.signal = signal;
    o.carrier = carrier_frequency(signal);
    o.cn0 = DbHz(43.5);
    o.pseudorange = Metres(21234567.8904);
    o.carrier_phase = -110000000.7656;
    o.doppler = Hertz(-1234.5678);
    return o;
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
        lines.push_back(text.substr(at, text.find('\n', at) - at));
    return lines;
}

TEST(ObservationWriter, WritesTheHeader) {
    const auto lines = split(ObservationWriter(two_systems()).header());
    for (const std::string& line : lines)
        EXPECT_EQ(line.size(), 80u) << line;
    EXPECT_THAT(lines, ::testing::IsSupersetOf(
                           {"     3.04           OBSERVATION DATA    M: MIXED            RINEX VERSION / TYPE",
                            "skyloop 9.9.9                           20240305 115942 UTC PGM / RUN BY / DATE ",
                            "  3782096.1791 -2248555.9434  4601986.9856                  APPROX POSITION XYZ ",
                            "G    8 C1C L1C D1C S1C C2L L2L D2L S2L                      SYS / # / OBS TYPES ",
                            "R    4 C1C L1C D1C S1C                                      SYS / # / OBS TYPES ",
                            "     0.200                                                  INTERVAL            ",
                            "  2024     3     5    12     0    0.0000000     GPS         TIME OF FIRST OBS   ",
                            "G L2L  0.00000                                              SYS / PHASE SHIFT   ",
                            "  9 R01 -4 R02 -3 R03 -2 R04 -1 R05  0 R06  1 R07  2 R08  3 GLONASS SLOT / FRQ #",
                            "    R09  4                                                  GLONASS SLOT / FRQ #",
                            " C1C    0.000 C1P    0.000 C2C    0.000 C2P    0.000        GLONASS COD/PHS/BIS ",
                            "    18                                                      LEAP SECONDS        "}));
    EXPECT_EQ(lines.back().substr(60, 13), "END OF HEADER");
}

TEST(ObservationWriter, WritesAnEpoch) {
    Observation l1 = measured(Constellation::gps, 7, Signal::l1);
    l1.slipped = true;
    l1.half_cycle_resolved = false;
    Observation l2 = measured(Constellation::gps, 8, Signal::l2);
    l2.carrier_phase.reset();
    l2.cn0 = DbHz(60);
    Observation g1 = measured(Constellation::glonass, 3, Signal::g1);
    g1.doppler.reset();
    g1.cn0 = DbHz(5);
    const ObservationWriter writer(two_systems());
    const Observations epoch{first_instant + std::chrono::nanoseconds(200'000'049),
                             false,
                             {l1, l2, measured(Constellation::galileo, 1, Signal::l1), g1}};
    EXPECT_EQ(writer.epoch(epoch),
              "> 2024 03 05 12 00  0.2000000  0  3\n"
              "G07  21234567.890 7-110000000.76637     -1234.568          43.500\n"
              "G08                                                                  21234567.890 9                     "
              "-1234.568          60.000\n"
              "R03  21234567.890 1-110000000.766 1                         5.000\n");
}

TEST(ObservationWriter, RoundsTimeAcrossTheMinute) {
    const ObservationWriter writer(two_systems());
    EXPECT_EQ(writer.epoch({first_instant + std::chrono::nanoseconds(59'999'999'960), false, {}}),
              "> 2024 03 05 12 01  0.0000000  0  0\n");
    EXPECT_EQ(writer.epoch({first_instant + std::chrono::nanoseconds(9'123'456'749), false, {}}),
              "> 2024 03 05 12 00  9.1234567  0  0\n");
}

TEST(ObservationWriter, LeavesBlankWhatHasNoRoom) {
    Observation o = measured(Constellation::gps, 7, Signal::l1);
    o.carrier_phase = 1e11;
    o.doppler = Hertz(std::numeric_limits<double>::quiet_NaN());
    o.pseudorange = Metres(-0.0001);
    const std::string text = ObservationWriter(two_systems()).epoch({first_instant, false, {o}});
    EXPECT_EQ(split(text).at(1), "G07         0.000 7" + std::string(32, ' ') + "        43.500");
}

TEST(ObservationWriter, DropsSignalsThatASystemDoesNotSend) {
    ObservationHeader header = two_systems();
    header.signals = {{Constellation::gps, {Signal::b1i}}, {Constellation::galileo, {Signal::l1, Signal::g1}}};
    const std::string text = ObservationWriter(header).header();
    EXPECT_THAT(text, ::testing::HasSubstr("E    4 C1C L1C D1C S1C"));
    EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("\nG ")));
    EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("GLONASS")));
}

// What the reader takes from real receivers comes back from the writer the same.
TEST(ObservationWriter, LosesNothingOfRealFiles) {
    SKYLOOP_REQUIRE_SHARED(root, "receivers");
    for (const char* path : {"tlse_20240101/TLSE00FRA_R_20240011200_15M_01S_MO.rnx.gz", "areq_20100115/areq015o.10o.gz",
                             "galway_20181015_m8p_static/galway.obs.gz"}) {
        const auto file = read_observation_file(root / path);
        ASSERT_TRUE(file);
        ObservationHeader header;
        header.first_epoch = file->epochs[0].receive_time;
        header.glonass_channels = file->glonass_channels;
        for (std::size_t c = 0; c < constellation_names.size(); ++c) {
            const auto signals = emulated_signals(static_cast<Constellation>(c));
            header.signals[static_cast<Constellation>(c)] = {signals.begin(), signals.end()};
        }
        const ObservationWriter writer(header);
        std::string text = writer.header();
        for (const Observations& epoch : file->epochs)
            text += writer.epoch(epoch);
        const auto again = read_observations(text, "written");
        ASSERT_TRUE(again) << again.error().message;
        EXPECT_EQ(again->skipped, SkippedObservations{});
        EXPECT_EQ(again->glonass_channels, file->glonass_channels);
        ASSERT_EQ(again->epochs.size(), file->epochs.size());
        std::size_t different = 0;
        for (std::size_t i = 0; i < file->epochs.size(); ++i) {
            const auto& a = file->epochs[i];
            const auto& b = again->epochs[i];
            ASSERT_TRUE(a.receive_time == b.receive_time && a.signals.size() == b.signals.size()) << path << i;
            for (std::size_t k = 0; k < a.signals.size(); ++k) {
                const Observation &x = a.signals[k], &y = b.signals[k];
                different += x.satellite != y.satellite || x.signal != y.signal || x.pseudorange != y.pseudorange ||
                             x.carrier_phase != y.carrier_phase || x.doppler != y.doppler || x.cn0 != y.cn0 ||
                             x.slipped != y.slipped || x.half_cycle_resolved != y.half_cycle_resolved ||
                             x.lock_time != y.lock_time || x.carrier != y.carrier;
            }
        }
        EXPECT_EQ(different, 0u) << path;
    }
}

}  // namespace
}  // namespace skyloop::test
