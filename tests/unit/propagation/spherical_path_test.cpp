#include "world/propagation/ray_geometry.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"
#include "world/propagation/propagation_effect.hpp"

namespace skyloop {
namespace {

using test::oracle_rows;
using test::OracleRow;

TEST(ShellPath, EveryOracleRow) {
    for (const OracleRow& row : oracle_rows("paper_layer_path.csv")) {
        SCOPED_TRACE(row.id());
        const SphericalRay ray{Angle::degrees(row.number("el_deg")), Metres(row.number("rx_h_m")),
                               Metres(row.number("earth_radius_m"))};
        const Metres path = shell_path(ray, Metres(row.number("layer_base_m")), Metres(row.number("layer_top_m")));
        EXPECT_NEAR(path.value(), row.number("path_m"), row.number("tol_m"));
    }
}

TEST(SphericalRay, EveryLinkGeometryRow) {
    for (const OracleRow& row : oracle_rows("link_geometry.csv")) {
        SCOPED_TRACE(row.id());
        const SphericalRay ray{Angle::degrees(row.number("el_deg")), Metres(row.number("rx_h_m"))};
        const Metres radius(row.number("orbit_radius_m"));
        const Metres range = path_to_height(ray, radius - ray.earth_radius);
        EXPECT_NEAR(range.value(), row.number("slant_range_m"), row.number("tol_m"));
        EXPECT_NEAR(off_boresight_angle(ray, radius).deg(), row.number("off_boresight_deg"), 1e-8);
        EXPECT_NEAR(free_space_loss(range, Hertz(carrier_frequency_l1)).value(), row.number("free_space_loss_L1_dB"),
                    1e-8);
    }
}

TEST(ShellPath, IsNothingBelowTheAntennaOrInAnInvertedShell) {
    const SphericalRay ray{Angle::degrees(10), Metres(5000)};
    EXPECT_EQ(shell_path(ray, Metres(0), Metres(3000)), Metres(0));
    EXPECT_EQ(shell_path(ray, Metres(9000), Metres(8000)), Metres(0));
    EXPECT_EQ(shell_path(ray, Metres(0), Metres(9000)), shell_path(ray, Metres(5000), Metres(9000)));
}

TEST(SphericalRay, RisesTowardsTheVerticalWithHeight) {
    const SphericalRay ray{Angle::degrees(5), Metres(0)};
    EXPECT_NEAR(elevation_at_height(ray, Metres(0)).deg(), 5, 1e-9);
    EXPECT_GT(elevation_at_height(ray, Metres(350000)).deg(), 18);
}

}  // namespace
}  // namespace skyloop
