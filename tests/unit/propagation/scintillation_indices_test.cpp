#include "world/propagation/ionosphere_effects.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "modern_sky.hpp"
#include "world/gnss/nequick_g.hpp"

namespace skyloop {
namespace {

Arrival scintillating(const ScintillationParameters& parameters, double elevation_deg, const ErrorTerm& term = {},
                      SatelliteId id = {Constellation::gps, 1}) {
    ScintillationIndices effect(parameters, term, LeapSeconds::announced());
    const SkyView sky{{test::satellite_at(id, 90, elevation_deg)}};
    return test::after(effect, sky, test::truth_of(test::odessa_place, test::april_noon)).satellites[0];
}

TEST(ScintillationIndices, GrowTowardsTheHorizonUpToTheStrongest) {
    const ScintillationParameters parameters{.s4 = 0.3, .sigma_phi = Angle::radians(0.2)};
    EXPECT_NEAR(scintillating(parameters, 90).amplitude_scintillation, 0.3, 1e-9);
    EXPECT_NEAR(scintillating(parameters, 90).phase_scintillation.rad(), 0.2, 1e-9);
    double before = 0.3;
    for (const double elevation : {60, 40, 25}) {
        const Arrival arrival = scintillating(parameters, elevation);
        EXPECT_GT(arrival.amplitude_scintillation, before);
        before = arrival.amplitude_scintillation;
    }
    EXPECT_EQ(scintillating(parameters, 5).amplitude_scintillation, strongest_s4);
    EXPECT_LT(strongest_s4, 1 / std::sqrt(2));
}

TEST(ScintillationIndices, AreOffByDefaultAndByTheirTerm) {
    EXPECT_EQ(scintillating({}, 10).amplitude_scintillation, 0);
    const ScintillationParameters parameters{.s4 = 0.4, .sigma_phi = Angle::radians(0.2)};
    EXPECT_EQ(scintillating(parameters, 60, {false, 1, {}}).amplitude_scintillation, 0);
    EXPECT_EQ(scintillating(parameters, 60, {false, 1, {}}).phase_scintillation.rad(), 0);
    EXPECT_NEAR(scintillating(parameters, 60, {true, 0.5, {}}).amplitude_scintillation,
                scintillating(parameters, 60).amplitude_scintillation / 2, 1e-12);
    EXPECT_GT(scintillating(parameters, 60, {}, {Constellation::beidou, 20}).amplitude_scintillation,
              scintillating(parameters, 60).amplitude_scintillation);
}

TEST(EveningShare, IsTheCrestsAndTheEvening) {
    const ScintillationParameters pattern{.s4 = 0.6, .equatorial_evening = true};
    const auto share = [&](double latitude, double longitude, double hours) {
        return evening_share(pattern, Geodetic::degrees(latitude, longitude, 0), hours);
    };
    // Sao Paulo lies under the southern crest: 21 h there is 0 h UT.
    EXPECT_GT(share(-23.5, -46.6, 0.1), 0.5);
    EXPECT_LT(share(-23.5, -46.6, 15), 0.01);
    EXPECT_LT(share(52, 13, 20), 0.05);
    EXPECT_EQ(evening_share({.s4 = 0.6}, Geodetic::degrees(52, 13, 0), 12), 1);
    EXPECT_LT(share(46.5, 30.7, 19), 0.1);
    EXPECT_GT(share(-12, -77, 2), 0.4);  // Lima, under the magnetic equator
}

TEST(DipoleModifiedDip, IsWithinTenDegreesOfTheRealFieldNearTheCrests) {
    const auto tables = read_nequick_tables(std::filesystem::path(SKYLOOP_SOURCE_DIR) / "data/nequick_g", 4);
    ASSERT_TRUE(tables) << tables.error().message;
    double square = 0;
    int count = 0;
    for (double latitude = -60; latitude <= 60; latitude += 10) {
        for (double longitude = -180; longitude < 180; longitude += 20, ++count) {
            const double real =
                modified_dip_latitude(tables->modip, Angle::degrees(latitude), Angle::degrees(longitude)).deg();
            square += std::pow(dipole_modified_dip(Geodetic::degrees(latitude, longitude, 0)).deg() - real, 2);
        }
    }
    EXPECT_LT(std::sqrt(square / count), 10);
}

}  // namespace
}  // namespace skyloop
