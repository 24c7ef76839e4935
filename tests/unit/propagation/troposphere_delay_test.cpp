#include "world/propagation/troposphere_delay.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "modern_sky.hpp"

namespace skyloop {
namespace {

using std::chrono::seconds;

ModernPropagationParameters still_air(const TroposphereParameters& model) {
    ModernPropagationParameters parameters;
    parameters.troposphere_model = model;
    parameters.troposphere_residual.enabled = false;
    return parameters;
}

double tropo_delay(const TroposphereParameters& model, double azimuth_deg, double elevation_deg,
                   const Geodetic& place = test::odessa_place) {
    TroposphereDelay effect(still_air(model), {}, {}, 1);
    const SkyView sky{{test::satellite_at({Constellation::gps, 1}, azimuth_deg, elevation_deg, place)}};
    return test::after(effect, sky, test::truth_of(place, test::april_noon)).satellites[0].tropo_delay.value();
}

UtcTime utc_noon() { return to_utc(test::april_noon, LeapSeconds::announced()); }

TEST(TroposphereDelay, StandardWeatherOverTheSineIsWhatReceiversCorrect) {
    const TroposphereParameters model{.relative_humidity = 0.7, .mapping = TroposphereMappingModel::cosecant};
    for (const double elevation : {5.0, 15.0, 40.0, 90.0}) {
        const Geodetic& place = test::odessa_place;
        EXPECT_EQ(
            tropo_delay(model, 30, elevation),
            saastamoinen_delay(place.latitude, {place.height.above_ellipsoid}, Angle::degrees(elevation), 0.7).value());
    }
}

TEST(TroposphereDelay, MapsEachPartByTheModelThatItNames) {
    const Geodetic place = Geodetic::degrees(-33, 151, 640);
    const MslHeight height{place.height.above_ellipsoid};
    const ZenithDelay zenith = saastamoinen_zenith_delay(standard_weather(height, 0.5), place.latitude, height);
    const auto expect = [&](TroposphereMappingModel model, double elevation, const TroposphereMapping& m) {
        EXPECT_NEAR(tropo_delay({.mapping = model}, 10, elevation, place),
                    zenith.hydrostatic.value() * m.hydrostatic + zenith.wet.value() * m.wet, 1e-12);
    };
    const AnnualPhase phase = AnnualPhase::of(utc_noon());
    for (const double degrees : {4.0, 10.0, 30.0, 88.0}) {
        const Angle elevation = Angle::degrees(degrees);
        const MappingSite site{place.latitude, height, day_of_year(utc_noon())};
        expect(TroposphereMappingModel::niell, degrees,
               {niell_hydrostatic_mapping(site, elevation), niell_wet_mapping(place.latitude, elevation)});
        const auto vienna = [&](const Vmf1Coefficients& a, double height_correction) {
            const auto hydrostatic = vmf1_hydrostatic(a.a_hydrostatic, place.latitude, phase);
            return TroposphereMapping{marini(hydrostatic, elevation) + height_correction,
                                      marini(vmf1_wet(a.a_wet), elevation)};
        };
        expect(TroposphereMappingModel::gmf, degrees,
               vienna(gmf_coefficients(place, phase), niell_height_correction(height, elevation)));
        expect(TroposphereMappingModel::vmf1, degrees, vienna(TroposphereParameters{}.vmf1, 0));
    }
}

// Niell's 1/sin e made 1200 m of it at 0.01° from a mountain, and a kink where the floor of 0.01° was.
TEST(TroposphereDelay, IsThatOfAnAtmosphereDownToTheHorizon) {
    for (const TroposphereMappingModel model : {TroposphereMappingModel::niell, TroposphereMappingModel::gmf}) {
        const auto delay = [model](double elevation, double height) {
            return tropo_delay({.mapping = model}, 10, elevation, Geodetic::degrees(35.7, 139.7, height));
        };
        for (double height = 0; height <= 9000; height += 1000) {
            double last = delay(0, height);
            EXPECT_LT(last, 105) << height;
            EXPECT_GT(last, 20) << height;
            EXPECT_LT(delay(0, height + 1000), last) << height;
            for (double elevation = 0.005; elevation < 4; elevation += 0.005) {
                const double now = delay(elevation, height);
                EXPECT_LT(now, last) << elevation;
                EXPECT_LT(last - now, 0.4) << elevation;
                last = now;
            }
        }
    }
}

TEST(TroposphereWeather, ComesFromEachSource) {
    const Geodetic place = test::odessa_place;
    const MslHeight height{place.height.above_ellipsoid};
    const AnnualPhase phase = AnnualPhase::of(utc_noon());
    const auto weather = [&](TroposphereParameters model) { return troposphere_weather(model, place, height, phase); };
    EXPECT_EQ(weather({.relative_humidity = 0.6}).vapour_pressure_hpa,
              standard_weather(height, 0.6).vapour_pressure_hpa);
    const GptWeather climate = gpt_weather(place, phase);
    EXPECT_EQ(weather({.weather = WeatherSource::gpt}).pressure_hpa, climate.pressure_hpa);
    EXPECT_EQ(weather({.weather = WeatherSource::gpt}).temperature.value(), climate.temperature_celsius + 273.15);
    const SurfaceWeather given = weather({.weather = WeatherSource::given,
                                          .relative_humidity = 0.5,
                                          .pressure_hpa = 990,
                                          .temperature = Kelvin(293.15)});
    EXPECT_EQ(given.pressure_hpa, 990);
    EXPECT_NEAR(given.vapour_pressure_hpa, 11.7, 0.1);  // half of 23.4 hPa at 20 °C
    EXPECT_NEAR(weather({.weather = WeatherSource::p835}).pressure_hpa, 1007.3, 0.2);
    EXPECT_NEAR(weather({.weather = WeatherSource::p835}).vapour_pressure_hpa, 9.7, 0.1);
}

TEST(TroposphereDelay, VapourWandersOnlyWhereThereIsVapour) {
    const auto wandered = [](double height) {
        const Geodetic place = Geodetic::degrees(46.4774, 30.7326, height);
        const SkyView sky{{test::satellite_at({Constellation::gps, 1}, 30, 90, place)}};
        const TruthState truth = test::truth_of(place, test::april_noon);
        TroposphereDelay real({}, {}, {}, 1), still(still_air({}), {}, {}, 1);
        return test::after(real, sky, truth).satellites[0].tropo_delay.value() -
               test::after(still, sky, truth).satellites[0].tropo_delay.value();
    };
    const double at_sea = wandered(0);
    EXPECT_GT(std::abs(at_sea), 1e-3);
    EXPECT_NEAR(wandered(-400), at_sea, std::abs(at_sea) * 1e-4);
    // The plumb line and the line to the centre of the Earth pass 1 km some metres apart.
    EXPECT_NEAR(wandered(2000), at_sea * std::exp(-1), std::abs(at_sea) * 1e-3);
    EXPECT_LT(std::abs(wandered(60e3)), 1e-9);
}

TEST(TroposphereDelay, GradientsLeanOneWay) {
    const TroposphereParameters level, tilted{.gradient_north = Metres(0.001), .gradient_east = Metres(0.0005)};
    const double slant = 1 / (std::sin(0.2617993877991494) * std::tan(0.2617993877991494) + 0.0032);
    const auto added = [&](double azimuth) {
        return tropo_delay(tilted, azimuth, 15) - tropo_delay(level, azimuth, 15);
    };
    EXPECT_NEAR(added(0), 0.001 * slant, 1e-9);
    EXPECT_NEAR(added(90), 0.0005 * slant, 1e-9);
    EXPECT_NEAR(added(180), -0.001 * slant, 1e-9);
}

// Zenith delay over and above the model's, 1 σ at an hour.
double deviation_at(const AtmosphereParameters& air, int hour) {
    constexpr int seeds = 600;
    const SkyView sky{{test::satellite_at({Constellation::gps, 1}, 0, 90)}};
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon + seconds(3600) * hour);
    TroposphereDelay still(still_air({}), air, {}, 1);
    const Metres model = test::after(still, sky, truth).satellites[0].tropo_delay;
    double square = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        TroposphereDelay effect({}, air, {}, seed);
        square += std::pow((test::after(effect, sky, truth).satellites[0].tropo_delay - model).value(), 2) / seeds;
    }
    return std::sqrt(square);
}

// At 50 m, 0.975 of the vapour lies above.
TEST(TroposphereDelay, TheVapoursFieldHasItsDeviationAtAllTimes) {
    EXPECT_NEAR(deviation_at({}, 0), 0.0351, 0.003);
    EXPECT_NEAR(deviation_at({}, 12), 0.0351, 0.003);
}

TEST(TroposphereDelay, AThunderstormStirsIt) {
    const TroposphereParameters model;
    AtmosphereParameters storm;
    storm.clouds = {cloud_catalogue().back()};
    storm.rain.rate_mm_h = 100;
    ASSERT_EQ(storm.clouds[0].kind, "thunderstorm");
    AtmosphereParameters rain;
    rain.rain.rate_mm_h = 5;
    EXPECT_EQ(wet_delay_deviation(model, {}).value(), 0.036);
    EXPECT_EQ(wet_delay_deviation(model, rain).value(), 0.042);
    EXPECT_EQ(wet_delay_deviation(model, storm).value(), 0.047);
    EXPECT_NEAR(deviation_at(storm, 12), 0.0458, 0.004);
}

TEST(TroposphereDelay, ItsTermsSwitchModelAndResidual) {
    const SkyView sky{{test::satellite_at({Constellation::gps, 1}, 0, 20)}};
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
    const auto delay = [&](ErrorTerm model, ErrorTerm residual) {
        ModernPropagationParameters parameters;
        parameters.troposphere = model;
        parameters.troposphere_residual = residual;
        TroposphereDelay effect(parameters, {}, {}, 3);
        return test::after(effect, sky, truth).satellites[0].tropo_delay.value();
    };
    const ErrorTerm on, off{false, 1, {}};
    EXPECT_EQ(delay(off, off), 0);
    EXPECT_NEAR(delay(on, on), delay(on, off) + delay(off, on), 1e-12);
    EXPECT_NE(delay(off, on), 0);
    EXPECT_NEAR(delay({true, 2, {}}, off), 2 * delay(on, off), 1e-12);
    EXPECT_EQ(delay(off, {true, 1, 3}), delay(off, on));
}

}  // namespace
}  // namespace skyloop
