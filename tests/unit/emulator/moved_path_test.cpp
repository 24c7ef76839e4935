#include "run/emulator/antenna_path.hpp"

#include <gtest/gtest.h>

#include "base/geo/local_frame.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;

// 20 m/s to the east of its home, in a straight line. Counts who asks it.
class Eastward : public Trajectory {
public:
    static constexpr GpsTime start = GpsTime{} + 24h;
    explicit Eastward(int& asked) : asked_(asked) {}
    [[nodiscard]] TruthState at(GpsTime time) const override {
        ++asked_;
        TruthState state;
        state.velocity = LocalFrame(home_).to_ecef(Velocity<Enu>(Eigen::Vector3d(20, 0, 0)));
        state.position = to_ecef(home_) + Displacement<Ecef>(state.velocity.vector() * difference(time, start).value());
        state.geodetic = to_geodetic(state.position);
        return state;
    }

private:
    Geodetic home_ = Geodetic::degrees(46, 30, 100);
    int& asked_;
};

Eigen::Vector3d velocity_at(const TruthState& state) {
    return LocalFrame(state.geodetic).to_enu(state.velocity).vector();
}

TEST(MovedPath, GoesOnInItsOwnDirectionOverTheGround) {
    int asked = 0;
    const Geodetic place = Geodetic::degrees(-33, 151, 20);
    const auto path = MovedPath::moved(std::make_unique<Eastward>(asked), place, Eastward::start);
    const TruthState there = path->at(Eastward::start), later = path->at(Eastward::start + 10s);
    EXPECT_NEAR((there.position - to_ecef(place)).vector().norm(), 0, 1e-6);
    EXPECT_NEAR((velocity_at(there) - Eigen::Vector3d(20, 0, 0)).norm(), 0, 1e-9);
    const Eigen::Vector3d way = LocalFrame(place).to_enu(later.position - to_ecef(place)).vector();
    EXPECT_NEAR((way - Eigen::Vector3d(200, 0, 0)).norm(), 0, 1e-6);
}

TEST(MovedPath, CostsAsMuchAfterManyMovesAsAfterOne) {
    int asked = 0;
    std::unique_ptr<Trajectory> path = std::make_unique<Eastward>(asked);
    GpsTime now = Eastward::start;
    for (int i = 0; i < 1000; ++i, now += 100ms) {
        const Geodetic place = Geodetic::degrees(-60 + 0.12 * i, 0.3 * i - 150, i % 50);
        path = MovedPath::moved(std::move(path), place, now);
        ASSERT_NEAR((path->at(now).position - to_ecef(place)).vector().norm(), 0, 1e-6) << i;
    }
    asked = 0;
    const TruthState state = path->at(now);
    EXPECT_EQ(asked, 1);
    EXPECT_NEAR(state.velocity.vector().norm(), 20, 1e-9) << "the turns stay turns";
    EXPECT_NEAR(velocity_at(state).x(), 20, 0.01) << "to the east, but for the line's own way off the curved ground";
}

}  // namespace
}  // namespace skyloop::test
