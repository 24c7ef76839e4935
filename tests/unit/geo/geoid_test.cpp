#include "base/geo/geoid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path grid_file = test::built_data() / "geoids/egm96-15.pgm";

double undulation_m(const Geoid& geoid, double latitude, double longitude) {
    return geoid.undulation(Angle::degrees(latitude), Angle::degrees(longitude)).value();
}

/// The grid that the build made; where the machine has no proj-data there is none.
class BuiltGeoid : public testing::Test {
protected:
    void SetUp() override {
        if (!fs::exists(grid_file)) GTEST_SKIP() << "no " << grid_file << ": the package proj-data was not installed";
        Result<Geoid> opened = Geoid::open(grid_file);
        ASSERT_TRUE(opened.has_value()) << opened.error().message;
        geoid_.emplace(std::move(*opened));
    }
    [[nodiscard]] const Geoid& geoid() const { return *geoid_; }

private:
    std::optional<Geoid> geoid_;
};

// u-blox's modules: every 10 degrees, linear between. What four of them reported at their places was 56.0, -30.0,
// -21.35 and 47.13 m (docs/fidelity.md).
TEST_F(BuiltGeoid, IsLinearBetweenTheNodesOfACoarseGrid) {
    const auto coarse = [&](double latitude, double longitude) {
        return geoid().undulation(Angle::degrees(latitude), Angle::degrees(longitude), 10).value();
    };
    EXPECT_DOUBLE_EQ(coarse(50, -10), undulation_m(geoid(), 50, -10));
    EXPECT_NEAR(coarse(55, -10), (undulation_m(geoid(), 50, -10) + undulation_m(geoid(), 60, -10)) / 2, 1e-9);
    EXPECT_NEAR(coarse(90, 12), undulation_m(geoid(), 90, 0), 0.01);
    EXPECT_NEAR(coarse(-90, -180), undulation_m(geoid(), -90, 0), 0.01);
    EXPECT_NEAR(coarse(53.288, -8.9823), 56.4, 0.2);
    EXPECT_NEAR(coarse(44.0688, -121.314), -21.5, 0.1);
    EXPECT_DOUBLE_EQ(geoid().undulation(Angle::degrees(53), Angle::degrees(-9), 0).value(),
                     undulation_m(geoid(), 53, -9));
}

TEST_F(BuiltGeoid, AgreesWithTheOracle) {
    for (const test::OracleRow& row : test::oracle_rows("geoid_egm96.csv")) {
        SCOPED_TRACE(row.id());
        const double value = undulation_m(geoid(), row.number("lat_deg"), row.number("lon_deg"));
        EXPECT_NEAR(value, row.number("N_m"), row.number("tol_m"));
        // The oracle's own interpolation of the same grid; two cubic ones differ by centimetres.
        EXPECT_NEAR(value, row.number("info_spline15min_m"), 0.05);
    }
}

TEST_F(BuiltGeoid, AgreesWithThePublishedCheckPoints) {
    SKYLOOP_REQUIRE_SHARED(path, "vectors/egm96_points.csv");
    std::ifstream file(path);
    int rows = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#') || line.starts_with("lat")) continue;
        std::istringstream cells(line);
        double latitude = 0;
        double longitude = 0;
        double expected = 0;
        char comma = 0;
        ASSERT_TRUE(cells >> latitude >> comma >> longitude >> comma >> expected) << line;
        EXPECT_NEAR(undulation_m(geoid(), latitude, longitude), expected, 0.06) << line;
        ++rows;
    }
    EXPECT_GE(rows, 6);
}

TEST_F(BuiltGeoid, IsOneValueAtAPoleAndOnTheDateLine) {
    for (double longitude = -180; longitude <= 180; longitude += 7.3) {
        EXPECT_NEAR(undulation_m(geoid(), 90, longitude), 13.606, 0.01);
        EXPECT_NEAR(undulation_m(geoid(), -90, longitude), -29.535, 0.01);
    }
    for (double latitude = -89; latitude < 90; latitude += 3.7) {
        EXPECT_EQ(undulation_m(geoid(), latitude, 180), undulation_m(geoid(), latitude, -180));
        // GeographicLib's cubic fit of one cell meets that of the next within centimetres.
        EXPECT_NEAR(undulation_m(geoid(), latitude, 179.99999), undulation_m(geoid(), latitude, -179.99999), 0.05);
        EXPECT_NEAR(undulation_m(geoid(), latitude, 359.99999), undulation_m(geoid(), latitude, 0.00001), 0.05);
        EXPECT_NEAR(undulation_m(geoid(), latitude, 250), undulation_m(geoid(), latitude, -110), 1e-6);
    }
}

TEST_F(BuiltGeoid, OutlivesAMove) {
    Result<Geoid> first = Geoid::open(grid_file);
    ASSERT_TRUE(first.has_value());
    const Geoid second = std::move(*first);
    EXPECT_NEAR(undulation_m(second, 46.4774, 30.7326), 27.668, 0.05);
}

TEST_F(BuiltGeoid, OpensByARelativePath) {
    const fs::path before = fs::current_path();
    fs::current_path(grid_file.parent_path());
    const Result<Geoid> opened = Geoid::open(grid_file.filename());
    fs::current_path(before);
    EXPECT_TRUE(opened.has_value());
}

TEST_F(BuiltGeoid, RefusesAGridThatIsCutOff) {
    std::string pattern = (fs::temp_directory_path() / "skyloop-geoid-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    const fs::path cut = fs::path(pattern) / "egm96-15.pgm";
    fs::copy_file(grid_file, cut);
    fs::resize_file(cut, fs::file_size(grid_file) - 1);
    const Result<Geoid> opened = Geoid::open(cut);
    fs::remove_all(pattern);
    ASSERT_FALSE(opened.has_value());
    EXPECT_THAT(opened.error().message, HasSubstr(cut.string()));
}

TEST(Geoid, SaysWhatIsMissingAndHowItIsMade) {
    const fs::path missing = "/nowhere/egm96-15.pgm";
    const Result<Geoid> opened = Geoid::open(missing);
    ASSERT_FALSE(opened.has_value());
    EXPECT_EQ(opened.error().code, ErrorCode::outside);
    EXPECT_THAT(opened.error().message, HasSubstr(missing.string()));
    EXPECT_THAT(opened.error().message, HasSubstr("no such file"));
    EXPECT_THAT(opened.error().message, HasSubstr("proj-data"));
    EXPECT_EQ(opened.error().message.find('\n'), std::string::npos);
}

TEST(Geoid, RefusesWhatIsNoGrid) {
    std::string pattern = (fs::temp_directory_path() / "skyloop-geoid-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    const fs::path folder = pattern;
    std::ofstream(folder / "text.pgm") << "no grid at all\n";
    std::ofstream(folder / "odd.pgm") << "P5\n# Offset -108\n# Scale 0.003\n3 3\n65535\n";
    fs::create_directory(folder / "folder.pgm");
    ASSERT_EQ(mkfifo((folder / "fifo.pgm").c_str(), 0600), 0);
    for (const char* name : {"text.pgm", "odd.pgm", "folder.pgm", "fifo.pgm", "grid.gtx", ".pgm", ""}) {
        const Result<Geoid> opened = Geoid::open(folder / name);
        ASSERT_FALSE(opened.has_value()) << name;
        EXPECT_EQ(opened.error().code, ErrorCode::outside) << name;
    }
    fs::remove_all(folder);
}

}  // namespace
}  // namespace skyloop
