#include "world/propagation/drifting_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "modern_sky.hpp"
#include "world/propagation/ionosphere_waves.hpp"

namespace skyloop {
namespace {

using std::chrono::seconds;

constexpr NoiseOctave two_octaves[] = {{Metres(1000), 0.6}, {Metres(50e3), 0.8}};

double field_at(const DriftingField& field, const Eigen::Vector3d& place, GpsTime time = test::april_noon) {
    FieldMemory memory;
    return field.at(place, time, memory);
}

TEST(NearbyNoise, IsSmoothNoiseWhateverWasAskedBefore) {
    NearbyNoise often;
    for (int i = -300; i < 300; ++i) {
        const std::array<double, 3> cells{0.05 * i, 7.3 - 0.011 * i, 0.2 * (i % 3)};
        NearbyNoise once;
        EXPECT_EQ(often.at(5, cells), once.at(5, cells));
        EXPECT_NEAR(often.at(5, cells), smooth_noise<3>(5, cells), 1e-12);
    }
    NearbyNoise other;
    EXPECT_NE(other.at(6, {1, 2, 3}), often.at(5, {1, 2, 3}));
}

TEST(DriftingField, HasItsDeviationEverywhereAndForgetsOverItsCells) {
    const Eigen::Vector3d place(4e6, -1e6, 4.7e6);
    double square = 0, near = 0, far = 0;
    for (std::uint64_t key = 0; key < 3000; ++key) {
        const DriftingField field(key, two_octaves, MetresPerSecond(8));
        const double here = field_at(field, place);
        square += here * here / 3000;
        near += here * field_at(field, place + Eigen::Vector3d(0, 0, 5000)) / 3000;
        far += here * field_at(field, place + Eigen::Vector3d(200e3, 0, 0)) / 3000;
    }
    EXPECT_NEAR(square, 1, 0.08);
    EXPECT_NEAR(near, 0.64, 0.06);  // of the large cells alone
    EXPECT_NEAR(far, 0, 0.06);
}

TEST(DriftingField, MovesAsOneFrozenBody) {
    const Eigen::Vector3d place(4e6, -1e6, 4.7e6);
    const DriftingField field(3, two_octaves, MetresPerSecond(8));
    // Along some direction what is here now was upstream a minute ago.
    const double now = field_at(field, place, test::april_noon + seconds(60));
    const Eigen::Vector3d drift = direction_of_bits(spread_bits(3)) * 8;
    EXPECT_NEAR(drift.norm(), 8, 1e-12);
    EXPECT_NEAR(field_at(field, place - drift * 60), now, 1e-6);
    EXPECT_GT(std::abs(field_at(field, place) - now), 1e-3);
}

TEST(SphereCrossing, LiesOnTheRayOrBelowAnAntennaThatIsOutside) {
    const SatelliteInView satellite = test::satellite_at({Constellation::gps, 1}, 70, 20);
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
    const Eigen::Vector3d point = sphere_crossing(truth, satellite, Metres(6821e3));
    EXPECT_NEAR(point.norm(), 6821e3, 1e-3);
    const Eigen::Vector3d to_point = (point - truth.position.vector()).normalized();
    const Eigen::Vector3d to_satellite =
        (satellite.position_at_transmission.vector() - truth.position.vector()).normalized();
    EXPECT_NEAR((to_point - to_satellite).norm(), 0, 1e-9);
    const Eigen::Vector3d below = sphere_crossing(truth, satellite, Metres(6300e3));
    EXPECT_NEAR((below - truth.position.vector().normalized() * 6300e3).norm(), 0, 1e-6);
}

TEST(IonosphereWaves, HaveTheirDeviationAndTheSlantOfTheShell) {
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
    const SatelliteInView satellite = test::satellite_at({Constellation::gps, 1}, 70, 20);
    double square = 0;
    for (std::uint64_t key = 0; key < 3000; ++key) {
        IonosphereWaves waves({Tecu(2), MetresPerSecond(120)}, key);
        const double vertical = waves.vertical(satellite, truth).value();
        square += vertical * vertical / 3000;
        EXPECT_NEAR(waves.slant(satellite, truth).value(), 2.087 * vertical, 0.001 * std::abs(vertical));
    }
    EXPECT_NEAR(std::sqrt(square), 2, 0.08);
}

TEST(IonosphereWaves, PassInTensOfMinutes) {
    const SatelliteInView overhead = test::satellite_at({Constellation::gps, 1}, 0, 90);
    const auto change = [&](int time) {
        double square = 0;
        for (std::uint64_t key = 0; key < 1000; ++key) {
            IonosphereWaves waves({Tecu(1), MetresPerSecond(120)}, key);
            const double before =
                waves.vertical(overhead, test::truth_of(test::odessa_place, test::april_noon)).value();
            const TruthState later = test::truth_of(test::odessa_place, test::april_noon + seconds(time));
            square += std::pow(waves.vertical(overhead, later).value() - before, 2) / 1000;
        }
        return std::sqrt(square);
    };
    EXPECT_LT(change(10), 0.04);
    EXPECT_NEAR(change(600), 0.9, 0.25);
    EXPECT_NEAR(change(3 * 3600), std::sqrt(2), 0.15);
}

}  // namespace
}  // namespace skyloop
