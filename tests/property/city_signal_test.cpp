// Streets between houses through the whole chain, from triangles to fixes (MODELS.md, B-14 and B-24).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/geo/local_frame.hpp"
#include "property/statistics.hpp"
#include "receiver/error_model/baseline.hpp"
#include "support/model_sky.hpp"
#include "support/modern_run.hpp"
#include "world/propagation/ray_traced_scene.hpp"
#include "world/scene/generated_city.hpp"

namespace skyloop::test {
namespace {

constexpr double street_width_m = 20, antenna_up_m = 1.6;
// Where ModelRun's antenna is.
const Geodetic street_antenna = Geodetic::degrees(46.4774, 30.7326, 50);
const Geodetic street_ground = Geodetic::degrees(46.4774, 30.7326, 50 - antenna_up_m);

std::shared_ptr<const UrbanScene> street_scene(double left_m, double right_m, double length_m, const Geodetic& origin) {
    StreetCanyonSettings settings;
    settings.width = street_width_m;
    settings.length = length_m;
    settings.left_height = left_m;
    settings.right_height = right_m;
    auto scene = UrbanScene::build(street_canyon(settings, origin));
    EXPECT_TRUE(scene);
    return *scene;
}

/// Satellites along the street, which no height hides, and one straight across it.
SkyView sky_over_street(double across_elevation_deg) {
    return sky_of({{0, 40}, {180, 35}, {0, 75}, {180, 65}, {2, 55}, {178, 50}, {90, across_elevation_deg}});
}

/// One epoch of the article's sensor in the middle of a street from south to north.
Trace article_epoch(double height_m, double across_elevation_deg) {
    RayTracedSceneSettings settings;
    settings.profile = SceneProfile::baseline;
    settings.search.rays = 16384;
    RayTracedScene city(street_scene(height_m, height_m, 200, street_ground), settings);
    const SkyView sky = sky_over_street(across_elevation_deg);
    EffectSettings strong;
    strong.link_budget.satellite_power = DecibelWatts(60);
    ModelRun run({}, strong);
    return run.epoch(sky, 0, [&](Arrivals& arrivals) {
        city.apply(arrivals, sky, truth_at(street_antenna, to_gps_time(2111, 0.0)));
    });
}

// B-14. A satellite straight across a canyon is heard over n mirrors when the image of the antenna n houses further
// away sees it over the roof: (W/2 + nW) tan e > H.
TEST(ClosingCanyon, CostsThreeDecibelsForEachReflectionAndHidesBeyondSixteen) {
    constexpr double elevation_deg = 12;
    const double slope = std::tan(Angle::degrees(elevation_deg).rad());
    const Trace open = article_epoch(1, elevation_deg);
    const Arrival& clear = open.arrivals.satellites.back();
    ASSERT_TRUE(clear.line_of_sight);
    const Metres spread_before = uere_scale(open.epoch.fix, open.arrivals, {}).sigma_uere;
    Metres accuracy_before = open.epoch.fix.horizontal_accuracy;
    for (const int n : {1, 2, 3, 5, 8, 12, 16}) {
        SCOPED_TRACE(n);
        // A roof half a step below what the n-th image sees over.
        const double height = antenna_up_m + street_width_m * n * slope;
        const Trace canyon = article_epoch(height, elevation_deg);
        const Arrival& echo = canyon.arrivals.satellites.back();
        EXPECT_FALSE(echo.line_of_sight);
        ASSERT_EQ(echo.paths, 1);
        EXPECT_EQ(echo.reflections, n);
        EXPECT_NEAR(clear.cn0->value() - echo.cn0->value(), 3.0103 * n, 1e-3);
        // From the middle of the street the n-th image stands nW away.
        EXPECT_NEAR(echo.excess_path.value(), street_width_m * n * std::cos(Angle::degrees(elevation_deg).rad()), 0.01);
        EXPECT_GT(uere_scale(canyon.epoch.fix, canyon.arrivals, {}).sigma_uere, spread_before);
        EXPECT_GT(canyon.epoch.fix.horizontal_accuracy, accuracy_before);
        accuracy_before = canyon.epoch.fix.horizontal_accuracy;
        EXPECT_EQ(canyon.epoch.fix.satellites_used(), 7);
    }
    const Trace closed = article_epoch(antenna_up_m + street_width_m * 17 * slope, elevation_deg);
    EXPECT_EQ(closed.arrivals.satellites.back().paths, 0);
    EXPECT_FALSE(closed.arrivals.satellites.back().cn0);
    EXPECT_EQ(closed.epoch.fix.satellites_used(), 6);
}

struct StreetFigure {
    std::vector<double> used, hdop, east, north;
    int detours_used = 0, echoes = 0;
    double least_detour_m = 1e9, least_detour_loss_db = 1e9;
    double worst_distortion = 0;
};

/// A consumer receiver in a street, or in the open.
Simulation city_run(const RayTracedSceneSettings& city, bool houses) {
    ModernSettings settings = ModernSettings::of(ModernPreset::consumer);
    settings.navigation.filter.kind = FilterKind::none;
    settings.navigation.integrity.enabled = false;
    settings = effective(settings);
    auto navigation = std::make_unique<FourSystems>();
    auto effects = modern_effects(settings.propagation, context_of(settings, *navigation, 1));
    EXPECT_TRUE(effects);
    // The antenna stands on the western pavement, 5 m from the houses.
    const Geodetic ground = Geodetic::degrees(48, 11 + 5 / 74'600.0, 500 - antenna_up_m);
    if (houses)
        effects->insert(effects->end() - 1, std::make_unique<RayTracedScene>(street_scene(24, 24, 300, ground), city));
    MeasuringReceiver receiver{MeasurementEngine(settings.measurement, 1),
                               NavigationEngine(settings.navigation, {navigation.get()})};
    return Simulation({std::make_unique<FixedPoint>(Geodetic::degrees(48, 11, 500)), std::move(navigation),
                       std::move(*effects), std::move(receiver)});
}

RayTracedSceneSettings street_rays() {
    RayTracedSceneSettings settings;
    settings.search.rays = 4096;
    settings.search.most_reflections = 3;
    settings.search.ground_reflects = true;
    return settings;
}

void look_at(const Trace& trace, StreetFigure& figure) {
    const Fix& fix = trace.epoch.fix;
    for (const Observation& o : trace.epoch.observations.signals)
        figure.worst_distortion = std::max(figure.worst_distortion, o.correlation_distortion.value_or(0));
    if (fix.type != FixType::fix_3d) return;
    figure.used.push_back(fix.satellites_used());
    figure.hdop.push_back(fix.dop.hdop);
    const Eigen::Vector3d e = LocalFrame(trace.truth.geodetic).to_enu(to_ecef(fix.position)).vector();
    figure.east.push_back(e.x());
    figure.north.push_back(e.y());
    std::map<SatelliteId, const Arrival*> arrivals;
    for (const Arrival& a : trace.arrivals.satellites)
        arrivals[a.id] = &a;
    for (const SatelliteStatus& s : fix.satellites) {
        const Arrival& a = *arrivals.at(s.id);
        figure.echoes += static_cast<int>(a.echoes.size());
        if (!s.used || a.line_of_sight) continue;
        ++figure.detours_used;
        figure.least_detour_m = std::min(figure.least_detour_m, a.excess_path.value());
        figure.least_detour_loss_db = std::min(figure.least_detour_loss_db, a.reflection_loss.value());
    }
}

StreetFigure street_figure(bool houses) {
    Simulation simulation = city_run(street_rays(), houses);
    StreetFigure figure;
    for (int k = 0; k < 360; ++k)
        look_at(simulation.run(to_gps_time(2300, 60.0 * k), all_systems()), figure);
    return figure;
}

// B-24
TEST(CityStreet, HidesLengthensAndPushesAcross) {
    const StreetFigure open = street_figure(false), street = street_figure(true);
    ASSERT_GT(street.east.size(), 250U);
    EXPECT_LT(mean(street.used), 0.85 * mean(open.used));
    EXPECT_GT(mean(street.hdop), 1.2 * mean(open.hdop));
    EXPECT_GT(street.echoes, 1000);
    EXPECT_GT(street.detours_used, 200);
    EXPECT_GT(street.least_detour_m, 0) << "an echo is never early";
    EXPECT_GT(street.least_detour_loss_db, 0);
    EXPECT_GT(street.worst_distortion, 0.05);
    EXPECT_GT(rms(street.east), 1.5 * rms(street.north)) << "across the street more than along it";
    EXPECT_GT(rms(street.east), 2 * rms(open.east));
}

// The same city and seed, the same bytes.
TEST(CityStreet, IsTheSameEveryTime) {
    const auto positions = [] {
        Simulation simulation = city_run(street_rays(), true);
        std::vector<double> latitudes;
        for (int k = 0; k < 20; ++k)
            latitudes.push_back(
                simulation.run(to_gps_time(2300, 1.0 * k), all_systems()).epoch.fix.position.latitude.rad());
        return latitudes;
    };
    EXPECT_EQ(positions(), positions());
}

}  // namespace
}  // namespace skyloop::test
