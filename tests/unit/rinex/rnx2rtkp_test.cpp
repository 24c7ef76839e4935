// RTKLIB's single-point solution of what our writers write must be the truth (MODELS.md B-02, B-03).
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/core/files.hpp"
#include "support/oracle_table.hpp"
#include "world/rinex/navigation_file.hpp"
#include "world/rinex/observation_reader.hpp"
#include "world/rinex/rinex_writer.hpp"

namespace skyloop::test {
namespace {

namespace fs = std::filesystem;

bool solver_present() { return std::system("command -v rnx2rtkp >/dev/null 2>&1") == 0; }

// RTKLIB's bits of systems by RINEX letter.
int system_mask(const std::string& letters) {
    int mask = 0;
    for (const char c : letters)
        mask |= c == 'G' ? 1 : c == 'R' ? 4 : c == 'E' ? 8 : c == 'J' ? 16 : c == 'C' ? 32 : 0;
    return mask;
}

// The observations of the oracle as our reader takes and our writer writes them.
std::string rewritten_observations(const fs::path& path) {
    const auto file = read_observation_file(path);
    EXPECT_TRUE(file) << (file ? "" : file.error().message);
    if (!file) return {};
    ObservationHeader header;
    header.first_epoch = file->epochs.front().receive_time;
    header.interval = Seconds(10);
    header.glonass_channels = file->glonass_channels;
    for (const Constellation c :
         {Constellation::gps, Constellation::glonass, Constellation::galileo, Constellation::beidou})
        header.signals[c] = {first_signal(c)};
    const ObservationWriter writer(header);
    std::string text = writer.header();
    for (const Observations& epoch : file->epochs)
        text += writer.epoch(epoch);
    return text;
}

std::string rewritten_navigation(const fs::path& folder, const std::string& names) {
    std::vector<Ephemeris> records;
    NavigationTextHeader header;
    std::istringstream list(names);
    for (std::string name; std::getline(list, name, ';');) {
        const auto file = read_navigation_file(folder / name);
        EXPECT_TRUE(file) << (file ? "" : file.error().message);
        if (!file) return {};
        records.insert(records.end(), file->records.begin(), file->records.end());
        if (file->ionosphere.gps) header.ionosphere.gps = file->ionosphere.gps;
        if (file->leap_seconds) header.leap_seconds = file->leap_seconds;
    }
    header.date = toe_of(records.front());
    return navigation_text(records, header);
}

class Solver {
public:
    Solver() : folder_(fs::temp_directory_path() / ("skyloop_rnx2rtkp." + std::to_string(getpid()))) {
        fs::create_directories(folder_);
    }
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;
    ~Solver() { fs::remove_all(folder_); }

    void give(const std::string& observations, const std::string& navigation) const {
        std::ofstream(folder_ / "a.obs") << observations;
        std::ofstream(folder_ / "a.nav") << navigation;
    }
    // ECEF positions, metres.
    [[nodiscard]] std::vector<Eigen::Vector3d> solve(const std::string& systems, bool corrected) const {
        std::ofstream(folder_ / "a.conf") << "pos1-posmode=single\npos1-elmask=5\npos1-ionoopt="
                                          << (corrected ? "brdc\npos1-tropopt=saas" : "off\npos1-tropopt=off")
                                          << "\npos1-navsys=" << system_mask(systems) << "\nout-solformat=xyz\n";
        const auto quoted = [&](const char* name) { return " '" + (folder_ / name).string() + "'"; };
        const std::string command = "rnx2rtkp -k" + quoted("a.conf") + " -o" + quoted("a.pos") + quoted("a.obs") +
                                    quoted("a.nav") + " >/dev/null 2>&1";
        fs::remove(folder_ / "a.pos");
        EXPECT_EQ(std::system(command.c_str()), 0) << command;
        std::vector<Eigen::Vector3d> positions;
        std::ifstream solution(folder_ / "a.pos");
        for (std::string line; std::getline(solution, line);) {
            if (line.starts_with('%')) continue;
            std::istringstream fields(line);
            std::string date, time;
            double x = 0, y = 0, z = 0;
            if (fields >> date >> time >> x >> y >> z) positions.emplace_back(x, y, z);
        }
        return positions;
    }

private:
    fs::path folder_;
};

double worst_error_m(const std::vector<Eigen::Vector3d>& positions, const OracleRow& row) {
    const Eigen::Vector3d truth(row.number("truth_x_m"), row.number("truth_y_m"), row.number("truth_z_m"));
    double worst = 0;
    for (const Eigen::Vector3d& p : positions)
        worst = std::max(worst, (p - truth).norm());
    return worst;
}

class Rnx2rtkp : public ::testing::Test {
protected:
    void SetUp() override {
        if (!solver_present()) GTEST_SKIP() << "rnx2rtkp absent: apt-get install rtklib";
    }
};

constexpr double two_millimetres = 0.002;

TEST_F(Rnx2rtkp, FindsTheTruthFromWhatIsWritten) {
    SKYLOOP_REQUIRE_SHARED(oracles, "oracles/spp");
    const fs::path folder = oracles.parent_path();
    const Solver solver;
    int rows = 0;
    for (const OracleRow& row : oracle_rows("spp_clean.csv")) {
        solver.give(rewritten_observations(folder / row.text("obs_file")),
                    rewritten_navigation(folder, row.text("nav_files")));
        const auto positions = solver.solve(row.text("systems"), false);
        EXPECT_EQ(static_cast<std::int64_t>(positions.size()), row.integer("n_epochs")) << row.id();
        EXPECT_LT(worst_error_m(positions, row), two_millimetres) << row.id() << ' ' << row.text("systems");
        ++rows;
    }
    EXPECT_EQ(rows, 19);
}

TEST_F(Rnx2rtkp, FindsTheTruthThroughTheAirWhenItCorrects) {
    SKYLOOP_REQUIRE_SHARED(oracles, "oracles/spp");
    const fs::path folder = oracles.parent_path();
    const Solver solver;
    int rows = 0;
    for (const OracleRow& row : oracle_rows("spp_atmosphere.csv")) {
        solver.give(rewritten_observations(folder / row.text("obs_file")),
                    rewritten_navigation(folder, row.text("nav_file")));
        const auto corrected = solver.solve(row.text("systems"), true);
        EXPECT_EQ(static_cast<std::int64_t>(corrected.size()), row.integer("n_epochs")) << row.id();
        EXPECT_LT(worst_error_m(corrected, row), two_millimetres) << row.id() << ' ' << row.text("systems");
        const double uncorrected = 1000 * worst_error_m(solver.solve(row.text("systems"), false), row);
        EXPECT_NEAR(uncorrected, row.number("info_uncorrected_err_mm"), 2) << row.id();
        ++rows;
    }
    EXPECT_EQ(rows, 6);
}

}  // namespace
}  // namespace skyloop::test
