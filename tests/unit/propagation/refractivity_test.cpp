#include "world/propagation/reference_air.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

TEST(Refractivity, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("refractivity_p453.csv")) {
        SCOPED_TRACE(row.id());
        const Refractivity n =
            refractivity_p453(row.number("P_dry_hPa"), Kelvin(row.number("T_K")), row.number("e_hPa"));
        EXPECT_NEAR(n.dry, row.number("N_dry"), row.number("tol"));
        EXPECT_NEAR(n.wet, row.number("N_wet"), row.number("tol"));
        EXPECT_NEAR(n.total(), row.number("N"), row.number("tol"));
    }
}

}  // namespace
}  // namespace skyloop
