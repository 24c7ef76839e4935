#include "world/propagation/sensor_model_losses.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "unit/propagation/one_satellite.hpp"

namespace skyloop {
namespace {

using test::OneSatellite;

const Geodetic sea_level_place = Geodetic::degrees(46.4774, 30.7326, 0);

Arrival arrival_through(const AtmosphereParameters& atmosphere, double elevation_deg) {
    OneSatellite scene(Angle::degrees(elevation_deg), Metres(22e6), sea_level_place);
    LayeredAtmosphereLoss loss(atmosphere);
    return scene.after(loss);
}

double loss_below(LayeredAtmosphereLoss& loss, OneSatellite& scene) { return scene.after(loss).gas_loss.value(); }

// MODELS.md section 8.
TEST(LayeredAtmosphereLoss, DefaultAirTakesTheKnownFractionsOfADecibel) {
    const std::array<std::array<double, 2>, 4> expected{{{90, 0.047}, {30, 0.094}, {10, 0.258}, {5, 0.458}}};
    for (const auto& [elevation, loss] : expected)
        EXPECT_NEAR(arrival_through({}, elevation).gas_loss.value(), loss, 0.0006) << elevation;
    AtmosphereParameters midpoint;
    midpoint.layers = default_layers();
    for (AtmosphericLayer& layer : midpoint.layers)
        layer.concentration = ConcentrationMode::midpoint;
    EXPECT_NEAR(arrival_through(midpoint, 90).gas_loss.value(), 0.038, 0.0006);
    EXPECT_NEAR(arrival_through(midpoint, 5).gas_loss.value(), 0.384, 0.0006);
}

TEST(LayeredAtmosphereLoss, OnlyTheAirAboveTheAntennaCounts) {
    LayeredAtmosphereLoss loss(AtmosphereParameters{});
    OneSatellite on_the_ground(Angle::degrees(90), Metres(20.2e6), sea_level_place);
    OneSatellite at_ten_km(Angle::degrees(90), Metres(20.2e6), Geodetic::degrees(46.4774, 30.7326, 10000));
    OneSatellite in_orbit(Angle::degrees(90), Metres(20.2e6), Geodetic::degrees(46.4774, 30.7326, 700000));
    const double ground = loss_below(loss, on_the_ground);
    // Oxygen alone would leave exp(-10000/8434.7) of it; the vapour's share is a hundredth.
    EXPECT_NEAR(loss_below(loss, at_ten_km) / ground, std::exp(-10000 / 8434.7), 0.01);
    EXPECT_EQ(loss_below(loss, in_orbit), 0);
}

TEST(LayeredAtmosphereLoss, DisabledLayersTakeNothing) {
    AtmosphereParameters atmosphere;
    atmosphere.layers = default_layers();
    for (AtmosphericLayer& layer : atmosphere.layers)
        layer.enabled = false;
    const Arrival arrival = arrival_through(atmosphere, 20);
    EXPECT_EQ(arrival.gas_loss, Decibels(0));
    EXPECT_EQ(arrival.cloud_loss, Decibels(0));
    EXPECT_EQ(arrival.rain_loss, Decibels(0));
    EXPECT_EQ(arrival.iono_loss, Decibels(0));
}

TEST(LayeredAtmosphereLoss, HeavyRainOverFourKilometres) {
    AtmosphereParameters atmosphere;
    atmosphere.rain.rate_mm_h = 100;
    EXPECT_NEAR(arrival_through(atmosphere, 90).rain_loss.value(), 0.00459 * 4, 0.0001);
    EXPECT_NEAR(arrival_through(atmosphere, 5).rain_loss.value(), 0.2, 0.02);
}

TEST(LayeredAtmosphereLoss, ThunderstormAsVapourIsInvisible) {
    AtmosphereParameters atmosphere;
    atmosphere.clouds.push_back(cloud_catalogue().back());
    EXPECT_NEAR(arrival_through(atmosphere, 90).cloud_loss.value(), 0.0005, 0.0001);
    EXPECT_NEAR(arrival_through(atmosphere, 5).cloud_loss.value(), 0.005, 0.001);
}

TEST(LayeredAtmosphereLoss, CloudDensityThinsWithHeightOnlyWhenAsked) {
    AtmosphereParameters atmosphere;
    atmosphere.clouds.push_back({"", Metres(6000), Metres(8000), 1.0});
    const double local = arrival_through(atmosphere, 40).cloud_loss.value();
    atmosphere.clouds_apply_concentration = true;
    const double thinned = arrival_through(atmosphere, 40).cloud_loss.value();
    EXPECT_GT(thinned, 0);
    EXPECT_NEAR(thinned / local, std::exp(-7000 / 8434.5), 0.02);
}

TEST(LayeredAtmosphereLoss, RiometerAbsorptionFallsWithFrequencySquared) {
    AtmosphereParameters atmosphere;
    atmosphere.ionosphere_loss = Decibels(0.25);
    atmosphere.riometer_absorption_30mhz = Decibels(1);
    EXPECT_NEAR(arrival_through(atmosphere, 90).iono_loss.value(), 0.25 + 0.0003626, 1e-7);
    EXPECT_GT(arrival_through(atmosphere, 5).iono_loss, Decibels(0.25 + 4 * 0.0003626));
}

TEST(LayeredAtmosphereLoss, NoIonosphereAbsorbsAboveItsLowerEdge) {
    AtmosphereParameters atmosphere;
    atmosphere.ionosphere_loss = Decibels(0.25);
    LayeredAtmosphereLoss loss(atmosphere);
    OneSatellite below(Angle::degrees(40), Metres(20.2e6), Geodetic::degrees(46.4774, 30.7326, 59999));
    OneSatellite above(Angle::degrees(40), Metres(20.2e6), Geodetic::degrees(46.4774, 30.7326, 60000));
    EXPECT_EQ(below.after(loss).iono_loss, Decibels(0.25));
    EXPECT_EQ(above.after(loss).iono_loss, Decibels(0));
}

// One layer at the zenith, so that the loss is the specific attenuation times its thickness.
TEST(LayeredAtmosphereLoss, IsThatOfEachSatellitesOwnCarrier) {
    AtmosphereParameters atmosphere;
    atmosphere.layers = {{"air", Metres(0), Metres(10000), 7.5, true, ConcentrationMode::fixed, 0.6}};
    atmosphere.clouds.push_back({"", Metres(1000), Metres(3000), 1.0});
    atmosphere.rain.rate_mm_h = 30;
    atmosphere.riometer_absorption_30mhz = Decibels(1);
    LayeredAtmosphereLoss loss(atmosphere);
    for (const double f : {1575.42e6, 1602e6, 1561.098e6, 1176.45e6}) {
        SCOPED_TRACE(f);
        const Hertz carrier(f);
        OneSatellite scene(Angle::degrees(90), Metres(22e6), sea_level_place);
        scene.arrival().signals.push_back({Signal::l1, carrier, Seconds(0), Decibels(0)});
        const Arrival& arrival = scene.after(loss);
        const double gas =
            oxygen_attenuation(carrier, 0.6, 0.277).value() + vapour_attenuation(carrier, 7.5, 0.6).value();
        EXPECT_NEAR(arrival.gas_loss.value(), 10 * gas, 1e-9);
        EXPECT_NEAR(arrival.cloud_loss.value(), 2 * vapour_attenuation(carrier, 1.0, 1.0).value(), 1e-9);
        EXPECT_NEAR(arrival.rain_loss.value(),
                    4 * rain_attenuation(atmosphere.rain, carrier, Angle::degrees(90)).value(), 1e-9);
        EXPECT_NEAR(arrival.iono_loss.value(), std::pow(30e6 / f, 2), 1e-9);
    }
}

}  // namespace
}  // namespace skyloop
