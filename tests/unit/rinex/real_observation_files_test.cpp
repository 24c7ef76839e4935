#include <gtest/gtest.h>

#include <map>
#include <set>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/signal.hpp"
#include "world/rinex/observation_reader.hpp"

namespace skyloop::test {
namespace {

// What a count of the lines that begin with '>' and with a satellite gives, by a few lines of Python; of version 2 by
// the numbers on the epochs' lines.
struct ExpectedContent {
    const char* path;
    std::size_t epochs, rows, satellites;
};
constexpr ExpectedContent real_files[] = {
    {"receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.obs.gz", 2072, 28910, 24},
    {"receivers/galway_20181015_m8p_static/galway.obs.gz", 3659, 56818, 23},
    {"receivers/hk_tst_static_20200603/2020_06_03_TST_03.obs.gz", 986, 27510, 37},
    {"receivers/areq_20100115/areq015o.10o.gz", 3600, 34574, 11},
    {"receivers/tlse_20240101/TLSE00FRA_R_20240011200_15M_01S_MO.rnx.gz", 900, 40720, 50},
    {"receivers/tlse_20240101/TLSE00FRA_R_20240011200_15M_01S_MO.crx.gz", 900, 40720, 50},
    {"oracles/spp/PS1.obs", 6, 198, 33},
    {"oracles/spp/PS2_atm.obs", 6, 222, 37},
    {"oracles/spp/PS4.obs", 6, 84, 14},
    {"oracles/spp/PS5.obs", 6, 90, 15},
};

TEST(RealObservationFiles, HaveTheEpochsAndSatellitesThatLinesShow) {
    SKYLOOP_REQUIRE_SHARED(root, "receivers");
    for (const ExpectedContent& expected : real_files) {
        const auto file = read_observation_file(root.parent_path() / expected.path);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->epochs.size(), expected.epochs) << expected.path;
        EXPECT_EQ(file->skipped, SkippedObservations{}) << expected.path;
        EXPECT_TRUE(file->warnings.empty()) << file->warnings[0];
        std::size_t rows = 0;
        std::set<SatelliteId> satellites;
        for (const Observations& epoch : file->epochs) {
            std::set<SatelliteId> here;
            for (const Observation& o : epoch.signals)
                here.insert(o.satellite);
            rows += here.size();
            satellites.insert(here.begin(), here.end());
        }
        EXPECT_EQ(rows, expected.rows) << expected.path;
        EXPECT_EQ(satellites.size(), expected.satellites) << expected.path;
    }
}

const Observation* find(const Observations& epoch, std::string_view satellite, Signal signal) {
    for (const Observation& o : epoch.signals)
        if (to_string(o.satellite) == satellite && o.signal == signal) return &o;
    return nullptr;
}

TEST(RealObservationFiles, HoldTheValuesOfVersion2) {
    SKYLOOP_REQUIRE_SHARED(path, "receivers/areq_20100115/areq015o.10o.gz");
    const auto file = read_observation_file(path);
    ASSERT_TRUE(file);
    EXPECT_EQ(file->marker, "AREQ");
    EXPECT_EQ(file->receiver, "ASHTECH UZ-12");
    EXPECT_EQ(file->antenna, "AOAD/M_T        JPLA");
    EXPECT_EQ(file->antenna_delta.height.value(), 0.061);
    const Observations& first = file->epochs[0];
    EXPECT_EQ(first.receive_time, gps_calendar_time(2010, 1, 15, 19, 0, 0));
    const Observation* l1 = find(first, "G04", Signal::l1);
    ASSERT_TRUE(l1);
    EXPECT_EQ(l1->pseudorange->value(), 24599069.504);
    EXPECT_EQ(l1->carrier_phase, 129268980.042);
    EXPECT_EQ(l1->cn0.value(), 46);
    const Observation* l2 = find(first, "G04", Signal::l2);
    ASSERT_TRUE(l2);
    EXPECT_EQ(l2->pseudorange->value(), 24599076.429);
    EXPECT_EQ(l2->carrier_phase, 100729070.381);
}

// How many epochs of each GPS satellite have a signal.
std::map<int, std::size_t> epochs_of_gps(const ObservationFile& file, Signal signal) {
    std::map<int, std::size_t> epochs;
    for (const Observations& epoch : file.epochs)
        for (const Observation& o : epoch.signals)
            if (o.satellite.constellation == Constellation::gps && o.signal == signal) ++epochs[o.satellite.number];
    return epochs;
}

TEST(RealObservationFiles, HaveL2cAndL5OfTheBlocksThatSendThem) {
    SKYLOOP_REQUIRE_SHARED(root, "receivers");
    // An F9P takes L2C alone; in a street canyon it lost some.
    const auto canyon = read_observation_file(root / "hk_tst_static_20200603/2020_06_03_TST_03.obs.gz");
    ASSERT_TRUE(canyon) << canyon.error().message;
    const GpsTime in_2020 = canyon->epochs[0].receive_time;
    const auto l2c = epochs_of_gps(*canyon, Signal::l2);
    EXPECT_EQ(l2c.size(), 7U);
    for (const auto& [prn, epochs] : l2c)
        EXPECT_TRUE(gps_sends(prn, Signal::l2, in_2020)) << prn;
    std::size_t without = 0;
    for (const auto& [prn, epochs] : epochs_of_gps(*canyon, Signal::l1)) {
        if (epochs < 900 || l2c.contains(prn)) continue;
        EXPECT_FALSE(gps_sends(prn, Signal::l2, in_2020)) << prn;
        ++without;
    }
    EXPECT_EQ(without, 2U);
    const auto roof = read_observation_file(root / "tlse_20240101/TLSE00FRA_R_20240011200_15M_01S_MO.rnx.gz");
    ASSERT_TRUE(roof) << roof.error().message;
    const auto l5 = epochs_of_gps(*roof, Signal::l5);
    EXPECT_EQ(l5.size(), 6U);
    for (const auto& [prn, epochs] : epochs_of_gps(*roof, Signal::l1))
        EXPECT_EQ(gps_sends(prn, Signal::l5, roof->epochs[0].receive_time), l5.contains(prn)) << prn;
}

TEST(RealObservationFiles, HoldTheValuesOfVersion3) {
    SKYLOOP_REQUIRE_SHARED(path, "receivers/galway_20181015_m8p_static/galway.obs.gz");
    const auto file = read_observation_file(path);
    ASSERT_TRUE(file);
    EXPECT_EQ(file->glonass_channels.size(), 11u);
    EXPECT_EQ(file->glonass_channels.at(22), -3);
    const Observations& first = file->epochs[0];
    EXPECT_EQ(first.receive_time, gps_calendar_time(2018, 10, 15, 16, 54, 59) + std::chrono::milliseconds(994));
    const Observation* r21 = find(first, "R21", Signal::g1);
    ASSERT_TRUE(r21);
    EXPECT_EQ(r21->pseudorange->value(), 19972734.725);
    EXPECT_EQ(r21->carrier_phase, 106878103.750);
    EXPECT_TRUE(r21->slipped);
    EXPECT_EQ(r21->doppler->value(), 157.597);
    EXPECT_EQ(r21->cn0.value(), 45);
    EXPECT_EQ(r21->carrier.value(), 1602e6 + 4 * 562.5e3);
    const Observation* g16 = find(first, "G16", Signal::l1);
    ASSERT_TRUE(g16);
    EXPECT_FALSE(g16->carrier_phase);
}

TEST(RealObservationFiles, HoldBeiDouOfVersion302) {
    SKYLOOP_REQUIRE_SHARED(path, "receivers/hk_tst_static_20200603/2020_06_03_TST_03.obs.gz");
    const auto file = read_observation_file(path);
    ASSERT_TRUE(file);
    const Observation* b1 = find(file->epochs[0], "C08", Signal::b1i);
    const Observation* b2 = find(file->epochs[0], "C08", Signal::e5b);
    ASSERT_TRUE(b1 && b2);
    EXPECT_EQ(b1->pseudorange->value(), 38008476.738);
    EXPECT_EQ(b2->carrier_phase, 153044367.188);
    EXPECT_EQ(b2->cn0.value(), 44);
    const Observation* g08 = find(file->epochs[0], "G08", Signal::l2);
    ASSERT_TRUE(g08);
    EXPECT_FALSE(g08->carrier_phase) << "blank but for its loss-of-lock digit";
}

}  // namespace
}  // namespace skyloop::test
