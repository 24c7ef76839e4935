#include "world/propagation/sensor_model_delays.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/flat_geoid.hpp"
#include "support/oracle_table.hpp"
#include "unit/propagation/one_satellite.hpp"

namespace skyloop {
namespace {

using test::OneSatellite;
using test::OracleRow;

TEST(SlantDelay, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("paper_tropo_delay.csv")) {
        SCOPED_TRACE(row.id());
        const double tolerance = row.number("tol_m");
        const Angle elevation = Angle::degrees(row.number("el_deg"));
        const MappingSite site{
            Angle::degrees(row.number("lat_deg")), {Metres(row.number("h_m"))}, row.number("doy_1based")};
        AtmosphereParameters atmosphere;
        atmosphere.zenith_wet_delay = Metres(row.number("zenith_wet_m"));
        const DryAndWetDelay zenith = zenith_delay(atmosphere, site.height);
        EXPECT_NEAR(zenith.dry.value(), row.number("zenith_dry_m"), tolerance);
        EXPECT_NEAR(niell_hydrostatic_mapping(site, elevation), row.number("m_dry"), tolerance);
        EXPECT_NEAR(niell_wet_mapping(site.latitude, elevation), row.number("m_wet"), tolerance);
        EXPECT_NEAR(slant_delay(zenith, site, elevation).value(), row.number("E_tropo_m"), tolerance);
    }
}

TEST(NiellTroposphereDelay, TakesSeasonAndHeightFromTheTruth) {
    OneSatellite scene(Angle::degrees(12), Metres(22e6), Geodetic::degrees(46.4774, 30.7326, 820));
    scene.truth.time = to_gps_time(UtcTime{2020, 6, 25, 10, 7, 0, 0}, LeapSeconds::announced());
    const MappingSite site{scene.truth.geodetic.latitude, {Metres(820)}, 177 + (10 * 60 + 7) / 1440.0};
    NiellTroposphereDelay effect({}, nullptr, LeapSeconds::announced());
    EXPECT_NEAR(scene.after(effect).tropo_delay.value(),
                slant_delay(zenith_delay({}, site.height), site, Angle::degrees(12)).value(), 1e-9);
}

TEST(NiellTroposphereDelay, AGeoidTurnsTheHeightIntoThatAboveTheSea) {
    const auto geoid = test::flat_geoid(27.5);
    ASSERT_TRUE(geoid) << geoid.error().message;
    OneSatellite over_ellipsoid(Angle::degrees(7), Metres(24e6), Geodetic::degrees(46.4774, 30.7326, 50 - 27.5));
    OneSatellite over_sea(Angle::degrees(7), Metres(24e6), Geodetic::degrees(46.4774, 30.7326, 50));
    NiellTroposphereDelay without({}, nullptr, LeapSeconds::announced());
    NiellTroposphereDelay with({}, &*geoid, LeapSeconds::announced());
    const Metres delay = over_sea.after(with).tropo_delay;
    EXPECT_NEAR(delay.value(), over_ellipsoid.after(without).tropo_delay.value(), 1e-9);
    EXPECT_GT(delay, over_sea.after(without).tropo_delay + Metres(0.01));
}

TEST(NiellTroposphereDelay, WetZenithDelayIsMappedByTheWetFunction) {
    OneSatellite scene(Angle::degrees(12), Metres(22e6), Geodetic::degrees(46.4774, 30.7326, 0));
    AtmosphereParameters wet;
    wet.zenith_wet_delay = Metres(0.2);
    NiellTroposphereDelay dry_effect({}, nullptr, LeapSeconds::announced());
    NiellTroposphereDelay wet_effect(wet, nullptr, LeapSeconds::announced());
    const double dry = scene.after(dry_effect).tropo_delay.value();
    const double both = scene.after(wet_effect).tropo_delay.value();
    EXPECT_NEAR(both - dry, 0.2 * niell_wet_mapping(Angle::degrees(46.4774), Angle::degrees(12)), 1e-9);
}

TEST(NiellTroposphereDelay, OnTheHorizonIsLargeButFinite) {
    OneSatellite scene(Angle::degrees(0), Metres(25e6), Geodetic::degrees(46, 30, 2000));
    NiellTroposphereDelay effect({}, nullptr, LeapSeconds::announced());
    EXPECT_TRUE(std::isfinite(scene.after(effect).tropo_delay.value()));
}

}  // namespace
}  // namespace skyloop
