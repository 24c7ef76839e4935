#include "world/propagation/atmosphere_losses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "modern_sky.hpp"
#include "world/propagation/gas_attenuation_p676.hpp"

namespace skyloop {
namespace {

const Geodetic sea_shore = Geodetic::degrees(46.4774, 30.7326, 0);

// The arrival of a GPS satellite after one effect.
Arrival after_loss(PropagationEffect& effect, double elevation_deg, const Geodetic& place = sea_shore) {
    const SkyView sky{{test::satellite_at({Constellation::gps, 1}, 100, elevation_deg, place)}};
    return test::after(effect, sky, test::truth_of(place, test::april_noon)).satellites[0];
}

TEST(GasLossTable, IsTheIntegralToATenthOfAMillidecibel) {
    GasLossTable table;
    for (const double height : {0.0, 50.0, 777.0, 1950.0, 5432.0, 9990.0, 10700.0, 11300.0, 15500.0, 19600.0}) {
        std::vector<Angle> elevations;
        for (double elevation = 0.5; elevation < 90; elevation *= 1.17)
            elevations.push_back(Angle::degrees(elevation));
        const auto exact = slant_gas_attenuation_p676(Hertz(carrier_frequency_l1), elevations, Metres(height));
        for (std::size_t i = 0; i < elevations.size(); ++i) {
            SCOPED_TRACE(testing::Message() << elevations[i].deg() << " deg, " << height << " m");
            EXPECT_NEAR(table.loss(elevations[i], Metres(height)).value(), exact[i].value(), 1e-4);
        }
    }
}

TEST(GasLossTable, HoldsBeyondItsEnds) {
    GasLossTable table;
    const auto at = [&](double elevation, double height) {
        return table.loss(Angle::degrees(elevation), Metres(height)).value();
    };
    EXPECT_EQ(at(-3, 0), at(0.5, 0));
    EXPECT_EQ(at(30, -400), at(30, 0));
    EXPECT_EQ(at(30, 500e3), at(30, 20e3));
    EXPECT_NEAR(at(90, 0), 0.034, 0.001);
    EXPECT_NEAR(at(5, 0), 0.366, 0.002);
}

TEST(GasLoss, IsScaledAndSwitchedOff) {
    GasLoss normal({}, nullptr), half({true, 0.5, {}}, nullptr), off({false, 1, {}}, nullptr);
    EXPECT_NEAR(after_loss(normal, 10).gas_loss.value(), 0.191, 0.001);
    EXPECT_NEAR(after_loss(half, 10).gas_loss.value(), after_loss(normal, 10).gas_loss.value() / 2, 1e-12);
    EXPECT_EQ(after_loss(off, 10).gas_loss.value(), 0);
}

// Through less air than at the elevation of the straight line.
TEST(GasLoss, IsThatOfTheBentRay) {
    GasLoss effect({}, nullptr);
    GasLossTable table;
    const auto at = [&](double apparent) { return table.loss(Angle::degrees(apparent), Metres(0)).value(); };
    const auto loss = [&](double elevation) { return after_loss(effect, elevation).gas_loss.value(); };
    EXPECT_NEAR(loss(1), at(1.4336), 1e-4);
    EXPECT_NEAR(loss(5), at(5.1864), 1e-5);
    EXPECT_LT(loss(5), at(5) * 0.98);
    EXPECT_NEAR(loss(90), at(90), 1e-9);
    // Whoever flies high sees satellites below the horizon.
    EXPECT_NEAR(loss(0), at(0.5787), 1e-4);
    for (const double below : {-1.0, -4.74, -4.8, -9.8, -30.0})
        EXPECT_NEAR(loss(below), at(0.5), 1e-9) << below;
}

// Cloud and rain of one kind of weather.
double weather_loss(const AtmosphereParameters& air, double elevation_deg, const Geodetic& place = sea_shore) {
    CloudLoss clouds(air.clouds, {}, nullptr);
    RainLoss rain(air.rain, {}, nullptr);
    return after_loss(clouds, elevation_deg, place).cloud_loss.value() +
           after_loss(rain, elevation_deg, place).rain_loss.value();
}

TEST(WeatherLosses, OfAThunderstorm) {
    AtmosphereParameters storm;
    storm.clouds = {cloud_catalogue().back()};
    storm.rain.rate_mm_h = 100;
    const double zenith = weather_loss(storm, 90), low = weather_loss(storm, 5);
    EXPECT_GT(zenith, 0.05);
    EXPECT_LT(zenith, 0.15);
    EXPECT_GT(low, 0.5);
    EXPECT_LT(low, 1.0);
    EXPECT_EQ(weather_loss({}, 5), 0);
    // Above all of it there is nothing left.
    EXPECT_EQ(weather_loss(storm, 5, Geodetic::degrees(46, 30, 12000)), 0);
}

TEST(CloudLoss, GrowsWithTheDensityOfTheCatalogue) {
    double before = 0;
    for (const CloudDeck& deck : cloud_catalogue()) {
        AtmosphereParameters air;
        air.clouds = {deck};
        EXPECT_GT(weather_loss(air, 90), before) << deck.kind;
        before = weather_loss(air, 90);
    }
}

TEST(RainLoss, EndsWithItsCell) {
    ModernPropagationParameters parameters;
    parameters.loss_model.rain_cell = Metres(5000);
    const Rain rain{100};
    RainLoss cell(rain, parameters, nullptr);
    parameters.loss_model.rain_cell = Metres(1e9);
    RainLoss wide(rain, parameters, nullptr);
    EXPECT_NEAR(after_loss(cell, 90).rain_loss.value(), 4 * 0.00459, 1e-4);
    EXPECT_EQ(after_loss(cell, 80).rain_loss, after_loss(wide, 80).rain_loss);
    EXPECT_NEAR(after_loss(cell, 5).rain_loss.value(), 5 * 0.00459 / std::cos(5 * std::numbers::pi / 180), 1e-4);
    EXPECT_NEAR(after_loss(wide, 5).rain_loss.value(), 0.2, 0.02);
    parameters.rain.enabled = false;
    RainLoss off(rain, parameters, nullptr);
    EXPECT_EQ(after_loss(off, 5).rain_loss.value(), 0);
}

TEST(RainLoss, IsOfP838WhateverTheSensorModelsAreTold) {
    RainLoss rain({100}, {}, nullptr);
    RainLoss vapour({100, Metres(4000), RainModel::as_vapour}, {}, nullptr);
    EXPECT_GT(after_loss(rain, 5).rain_loss.value(), 0.05);
    EXPECT_EQ(after_loss(vapour, 5).rain_loss, after_loss(rain, 5).rain_loss);
}

TEST(FoliageLoss, StandsAroundTheAntennaUpToItsTop) {
    FoliageLoss none({}, {});
    EXPECT_EQ(after_loss(none, 10).foliage_loss.value(), 0);
    const LossParameters hedge{.canopy_depth = Metres(6), .canopy_density = 0.5};
    FoliageLoss trees(hedge, {}), off(hedge, {false, 1, {}});
    EXPECT_NEAR(after_loss(trees, 20).foliage_loss.value(), 0.8 * 3 / std::cos(20 * std::numbers::pi / 180), 1e-9);
    EXPECT_EQ(after_loss(trees, 36).foliage_loss.value(), 0);
    EXPECT_EQ(after_loss(off, 20).foliage_loss.value(), 0);
    FoliageLoss wood({.canopy_depth = Metres(60)}, {});
    EXPECT_EQ(after_loss(wood, 20).foliage_loss.value(), 12);
}

}  // namespace
}  // namespace skyloop
