// The smoother takes noise out of rows and leaves alone what is motion.
#include "motion/trajectory/track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "law_track.hpp"
#include "motion/trajectory/recorded_path.hpp"

namespace skyloop {
namespace {

Track noisy(const PathLaw& law, const std::vector<double>& times, double in_plan, double up) {
    std::mt19937 dice(11);
    std::normal_distribution<double> normal;
    Track track = track_of(law, times, false);
    for (TrackRow& row : track.points)
        row.position = row.position + recorded_frame.to_ecef(Displacement<Enu>(
                                          in_plan * normal(dice), in_plan * normal(dice), up * normal(dice)));
    return track;
}

// Root of the mean square, m and m/s.
struct Distance {
    double place = 0, velocity = 0;
};

Distance distance_from(const PathLaw& law, const Track& track, Smoothing smoothing) {
    const RecordedPath path(track, {}, recorded_start, {VehicleClass::car, {}, smoothing});
    Distance sum;
    int count = 0;
    for (double t = 10; t < 190; t += 0.1, ++count) {
        const TruthState state = path.at(advanced(recorded_start, Seconds(t)));
        sum.place += std::pow((recorded_frame.to_enu(state.position).vector() - law(t)).norm(), 2);
        sum.velocity += std::pow((recorded_frame.to_enu(state.velocity).vector() - slope_of(law, t)).norm(), 2);
    }
    return {std::sqrt(sum.place / count), std::sqrt(sum.velocity / count)};
}

TEST(TrackSmoothing, TellsTheNoiseOfTheRows) {
    for (const double sigma : {0.3, 1.5}) {
        const Track track = noisy(circle_of(300, 10), evenly(0, 600, 0.2), sigma, 2 * sigma);
        const PositionNoise noise = noise_of(track, VehicleClass::car);
        EXPECT_NEAR(noise.in_plan, sigma, 0.06 * sigma);
        EXPECT_NEAR(noise.up, 2 * sigma, 0.2 * sigma);
    }
    const PositionNoise none = noise_of(track_of(circle_of(60, 20), evenly(0, 60, 1), false), VehicleClass::car);
    EXPECT_EQ(none.in_plan, 0) << "a tight turn is no noise";
    EXPECT_EQ(none.up, 0);
}

TEST(TrackSmoothing, TakesNoiseOut) {
    const PathLaw law = circle_of(300, 10);
    const Track track = noisy(law, evenly(0, 200, 0.5), 1, 2);
    const Distance kept = distance_from(law, track, Smoothing::none);
    for (const Smoothing smoothing : {Smoothing::noise, Smoothing::sensor}) {
        const Distance smooth = distance_from(law, track, smoothing);
        EXPECT_LT(smooth.place, 0.7 * kept.place);
        EXPECT_LT(smooth.velocity, 0.3 * kept.velocity);
    }
}

TEST(TrackSmoothing, LeavesCleanRowsWhereTheyAre) {
    Track track = track_of(circle_of(60, 20), evenly(0, 100, 0.5), true);
    const Track before = track;
    const SmoothingReport report = smooth_track(track, VehicleClass::car, Smoothing::noise);
    EXPECT_FALSE(report.taken.has_value());
    for (std::size_t i = 0; i < track.points.size(); ++i)
        EXPECT_EQ((track.points[i].position - before.points[i].position).length().value(), 0);
}

TEST(TrackSmoothing, PassesByOutliersButFollowsAVehicleThatIsThere) {
    const PathLaw law = circle_of(300, 10);
    Track track = noisy(law, evenly(0, 200, 0.5), 0.5, 1);
    for (const std::size_t i : {50u, 120u, 200u})
        track.points[i].position = track.points[i].position + recorded_frame.to_ecef(Displacement<Enu>(80, 0, 0));
    const SmoothingReport report = smooth_track(track, VehicleClass::car, Smoothing::noise);
    EXPECT_EQ(report.outliers, 3u);
    EXPECT_LT((recorded_frame.to_enu(track.points[120].position).vector() - law(60)).norm(), 3);

    Track moved = noisy(law, evenly(0, 200, 0.5), 0.5, 1);
    for (std::size_t i = 200; i < moved.points.size(); ++i)
        moved.points[i].position = moved.points[i].position + recorded_frame.to_ecef(Displacement<Enu>(80, 0, 0));
    smooth_track(moved, VehicleClass::car, Smoothing::noise);
    EXPECT_LT(
        (recorded_frame.to_enu(moved.points[300].position).vector() - law(150) - Eigen::Vector3d(80, 0, 0)).norm(), 3);
}

}  // namespace
}  // namespace skyloop
