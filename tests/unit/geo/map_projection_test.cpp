#include "base/geo/map_projection.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

struct MappedPlace {
    int code;
    double east, north, latitude, longitude;
};

// Forward by formulas of our own in Python: Krueger's series to the third order, Lambert's cone by EPSG guidance note
// 7-2 (method 9802), the sphere's Mercator.
TEST(MapProjection, TakesPlacesOfTheMapToTheEarth) {
    for (const MappedPlace& p : {MappedPlace{25832, 691603.0320, 5334780.0309, 48.1374, 11.5755},
                                 {32632, 691603.0320, 5334780.0309, 48.1374, 11.5755},
                                 {5555, 691603.0320, 5334780.0309, 48.1374, 11.5755},
                                 {4647, 32691603.0320, 5334780.0309, 48.1374, 11.5755},
                                 {25832, 32691603.0320, 5334780.0309, 48.1374, 11.5755},
                                 {5649, 31550467.5143, 5655631.7112, 51.05, 3.72},
                                 {5650, 33392118.4866, 5820064.6749, 52.52, 13.41},
                                 {7856, 334900.5697, 6252288.7529, -33.8568, 151.2153},
                                 {32756, 334900.5697, 6252288.7529, -33.8568, 151.2153},
                                 {2154, 648289.2745, 6863983.7035, 48.8738, 2.2950},
                                 {3857, 1224514.3987, 6123507.4250, 48.1, 11.0}}) {
        const auto projection = MapProjection::of_epsg(p.code);
        ASSERT_TRUE(projection) << p.code;
        const EarthPlace place = projection->on_earth({p.east, p.north});
        EXPECT_NEAR(place.latitude.deg(), p.latitude, 2e-9) << p.code;
        EXPECT_NEAR(place.longitude.deg(), p.longitude, 2e-9) << p.code;
    }
}

TEST(MapProjection, ReachesBeyondTheZoneButNotAroundTheEarth) {
    const auto utm = MapProjection::of_epsg(25833);
    ASSERT_TRUE(utm);
    for (const double east : {-50e3, 392e3, 1.1e6, 33.392e6})
        EXPECT_TRUE(utm->reaches({east, 5.82e6})) << east;
    // Of zone 32, and of Gauss and Krueger's third.
    for (const double east : {32.692e6, 3.392e6, -3e6})
        EXPECT_FALSE(utm->reaches({east, 5.82e6})) << east;
    EXPECT_FALSE(utm->reaches({392e3, 33.4e6})) << "north and east exchanged";
}

TEST(MapProjection, KnowsNoOthers) {
    // Geographic, Dutch, Bessel's ellipsoid, beyond the zones.
    for (const int code : {0, 4326, 28992, 31468, 32661, 32600})
        EXPECT_FALSE(MapProjection::of_epsg(code)) << code;
}

}  // namespace
}  // namespace skyloop
