#include "world/propagation/sensor_model_delays.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/oracle_table.hpp"
#include "unit/propagation/one_satellite.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

TEST(TraceRay, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("refraction_raytrace.csv")) {
        SCOPED_TRACE(row.id());
        const double tolerance = row.number("tol_m");
        const ExponentialRefractivity air{row.number("N0"), Metres(row.number("H_m"))};
        const RefractedRay ray = trace_ray(air, Angle::degrees(row.number("apparent_el_deg")), {});
        EXPECT_NEAR(ray.chord_elevation.deg(), row.number("chord_el_deg"), 1e-8);
        EXPECT_NEAR(ray.excess_optical.value(), row.number("excess_optical_m"), tolerance);
        EXPECT_NEAR(ray.geometric_lengthening.value(), row.number("geometric_lengthening_m"), tolerance);
        EXPECT_NEAR(ray.excess().value(), row.number("total_excess_m"), tolerance);
    }
}

TEST(TraceRay, ALevelRayAndAHighAntennaStayFinite) {
    const RefractedRay level = trace_ray({}, Angle::degrees(0), {});
    EXPECT_NEAR(level.excess().value(), 97, 10);
    EXPECT_EQ(trace_ray({}, Angle::degrees(30), {Metres(200000)}).excess().value(), 0);
    EXPECT_TRUE(std::isfinite(trace_ray({5000, Metres(7350)}, Angle::degrees(0), {}).excess().value()));
}

TEST(RefractionBending, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("refraction_p834_bending.csv")) {
        SCOPED_TRACE(row.id());
        const Angle bending =
            refraction_bending(Angle::degrees(row.number("elevation_deg")), {Metres(row.number("rx_h_km") * 1000)});
        EXPECT_NEAR(bending.deg(), row.number("bend_if_free_space_deg"), row.number("tol_deg"));
    }
}

TEST(RefractionDelay, IsTheExcessPathAtTheApparentElevation) {
    test::OneSatellite scene(Angle::degrees(10), Metres(22e6), Geodetic::degrees(46, 30, 300));
    RefractionDelay effect({}, nullptr);
    const Angle apparent = Angle::degrees(10) + refraction_bending(Angle::degrees(10), {Metres(300)});
    EXPECT_EQ(scene.after(effect).tropo_delay, trace_ray({}, apparent, {Metres(300)}).excess());
    EXPECT_NEAR(scene.arrival().tropo_delay.value(), 12.4, 0.3);
}

}  // namespace
}  // namespace skyloop
