#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "world/city/city_file.hpp"

namespace skyloop::city_doubts_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Two walls that meet, and a roof.
CityModel house(double width, double height, const Eigen::Vector3d& at = Eigen::Vector3d::Zero()) {
    CityModel city;
    const Eigen::Vector3d east(width, 0, 0), north(0, width, 0), up(0, 0, height);
    city.add_quad({at, at + east, at + east + up, at + up}, SurfaceKind::wall);
    city.add_quad({at, at + north, at + north + up, at + up}, SurfaceKind::wall);
    city.add_quad({at + up, at + up + east, at + up + east + north, at + up + north}, SurfaceKind::roof);
    return city;
}

TEST(DoubtsAbout, HasNoneAboutAnOrdinaryCity) {
    EXPECT_THAT(doubts_about(house(500, 40)), IsEmpty());
    EXPECT_THAT(doubts_about(CityModel{}), IsEmpty());
}

TEST(DoubtsAbout, TellsOfUnitsThatCannotBe) {
    EXPECT_THAT(doubts_about(house(100, 3)), Contains(HasSubstr("3.00 m tall")));
    EXPECT_THAT(doubts_about(house(5, 4)), Contains(HasSubstr("5.00 m wide")));
    EXPECT_THAT(doubts_about(house(1000, 4000)), Contains(HasSubstr("4000 m tall")));
    EXPECT_THAT(doubts_about(house(150'000, 40)), Contains(HasSubstr("150 km wide")));
}

TEST(DoubtsAbout, TellsOfCoordinatesFarFromTheOrigin) {
    EXPECT_THAT(doubts_about(house(500, 40, {691'000, 5'334'000, 500})),
                Contains(AllOf(HasSubstr("5379 km from its origin"), HasSubstr("scene.file_origin"))));
}

TEST(DoubtsAbout, TellsOfMissingWallsAndOfDeepOnes) {
    CityModel roofs = house(500, 40);
    roofs.triangles.erase(roofs.triangles.begin(), roofs.triangles.begin() + 4);
    roofs.add_quad({Eigen::Vector3d(0, 0, 0), {9, 0, 0}, {9, 9, 0}, {0, 9, 0}}, SurfaceKind::ground);
    EXPECT_THAT(doubts_about(roofs), Contains(HasSubstr("no wall")));
    CityModel deep = house(500, 140, {0, 0, -100});
    deep.add_quad({Eigen::Vector3d(0, 0, 0), {9, 0, 0}, {9, 9, 0}, {0, 9, 0}}, SurfaceKind::ground);
    EXPECT_THAT(doubts_about(deep), Contains(HasSubstr("100 m below the lowest ground")));
}

TEST(DoubtsAbout, OverlooksCornersThatAreNoNumbersAndTerrainThatIsFlat) {
    CityModel city = house(500, 40);
    city.add_triangle({Eigen::Vector3d(std::nan(""), 0, 0), {1e300, 0, INFINITY}, {0, NAN, 0}}, SurfaceKind::wall);
    city.vertices.back() = Eigen::Vector3d(0, std::nan(""), 0);
    city.vertices[city.vertices.size() - 2].setConstant(INFINITY);
    EXPECT_THAT(doubts_about(city), IsEmpty());
    CityModel plain;
    plain.add_quad({Eigen::Vector3d(0, 0, 0), {900, 0, 0}, {900, 900, 1}, {0, 900, 1}}, SurfaceKind::ground);
    EXPECT_THAT(doubts_about(plain), IsEmpty());
}

}  // namespace
}  // namespace skyloop::city_doubts_test
