#include "world/propagation/signal_in_space_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "modern_sky.hpp"

namespace skyloop {
namespace {

using std::chrono::seconds;
using test::after;

TEST(OrbitClockSigmas, GiveTheSisreOfEachSystem) {
    const SignalInSpaceParameters parameters;
    const auto of = [&](Constellation constellation, int number) {
        const SatelliteId id{constellation, number};
        return sisre(orbit_clock_sigmas(id, parameters), sisre_weights(id)).value();
    };
    EXPECT_NEAR(of(Constellation::gps, 7), 0.35, 1e-12);
    EXPECT_NEAR(of(Constellation::galileo, 7), 0.20, 1e-12);
    EXPECT_NEAR(of(Constellation::beidou, 1), 1.2, 1e-12);
    EXPECT_NEAR(of(Constellation::beidou, 18), 1.2, 1e-12);
    EXPECT_NEAR(of(Constellation::beidou, 19), 0.45, 1e-12);
    EXPECT_NEAR(of(Constellation::glonass, 7), 1.5, 1e-12);
    EXPECT_NEAR(of(Constellation::qzss, 2), 0.8, 1e-12);
    EXPECT_EQ(sisre_weights({Constellation::beidou, 3}).radial, 0.99);
    EXPECT_EQ(sisre_weights({Constellation::beidou, 27}).radial, 0.98);
}

TEST(OrbitClockSigmas, OfGpsAreTheTypicalOnes) {
    const OrbitClockSigmas s = orbit_clock_sigmas({Constellation::gps, 1}, {});
    EXPECT_NEAR(s.radial, 0.15, 0.01);
    EXPECT_NEAR(s.clock, 0.30, 0.02);
    EXPECT_NEAR(s.along, 0.9, 0.06);
    EXPECT_NEAR(s.cross, 0.5, 0.03);
}

// Whatever the scale; where the term is off the broadcast is the truth, steps and all.
TEST(SignalInSpaceError, JoinsTheRecords) {
    SkyView sky = test::gps_ring(4);
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
    ErrorTerm tenth, off;
    tenth.scale = 0.1;
    off.enabled = false;
    for (const ErrorTerm& term : {ErrorTerm{}, tenth, off}) {
        SignalInSpaceError effect({}, term, 5);
        sky.satellites[2].earlier_records = {};
        const Arrival plain = after(effect, sky, truth).satellites[2];
        sky.satellites[2].earlier_records = {Metres(2.5), MetresPerSecond(-0.01), std::nullopt};
        const Arrival joined = after(effect, sky, truth).satellites[2];
        const double share = term.enabled ? 1 : 0;
        EXPECT_NEAR((joined.signal_in_space_error - plain.signal_in_space_error).value(), 2.5 * share, 1e-12);
        EXPECT_NEAR((joined.range_rate_error - plain.range_rate_error).value(), -0.01 * share, 1e-12);
        EXPECT_EQ(joined.earlier_records.range, Metres(2.5 * share));
    }
}

TEST(SignalInSpaceError, HasTheSizeAndMemoryOfItsSystem) {
    double square = 0, lagged = 0;
    int count = 0;
    const SkyView sky = test::gps_ring(32);
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        SignalInSpaceError effect({}, {}, seed);
        std::vector<std::vector<double>> series(sky.satellites.size());
        for (int hour = 0; hour < 24; ++hour) {
            const TruthState truth = test::truth_of(test::odessa_place, test::april_noon + seconds(3600) * hour);
            const Arrivals arrivals = after(effect, sky, truth);
            for (std::size_t i = 0; i < series.size(); ++i)
                series[i].push_back(arrivals.satellites[i].signal_in_space_error.value());
        }
        for (const auto& values : series) {
            for (std::size_t i = 0; i + 2 < values.size(); ++i, ++count) {
                square += values[i] * values[i];
                lagged += values[i] * values[i + 2];
            }
        }
    }
    EXPECT_NEAR(std::sqrt(square / count), 0.35, 0.04);
    EXPECT_NEAR(lagged / square, std::exp(-1), 0.06);
}

TEST(SignalInSpaceError, RateIsItsDerivative) {
    // A satellite on a straight line and an antenna that moves: half a second either way.
    SignalInSpaceError effect({}, {}, 3);
    const SatelliteInView middle = test::satellite_at({Constellation::gps, 4}, 70, 25);
    // Between knots, where the curve has one curvature.
    TruthState truth = test::truth_of(test::odessa_place, test::april_noon + seconds(17));
    truth.velocity = Velocity<Ecef>(30, -40, 20);
    const auto at = [&](double dt) {
        SkyView sky;
        sky.satellites.push_back(middle);
        SatelliteInView& satellite = sky.satellites.front();
        const Eigen::Vector3d p = middle.position_at_transmission.vector(),
                              v = middle.velocity_at_transmission.vector();
        const Eigen::Vector3d turn(0, 0, earth_rotation_rate);
        const Eigen::Vector3d a =
            -gravitational_constant_gps / std::pow(p.norm(), 3) * p - 2 * turn.cross(v) - turn.cross(turn.cross(p));
        satellite.position_at_transmission = Position<Ecef>(p + v * dt + a * dt * dt / 2);
        satellite.velocity_at_transmission = Velocity<Ecef>(v + a * dt);
        TruthState moved = truth;
        moved.time = advanced(truth.time, Seconds(dt));
        moved.position = truth.position + Displacement<Ecef>(truth.velocity.vector() * dt);
        return after(effect, sky, moved).satellites.front();
    };
    const Arrival before = at(-0.5), now = at(0), then = at(0.5);
    const double difference = (then.signal_in_space_error - before.signal_in_space_error).value();
    EXPECT_NE(now.range_rate_error.value(), 0);
    EXPECT_LT(std::abs(now.range_rate_error.value()), 0.01);
    EXPECT_NEAR(now.range_rate_error.value(), difference, 2e-7);
}

TEST(SignalInSpaceError, DoesNotDependOnWhoElseIsThere) {
    SignalInSpaceError all({}, {}, 9), one({}, {}, 9), other({}, {}, 10);
    const SkyView sky = test::gps_ring(8);
    const SkyView alone{{sky.satellites[5]}};
    for (int i = 0; i < 20; ++i) {
        const TruthState truth = test::truth_of(test::odessa_place, test::april_noon + seconds(97) * i);
        const auto error = after(all, sky, truth).satellites[5].signal_in_space_error;
        EXPECT_EQ(after(one, alone, truth).satellites[0].signal_in_space_error, error);
        EXPECT_NE(after(other, alone, truth).satellites[0].signal_in_space_error, error);
    }
}

TEST(SignalInSpaceError, IsScaledAndSwitchedOffAndHasItsOwnSeed) {
    const SkyView sky = test::gps_ring(3);
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
    SignalInSpaceError normal({}, {}, 1), doubled({}, {true, 2, {}}, 1), off({}, {false, 1, {}}, 1),
        own({}, {true, 1, 1}, 8);
    const double error = after(normal, sky, truth).satellites[0].signal_in_space_error.value();
    EXPECT_NEAR(after(doubled, sky, truth).satellites[0].signal_in_space_error.value(), 2 * error, 1e-12);
    EXPECT_EQ(after(off, sky, truth).satellites[0].signal_in_space_error.value(), 0);
    EXPECT_EQ(after(off, sky, truth).satellites[0].range_rate_error.value(), 0);
    EXPECT_EQ(after(own, sky, truth).satellites[0].signal_in_space_error.value(), error);
}

}  // namespace
}  // namespace skyloop
