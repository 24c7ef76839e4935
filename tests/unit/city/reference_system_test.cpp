// Files of many reference systems stand where PROJ's own program puts them, or are refused with a line that says why.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <stdlib.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/geo/geodetic.hpp"
#include "mesh_support.hpp"
#include "support/flat_geoid.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A level roof of 20 m about a place, in the order in which the numbers stand.
std::string roof_file(std::string_view system, double first, double second, double height = 10, double half = 10) {
    const auto corner = [&](double a, double b) {
        return fmt::format("{:.9f} {:.9f} {} ", first + a * half, second + b * half, height);
    };
    return fmt::format(
        "<CityModel xmlns:gml='g'><gml:Envelope srsName='{}'/><Building><lod2MultiSurface><gml:Polygon><gml:exterior>"
        "<gml:LinearRing><gml:posList>{}{}{}{}{}</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>"
        "</lod2MultiSurface></Building></CityModel>",
        system, corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1), corner(-1, -1));
}

Result<CityFile> read_roof(const std::string& text, const CityFileSettings& settings = {}) {
    return parse_citygml(text, "roof.gml", settings);
}

/// A place of a map, east first, and where it lies by PROJ 9.1.1 without the network and with Debian's proj-data alone:
/// `echo EAST NORTH | cs2cs -f %.9f SYSTEM EPSG:4326`, north before east for the systems whose first axis is north.
struct MappedPlace {
    const char* system;
    double east, north, latitude, longitude;
    bool north_first = false;
    double tolerance = 0.01;  ///< m; of a datum other than WGS 84 later versions may know better transformations
};
constexpr std::array mapped_places{
    MappedPlace{"EPSG:28992", 84878.653, 447586.818, 52.012207498, 4.365796156, false, 1},
    MappedPlace{"EPSG:27700", 530000, 180000, 51.503990828, -0.128353940, false, 1},
    MappedPlace{"EPSG:2056", 2600000, 1200000, 46.951082772, 7.438632421, false, 1},
    MappedPlace{"EPSG:31256", 2000, 341000, 48.207400175, 16.359042768, true, 1},
    MappedPlace{"EPSG:6677", -8000, -35000, 35.684495882, 139.744947668, true},
    MappedPlace{"EPSG:2193", 1748735, 5427507, -41.290186824, 174.776293418, true},
    MappedPlace{"EPSG:2180", 637000, 487000, 52.231977419, 21.006704108, true},
    MappedPlace{"EPSG:31468", 4468000, 5333000, 48.134231331, 11.568634764, true, 1},
    MappedPlace{"EPSG:32661", 2500000, 1500000, 83.637317561, 45.000000000, true},
    // By formulas of our own in Python: Krueger's series to the third order, Lambert's
    // cone by EPSG guidance note 7-2 (method 9802), the sphere's Mercator.
    MappedPlace{"EPSG:25832", 691603.0320, 5334780.0309, 48.1374, 11.5755},
    MappedPlace{"EPSG:4647", 32691603.0320, 5334780.0309, 48.1374, 11.5755},
    MappedPlace{"EPSG:7856", 334900.5697, 6252288.7529, -33.8568, 151.2153},
    MappedPlace{"EPSG:2154", 648289.2745, 6863983.7035, 48.8738, 2.2950},
    MappedPlace{"EPSG:3857", 1224514.3987, 6123507.4250, 48.1, 11.0}};

double metres_from(const Geodetic& place, double latitude, double longitude) {
    return geodesic_between(place, Geodetic::degrees(latitude, longitude, 0)).length.value();
}

TEST(ReferenceSystem, FilesStandWhereProjPutsThemWithoutAKey) {
    for (const MappedPlace& p : mapped_places) {
        const auto file = read_roof(roof_file(p.system, p.east, p.north));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_LT(metres_from(file->model.origin, p.latitude, p.longitude), p.tolerance) << p.system;
        EXPECT_THAT(file->warnings, testing::Not(Contains(HasSubstr("first")))) << p.system;
    }
}

TEST(ReferenceSystem, UrnsHaveTheOrderOfAxesOfTheRegistry) {
    for (const MappedPlace& p : mapped_places) {
        if (!p.north_first) continue;
        const std::string urn = fmt::format("urn:ogc:def:crs:EPSG::{}", std::string_view(p.system).substr(5));
        const auto file = read_roof(roof_file(urn, p.north, p.east));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_LT(metres_from(file->model.origin, p.latitude, p.longitude), p.tolerance) << p.system;
    }
}

TEST(ReferenceSystem, TheOtherOrderOfAxesIsKnownByWhereItLies) {
    const MappedPlace vienna = mapped_places[3], warsaw = mapped_places[6];
    const auto by_area = read_roof(roof_file("EPSG:31256", vienna.north, vienna.east));
    ASSERT_TRUE(by_area) << by_area.error().message;
    EXPECT_LT(metres_from(by_area->model.origin, vienna.latitude, vienna.longitude), vienna.tolerance);
    EXPECT_THAT(by_area->warnings, ElementsAre(HasSubstr("(EPSG:31256) stand north first, by where they lie")));
    // Both orders lie in Poland; one of them near the run.
    CityFileSettings near;
    near.origin = Geodetic::degrees(52.23, 21.01, 100);
    const auto by_run = read_roof(roof_file("EPSG:2180", warsaw.north, warsaw.east), near);
    ASSERT_TRUE(by_run) << by_run.error().message;
    EXPECT_THAT(by_run->warnings, Contains(HasSubstr("(EPSG:2180) stand north first, by where they lie")));
    EXPECT_LT(by_run->model.vertices.at(0).head<2>().norm(), 500);
}

TEST(ReferenceSystem, NamesOfManyKindsAreRead) {
    const auto same = [](int place, std::string_view name) {
        const MappedPlace& p = mapped_places[static_cast<std::size_t>(place)];
        const auto file = read_roof(roof_file(name, p.east, p.north));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_LT(metres_from(file->model.origin, p.latitude, p.longitude), p.tolerance) << name;
    };
    for (const std::string_view name :
         {"epsg:25832", "urn:ogc:def:crs:EPSG:6.12:25832", "http://www.opengis.net/def/crs/EPSG/0/25832",
          "http://www.opengis.net/gml/srs/epsg.xml#25832", "urn:ogc:def:crs,crs:EPSG:6.12:25832,crs:EPSG:6.12:5783",
          "urn:adv:crs:ETRS89_UTM32*DE_DHHN92_NH", "ETRS89 / UTM zone 32N",
          "+proj=utm +zone=32 +ellps=GRS80 +type=crs"})
        same(9, name);
    for (const std::string_view name : {"urn:adv:crs:DE_DHDN_3GK4", "urn:adv:crs:DE_DHDN_3GK4*DE_DHHN92_NH"})
        same(7, name);
}

/// Runs PROJ's program; nothing where it is not installed.
std::optional<std::pair<double, double>> cs2cs(const MappedPlace& p) {
    const std::string command =
        fmt::format("echo {:.4f} {:.4f} | PROJ_NETWORK=OFF cs2cs -f %.9f {} EPSG:4326 2>/dev/null",
                    p.north_first ? p.north : p.east, p.north_first ? p.east : p.north, p.system);
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::array<char, 200> line{};
    double latitude = 0, longitude = 0;
    if (!pipe || !std::fgets(line.data(), line.size(), pipe.get())) return std::nullopt;
    if (std::sscanf(line.data(), "%lf %lf", &latitude, &longitude) != 2) return std::nullopt;
    return std::pair(latitude, longitude);
}

TEST(ReferenceSystem, AgreesWithTheProgramCs2cs) {
    if (std::system("command -v cs2cs >/dev/null") != 0) GTEST_SKIP() << "cs2cs of the package proj-bin is missing";
    for (const MappedPlace& p : mapped_places) {
        const auto expected = cs2cs(p);
        ASSERT_TRUE(expected) << p.system;
        const auto file = read_roof(roof_file(p.system, p.east, p.north));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_LT(metres_from(file->model.origin, expected->first, expected->second), 1) << p.system;
    }
}

// cs2cs itself takes a compound system whose grid of heights is missing by a ballpark transformation, which leaves the
// shift of the datum out, too: 100 m in the Netherlands. Places are those of the horizontal system.
TEST(ReferenceSystem, CompoundsLieWhereTheirHorizontalSystemDoes) {
    const auto geoid = flat_geoid(43.5);
    ASSERT_TRUE(geoid) << geoid.error().message;
    CityFileSettings settings;
    settings.geoid = &*geoid;
    for (const auto& [system, of, datum] :
         {std::tuple("EPSG:7415", 0, "NAP height"),
          std::tuple("urn:ogc:def:crs,crs:EPSG::28992,crs:EPSG::5709", 0, "NAP height"),
          std::tuple("EPSG:7405", 1, "ODN height"), std::tuple("EPSG:2056+5728", 2, "LN02 height"),
          std::tuple("EPSG:25832+7837", 9, "DHHN2016 height"), std::tuple("EPSG:25832+5621", 9, "EVRF2007 height"),
          std::tuple("EPSG:31256+5778", 3, "GHA height"), std::tuple("EPSG:5555", 9, "DHHN92 height")}) {
        const MappedPlace& p = mapped_places[static_cast<std::size_t>(of)];
        const auto file = read_roof(roof_file(system, p.east, p.north), settings);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_LT(metres_from(file->model.origin, p.latitude, p.longitude), p.tolerance) << system;
        if (file->model.origin.height.above_ellipsoid != Metres(53.5)) continue;  // where the grid is installed
        EXPECT_THAT(file->warnings, Contains(AllOf(HasSubstr("heights ("), HasSubstr(datum),
                                                   HasSubstr("taken as above mean sea level, the geoid EGM96"))))
            << system;
    }
}

// echo 52.01 4.36 10 | cs2cs -f %.4f EPSG:4326+5773 EPSG:4979, with egm96_15.gtx of proj-data.
TEST(ReferenceSystem, HeightsAreThoseOfProjWhereItHasTheGrid) {
    const auto file = read_roof(roof_file("EPSG:4326+5773", 52.01, 4.36, 10, 1e-4));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(file->model.origin.height.above_ellipsoid.value(), 53.4667, 1e-3);
    EXPECT_NEAR(file->model.vertices.at(0).z(), 0, 1e-3);
    EXPECT_THAT(file->warnings, IsEmpty());
}

TEST(ReferenceSystem, TheKeyStandsForWhatAFileNamesOrLeavesOut) {
    const MappedPlace& delft = mapped_places[0];
    CityFileSettings settings;
    settings.file_crs = "EPSG:28992";
    const std::string outline =
        fmt::format(R"({{"type":"Polygon","coordinates":[[[{0},{2}],[{1},{2}],[{1},{3}],[{0},{3}],[{0},{2}]]]}})",
                    delft.east - 10, delft.east + 10, delft.north - 10, delft.north + 10);
    const std::string grid = fmt::format("ncols 3\nnrows 3\nxllcenter {}\nyllcenter {}\ncellsize 10\n1 1 1 1 1 1 1 1 1",
                                         delft.east - 10, delft.north - 10);
    const std::string mesh = fmt::format("v {0} {2} 1\nv {1} {2} 1\nv {1} {3} 9\nv {0} {3} 9\nf 1 2 3 4\n",
                                         delft.east - 10, delft.east + 10, delft.north - 10, delft.north + 10);
    for (const auto& file :
         {read_roof(roof_file("EPSG:25832", delft.east, delft.north), settings), parse_geojson(outline, "a", settings),
          parse_height_grid(grid, "a", settings), parse_obj(mesh, "a", settings)}) {
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_LT(metres_from(file->model.origin, delft.latitude, delft.longitude), delft.tolerance) << file->format;
        EXPECT_LT(std::abs(file->model.vertices.at(0).head<2>().norm() - std::sqrt(200)), 0.01) << file->format;
    }
    settings.file_crs = "local";
    settings.origin = Geodetic::degrees(10, 10, 0);
    const auto laid = read_roof(roof_file("EPSG:28992", delft.east, delft.north), settings);
    ASSERT_TRUE(laid) << laid.error().message;
    EXPECT_LT((laid->model.vertices.at(0) - Eigen::Vector3d(-10, -10, 0)).norm(), 1e-6);
}

TEST(ReferenceSystem, AFileFarFromTheRunIsRefused) {
    CityFileSettings settings;
    settings.origin = Geodetic::degrees(46.4775, 30.7326, 50);
    settings.origin_is_guess = true;
    const MappedPlace& delft = mapped_places[0];
    const std::string town = roof_file("EPSG:28992", delft.east, delft.north);
    EXPECT_THAT(refusal(read_roof(town, settings)),
                AllOf(HasSubstr("roof.gml: EPSG:28992: lies at 52.0122, 4.3658 (latitude, longitude), 2003 km from the "
                                "start of the run at 46.4775, 30.7326"),
                      HasSubstr("scene.file_crs"), HasSubstr("scene.origin")));
    settings.origin = Geodetic::degrees(52.012, 5.81, 50);  // 99 km to the east
    EXPECT_TRUE(read_roof(town, settings));
    settings.origin = Geodetic::degrees(52.012, 5.84, 50);  // 101 km
    EXPECT_THAT(refusal(read_roof(town, settings)), HasSubstr("101 km from"));
}

TEST(ReferenceSystem, AnUnknownSystemIsRefusedUnlessAnOriginIsGiven) {
    const std::string town = roof_file("EPSG:99999", 5000, 6000);
    CityFileSettings settings;
    settings.origin = Geodetic::degrees(46.4775, 30.7326, 50);
    settings.origin_is_guess = true;
    EXPECT_THAT(refusal(read_roof(town, settings)),
                AllOf(HasSubstr("roof.gml: EPSG:99999: is no reference system that PROJ "), HasSubstr("scene.file_crs"),
                      HasSubstr("scene.origin")));
    settings.origin_is_guess = false;
    const auto given = read_roof(town, settings);
    ASSERT_TRUE(given) << given.error().message;
    EXPECT_THAT(given->warnings, ElementsAre(AllOf(HasSubstr("coordinates are projected (EPSG:99999"),
                                                   HasSubstr("no reference system that PROJ"))));
    const auto by_itself = read_roof(town);
    ASSERT_TRUE(by_itself) << by_itself.error().message;
    EXPECT_THAT(by_itself->warnings, ElementsAre(HasSubstr("its place on Earth is not known: give an origin")));
    settings.origin_is_guess = true;
    EXPECT_THAT(refusal(read_roof(roof_file("Amsterdam", 5000, 6000), settings)),
                HasSubstr("Amsterdam: is no reference system"))
        << "though names of PROJ's are like it";
    EXPECT_THAT(refusal(read_roof(roof_file("EPSG:4978", 5000, 6000), settings)),
                HasSubstr("EPSG:4978: is of another kind; expected a system of a map"));
}

TEST(ReferenceSystem, NumbersThatNoSuchMapHasAreRefused) {
    EXPECT_THAT(refusal(read_roof(roof_file("EPSG:28992", 5e6, 9e6))),
                AllOf(HasSubstr("EPSG:28992: no place of this map lies 5000000 m east and 9000000 m north"),
                      HasSubstr("scene.file_crs")));
    EXPECT_THAT(refusal(read_roof(roof_file("EPSG:25833", 3392118, 5820064))), HasSubstr("no place of this map"));
}

TEST(ReferenceSystem, AMissingGridOfTheDatumIsTold) {
    const auto file = read_roof(roof_file("EPSG:27700", 530000, 180000));
    ASSERT_TRUE(file) << file.error().message;
    if (file->warnings.empty()) GTEST_SKIP() << "Britain's grid is installed";
    EXPECT_THAT(file->warnings, ElementsAre(AllOf(HasSubstr("places are right to 2 m: the grid uk_os_OSTN15"),
                                                  HasSubstr("is not installed (EPSG:27700)"))));
}

// With a folder that has no proj.db.
TEST(ReferenceSystem, WithoutTheDatabaseANamedSystemIsRefusedWithThePackagesName) {
    const auto folder = std::filesystem::temp_directory_path();
    ::setenv("PROJ_DATA", folder.c_str(), 1);
    ::setenv("PROJ_LIB", folder.c_str(), 1);
    const auto named = read_roof(roof_file("EPSG:28992", 84878, 447586));
    const auto degrees = read_roof(roof_file("EPSG:4326", 52, 4, 10, 1e-4));
    ::unsetenv("PROJ_DATA");
    ::unsetenv("PROJ_LIB");
    EXPECT_TRUE(degrees) << "needs no database";
    if (named) GTEST_SKIP() << "PROJ finds its database elsewhere";
    EXPECT_EQ(named.error().code, ErrorCode::outside);
    EXPECT_THAT(named.error().message,
                HasSubstr("roof.gml: EPSG:28992: PROJ's database proj.db is missing: install the package proj-data"));
}

}  // namespace
}  // namespace skyloop::test
