// Laws of the curve that hold for any smooth motion, drawn at random: the rows are kept, velocity is the slope of the
// place and acceleration that of the velocity, and none of them steps.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "law_track.hpp"
#include "motion/trajectory/recorded_path.hpp"

namespace skyloop {
namespace {

// A sum of slow waves along each axis, anywhere on the Earth.
struct RandomMotion {
    LocalFrame frame;
    std::array<Eigen::Vector3d, 4> size{}, rate{}, phase{};
    Eigen::Vector3d drift{};

    explicit RandomMotion(std::mt19937& dice)
        : frame(Geodetic::degrees(std::uniform_real_distribution<double>(-89.9, 89.9)(dice),
                                  std::uniform_real_distribution<double>(-180, 180)(dice), 1000)) {
        std::uniform_real_distribution<double> share(-1, 1), positive(0.1, 1);
        for (std::size_t k = 0; k < size.size(); ++k)
            for (Eigen::Index axis = 0; axis < 3; ++axis) {
                size[k](axis) = 30 * share(dice);
                rate[k](axis) = 0.3 * positive(dice);
                phase[k](axis) = 6 * share(dice);
            }
        drift = Eigen::Vector3d(20 * share(dice), 20 * share(dice), 3 * share(dice));
    }
    // 0: place, 1: velocity, 2: acceleration; east, north, up.
    [[nodiscard]] Eigen::Vector3d at(double t, int derivative) const {
        Eigen::Vector3d sum = derivative == 0   ? Eigen::Vector3d(drift * t)
                              : derivative == 1 ? drift
                                                : Eigen::Vector3d(Eigen::Vector3d::Zero());
        for (std::size_t k = 0; k < size.size(); ++k)
            for (Eigen::Index i = 0; i < 3; ++i)
                sum(i) += size[k](i) * std::pow(rate[k](i), derivative) *
                          std::sin(rate[k](i) * t + phase[k](i) + derivative * std::numbers::pi / 2);
        return sum;
    }
    [[nodiscard]] Track track(std::mt19937& dice, bool with_velocity) const {
        std::uniform_real_distribution<double> step(0.15, 0.4);
        Track track;
        double t = 0;
        for (int i = 0; i < 120; ++i, t += step(dice)) {
            TrackRow row;
            row.time = to_nanoseconds(Seconds(t));
            const double exact = to_seconds(row.time).value();
            row.position = frame.to_ecef(Position<Enu>(at(exact, 0)));
            if (with_velocity) row.velocity = frame.to_ecef(Velocity<Enu>(at(exact, 1)));
            track.points.push_back(row);
        }
        return track;
    }
};

struct Instant {
    Eigen::Vector3d place, velocity, acceleration;  // ECEF
};

Instant instant(const RecordedPath& path, double t) {
    const GpsTime time = advanced(recorded_start, Seconds(t));
    const TruthState state = path.at(time);
    return {state.position.vector(), state.velocity.vector(), path.acceleration(time)};
}

TEST(CurveProperty, RowsAreKeptAndDerivativesAreThose) {
    std::mt19937 dice(42);
    for (int round = 0; round < 40; ++round) {
        const RandomMotion motion(dice);
        const bool with_velocity = round % 2 == 0;
        const Track track = motion.track(dice, with_velocity);
        const RecordedPath path(track, {}, recorded_start);
        ASSERT_EQ(path.report().cubic_pieces, 0u);
        for (const TrackRow& row : track.points)
            ASSERT_LT((path.at(recorded_start + row.time).position - row.position).length().value(), 1e-6);
        constexpr double aside = 1e-3;
        for (double t = 1; t < path.duration().value() - 1; t += 0.0371) {
            const Instant before = instant(path, t - aside), now = instant(path, t), after = instant(path, t + aside);
            const Eigen::Vector3d place = motion.frame.to_enu(Position<Ecef>(now.place)).vector();
            ASSERT_LT((place - motion.at(t, 0)).norm(), with_velocity ? 1e-3 : 0.01) << t;
            const Eigen::Vector3d velocity = motion.frame.to_enu(Velocity<Ecef>(now.velocity)).vector();
            ASSERT_LT((velocity - motion.at(t, 1)).norm(), with_velocity ? 0.005 : 0.2) << t;
            // Places have steps of a nanometre, so that the slope is known to a micrometre a second; where the
            // acceleration changes, at worst at once and just here, it lies a quarter of that change beside.
            const double turn = aside / 4 * (after.acceleration - before.acceleration).norm();
            ASSERT_LT(((after.place - before.place) / (2 * aside) - now.velocity).norm(),
                      1e-6 * std::max(10.0, now.velocity.norm()) + turn)
                << t;
            ASSERT_LT(((after.velocity - before.velocity) / (2 * aside) - now.acceleration).norm(), 0.01) << t;
            ASSERT_LT((after.acceleration - before.acceleration).norm(), 0.2) << t;
            // The motion accelerates by 4 waves of up to 30 m · 0.09 /s² on each axis.
            ASSERT_LT(now.acceleration.norm(), 4 * 2.7 * std::sqrt(3.0) * 1.2) << t;
        }
    }
}

TEST(CurveProperty, NothingStepsAtTheRows) {
    std::mt19937 dice(43);
    for (int round = 0; round < 40; ++round) {
        const RandomMotion motion(dice);
        const Track track = motion.track(dice, round % 2 == 0);
        const RecordedPath path(track, {}, recorded_start);
        for (std::size_t i = 1; i + 1 < track.points.size(); ++i) {
            const double t = to_seconds(track.points[i].time).value();
            const Instant before = instant(path, t - 1e-8), after = instant(path, t + 1e-8);
            ASSERT_LT((after.place - before.place).norm(), 1e-5);
            ASSERT_LT((after.velocity - before.velocity).norm(), 1e-5);
            ASSERT_LT((after.acceleration - before.acceleration).norm(), 1e-4);
        }
    }
}

}  // namespace
}  // namespace skyloop
