// Whole runs against the tables of fixes in tests/golden/runs, which tools/bless_golden.py makes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "run/emulator/assembly.hpp"
#include "run/scenario/scenario_file.hpp"
#include "support/oracle_table.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;

using Table = std::vector<std::vector<std::string>>;

Table read_table(const fs::path& file) {
    std::ifstream stream(file);
    EXPECT_TRUE(stream) << file;
    Table table;
    for (std::string line; std::getline(stream, line);) {
        table.emplace_back(1);
        for (const char c : line)
            if (c == ',')
                table.back().emplace_back();
            else
                table.back().back() += c;
    }
    return table;
}

// One and a half units of a column's last digit: a value that another mathematics library rounds the other way passes,
// any change of a formula does not.
double tolerance_of(const std::string& column) {
    static const std::map<std::string, double> digits{{"tow_s", 1e-3},   {"gdop", 1e-3},   {"pdop", 1e-3},
                                                      {"hdop", 1e-3},    {"vdop", 1e-3},   {"tdop", 1e-3},
                                                      {"h_acc_m", 1e-3}, {"v_acc_m", 1e-3}};
    if (column.ends_with("_lat_deg") || column.ends_with("_lon_deg") || column == "lat_deg" || column == "lon_deg")
        return 1.5e-9;
    const auto found = digits.find(column);
    return 1.5 * (found == digits.end() ? 1e-4 : found->second);
}

// Courses of 0 and 360 are one.
double difference_of(const std::string& column, double a, double b) {
    return column == "course_deg" ? std::abs(std::remainder(a - b, 360)) : std::abs(a - b);
}

std::optional<double> number_of(const std::string& cell) {
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (cell.empty() || error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
    return value;
}

void expect_same_tables(const Table& found, const Table& expected) {
    ASSERT_GT(expected.size(), 1U);
    ASSERT_EQ(found.size(), expected.size());
    ASSERT_EQ(found[0], expected[0]) << "the columns have changed";
    for (std::size_t row = 1; row < expected.size(); ++row) {
        ASSERT_EQ(found[row].size(), expected[0].size());
        for (std::size_t i = 0; i < expected[0].size(); ++i) {
            const std::string& column = expected[0][i];
            const auto a = number_of(found[row][i]), b = number_of(expected[row][i]);
            if (a && b)
                EXPECT_LE(difference_of(column, *a, *b), tolerance_of(column))
                    << "row " << row << ", " << column << ": " << found[row][i] << " instead of " << expected[row][i];
            else
                EXPECT_EQ(found[row][i], expected[row][i]) << "row " << row << ", " << column;
        }
    }
}

// Runs a scenario as `skyloop simulate` does and gives its fixes.csv.
Table simulated(const fs::path& file) {
    const auto scenario = read_scenario_file(file);
    EXPECT_TRUE(scenario) << scenario.error().message;
    const test::TemporaryFolder folder;
    RunMode mode;
    mode.virtual_time = true;
    mode.open_ports = false;
    mode.record = folder / "run";
    auto assembly = assemble(*scenario, {{test::built_data()}}, mode);
    EXPECT_TRUE(assembly) << assembly.error().message;
    if (!assembly) return {};
    EXPECT_THAT(assembly->warnings, testing::IsEmpty());
    EXPECT_TRUE(assembly->emulator->begin());
    assembly->emulator->run_until(assembly->end.value(), false);
    EXPECT_FALSE(assembly->emulator->recorder()->failure());
    return read_table(folder / "run/fixes.csv");
}

class GoldenRun : public testing::TestWithParam<std::string> {};

TEST_P(GoldenRun, GivesTheBlessedFixes) {
    const fs::path folder = fs::path(SKYLOOP_SOURCE_DIR) / "tests/golden/runs";
    expect_same_tables(simulated(folder / (GetParam() + ".toml")), read_table(folder / (GetParam() + ".csv")));
}

std::vector<std::string> golden_names() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(SKYLOOP_SOURCE_DIR "/tests/golden/runs"))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

INSTANTIATE_TEST_SUITE_P(Runs, GoldenRun, testing::ValuesIn(golden_names()), [](const auto& run) { return run.param; });

TEST(GoldenRuns, AreThere) { EXPECT_GE(golden_names().size(), 6U); }

TEST(GoldenRuns, AnotherSeedIsSeen) {
    const Table expected = read_table(SKYLOOP_SOURCE_DIR "/tests/golden/runs/strict_baseline.csv");
    const auto latitude = std::find(expected[0].begin(), expected[0].end(), "lat_deg") - expected[0].begin();
    ASSERT_GT(expected.size(), 2U);
    const double one = number_of(expected[1][static_cast<std::size_t>(latitude)]).value();
    const double two = number_of(expected[2][static_cast<std::size_t>(latitude)]).value();
    EXPECT_GT(std::abs(one - two), 100 * tolerance_of("lat_deg")) << "the tolerance lies far below the noise";
}

}  // namespace
}  // namespace skyloop
