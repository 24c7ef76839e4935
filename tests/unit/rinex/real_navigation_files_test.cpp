#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "skyloop/gnss/foreign_records.hpp"
#include "skyloop/gnss/navigation_data.hpp"
#include "skyloop/rinex/navigation_file.hpp"
#include "skyloop/time/utc_time.hpp"
#include "support/oracle_table.hpp"

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

// Records in each version 2 GPS file: lines after the header, divided by eight.
const std::map<std::string, std::size_t> version_2_counts{
    {"07590920.05n", 162},    {"30400920.05n", 164},
    {"brdc0910.09n", 424},    {"brdc1820.10n", 421},
    {"cbw10010.21n.gz", 187}, {"ijmu3650.21n.gz", 244},
    {"14601736.18n", 7},      {"test_input_rinex2_nav_RinexNavExample.99n", 2},
};

// Records of GPS and QZSS in files of later versions, counted by their satellite letters.
const std::map<std::string, std::size_t> later_counts{
    {"BRDC00IGS_R_20230010000_01D_MN.rnx.gz", 532},
    {"BRDC00IGS_R_20240010000_01D_MN.rnx.gz", 552},
    {"ESBC00DNK_R_20201770000_01D_MN.rnx.gz", 272},
    {"KMS300DNK_R_20221591000_01H_MN.rnx.gz", 31},
    {"nav_20200625_eu_MN.rnx", 257},
    {"CBW100NLD_R_20210010000_01D_MN.rnx", 2},
    {"Example_GPS_Rinex301.n", 2},
    {"Example_GPS_Rinex400.n", 2},
    {"Example_Mixed_Rinex304.n", 2},
    {"Example_Mixed_Rinex305.n", 2},
    {"Example_QZSS_Rinex302.n", 3},
    {"demo_nav3.17n", 4},
    {"qzss_nav3.14n", 1},
    {"qzsssampl_U_20141330729_01D_RN.rnx", 1},
    {"spare_filled_nav3.rnx", 4},
    {"test_input_rinex3_nav_RinexNavExample.15n", 13},
};

TEST(RealNavigationFiles, LoadWithExactCountsOrFailWithOneClearLine) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    std::set<std::string> loaded;
    for (const fs::path& path : files_below(nav)) {
        const std::string name = path.filename().string();
        const Result<NavigationFile> file = read_navigation_file(path);
        const bool version_2 = version_2_counts.contains(name);
        if (version_2 || later_counts.contains(name)) {
            ASSERT_TRUE(file) << file.error().message;
            EXPECT_EQ(file->records.size(), version_2 ? version_2_counts.at(name) : later_counts.at(name)) << name;
            EXPECT_EQ(file->skipped.defective, 0) << name;
            EXPECT_EQ(file->skipped.incomplete, 0) << name;
            EXPECT_TRUE(file->warnings.empty() || !version_2) << name;
            loaded.insert(name);
        } else {
            ASSERT_FALSE(file) << name << " gave " << file->records.size() << " records";
            EXPECT_EQ(file.error().code, ErrorCode::input);
            EXPECT_THAT(file.error().message, ::testing::StartsWith(path.string() + ":"));
            EXPECT_THAT(file.error().message, ::testing::HasSubstr("; expected "));
            EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
        }
    }
    EXPECT_EQ(loaded.size(), version_2_counts.size() + later_counts.size() - 1)
        << "all but the scenes' file, which lies elsewhere";
}

TEST(RealNavigationFiles, HaveTheirHeadersRead) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    const auto july = read_navigation_file(nav / "brdc1820.10n");
    ASSERT_TRUE(july);
    EXPECT_EQ(july->version, 2);
    EXPECT_EQ(july->leap_seconds, 15);
    EXPECT_EQ(july->klobuchar->alpha, (std::array<double, 4>{0.4657e-8, 0.1490e-7, -0.5960e-7, -0.1192e-6}));
    EXPECT_EQ(july->klobuchar->beta, (std::array<double, 4>{0.8192e5, 0.8192e5, -0.6554e5, -0.5243e6}));
    EXPECT_FALSE(read_navigation_file(nav / "ijmu3650.21n.gz")->klobuchar);
    const auto block = read_navigation_file(nav / "KMS300DNK_R_20221591000_01H_MN.rnx.gz");
    EXPECT_TRUE(block->klobuchar) << "from an ION block";
}

TEST(RealNavigationFiles, CarryUnhealthyFlags) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    const auto file = read_navigation_file(nav / "ijmu3650.21n.gz");
    std::set<int> unhealthy;
    for (const KeplerEphemeris& e : file->records)
        if (!e.healthy()) unhealthy.insert(e.satellite.number);
    EXPECT_EQ(unhealthy, (std::set<int>{11, 22}));
}

TEST(RealNavigationFiles, HaveNoForeignRecordsButOne) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    int checked = 0;
    for (const char* folder : {"nav", "oracles/nav"})
        for (const fs::path& path : files_below(*shared_data(folder))) {
            auto file = read_navigation_file(path);
            if (!file) continue;
            const std::size_t before = file->records.size();
            const std::vector<DroppedRecord> dropped = drop_foreign_records(file->records);
            const bool has_one = path.filename() == "brdc1820.10n";
            ASSERT_EQ(dropped.size(), has_one ? 1u : 0u) << path << (dropped.empty() ? "" : ": " + dropped[0].reason);
            EXPECT_EQ(file->records.size(), before - dropped.size());
            ++checked;
        }
    EXPECT_EQ(checked, 25);
}

TEST(RealNavigationFiles, TellWhoseOrbitTheForeignRecordIs) {
    SKYLOOP_REQUIRE_SHARED(path, "nav/brdc1820.10n");
    auto file = read_navigation_file(path);
    const auto dropped = drop_foreign_records(file->records);
    ASSERT_EQ(dropped.size(), 1u);
    EXPECT_EQ(to_string(dropped[0].record.satellite), "G01");
    EXPECT_EQ(dropped[0].record.toe, gps_calendar_time(2010, 7, 1, 6, 0, 0));
    EXPECT_EQ(
        dropped[0].reason,
        "G01: record with toe 2010-07-01T06:00:00 lies 20883 km from its neighbours (it is the orbit of G23); dropped");
    EXPECT_EQ(file->records.size(), 420u);
}

TEST(RealNavigationFiles, CanBeMovedToAnyDay) {
    SKYLOOP_REQUIRE_SHARED(path, "nav/brdc1820.10n");
    const auto file = read_navigation_file(path);
    const NavigationData data(file->records, file->klobuchar, "brdc1820.10n");
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
