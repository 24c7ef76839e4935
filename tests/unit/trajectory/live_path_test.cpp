#include "motion/trajectory/live_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

const GpsTime live_start = GpsTime() + std::chrono::hours(24 * 365 * 46);
const Geodetic live_origin = Geodetic::degrees(48.1, 11.5, 500);

GpsTime live_time(double seconds) { return advanced(live_start, Seconds(seconds)); }

// A circle of 60 m at 20 m/s.
struct RoundFlight {
    double radius = 60, speed = 20;
    LocalFrame frame{live_origin};
    [[nodiscard]] TruthSample at(double t, bool with_velocity = true) const {
        const double angle = speed / radius * t;
        TruthSample sample;
        sample.source_time = to_nanoseconds(Seconds(t));
        sample.position = frame.to_ecef(Position<Enu>(radius * std::sin(angle), radius * std::cos(angle), 10));
        if (with_velocity)
            sample.velocity = frame.to_ecef(Velocity<Enu>(speed * std::cos(angle), -speed * std::sin(angle), 0));
        sample.attitude = Attitude::roll_pitch_yaw(Angle(), Angle(), Angle::radians(std::numbers::pi / 2 + angle));
        return sample;
    }
    // m from where the vehicle is
    [[nodiscard]] double error(const TruthState& state, double t) const {
        return (state.position - at(t).position).length().value();
    }
    [[nodiscard]] double velocity_error(const TruthState& state, double t) const {
        return (state.velocity.vector() - at(t).velocity->vector()).norm();
    }
};

LivePath live_path(LivePathSettings settings = {}) {
    settings.before = live_origin;
    return LivePath(settings);
}

TEST(LivePath, StandsWhereItWasToldUntilTheFirstSample) {
    const LivePath path = live_path();
    const TruthState state = path.at(live_start);
    EXPECT_EQ(state.geodetic.latitude, live_origin.latitude);
    EXPECT_EQ(state.velocity.length().value(), 0);
    EXPECT_FALSE(state.orientation);
    EXPECT_EQ(path.state(live_start), LiveState::silent);
    EXPECT_FALSE(path.newest());
}

TEST(LivePath, StandsWhereItsFirstSampleIsBeforeItWhereNobodyNamedAPlace) {
    const RoundFlight circle;
    LivePathSettings settings;
    settings.begins_at_first = true;
    settings.delay = Seconds(1);
    LivePath path = live_path(settings);
    for (int i = 0; i <= 100; ++i)
        path.add(live_time(0.02 * i), circle.at(0.02 * i));
    for (const double t : {-2.0, 0.0, 0.5, 0.999}) {
        const TruthState state = path.at(live_time(t));
        EXPECT_LT(circle.error(state, 0), 1e-6) << t;
        EXPECT_EQ(state.velocity.length().value(), 0) << t;
        ASSERT_TRUE(state.orientation) << t;
        EXPECT_NEAR(state.orientation->attitude.yaw().rad(), std::numbers::pi / 2, 1e-9) << t;
        EXPECT_EQ(state.orientation->turn_rate.norm(), 0) << t;
    }
    EXPECT_LT(circle.error(path.at(live_time(2.5)), 1.5), 0.001) << "later it is late by the delay";
}

TEST(LivePath, KeepsItsSamplesAndIsSmoothBetweenThem) {
    const RoundFlight circle;
    LivePath path = live_path();
    for (int i = 0; i <= 200; ++i)
        path.add(live_time(0.05 * i), circle.at(0.05 * i));
    for (int i = 120; i <= 200; ++i)
        EXPECT_LT(circle.error(path.at(live_time(0.05 * i)), 0.05 * i), 1e-6);
    for (double t = 6; t < 10; t += 0.003) {
        EXPECT_LT(circle.error(path.at(live_time(t)), t), 0.0005) << t;
        EXPECT_LT(circle.velocity_error(path.at(live_time(t)), t), 0.02) << t;
    }
    const TruthState state = path.at(live_time(8.013));
    ASSERT_TRUE(state.orientation);
    EXPECT_NEAR(std::remainder(state.orientation->attitude.yaw().rad() - std::numbers::pi / 2 - 8.013 / 3,
                               2 * std::numbers::pi),
                0, 1e-4);
    EXPECT_NEAR(state.orientation->turn_rate.z(), 1 / 3.0, 1e-3);
    EXPECT_EQ(path.counts().samples, 201u);
    EXPECT_EQ(path.counts().jumps, 0u);
}

// As of a source that tells degrees in steps of 1e-7.
TruthSample rounded(TruthSample sample) {
    Geodetic place = to_geodetic(sample.position);
    place.latitude = Angle::degrees(std::round(place.latitude.deg() * 1e7) / 1e7);
    place.longitude = Angle::degrees(std::round(place.longitude.deg() * 1e7) / 1e7);
    sample.position = to_ecef(place);
    return sample;
}

TEST(LivePath, TakesVelocitiesOfTheSourceAndNotOfItsRoundedPlaces) {
    const RoundFlight circle;
    LivePath path = live_path();
    for (int i = 0; i <= 800; ++i)
        path.add(live_time(0.005 * i), rounded(circle.at(0.005 * i)));
    for (double t = 2; t < 4; t += 0.0013) {
        EXPECT_LT(circle.error(path.at(live_time(t)), t), 0.012) << t;
        EXPECT_LT(circle.velocity_error(path.at(live_time(t)), t), 0.02) << t;
    }
}

TEST(LivePath, FindsVelocitiesThatTheSourceDoesNotTell) {
    const RoundFlight circle;
    LivePath path = live_path();
    for (int i = 0; i <= 200; ++i)
        path.add(live_time(0.02 * i), circle.at(0.02 * i, false));
    for (double t = 2; t < 4; t += 0.003) {
        EXPECT_LT(circle.error(path.at(live_time(t)), t), 0.005) << t;
        EXPECT_LT(circle.velocity_error(path.at(live_time(t)), t), 0.1) << t;
    }
    EXPECT_EQ(path.counts().jumps, 0u);
}

TEST(LivePath, CoastsFadesAndHolds) {
    const RoundFlight circle;
    LivePath path = live_path();
    for (int i = 0; i <= 100; ++i)
        path.add(live_time(0.02 * i), circle.at(0.02 * i));
    const auto state = [&](double age) { return path.state(live_time(2 + age)); };
    EXPECT_EQ(state(0.025), LiveState::live);
    EXPECT_EQ(state(0.2), LiveState::coasting);
    EXPECT_EQ(state(0.7), LiveState::fading);
    EXPECT_EQ(state(1.6), LiveState::holding);
    EXPECT_LT(circle.error(path.at(live_time(2.1)), 2.1), 0.02);
    EXPECT_EQ(path.counts().coasts, 1u);
    EXPECT_EQ(path.counts().holds, 0u);
    const TruthState held = path.at(live_time(4)), later = path.at(live_time(400));
    EXPECT_EQ(held.velocity.length().value(), 0);
    EXPECT_EQ((held.position - later.position).length().value(), 0);
    EXPECT_EQ(path.counts().coasts, 1u);
    EXPECT_EQ(path.counts().holds, 1u);
}

TEST(LivePath, WaitsForSlowSourcesByTheirOwnStep) {
    const RoundFlight circle{.radius = 1000};
    LivePath path = live_path();
    for (int i = 0; i <= 20; ++i)
        path.add(live_time(i), circle.at(i));
    EXPECT_EQ(path.state(live_time(21.2)), LiveState::live);
    EXPECT_EQ(path.state(live_time(22)), LiveState::fading);
    EXPECT_EQ(path.counts().jumps, 0u);
}

TEST(LivePath, IsLateByItsDelay) {
    const RoundFlight circle;
    LivePath path = live_path({.delay = Seconds(0.1)});
    for (int i = 0; i <= 100; ++i)
        path.add(live_time(0.05 * i), circle.at(0.05 * i));
    EXPECT_LT(circle.error(path.at(live_time(4.63)), 4.53), 0.001);
    EXPECT_EQ(path.at(live_time(4.63)).time, live_time(4.63));
}

// What a receiver sees of a path: asked every 5 ms while samples come. The acceleration between two looks is bounded,
// so there is no step of the velocity; and velocity is the slope of the position.
struct Smoothness {
    double most_acceleration = 0, most_mismatch_mps = 0;
};
Smoothness watch(LivePath& path, const RoundFlight& circle, double from, double to, const auto& arrives) {
    constexpr double look_s = 0.005, sample_s = 0.02;
    Smoothness seen;
    int next = static_cast<int>(from / sample_s);
    std::optional<TruthState> before;
    for (double t = from; t < to; t += look_s) {
        for (; sample_s * next <= t + 1e-9; ++next)
            if (arrives(sample_s * next)) path.add(live_time(sample_s * next), circle.at(sample_s * next));
        const TruthState state = path.at(live_time(t));
        if (before) {
            const Eigen::Vector3d change = state.velocity.vector() - before->velocity.vector();
            seen.most_acceleration = std::max(seen.most_acceleration, change.norm() / look_s);
            const Eigen::Vector3d moved = (state.position - before->position).vector() / look_s;
            const Eigen::Vector3d mean = (state.velocity.vector() + before->velocity.vector()) / 2;
            seen.most_mismatch_mps = std::max(seen.most_mismatch_mps, (moved - mean).norm());
        }
        before = state;
    }
    return seen;
}

TEST(LivePath, HasNoStepOfVelocityWhileItsSourceIsSmooth) {
    const RoundFlight circle;
    LivePath path = live_path();
    watch(path, circle, 0, 1, [](double) { return true; });
    const Smoothness live = watch(path, circle, 1, 4, [](double) { return true; });
    EXPECT_LT(live.most_acceleration, 15);  // 6.7 m/s² by itself; a step of 5 cm/s would be 10 more
    EXPECT_LT(live.most_mismatch_mps, 0.1);
}

TEST(LivePath, HasNoStepOfVelocityThroughCoastFadeAndReturn) {
    for (const double silence : {0.1, 0.25, 0.4}) {
        const RoundFlight circle{.radius = 200};
        LivePath path = live_path();
        watch(path, circle, 0, 3, [](double) { return true; });
        const Smoothness seen = watch(path, circle, 3, 6, [&](double t) { return t < 3.5 || t > 3.5 + silence; });
        EXPECT_EQ(path.counts().jumps, 0u) << silence;
        // Taking 1 m away within 0.3 s needs 64 m/s²; a step of the velocity by 2 m/s would be 400.
        EXPECT_LT(seen.most_acceleration, 150) << silence;
        EXPECT_LT(seen.most_mismatch_mps, 0.3) << silence;
        EXPECT_LT(circle.error(path.at(live_time(6)), 6), 0.01) << silence;
    }
}

TEST(LivePath, ComesToRestAndStartsAgainSmoothlyWhereNothingHasMoved) {
    const RoundFlight standing{.radius = 60, .speed = 0};
    LivePath path = live_path();
    const auto arrives = [](double t) { return t < 1 || t > 4; };
    const Smoothness seen = watch(path, standing, 0, 6, arrives);
    EXPECT_LT(seen.most_acceleration, 0.01);
    EXPECT_EQ(path.counts().jumps, 0u);
    EXPECT_EQ(path.counts().holds, 1u);
}

TEST(LivePath, DoesNotLeadAcrossAJump) {
    const RoundFlight circle;
    for (const bool said : {true, false}) {
        LivePath path = live_path();
        for (int i = 0; i < 50; ++i)
            path.add(live_time(0.02 * i), circle.at(0.02 * i));
        for (int i = 50; i < 100; ++i) {
            TruthSample sample = circle.at(0.02 * i + (said ? 0 : 5));
            sample.jump = said && i == 50;
            path.add(live_time(0.02 * i), sample);
        }
        EXPECT_EQ(path.counts().jumps, 1u);
        EXPECT_LT(circle.error(path.at(live_time(0.999)), 0.999), 0.01);
        EXPECT_LT(circle.error(path.at(live_time(1.001)), 1.001 + (said ? 0 : 5)), 0.01);
        EXPECT_NEAR(path.at(live_time(1.001)).velocity.length().value(), 20, 0.1);
    }
}

TEST(LivePath, LeavesOutTheLateAndTakesTheLastOfEqualTimes) {
    const RoundFlight circle;
    LivePath path = live_path();
    for (int i = 0; i < 50; ++i) {
        path.add(live_time(0.02 * i), circle.at(0.02 * i));
        path.add(live_time(0.02 * i), circle.at(0.02 * i));         // twice
        path.add(live_time(0.02 * i + 1e-6), circle.at(0.02 * i));  // the same once more, by a moved clock
        if (i > 5) path.add(live_time(0.02 * (i - 3)), circle.at(0.02 * (i - 3)));  // overtaken
    }
    EXPECT_EQ(path.counts().late, 44u);
    EXPECT_EQ(path.counts().jumps, 0u);
    for (double t = 0.2; t < 0.98; t += 0.003)
        EXPECT_LT(circle.error(path.at(live_time(t)), t), 0.001);
}

TEST(LivePath, RefusesWhatCannotBe) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    const TruthSample good = RoundFlight().at(0);
    std::vector<TruthSample> bad(12, good);
    bad[0].position = Position<Ecef>(nan, 0, 0);
    bad[1].position = Position<Ecef>(0, infinite, 0);
    bad[2].position = Position<Ecef>(0, 0, 0);
    bad[3].position = Position<Ecef>(6378137, 0, 0);  // latitude and longitude zero
    bad[4].position = Position<Ecef>(good.position.vector() * 1.2);
    bad[5].position = Position<Ecef>(good.position.vector() * 0.8);
    bad[6].velocity = Velocity<Ecef>(nan, 0, 0);
    bad[7].velocity = Velocity<Ecef>(0, 13e3, 0);
    bad[8].attitude = Attitude(Eigen::Quaterniond(0, 0, 0, 0) * Eigen::Quaterniond(nan, 0, 0, 0));
    bad[9].turn_rate = Eigen::Vector3d(0, infinite, 0);
    bad[10].acceleration = Eigen::Vector3d(0, nan, 0);
    bad[11].position = Position<Ecef>(1e300, 1e300, 1e300);
    LivePath path = live_path();
    for (const TruthSample& sample : bad)
        path.add(live_start, sample);
    EXPECT_EQ(path.counts().refused, bad.size());
    EXPECT_EQ(path.counts().samples, 0u);
}

double yaw_at(const LivePath& path, double t) {
    const TruthState state = path.at(live_time(t));
    return state.orientation ? state.orientation->attitude.yaw().rad() : std::numeric_limits<double>::quiet_NaN();
}

// A source may tell its attitude less often than its place.
TEST(LivePath, CarriesAnAttitudeOnThroughSamplesThatTellNone) {
    const RoundFlight circle;
    LivePath path = live_path();
    for (int i = 0; i <= 200; ++i) {
        TruthSample sample = circle.at(0.02 * i);
        if (i % 5 != 0) sample.attitude.reset();
        path.add(live_time(0.02 * i), sample);
        if (i < 20) continue;
        const double wanted = std::numbers::pi / 2 + 0.02 * i / 3;
        EXPECT_NEAR(std::remainder(yaw_at(path, 0.02 * i) - wanted, 2 * std::numbers::pi), 0, 0.01) << i;
        EXPECT_NEAR(path.at(live_time(0.02 * i)).orientation->turn_rate.z(), 1 / 3.0, 0.15) << i;
    }
    TruthSample silent = circle.at(14);
    silent.attitude.reset();
    path.add(live_time(14), silent);
    EXPECT_TRUE(std::isnan(yaw_at(path, 14))) << "behind a jump nothing is known of it";
}

TEST(LivePath, TurnsAnAttitudeOnByTheRateThatIsTold) {
    const RoundFlight standing{.speed = 0};
    LivePath path = live_path();
    for (int i = 0; i <= 50; ++i) {
        TruthSample sample = standing.at(0.02 * i);
        if (i > 0) sample.attitude.reset();
        sample.turn_rate = Eigen::Vector3d(0, 0, 0.5);
        path.add(live_time(0.02 * i), sample);
    }
    EXPECT_NEAR(yaw_at(path, 1), std::numbers::pi / 2 + 0.5, 0.03);
    TruthSample reset = standing.at(1.02);
    reset.attitude.reset();
    reset.jump = true;
    path.add(live_time(1.02), reset);
    EXPECT_TRUE(std::isnan(yaw_at(path, 1.02)));
}

TEST(LivePath, KeepsTheAttitudeOfAnInstantThatIsToldAgainWithoutOne) {
    const RoundFlight circle;
    LivePath path = live_path();
    for (int i = 0; i <= 50; ++i) {
        path.add(live_time(0.02 * i), circle.at(0.02 * i));
        TruthSample again = circle.at(0.02 * i);
        again.attitude.reset();
        path.add(live_time(0.02 * i), again);
    }
    EXPECT_NEAR(yaw_at(path, 0.5), std::numbers::pi / 2 + 0.5 / 3, 1e-3);
    EXPECT_NEAR(yaw_at(path, 1), std::numbers::pi / 2 + 1 / 3.0, 1e-9);
}

TEST(LivePath, TellsWhenItComesToRest) {
    const RoundFlight circle;
    LivePath path = live_path({.delay = Seconds(0.1)});
    EXPECT_FALSE(path.rests_at());
    for (int i = 0; i <= 100; ++i)
        path.add(live_time(0.02 * i), circle.at(0.02 * i));
    ASSERT_TRUE(path.rests_at());
    EXPECT_EQ(*path.rests_at(), live_time(3.6));
    EXPECT_EQ(path.state(*path.rests_at()), LiveState::fading);
    EXPECT_EQ(path.state(*path.rests_at() + 1ms), LiveState::holding);
}

TEST(LivePath, SaysWhyASampleCannotBe) {
    TruthSample sample = RoundFlight().at(0);
    EXPECT_FALSE(implausible(sample));
    sample.velocity = Velocity<Ecef>(0, 13e3, 0);
    EXPECT_EQ(implausible(sample), "the speed is 13000 m/s; expected less than 12 000");
    sample.velocity.reset();
    sample.position = to_ecef(Geodetic::degrees(48, 11, 2e6));
    EXPECT_EQ(implausible(sample), "the height is 2000000 m above the ellipsoid; expected less than 1 000 000");
}

TEST(LivePath, StaysFiniteUnderAnySamples) {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> unit(-1, 1);
    LivePath path = live_path();
    const LocalFrame frame(live_origin);
    double t = 0;
    for (int i = 0; i < 20000; ++i) {
        t += unit(random) > 0.9 ? 10 * unit(random) : 1e-9 + 0.01 * std::abs(unit(random));
        TruthSample sample;
        const double far = unit(random) > 0.95 ? 1e5 : 1;
        sample.position = frame.to_ecef(Position<Enu>(far * unit(random), far * unit(random), unit(random)));
        if (unit(random) > 0) sample.velocity = Velocity<Ecef>(100 * unit(random), 0, 11e3 * unit(random));
        if (unit(random) > 0) sample.acceleration = Eigen::Vector3d(1e4 * unit(random), 0, 0);
        if (unit(random) > 0)
            sample.attitude = Attitude::roll_pitch_yaw(Angle(), Angle(), Angle::radians(3 * unit(random)));
        if (unit(random) > 0) sample.turn_rate = Eigen::Vector3d(300 * unit(random), 0, 1);
        sample.jump = unit(random) > 0.9;
        path.add(live_time(t), sample);
        const TruthState state = path.at(live_time(t + unit(random)));
        ASSERT_TRUE(state.position.vector().allFinite() && state.velocity.vector().allFinite()) << i;
        ASSERT_TRUE(!state.orientation || state.orientation->attitude.body_to_ned().coeffs().allFinite()) << i;
    }
}

}  // namespace
}  // namespace skyloop
