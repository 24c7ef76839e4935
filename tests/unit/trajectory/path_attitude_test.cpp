// How a vehicle stands on a recorded path: as its rows tell, or as its motion asks for.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/geo/attitude.hpp"
#include "law_track.hpp"
#include "motion/trajectory/recorded_path.hpp"

namespace skyloop {
namespace {

RecordedPath standing_path(Track& track, const CurveSettings& settings = {}) {
    const auto gaps = clean_track(track, Seconds(10));
    EXPECT_TRUE(gaps.has_value());
    return RecordedPath(track, *gaps, recorded_start, settings);
}

TruthState standing_at(const RecordedPath& path, double t) { return path.at(advanced(recorded_start, Seconds(t))); }

Attitude attitude_on(const RecordedPath& path, double t) {
    const TruthState state = standing_at(path, t);
    EXPECT_TRUE(state.orientation.has_value());
    return state.orientation ? state.orientation->attitude : Attitude();
}

CurveSettings standing_as(VehicleClass vehicle, std::optional<Angle> heading = {}) { return {vehicle, heading, {}}; }

constexpr double degree = std::numbers::pi / 180;

TEST(PathAttitude, KeepsThatOfTheRowsAndTurnsWithoutAStep) {
    const auto attitude = [](double t) {
        return Attitude::roll_pitch_yaw(Angle::degrees(20 * std::sin(t)), Angle::degrees(8 * std::cos(0.7 * t)),
                                        Angle::degrees(170 + 25 * t));
    };
    Track track = track_of(circle_of(200, 15), evenly(0, 30, 0.2), true);
    for (TrackRow& row : track.points)
        row.attitude = attitude(to_seconds(row.time).value());
    const RecordedPath path = standing_path(track);
    EXPECT_EQ(path.report().attitude, AttitudeSource::rows);
    EXPECT_EQ(path.report().rows_with_attitude, track.points.size());
    Eigen::Vector3d before = standing_at(path, 1).orientation->turn_rate;
    for (double t = 1; t < 29; t += 0.005) {
        const TruthState state = standing_at(path, t);
        EXPECT_LT(state.orientation->attitude.body_to_ned().angularDistance(attitude(t).body_to_ned()), 0.05 * degree);
        ASSERT_LT((state.orientation->turn_rate - before).norm(), 0.02) << t;  // 1 rad/s² or so times the step
        before = state.orientation->turn_rate;
        // The rate is that of the attitude: q(t+δ) = q(t) exp(ω δ).
        const TruthState later = standing_at(path, t + 1e-4);
        const Eigen::Quaterniond turned = body_to_ecef(state.orientation->attitude, state.geodetic).conjugate() *
                                          body_to_ecef(later.orientation->attitude, later.geodetic);
        ASSERT_LT((2 * turned.vec() / 1e-4 - state.orientation->turn_rate).norm(), 2e-3) << t;
    }
}

TEST(PathAttitude, WithoutAVehicleItIsNotInvented) {
    Track track = track_of(circle_of(60, 20), evenly(0, 30, 1), true);
    const RecordedPath path = standing_path(track);
    EXPECT_EQ(path.report().attitude, AttitudeSource::none);
    EXPECT_FALSE(standing_at(path, 10).orientation.has_value());
}

TEST(PathAttitude, APlaneBanksAsTheTurnAsksFor) {
    // tan φ = v²/(R g) to the right, for the circle is clockwise.
    Track track = track_of(circle_of(400, 40, 2), evenly(0, 60, 1), true);
    const RecordedPath path = standing_path(track, standing_as(VehicleClass::plane));
    EXPECT_EQ(path.report().attitude, AttitudeSource::motion);
    for (double t = 5; t < 55; t += 0.7) {
        const Attitude attitude = attitude_on(path, t);
        EXPECT_NEAR(attitude.roll().deg(), std::atan(40.0 * 40 / 400 / 9.80665) / degree, 0.3) << t;
        EXPECT_NEAR(attitude.pitch().deg(), std::atan(2.0 / 40) / degree + 3, 0.3) << t;
        const Eigen::Vector3d way = slope_of(circle_of(400, 40, 2), t);
        EXPECT_NEAR(std::remainder(attitude.yaw().rad() - std::atan2(way.x(), way.y()), 2 * std::numbers::pi), 0,
                    0.5 * degree);
        EXPECT_NEAR(standing_at(path, t).orientation->turn_rate.norm(), 0.1, 0.005) << "40 m/s on 400 m";
    }
}

TEST(PathAttitude, AMultirotorLeansIntoItsAcceleration) {
    // Along north: speeds up by 3 m/s² for 4 s.
    const PathLaw law = [](double t) {
        const double s = t < 5 ? 0 : t < 9 ? 1.5 * (t - 5) * (t - 5) : 24 + 12 * (t - 9);
        return Eigen::Vector3d(0, s, 0);
    };
    Track track = track_of(law, evenly(0, 20, 0.1), true);
    const RecordedPath path = standing_path(track, standing_as(VehicleClass::multirotor, Angle::degrees(0)));
    EXPECT_NEAR(attitude_on(path, 2).pitch().deg(), 0, 0.1) << "hovers";
    EXPECT_NEAR(attitude_on(path, 7).pitch().deg(), -std::atan((3 + 0.1 * 6) / 9.80665) / degree, 0.5);
    EXPECT_NEAR(attitude_on(path, 15).pitch().deg(), -std::atan(0.1 * 12 / 9.80665) / degree, 0.3) << "drag alone";
    EXPECT_NEAR(attitude_on(path, 15).roll().deg(), 0, 0.1);
}

TEST(PathAttitude, ACarReversesWithoutTurningRoundAndHoldsItsYawAtRest) {
    // North for 5 s, rest for 5 s, back for 5 s, rest.
    const PathLaw law = [](double t) {
        const auto leg = [](double u) { return u <= 0 ? 0.0 : u >= 5 ? 10.0 : 10 * u * u * (15 - 2 * u) / 125; };
        return Eigen::Vector3d(0, leg(t) - leg(t - 10), 0);
    };
    Track track = track_of(law, evenly(0, 20, 0.1), true);
    const RecordedPath path = standing_path(track, standing_as(VehicleClass::car));
    for (double t = 0; t <= 20; t += 0.05)
        ASSERT_NEAR(attitude_on(path, t).yaw().deg(), 0, 0.5) << t;
    // On foot one turns round.
    const RecordedPath walk = standing_path(track, standing_as(VehicleClass::pedestrian));
    EXPECT_NEAR(std::abs(attitude_on(walk, 13).yaw().deg()), 180, 1);
}

TEST(PathAttitude, UntilItMovesItLooksWhereItIsTold) {
    const PathLaw law = [](double t) { return Eigen::Vector3d(t < 10 ? 0 : 2 * (t - 10) * (t - 10), 0, 0); };
    Track track = track_of(law, evenly(0, 15, 0.1), true);
    EXPECT_NEAR(attitude_on(standing_path(track, standing_as(VehicleClass::car, Angle::degrees(30))), 2).yaw().deg(),
                30, 0.01);
    EXPECT_NEAR(attitude_on(standing_path(track, standing_as(VehicleClass::car)), 2).yaw().deg(), 90, 0.01)
        << "nothing told: where it first goes";
    const RecordedPath fixed = standing_path(track, standing_as(VehicleClass::fixed, Angle::degrees(30)));
    EXPECT_NEAR(attitude_on(fixed, 14).yaw().deg(), 30, 0.01);
}

TEST(PathAttitude, ABoatHeelsOutOfTheTurnAndACarLeans) {
    for (const auto& [vehicle, degrees_per_g] :
         {std::pair{VehicleClass::boat, 15.0}, std::pair{VehicleClass::car, 4.0}}) {
        Track track = track_of(circle_of(50, 10, 0), evenly(0, 60, 0.5), true);
        const RecordedPath path = standing_path(track, standing_as(vehicle));
        EXPECT_NEAR(attitude_on(path, 30).roll().deg(), -degrees_per_g * 2 / 9.80665, 0.1) << "2 m/s² to the right";
    }
}

TEST(PathAttitude, NothingLeadsAcrossAJump) {
    Track track =
        track_of([](double t) { return Eigen::Vector3d(0, t < 10 ? 5 * t : 1000 - 5 * t, 0); }, evenly(0, 20, 1), true);
    track.points[10].jump = true;
    track.points[10].velocity = track.points[11].velocity;
    const RecordedPath path = standing_path(track, standing_as(VehicleClass::car));
    EXPECT_EQ(path.report().stretches, 2u);
    EXPECT_EQ(path.duration().value(), 20);
    const TruthState last = standing_at(path, 9.5), next = standing_at(path, 10);
    EXPECT_LT((last.position - track.points[9].position).length().value(), 1e-6) << "it holds at the last row";
    EXPECT_EQ(last.velocity.length().value(), 0);
    EXPECT_LT((next.position - track.points[10].position).length().value(), 1e-6);
    EXPECT_NEAR(next.velocity.length().value(), 5, 1e-3);
    EXPECT_NEAR(attitude_on(path, 9.9).yaw().deg(), 0, 0.5);
    EXPECT_NEAR(std::abs(attitude_on(path, 10).yaw().deg()), 180, 0.5);
    // Speeds stay ordinary on both sides.
    for (double t = 0; t <= 20; t += 0.01)
        ASSERT_LT(standing_at(path, t).velocity.length().value(), 6) << t;
}

TEST(PathAttitude, EveryRowMayBeAJump) {
    Track track = track_of(circle_of(60, 20), {0, 1, 2, 3}, false);
    for (TrackRow& row : track.points)
        row.jump = true;
    const RecordedPath path = standing_path(track, standing_as(VehicleClass::plane));
    for (double t = -1; t < 5; t += 0.1) {
        const TruthState state = standing_at(path, t);
        ASSERT_TRUE(state.position.vector().allFinite());
        ASSERT_TRUE(state.orientation->attitude.body_to_ned().coeffs().allFinite());
        ASSERT_EQ(state.velocity.length().value(), 0) << t;
    }
}

}  // namespace
}  // namespace skyloop
