// CNAV and its like of RINEX 4: orbits with two rates, which serve where no legacy message does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"
#include "navigation_text.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop {
namespace {

std::string number_lines(std::initializer_list<std::array<double, 4>> lines) {
    std::string text;
    for (const auto& line : lines) {
        text += "    ";
        for (const double value : line)
            text += test::field(value);
        text += "\n";
    }
    return text;
}

// Of G01 in October 2022 the file has CNAV and LNAV of neighbouring hours: the same orbit, to some decimetres.
TEST(ModernRecords, CnavIsTheOrbitOfLnav) {
    SKYLOOP_REQUIRE_SHARED(path, "nav/odd/Example_GPS_Rinex400.n");
    const auto file = read_navigation_file(path);
    ASSERT_TRUE(file);
    std::vector<KeplerEphemeris> legacy, modern;
    for (const Ephemeris& any : file->records) {
        const auto& r = std::get<KeplerEphemeris>(any);
        if (r.satellite.number == 1) (r.message == NavigationMessage::modern ? modern : legacy).push_back(r);
    }
    ASSERT_EQ(legacy.size(), 2u);
    ASSERT_EQ(modern.size(), 2u);
    EXPECT_DOUBLE_EQ(modern[0].axis_rate, -5.971431732178e-03);
    EXPECT_DOUBLE_EQ(modern[0].delta_n_rate, 6.631309981839e-14);
    EXPECT_EQ(modern[0].toe, modern[0].toc);
    EXPECT_EQ(modern[0].accuracy_m, 1.7) << "index −1";
    for (int minutes = -20; minutes <= 20; minutes += 10) {
        const GpsTime time = modern[0].toe + std::chrono::minutes(30 + minutes);
        const SatelliteState is = satellite_state(legacy[1], time), said = satellite_state(modern[0], time);
        EXPECT_LT((is.position.vector() - said.position.vector()).norm(), 3) << minutes;
        EXPECT_LT((is.velocity.vector() - said.velocity.vector()).norm(), 0.001) << minutes;
        EXPECT_NEAR(is.clock_bias, said.clock_bias, 3e-9);
        const SatelliteState later = satellite_state(modern[0], time + std::chrono::seconds(1));
        const Eigen::Vector3d moved = later.position.vector() - said.position.vector();
        EXPECT_LT((moved - 0.5 * (later.velocity.vector() + said.velocity.vector())).norm(), 1e-3);
    }
}

// A file of CNAV-2 alone, and BeiDou's B-CNAV1 and 3.
TEST(ModernRecords, FilesWithoutLegacyMessagesServeOrbits) {
    const std::string body = number_lines({{2e-3, 1, 4.6e-9, 1.9},
                                           {1e-8, 3.3e-4, 8.4e-6, 5153.8},
                                           {180000, -5e-9, 0.5, 2e-8},
                                           {0.96, 217, -1.7, -8e-9},
                                           {-3e-10, -1.3e-14, 0, 180000}});
    const std::string epoch = " 2024 03 05 02 00 00" + test::field(1e-4) + test::field(7e-12) + test::field(0) + "\n";
    const std::string gps = number_lines({{-3, 0, 9.999e9, 5}, {0, 0, 0, 0}, {0, 0, 0, 0}, {180000, 2304, 0, 0}});
    const std::string beidou = number_lines({{0, 0, 0, 0}, {1e-9, 0, 2e-9, 3e-9}, {15, 1, 0, 97}, {180000, 0, 0, 98}});
    const std::string third = number_lines({{0, 0, 0, 0}, {15, 0, 0, 2e-9}, {180000, 0, 0, 0}});
    const auto file =
        read_navigation(test::header_v3("4.00") + "> EPH G04 CNV2\nG04" + epoch + body + gps + "> EPH C25 CNV1\nC25" +
                            epoch + body + beidou + "> EPH C26 CNV3\nC26" + epoch + body + third,
                        "made.nav");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_THAT(file->warnings, testing::IsEmpty());
    ASSERT_EQ(file->records.size(), 3u);
    const auto& g = std::get<KeplerEphemeris>(file->records[0]);
    EXPECT_EQ(g.toe, to_gps_time({2024, 3, 5, 2, 0, 0}, LeapSeconds::announced()) - std::chrono::seconds(18));
    EXPECT_EQ(g.tgd, 0) << "9.999E+09 is unknown";
    EXPECT_EQ(g.accuracy_m, 0.85);
    EXPECT_TRUE(g.healthy());
    const auto& c = std::get<KeplerEphemeris>(file->records[1]);
    EXPECT_FALSE(c.healthy());
    EXPECT_EQ(c.iodc, 97);
    EXPECT_EQ(c.iode, 98);
    EXPECT_EQ(c.axis_rate, 2e-3);
    EXPECT_EQ(c.delta_n_rate, -1.3e-14);
    EXPECT_EQ(bdt_week_and_tow(c.toe).tow_seconds(), 180000);
    EXPECT_TRUE(std::get<KeplerEphemeris>(file->records[2]).healthy());

    KeplerEphemeris legacy = g;
    legacy.message = NavigationMessage::lnav;
    legacy.axis_rate = 0;
    std::vector<Ephemeris> both = file->records;
    both.emplace_back(legacy);
    const NavigationData alone(file->records, {}, "alone"), mixed(both, {}, "mixed");
    EXPECT_EQ(message_of(*alone.ephemeris(g.satellite, g.toe)), NavigationMessage::modern);
    EXPECT_EQ(message_of(*mixed.ephemeris(g.satellite, g.toe)), NavigationMessage::lnav);
    EXPECT_EQ(message_of(*mixed.ephemeris(c.satellite, c.toe)), NavigationMessage::modern);
}

}  // namespace
}  // namespace skyloop
