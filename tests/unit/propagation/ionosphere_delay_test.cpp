#include "world/propagation/ionosphere_effects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include <cmath>
#include <limits>
#include <tuple>

#include "modern_sky.hpp"
#include "world/gnss/atmosphere.hpp"
#include "world/gnss/nequick_g.hpp"

namespace skyloop {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;

const KlobucharCoefficients broadcast_2025{{2.1e-8, 7.5e-9, -1.2e-7, -6e-8}, {1.2e5, 4.9e4, -1.3e5, -3.3e5}};

ModernContext ionosphere_context() {
    ModernContext context;
    context.run = {test::april_noon, test::april_noon + seconds(86400)};
    context.broadcast.gps = broadcast_2025;
    context.broadcast.galileo = std::array{90.0, 0.4, 0.01};
    context.nequick_folder = std::filesystem::path(SKYLOOP_SOURCE_DIR) / "data/nequick_g";
    return context;
}

// The delays of a model without its residual.
IonosphereDelay ionosphere_effect(IonosphereModel model, const ModernContext& context = ionosphere_context()) {
    ModernPropagationParameters parameters;
    parameters.ionosphere_model.model = model;
    parameters.ionosphere_model.waves.content = Tecu(0);
    auto truth = make_ionosphere_truth(parameters.ionosphere_model, context);
    if (!truth) throw std::runtime_error(truth.error().message);
    return {std::move(*truth), parameters, {}, 1};
}

SkyView ionosphere_sky() {
    SkyView sky = test::gps_ring(5, 33);
    sky.satellites.push_back(test::satellite_at({Constellation::galileo, 3}, 200, 12));
    sky.satellites.push_back(test::satellite_at({Constellation::beidou, 22}, 20, 71));
    sky.satellites.push_back(test::satellite_at({Constellation::glonass, 9}, 120, 5));
    return sky;
}

SkyDirection direction_to(const SatelliteInView& satellite) { return {satellite.azimuth, satellite.elevation}; }

// NTCM-G leaves the antenna's height out.
PiercePoint pierce_point_from_ground(const TruthState& truth, const SatelliteInView& satellite) {
    return pierce_point({}, {truth.geodetic.latitude, truth.geodetic.longitude, {}}, direction_to(satellite));
}

// Holds every delay of an effect against an expectation, over a day.
template <class Expected>
void expect_delays(IonosphereDelay& effect, Expected&& expected) {
    const SkyView sky = ionosphere_sky();
    for (int i = 0; i < 24; ++i) {
        const TruthState truth = test::truth_of(test::odessa_place, test::april_noon + seconds(3601) * i);
        const Arrivals arrivals = test::after(effect, sky, truth);
        for (std::size_t k = 0; k < sky.satellites.size(); ++k) {
            const double delay = arrivals.satellites[k].iono_delay.value();
            EXPECT_GT(delay, 0.5);
            EXPECT_LT(delay, 100);
            EXPECT_NEAR(delay, expected(sky.satellites[k], truth, first_carrier(arrivals.satellites[k])).value(), 1e-9);
        }
    }
}

TEST(IonosphereTruth, KlobucharIsWhatAReceiverCorrects) {
    IonosphereDelay effect = ionosphere_effect(IonosphereModel::klobuchar);
    expect_delays(effect, [](const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) {
        const auto model = klobuchar_delay(broadcast_2025, truth.geodetic, direction_to(satellite), truth.time);
        return ionosphere_delay_at(model.slant, carrier);
    });
}

TEST(IonosphereTruth, NtcmGIsTheFormulaWithTheCoefficientsOfTheBroadcast) {
    IonosphereDelay effect = ionosphere_effect(IonosphereModel::ntcm_g);
    expect_delays(effect, [](const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) {
        const IonosphereTime when = IonosphereTime::of(to_utc(truth.time, LeapSeconds::announced()));
        const auto content =
            ntcm_g_content({90, 0.4, 0.01}, pierce_point_from_ground(truth, satellite), satellite.elevation, when);
        return ionosphere_group_delay(content, carrier);
    });
}

// Where receivers follow the published geometry, whose longitudes are wrong (NtcmG, …BeyondThePole…).
TEST(IonosphereTruth, NtcmGGoesOverThePoleWhereTheRayDoes) {
    IonosphereDelay effect = ionosphere_effect(IonosphereModel::ntcm_g);
    SkyView sky;
    sky.satellites.push_back(test::satellite_at({Constellation::galileo, 3}, -21, 15));
    const SatelliteInView& satellite = sky.satellites.front();
    const TruthState truth = test::truth_of(Geodetic::degrees(82.49, -62.34, 0), test::april_noon);
    const IonosphereTime when = IonosphereTime::of(to_utc(truth.time, LeapSeconds::announced()));
    const auto delay = [&](const PiercePoint& pierce) {
        const auto content = ntcm_g_content({90, 0.4, 0.01}, pierce, satellite.elevation, when);
        return ionosphere_group_delay(content, Hertz(carrier_frequency_l1)).value();
    };
    const double exact = delay(pierce_point({}, truth.geodetic, direction_to(satellite)));
    const double published = delay(published_pierce_point({}, truth.geodetic, direction_to(satellite)));
    EXPECT_GT(std::abs(exact - published), 0.1);
    EXPECT_NEAR(test::after(effect, sky, truth).satellites[0].iono_delay.value(), exact, 1e-9);
}

TEST(IonosphereTruth, ConstantContentIsMappedByTheShell) {
    IonosphereDelay effect = ionosphere_effect(IonosphereModel::constant);
    expect_delays(effect, [](const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) {
        const double mapping = single_layer_mapping({}, satellite.elevation, truth.geodetic.height.above_ellipsoid);
        return ionosphere_group_delay(Tecu(20 * mapping), carrier);
    });
}

IonosphereMaps maps_of_a_day() {
    IonosphereMaps maps;
    maps.latitude = {Angle::degrees(87.5), Angle::degrees(-2.5), 71};
    maps.longitude = {Angle::degrees(-180), Angle::degrees(5), 73};
    for (int hour = 0; hour <= 24; hour += 2) {
        IonosphereMap map{test::april_noon + std::chrono::hours(hour), {}};
        for (int i = 0; i < 71; ++i)
            for (int j = 0; j < 73; ++j)
                map.content_tecu.push_back(15 + hour * 0.3 + 0.1 * i + 3 * std::cos(j * 5 * std::numbers::pi / 180));
        maps.maps.push_back(map);
    }
    return maps;
}

TEST(IonosphereTruth, IonexIsTheContentOfTheMaps) {
    ModernContext context = ionosphere_context();
    context.maps = {"codg1000.25i", maps_of_a_day()};
    IonosphereDelay effect = ionosphere_effect(IonosphereModel::ionex, context);
    expect_delays(effect, [&](const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) {
        const IonosphereMaps& maps = context.maps->maps;
        const PiercePoint where = pierce_point(maps.shell, truth.geodetic, direction_to(satellite));
        const double vertical = vertical_content(maps, where, truth.time)->value();
        const double mapping =
            single_layer_mapping(maps.shell, satellite.elevation, truth.geodetic.height.above_ellipsoid);
        return ionosphere_group_delay(Tecu(vertical * mapping), carrier);
    });
}

TEST(IonosphereTruth, TheLastMapHoldsOnTurnedWithTheSun) {
    ModernContext context = ionosphere_context();
    context.run.last = context.run.first;  // a run without an end
    context.maps = {"codg1000.25i", maps_of_a_day()};
    IonosphereDelay effect = ionosphere_effect(IonosphereModel::ionex, context);
    const IonosphereMaps& maps = context.maps->maps;
    const IonosphereMap& last = maps.maps.back();
    const SkyView sky = ionosphere_sky();
    const SatelliteInView& satellite = sky.satellites.front();
    const auto delay = [&](GpsTime time) {
        return test::after(effect, sky, test::truth_of(test::odessa_place, time)).satellites.front().iono_delay.value();
    };
    const double at_last = delay(last.time);
    EXPECT_GT(at_last, 0.5);
    EXPECT_NEAR(delay(last.time + seconds(1)), at_last, 1e-3);
    // Six hours later the Sun, and the map with it, stands 90° further west.
    const PiercePoint where = pierce_point(maps.shell, test::odessa_place, direction_to(satellite));
    const Tecu vertical = *map_content(maps, last, {where.latitude, where.longitude + Angle::degrees(90)});
    const double mapping =
        single_layer_mapping(maps.shell, satellite.elevation, test::odessa_place.height.above_ellipsoid);
    EXPECT_NEAR(delay(last.time + std::chrono::hours(6)),
                ionosphere_group_delay(vertical * mapping, Hertz(carrier_frequency_l1)).value(), 1e-6);
}

TEST(IonosphereTruth, MapsMustCoverTheRunAndTheGlobe) {
    const IonosphereParameters parameters{.model = IonosphereModel::ionex};
    ModernContext context = ionosphere_context();
    const auto refusal = [&] {
        const auto made = make_ionosphere_truth(parameters, context);
        return made ? std::string("none") : made.error().message;
    };
    EXPECT_THAT(refusal(), HasSubstr("expected an IONEX file"));
    context.maps = {"codg1000.25i", maps_of_a_day()};
    EXPECT_EQ(refusal(), "none");
    context.run.last += seconds(1);
    EXPECT_EQ(refusal(),
              "codg1000.25i: its maps span 2025-04-10T11:59:42Z to 2025-04-11T11:59:42Z; the run lasts from "
              "2025-04-10T11:59:42Z to 2025-04-11T11:59:43Z");
    context.run.last -= seconds(1);
    context.maps->maps.maps[3].content_tecu[1000] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refusal(), HasSubstr("codg1000.25i: the map of 2025-04-10T17:59:42Z has no value at latitude 55.00°, "
                                     "longitude 75.00°"));
}

// Two maps of one value, at the ends of the run of ionosphere_context().
IonosphereMaps even_maps(const GridAxis& latitude, const GridAxis& longitude) {
    IonosphereMaps maps{{}, latitude, longitude, {}};
    for (const int hour : {0, 24})
        maps.maps.push_back(
            {test::april_noon + std::chrono::hours(hour), std::vector<double>(latitude.count * longitude.count, 20)});
    return maps;
}

TEST(IonosphereTruth, MapsHaveNoHoleHoweverSmall) {
    ModernContext context = ionosphere_context();
    const auto refusal = [&](IonosphereMaps maps) {
        context.maps = {"fine.25i", std::move(maps)};
        const auto made = make_ionosphere_truth({.model = IonosphereModel::ionex}, context);
        return made ? std::string("none") : made.error().message;
    };
    const GridAxis fine{Angle::degrees(90), Angle::degrees(-1), 181};
    const GridAxis around{Angle::degrees(-180), Angle::degrees(1), 361};
    EXPECT_EQ(refusal(even_maps(fine, around)), "none");
    IonosphereMaps holed = even_maps(fine, around);
    for (std::size_t i = 0; i < 181; ++i)
        holed.maps[1].content_tecu[361 * i + 1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refusal(holed), HasSubstr("has no value at latitude 90.00°, longitude -179.00°"));
    // The meridian at which the globe closes may be missing, not the one before, and parallels one step short of a
    // pole.
    EXPECT_EQ(refusal(even_maps(fine, {Angle::degrees(-180), Angle::degrees(1), 360})), "none");
    EXPECT_THAT(refusal(even_maps(fine, {Angle::degrees(-180), Angle::degrees(1), 359})),
                HasSubstr("has no value at latitude -90.00°, longitude 179.00°"));
    EXPECT_THAT(refusal(even_maps(fine, {Angle::degrees(180), Angle::degrees(-1), 359})),
                HasSubstr("has no value at latitude -90.00°, longitude -179.00°"));
    EXPECT_EQ(refusal(even_maps({Angle::degrees(89), Angle::degrees(-1), 179}, around)), "none");
    EXPECT_THAT(refusal(even_maps({Angle::degrees(88), Angle::degrees(-1), 177}, around)),
                HasSubstr("has no value at latitude -90.00°, longitude"));
}

TEST(IonosphereTruth, NequickIsTracedEveryHalfMinuteAndLinearBetween) {
    const ModernContext context = ionosphere_context();
    const auto tables = read_nequick_tables(context.nequick_folder, 4);
    ASSERT_TRUE(tables) << tables.error().message;
    SkyView sky;
    sky.satellites.push_back(test::satellite_at({Constellation::gps, 9}, 215, 22));
    const SatelliteInView& satellite = sky.satellites.front();
    IonosphereDelay effect = ionosphere_effect(IonosphereModel::nequick_g);
    IonosphereDelay slow = ionosphere_effect(IonosphereModel::nequick_g);
    const auto at = [&](IonosphereDelay& which, double since) {
        const TruthState truth = test::truth_of(test::odessa_place, advanced(test::april_noon, Seconds(since)));
        return test::after(which, sky, truth).satellites.front().iono_delay.value();
    };
    const double at_knot = at(effect, 0);
    const Tecu content = nequick_slant_content(*tables, {90, 0.4, 0.01}, test::odessa_place,
                                               to_geodetic(satellite.position_at_transmission), 12 - 18. / 3600);
    EXPECT_NEAR(at_knot, ionosphere_group_delay(content, Hertz(carrier_frequency_l1)).value(), 1e-9);
    const double third = at(effect, 10), most = at(effect, 29.9);
    EXPECT_NEAR((most - at_knot) / 29.9, (third - at_knot) / 10, 1e-12);
    EXPECT_NE(third, at_knot);
    EXPECT_NEAR(at(effect, 30), most, 0.005);
    // From elsewhere in the half minute the satellite is carried to the same knots, were its state that of its orbit.
    EXPECT_NEAR(at(slow, 10), third, 0.05);
}

TEST(IonosphereTruth, NequickGoesFromMonthToMonthWhereverTheRunEnds) {
    ModernContext context = ionosphere_context();
    const GpsTime start = gps_calendar_time(2025, 3, 30, 0, 0, 0);
    context.run = {start, start + seconds(3600)};
    IonosphereDelay effect = ionosphere_effect(IonosphereModel::nequick_g, context);
    SkyView sky;
    sky.satellites.push_back(test::satellite_at({Constellation::gps, 9}, 215, 22));
    const Geodetic there = to_geodetic(sky.satellites.front().position_at_transmission);
    // The first knot of April in UTC, and a noon of May, 18 s before that of GPS.
    for (const auto& [month, time, ut_hours] :
         {std::tuple{4, gps_calendar_time(2025, 4, 1, 0, 0, 30), 12. / 3600},
          std::tuple{5, gps_calendar_time(2025, 5, 10, 12, 0, 0), 12 - 18. / 3600}}) {
        const auto tables = read_nequick_tables(context.nequick_folder, month);
        ASSERT_TRUE(tables) << tables.error().message;
        const Tecu content = nequick_slant_content(*tables, {90, 0.4, 0.01}, test::odessa_place, there, ut_hours);
        const auto arrived = test::after(effect, sky, test::truth_of(test::odessa_place, time));
        EXPECT_NEAR(arrived.satellites.front().iono_delay.value(),
                    ionosphere_group_delay(content, Hertz(carrier_frequency_l1)).value(), 1e-9)
            << "month " << month;
    }
}

TEST(IonosphereTruth, NequickRefusesAMonthWithoutTablesByName) {
    ModernContext context = ionosphere_context();
    const auto all_but_may = std::filesystem::path(::testing::TempDir()) / "skyloop_nequick_without_may";
    std::filesystem::remove_all(all_but_may);
    std::filesystem::copy(context.nequick_folder, all_but_may);
    std::filesystem::remove(all_but_may / "ccir15.asc");
    context.nequick_folder = all_but_may;
    const auto made = make_ionosphere_truth({.model = IonosphereModel::nequick_g}, context);
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error().message, HasSubstr("NeQuick-G has no tables for May: "));
    EXPECT_THAT(made.error().message, HasSubstr("ccir15.asc"));
}

TEST(IonosphereTruth, WithoutBroadcastTheParametersServe) {
    ModernContext context = ionosphere_context();
    context.broadcast = std::nullopt;
    const IonosphereParameters defaults;
    const SkyView sky = ionosphere_sky();
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
    IonosphereDelay klobuchar = ionosphere_effect(IonosphereModel::klobuchar, context);
    IonosphereDelay ntcm = ionosphere_effect(IonosphereModel::ntcm_g, context);
    const auto& first = sky.satellites.front();
    EXPECT_EQ(test::after(klobuchar, sky, truth).satellites[0].iono_delay,
              klobuchar_delay(defaults.klobuchar, truth.geodetic, direction_to(first), truth.time).slant);
    const auto content = [&](const EffectiveIonisation& level) {
        return ntcm_g_content(level, pierce_point_from_ground(truth, first), first.elevation, IonosphereTime{100, 10});
    };
    EXPECT_GT(content(defaults.ionisation), content({64, 0, 0}));
    EXPECT_LT(content(defaults.ionisation), content({80, 0, 0}));
    EXPECT_GT(test::after(ntcm, sky, truth).satellites[0].iono_delay.value(), 2);
}

TEST(IonosphereTruth, LiesBelowAnAntennaInOrbit) {
    const SkyView sky = ionosphere_sky();
    for (const IonosphereModel model :
         {IonosphereModel::klobuchar, IonosphereModel::ntcm_g, IonosphereModel::constant}) {
        IonosphereDelay effect = ionosphere_effect(model);
        const auto largest = [&](double height) {
            const Geodetic place = Geodetic::degrees(46.4774, 30.7326, height);
            double most = 0;
            for (const Arrival& a : test::after(effect, sky, test::truth_of(place, test::april_noon)).satellites)
                most = std::max(most, a.iono_delay.value());
            return most;
        };
        EXPECT_GT(largest(60e3), 1);
        EXPECT_EQ(largest(1000e3), 0);
    }
}

// Relative departures of the delay of a ring of satellites from its model, by epoch, then satellite.
std::vector<std::vector<double>> residual_shares(const SkyView& sky, std::uint64_t seed, int epochs,
                                                 const ErrorTerm& term = {}) {
    IonosphereResidual residual({}, term, seed);
    std::vector<std::vector<double>> shares;
    for (int i = 0; i < epochs; ++i) {
        shares.emplace_back();
        for (const SatelliteInView& satellite : sky.satellites)
            shares.back().push_back(residual.share(satellite.id, direction_to(satellite), test::odessa_place,
                                                   test::april_noon + seconds(1800) * i));
    }
    return shares;
}

TEST(IonosphereResidual, IsMostlyCommonAndRemembersForTwoHours) {
    const SkyView sky = test::gps_ring(12, 89);
    double square = 0, product = 0, lagged = 0, count = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const auto shares = residual_shares(sky, seed, 48);
        for (std::size_t i = 0; i + 4 < shares.size(); ++i, ++count) {
            square += shares[i][0] * shares[i][0];
            product += shares[i][0] * shares[i][6];
            lagged += shares[i][0] * shares[i + 4][6];
        }
    }
    EXPECT_NEAR(std::sqrt(square / count), std::hypot(0.28, 0.05), 0.03);
    EXPECT_NEAR(product / count, 0.28 * 0.28, 0.02);
    EXPECT_NEAR(lagged / product, std::exp(-1), 0.12);
}

TEST(IonosphereResidual, TiltsTowardsTheHorizon) {
    const SkyView sky = test::gps_ring(2, 30);  // north and south
    double square = 0, count = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        for (const auto& shares : residual_shares(sky, seed, 12)) {
            square += std::pow((shares[0] - shares[1]) / 2, 2);
            ++count;
        }
    }
    // 30° up the pierce point is 5.96° away.
    EXPECT_NEAR(std::sqrt(square / count), std::hypot(0.14 * 5.96 / 9, 0.05 / std::sqrt(2)), 0.015);
}

TEST(IonosphereResidual, DoesNotDependOnWhoElseIsThere) {
    const SkyView sky = test::gps_ring(8);
    const auto all = residual_shares(sky, 4, 10);
    const auto alone = residual_shares({{sky.satellites[3]}}, 4, 10);
    const auto seeded = residual_shares({{sky.satellites[3]}}, 77, 10, {true, 1, 4});
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i][3], alone[i][0]);
        EXPECT_EQ(all[i][3], seeded[i][0]);
    }
}

TEST(IonosphereDelay, ItsTermsSwitchModelAndResidual) {
    const SkyView sky = ionosphere_sky();
    const TruthState truth = test::truth_of(test::odessa_place, test::april_noon);
    const auto delay = [&](bool residual_wanted, ErrorTerm model, ErrorTerm residual) {
        ModernPropagationParameters parameters;
        parameters.ionosphere = model;
        parameters.ionosphere_residual = residual;
        auto made = make_ionosphere_truth(parameters.ionosphere_model, ionosphere_context());
        IonosphereDelay effect(std::move(*made), parameters, {false, residual_wanted}, 5);
        return test::after(effect, sky, truth).satellites[2].iono_delay.value();
    };
    const ErrorTerm off{false, 1, {}};
    const double model = delay(false, {}, off), waves = delay(false, {}, {}) - model;
    EXPECT_NE(delay(true, {}, {}), model);
    EXPECT_NE(waves, 0);
    EXPECT_NEAR(waves, 0, 1);
    EXPECT_NEAR(delay(false, {}, {true, 2, {}}) - model, 2 * waves, 1e-9);
    EXPECT_NEAR(delay(false, {true, 2, {}}, {}), 2 * (model + waves), 1e-9);
    EXPECT_EQ(delay(true, {}, {false, 1, {}}), model);
    EXPECT_EQ(delay(true, {false, 1, {}}, {}), 0);
    EXPECT_NEAR(delay(false, {true, 0.5, {}}, off), model / 2, 1e-12);
    EXPECT_NEAR(delay(true, {}, {true, 0.5, {}}) - model, (delay(true, {}, {}) - model) / 2, 1e-9);
}

}  // namespace
}  // namespace skyloop
