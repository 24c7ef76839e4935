#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/foreign_records.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_below(const fs::path& root) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// Records of each system, counted by their first lines with another program; of version 4, those of messages that are
// read. Every other file must be refused.
const std::map<std::string, std::string> record_counts{
    {"07590920.05n", "G162"},
    {"30400920.05n", "G164"},
    {"AMEL00NLD_R_20210010000_01D_MN.rnx", "E2 C2 R2"},
    {"BRDC00IGS_R_20230010000_01D_MN.rnx.gz", "G436 S11338 E5663 C1032 J96 R1198 I216"},
    {"BRDC00IGS_R_20240010000_01D_MN.rnx.gz", "G452 S11235 E5390 C1080 J100 R1199 I145"},
    {"CBW100NLD_R_20210010000_01D_MN.rnx", "G2 E2 C2"},
    {"ESBC00DNK_R_20201770000_01D_MN.rnx.gz", "G257 S2130 E1602 C357 J15 R510"},
    {"KMS300DNK_R_20221591000_01H_MN.rnx.gz", "G30 S158 E108 C36 J1 R24"},
    {"amel0010.21g", "R6"},
    {"brdc0910.09g", "R912"},
    {"brdc0910.09n", "G424"},
    {"brdc1820.10n", "G421"},
    {"cbw10010.21n.gz", "G187"},
    {"ijmu3650.21n.gz", "G244"},
    {"14601736.18n", "G7"},
    {"Example_Beidou_Rinex302.n", "C2"},
    {"Example_GPS_Rinex301.n", "G2"},
    {"Example_GPS_Rinex400.n", "G5"},
    {"Example_Galileo_Rinex304.n", "E2"},
    {"Example_Glonass_Rinex303.n", "R3"},
    {"Example_Mixed_Rinex304.n", "G2 C2 R1"},
    {"Example_Mixed_Rinex305.n", "G2 R2"},
    {"Example_NavIC_Rinex303.n", "I3"},
    {"Example_QZSS_Rinex302.n", "J3"},
    {"Example_SBAS_Rinex301.n", "S2"},
    {"demo_nav3.17n", "G4"},
    {"galileo3.15n", "E2"},
    {"minimal3.10n", "S1"},
    {"qzss_nav3.14n", "J1"},
    {"qzsssampl_U_20141330729_01D_RN.rnx", "J1"},
    {"spare_filled_nav3.rnx", "G4 E2 R1"},
    {"test_input_rinex2_nav_RinexNavExample.99n", "G2"},
    {"test_input_rinex3_nav_BeiDou.14n", "C1"},
    {"test_input_rinex3_nav_RinexNavExample.15n", "G13"},
    {"nav_20200625_eu_MN.rnx", "G257 E821 C357 R510"},
};

// "G436 S11338 …": systems in the order of Constellation.
std::string counts_text(const NavigationFile& file) {
    std::string text;
    for (const auto& [constellation, count] : file.counts())
        text += (text.empty() ? "" : " ") + std::string(1, rinex_letter(constellation)) + std::to_string(count);
    return text;
}

void check_refusal(const fs::path& path, const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::input);
    EXPECT_THAT(error.message, ::testing::StartsWith(path.string() + ":"));
    EXPECT_THAT(error.message, ::testing::HasSubstr("; expected "));
    EXPECT_EQ(error.message.find('\n'), std::string::npos);
}

TEST(RealNavigationFiles, LoadWithExactCountsOrFailWithOneClearLine) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    std::set<std::string> loaded;
    for (const fs::path& path : files_below(nav)) {
        const std::string name = path.filename().string();
        const Result<NavigationFile> file = read_navigation_file(path);
        if (!record_counts.contains(name)) {
            ASSERT_FALSE(file) << name << " gave " << file->records.size() << " records";
            check_refusal(path, file.error());
            continue;
        }
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(counts_text(*file), record_counts.at(name)) << name;
        // One record of Galileo has a blank where a digit belongs.
        const bool torn = name == "galileo3.15n";
        EXPECT_EQ(file->skipped.defective, torn ? 1 : 0) << name << ": " << ::testing::PrintToString(file->warnings);
        EXPECT_EQ(file->skipped.incomplete, 0) << name;
        EXPECT_TRUE(file->warnings.empty() || torn || file->version >= 4) << name << ": " << file->warnings.front();
        loaded.insert(name);
    }
    EXPECT_EQ(loaded.size(), record_counts.size() - 1) << "all but the scenes' file, which lies elsewhere";
}

TEST(RealNavigationFiles, NameTheMessagesThatAreNotRead) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    const auto gps = read_navigation_file(nav / "odd/Example_GPS_Rinex400.n");
    ASSERT_TRUE(gps);
    EXPECT_THAT(gps->skipped.messages, ::testing::IsEmpty());
    const auto ionosphere = read_navigation_file(nav / "odd/Example_Ion_Rinex400.n");
    ASSERT_FALSE(ionosphere);
    EXPECT_THAT(ionosphere.error().message, ::testing::HasSubstr("only messages of other kinds (3 'ION')"));
}

// Invented numbers stand in some files; those records must say what is wrong with them.
TEST(RealNavigationFiles, SayWhatIsWrongWithInventedRecords) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    const auto file = read_navigation_file(nav / "odd/brdc0320.16l.txt");
    ASSERT_FALSE(file);
    EXPECT_THAT(file.error().message,
                ::testing::HasSubstr("0320.16l.txt:10:43: found '4.515803819724e+04'; expected OMEGA0"));
}

TEST(RealNavigationFiles, HaveTheirHeadersRead) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    const auto july = read_navigation_file(nav / "brdc1820.10n");
    ASSERT_TRUE(july);
    EXPECT_EQ(july->version, 2);
    EXPECT_EQ(july->leap_seconds, 15);
    EXPECT_EQ(july->ionosphere.gps->alpha, (std::array<double, 4>{0.4657e-8, 0.1490e-7, -0.5960e-7, -0.1192e-6}));
    EXPECT_EQ(july->ionosphere.gps->beta, (std::array<double, 4>{0.8192e5, 0.8192e5, -0.6554e5, -0.5243e6}));
    EXPECT_FALSE(read_navigation_file(nav / "ijmu3650.21n.gz")->ionosphere.gps);
    const auto block = read_navigation_file(nav / "KMS300DNK_R_20221591000_01H_MN.rnx.gz");
    EXPECT_TRUE(block->ionosphere.gps) << "from an ION block";
    EXPECT_TRUE(block->ionosphere.beidou && block->ionosphere.galileo);
    const auto day = read_navigation_file(nav / "BRDC00IGS_R_20230010000_01D_MN.rnx.gz");
    EXPECT_EQ(day->ionosphere.galileo, (std::array<double, 3>{129, -0.59375, 6.1035e-4}));
    EXPECT_EQ(day->ionosphere.beidou->alpha[0], 2.7008e-8);
}

TEST(RealNavigationFiles, CarryUnhealthyFlags) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    const auto file = read_navigation_file(nav / "ijmu3650.21n.gz");
    std::set<int> unhealthy;
    for (const Ephemeris& e : file->records)
        if (!is_healthy(e)) unhealthy.insert(satellite_of(e).number);
    EXPECT_EQ(unhealthy, (std::set<int>{11, 22}));

    // Those of the whole day that MANIFEST.md names, and no other of their systems.
    const auto day = read_navigation_file(nav / "BRDC00IGS_R_20230010000_01D_MN.rnx.gz");
    std::set<std::string> named;
    for (const Ephemeris& e : day->records)
        if (!is_healthy(e) && satellite_of(e).constellation != Constellation::sbas)
            named.insert(to_string(satellite_of(e)));
    EXPECT_THAT(named, ::testing::IsSupersetOf({"E14", "E18", "J07", "R25"}));
    EXPECT_LT(named.size(), 20u) << ::testing::PrintToString(named);

    // Of index 15 is the user range accuracy of 20 records; the clock of the one of 00:36 is 32 m off.
    const SatelliteId i02{Constellation::navic, 2};
    const auto without_accuracy = std::count_if(day->records.begin(), day->records.end(), [&](const Ephemeris& e) {
        return satellite_of(e) == i02 && !is_healthy(e) && std::get<KeplerEphemeris>(e).health == 0;
    });
    EXPECT_EQ(without_accuracy, 20);
}

// In one merged day records of GLONASS bear the orbits and clocks of the satellite on the opposite side of the plane,
// four slots away, which sends on the same frequency channel.
const std::map<std::string, std::size_t> foreign_counts{{"brdc1820.10n", 1},
                                                        {"BRDC00IGS_R_20240010000_01D_MN.rnx.gz", 82}};

TEST(RealNavigationFiles, HaveForeignRecordsInTwoOfThem) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    int checked = 0;
    for (const char* folder : {"nav", "oracles/nav"})
        for (const fs::path& path : files_below(*shared_data(folder))) {
            auto file = read_navigation_file(path);
            if (!file) continue;
            const std::size_t before = file->records.size();
            const std::vector<DroppedRecord> dropped = drop_foreign_records(file->records);
            const auto expected = foreign_counts.find(path.filename().string());
            ASSERT_EQ(dropped.size(), expected == foreign_counts.end() ? 0 : expected->second)
                << path << (dropped.empty() ? "" : ": " + dropped[0].reason);
            EXPECT_EQ(file->records.size(), before - dropped.size());
            std::size_t owned = 0;
            for (const DroppedRecord& d : dropped) {
                const bool gps_day = path.filename() == "brdc1820.10n";
                EXPECT_EQ(satellite_of(d.record).constellation, gps_day ? Constellation::gps : Constellation::glonass);
                owned += d.reason.find("it is the orbit of") != std::string::npos ? 1u : 0u;
            }
            EXPECT_GE(owned + 1, dropped.size()) << "one stands where its owner's records are foreign, too";
            ++checked;
        }
    EXPECT_EQ(checked, 37);
}

TEST(RealNavigationFiles, TellWhoseOrbitTheForeignRecordIs) {
    SKYLOOP_REQUIRE_SHARED(path, "nav/brdc1820.10n");
    auto file = read_navigation_file(path);
    const auto dropped = drop_foreign_records(file->records);
    ASSERT_EQ(dropped.size(), 1u);
    EXPECT_EQ(to_string(satellite_of(dropped[0].record)), "G01");
    EXPECT_EQ(toe_of(dropped[0].record), gps_calendar_time(2010, 7, 1, 6, 0, 0));
    EXPECT_EQ(
        dropped[0].reason,
        "G01: record with toe 2010-07-01T06:00:00 lies 20883 km from its neighbours (it is the orbit of G23); dropped");
    EXPECT_EQ(file->records.size(), 420u);
}

TEST(RealNavigationFiles, CanBeMovedToAnyDay) {
    SKYLOOP_REQUIRE_SHARED(path, "nav/brdc1820.10n");
    const auto file = read_navigation_file(path);
    const NavigationData data(file->records, file->ionosphere, "brdc1820.10n");
    for (int hour = 0; hour < 24; hour += 3) {
        const GpsTime start = gps_calendar_time(2026, 2, 14, static_cast<unsigned>(hour), 17, 0);
        const auto moved = rebased(data, start);
        ASSERT_TRUE(moved) << moved.error().message;
        EXPECT_GE(moved->satellites_at(start), 30u) << hour;
        EXPECT_TRUE(moved->klobuchar());
    }
}

}  // namespace
}  // namespace skyloop::test
