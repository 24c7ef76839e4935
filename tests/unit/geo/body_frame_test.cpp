// Attitudes against the Earth as a whole.
#include "base/geo/attitude.hpp"

#include <gtest/gtest.h>

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

TEST(BodyFrame, NorthEastDownAreThoseOfTheLocalFrame) {
    for (const double latitude : {-90.0, -35.0, 0.0, 47.0, 90.0})
        for (const double longitude : {-179.0, -60.0, 0.0, 30.0, 180.0}) {
            const Geodetic place = Geodetic::degrees(latitude, longitude, 100);
            const LocalFrame frame(place);
            const Eigen::Quaterniond q = ned_to_ecef(place);
            EXPECT_LT((q * Eigen::Vector3d(1, 2, 3) - frame.to_ecef(Velocity<Enu>(2, 1, -3)).vector()).norm(), 1e-12);
        }
}

}  // namespace
}  // namespace skyloop
