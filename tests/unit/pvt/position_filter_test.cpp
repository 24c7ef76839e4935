#include "receiver/pvt/position_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

using Eigen::Vector3d;

const Vector3d home(3800000, 2200000, 4600000);

PositionInput input_at(double second, const Vector3d& position, const Vector3d& velocity) {
    return {GpsTime(std::chrono::seconds(1'000'000'000)) + to_nanoseconds(Seconds(second)), Position<Ecef>(position),
            Metres(2), Velocity<Ecef>(velocity), MetresPerSecond(0.05)};
}

TEST(PositionFilter, RemembersThePositionAtRest) {
    PositionFilter filter({});
    const ReceiverSettings settings;
    RandomStream white(5, "white");
    RandomStream speed(5, "speed");
    std::vector<GaussMarkov> slow;
    for (const char* axis : {"x", "y", "z"})
        slow.emplace_back(GaussMarkovParameters{1.0, Seconds(120)}, RandomStream(5, axis));
    std::vector<double> x;
    for (int s = 0; s < 20000; ++s) {
        Vector3d error, velocity;
        for (int i = 0; i < 3; ++i) {
            error[i] = slow[static_cast<std::size_t>(i)].advance(Seconds(1)) + 0.4 * white.normal();
            velocity[i] = 0.03 * speed.normal();
        }
        const auto out = filter.update(input_at(s, home + error, velocity), settings);
        if (s > 100) x.push_back(out.position.vector().x() - home.x());
    }
    const auto autocorrelation = [&](std::size_t lag) {
        double mean = 0;
        for (const double v : x)
            mean += v / static_cast<double>(x.size());
        double a = 0, b = 0;
        for (std::size_t i = 0; i + lag < x.size(); ++i)
            a += (x[i] - mean) * (x[i + lag] - mean);
        for (const double v : x)
            b += (v - mean) * (v - mean);
        return a / b;
    };
    EXPECT_GE(autocorrelation(1), 0.99);
    EXPECT_GE(autocorrelation(10), 0.95);
    EXPECT_GE(autocorrelation(60), 0.5);
    EXPECT_LE(autocorrelation(60), 0.8);
}

TEST(VelocityFilter, AveragesAtRestAndFollowsAManoeuvre) {
    FilterParameters parameters;
    parameters.velocity_memory = Seconds(0.1);
    parameters.velocity_rest_memory = Seconds(2);
    VelocityFilter filter;
    RandomStream noise(7, "noise");
    const auto filtered = [&](double second, const Vector3d& velocity) {
        return filter
            .update(parameters, input_at(second, home, velocity).time, Velocity<Ecef>(velocity), MetresPerSecond(0.02),
                    DynamicModel::portable)
            .vector();
    };
    double before = 0, product = 0, square = 0;
    for (int s = 0; s < 20000; ++s) {
        const double now = filtered(s, Vector3d(0.01 * noise.normal(), 0, 0)).x();
        product += before * now;
        square += now * now;
        before = now;
    }
    EXPECT_NEAR(product / square, std::exp(-0.5), 0.03) << "remembers for two seconds";
    // A step beyond the noise: within half a second of epochs at 10 Hz.
    Vector3d last = Vector3d::Zero();
    for (int i = 1; i <= 5; ++i)
        last = filtered(20000 + 0.1 * i, Vector3d(10, 0, 0));
    EXPECT_NEAR(last.x(), 10, 0.1);
}

TEST(PositionFilter, IsExactAtConstantVelocity) {
    PositionFilter filter({});
    const Vector3d velocity(50, -30, 10);
    for (int s = 0; s < 200; ++s) {
        const auto out = filter.update(input_at(s, home + s * velocity, velocity), {});
        EXPECT_LT((out.position.vector() - home - s * velocity).norm(), 1e-6);
        EXPECT_EQ(out.velocity.vector(), velocity);
    }
}

// 60 m/s through turns of 2 g, with straight parts between: the worst error.
double worst_lag(double rate_hz) {
    PositionFilter filter({});
    const double turn_rate = 2 * 9.81 / 60;
    Vector3d position = home;
    double heading = 0;
    double worst = 0;
    const int parts = 1000;
    const double dt = 1 / rate_hz / parts;
    for (int epoch = 0; epoch < static_cast<int>(120 * rate_hz); ++epoch) {
        const double t = epoch / rate_hz;
        const Vector3d velocity(60 * std::cos(heading), 60 * std::sin(heading), 0);
        const auto out = filter.update(input_at(t, position, velocity), {});
        worst = std::max(worst, (out.position.vector() - position).norm());
        // Turns set in at once, at whole epochs.
        const double turning = std::fmod(t, 40.0) >= 20 ? turn_rate : 0;
        for (int i = 0; i < parts; ++i) {
            heading += turning * dt;
            position +=
                dt * Vector3d(60 * std::cos(heading - turning * dt / 2), 60 * std::sin(heading - turning * dt / 2), 0);
        }
    }
    return worst;
}

TEST(PositionFilter, DoesNotLagInTurns) {
    EXPECT_LT(worst_lag(1), 0.05);
    EXPECT_LT(worst_lag(2), 0.05);
    EXPECT_LT(worst_lag(5), 0.05);
    EXPECT_LT(worst_lag(10), 0.05);
}

// A vehicle that begins to brake at 2 m/s² at 60 m/s.
TEST(PositionFilter, ReportsAManoeuvreLateByTheMemoryOfTheVelocityAtEveryRate) {
    for (const double rate_hz : {1.0, 5.0, 25.0}) {
        FilterParameters parameters;
        parameters.velocity_memory = Seconds(0.1);
        PositionFilter filter(parameters);
        FilteredPosition out;
        Vector3d truth, velocity;
        for (int epoch = 0; epoch <= static_cast<int>(30 * rate_hz); ++epoch) {
            const double t = epoch / rate_hz, braked = std::max(0.0, t - 20);
            velocity = Vector3d(60 - 2 * braked, 0, 0);
            truth = home + Vector3d(60 * t - braked * braked, 0, 0);
            out = filter.update(input_at(t, truth, velocity), {});
            if (t == 20) {
                EXPECT_LT((out.velocity.vector() - velocity).norm(), 1e-6);
                EXPECT_LT((out.position.vector() - truth).norm(), 0.01);
            }
        }
        EXPECT_NEAR(out.velocity.vector().x() - velocity.x(), 0.2, 0.01) << rate_hz;
        EXPECT_NEAR(out.position.vector().x() - truth.x(), 0.2 * 3, 0.15) << rate_hz;
    }
}

TEST(PositionFilter, HoldsBelowASpeedOfItsOwn) {
    FilterParameters parameters;
    parameters.hold_below = MetresPerSecond(0.5);
    parameters.position_memory = Seconds(1);
    PositionFilter filter(parameters);
    for (int s = 0; s < 10; ++s)
        EXPECT_EQ(filter.update(input_at(s, home, Vector3d(0.4, 0, 0)), {}).held, s > 0);
    EXPECT_FALSE(filter.update(input_at(10, home, Vector3d(0.6, 0, 0)), {}).held);
}

TEST(PositionFilter, GlidesToAJumpAndFollowsAFarOneAtOnce) {
    PositionFilter filter({});
    for (int s = 0; s < 100; ++s)
        filter.update(input_at(s, home, Vector3d::Zero()), {});
    const Vector3d near = home + Vector3d(100, 0, 0), far = home + Vector3d(1200, 0, 0);
    const double first = (filter.update(input_at(100, near, Vector3d::Zero()), {}).position.vector() - near).norm();
    EXPECT_NEAR(first, 100 * std::exp(-0.5), 1e-6) << "with a memory of two seconds";
    EXPECT_EQ(filter.update(input_at(101, far, Vector3d::Zero()), {}).position.vector(), far);
}

TEST(PositionFilter, HoldsASlowReceiverUntilItLeavesTheCircle) {
    FilterParameters parameters;
    parameters.static_hold_radius = Metres(5);
    parameters.position_memory = Seconds(1);
    PositionFilter filter(parameters);
    ReceiverSettings settings;
    settings.static_hold_below = MetresPerSecond(0.3);
    const Vector3d creeping(0.1, 0, 0);
    double farthest = 0;
    int released = 0;
    Vector3d held = home;
    for (int s = 0; s < 120; ++s) {
        const Vector3d truth = home + s * creeping;
        const auto out = filter.update(input_at(s, truth, creeping), settings);
        EXPECT_EQ(out.held, s > 0) << "the very first position is no average yet";
        EXPECT_EQ(out.velocity.vector(), s > 0 ? Vector3d(Vector3d::Zero()) : creeping);
        if (out.position.vector() != held) ++released;
        held = out.position.vector();
        farthest = std::max(farthest, (held - truth).norm());
    }
    EXPECT_EQ(released, 3) << "once to the first average, twice out of the circle";
    EXPECT_LT(farthest, 5.2);
    const Vector3d running(2, 0, 0);
    const auto out = filter.update(input_at(120, home + Vector3d(13, 0, 0), running), settings);
    EXPECT_FALSE(out.held);
    EXPECT_EQ(out.velocity.vector(), running);
}

TEST(PositionFilter, CoastsForAsLongAsItMay) {
    PositionFilter filter({});
    const Vector3d velocity(20, 0, 0);
    EXPECT_FALSE(filter.coast(input_at(0, home, velocity).time));
    for (int s = 0; s <= 10; ++s)
        filter.update(input_at(s, home + s * velocity, velocity), {});
    const auto carried = filter.coast(input_at(12, home, velocity).time);
    ASSERT_TRUE(carried);
    EXPECT_LT((carried->position.vector() - home - 12 * velocity).norm(), 1e-6);
    EXPECT_EQ(carried->coasted, Seconds(2));
    EXPECT_FALSE(filter.coast(input_at(12.5, home, velocity).time));
}

}  // namespace
}  // namespace skyloop
