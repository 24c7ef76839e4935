// A street between two rows of houses (MODELS.md, B-24): what the chain makes of satellites that are hidden, or heard
// only over the other side of the street.
#include <gtest/gtest.h>

#include <cmath>

#include "property/statistics.hpp"
#include "support/modern_run.hpp"

namespace skyloop::test {
namespace {

/// Two endless walls along a street from south to north, the antenna on its western pavement.
class StreetCanyon : public PropagationEffect {
public:
    void apply(Arrivals& arrivals, const SkyView&, const TruthState&) override {
        for (Arrival& a : arrivals.satellites) {
            const double eastward = std::sin(a.direction.azimuth.rad());
            const double across = std::abs(eastward), slope = std::tan(a.direction.elevation.rad());
            const double before = eastward > 0 ? to_east_m : to_west_m;  // the wall on the satellite's side
            const double behind = eastward > 0 ? to_west_m : to_east_m;
            // Height over the antenna at which the ray crosses the wall before it.
            if (before / across * slope > wall_m) continue;
            a.line_of_sight = false;
            a.reflections = 1;
            a.reflection_loss = Decibels(6);
            a.excess_path = Metres(2 * behind * across * std::cos(a.direction.elevation.rad()));
            // The echo comes from the wall behind, and must come over the one before.
            const bool arrives = behind / across * slope < wall_m && (2 * behind + before) / across * slope > wall_m;
            if (!arrives) a.paths = 0;
        }
    }

private:
    static constexpr double to_west_m = 5, to_east_m = 19, wall_m = 24;
};

struct StreetFigures {
    std::vector<double> used, hdop, east, north;
    int echoes_used = 0;
    double least_excess_m = 1e9;
};

StreetFigures street(bool walls) {
    ModernSettings settings = ModernSettings::of(ModernPreset::consumer);
    settings.navigation.filter.kind = FilterKind::none;
    settings.navigation.integrity.enabled = false;
    settings = effective(settings);
    auto navigation = std::make_unique<FourSystems>();
    auto effects = modern_effects(settings.propagation, context_of(settings, *navigation, 1));
    EXPECT_TRUE(effects);
    // The link budget comes last: it takes the loss of the reflection.
    if (walls) effects->insert(effects->end() - 1, std::make_unique<StreetCanyon>());
    MeasuringReceiver receiver{MeasurementEngine(settings.measurement, 1),
                               NavigationEngine(settings.navigation, {navigation.get()})};
    Simulation simulation({std::make_unique<FixedPoint>(Geodetic::degrees(48, 11, 500)), std::move(navigation),
                           std::move(*effects), std::move(receiver)});
    StreetFigures figures;
    for (int k = 0; k < 720; ++k) {
        const Trace trace = simulation.run(to_gps_time(2300, 30.0 * k), all_systems());
        const Fix& fix = trace.epoch.fix;
        if (fix.type != FixType::fix_3d) continue;
        figures.used.push_back(fix.satellites_used());
        figures.hdop.push_back(fix.dop.hdop);
        const Eigen::Vector3d e = LocalFrame(trace.truth.geodetic).to_enu(to_ecef(fix.position)).vector();
        figures.east.push_back(e.x());
        figures.north.push_back(e.y());
        for (const Arrival& a : trace.arrivals.satellites)
            for (const SatelliteStatus& s : fix.satellites)
                if (s.id == a.id && s.used && !a.line_of_sight) {
                    ++figures.echoes_used;
                    figures.least_excess_m = std::min(figures.least_excess_m, a.excess_path.value());
                }
    }
    return figures;
}

TEST(StreetCanyon, HidesLengthensAndPushesAcross) {
    const StreetFigures open = street(false), canyon = street(true);
    ASSERT_GT(canyon.east.size(), 600U);
    EXPECT_LT(mean(canyon.used), 0.8 * mean(open.used));
    EXPECT_GT(mean(canyon.hdop), 1.3 * mean(open.hdop));
    EXPECT_GT(canyon.echoes_used, 500);
    EXPECT_GT(canyon.least_excess_m, 0) << "an echo is never early";
    EXPECT_GT(rms(canyon.east), 1.5 * rms(canyon.north)) << "across the street more than along it";
    EXPECT_GT(rms(canyon.east), 2 * rms(open.east));
}

}  // namespace
}  // namespace skyloop::test
