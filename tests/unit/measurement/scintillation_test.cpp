#include "skyloop/measurement/scintillation.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

TEST(Scintillation, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("scintillation_tracking.csv")) {
        SCOPED_TRACE(row.id());
        const DbHz cn0(row.number("cn0_dBHz"));
        const double s4 = row.number("S4");
        CodeLoop code;
        code.bandwidth = Hertz(row.number("Bn_Hz"));
        code.spacing_chips = row.number("D_chips");
        code.integration = Seconds(row.number("T_s"));
        const CarrierLoop carrier{code.bandwidth * 10, code.integration};
        const double tolerance = row.number("tol_rel");
        if (s4 > 0) {
            EXPECT_NEAR(nakagami_m(s4) / row.number("nakagami_m"), 1, tolerance);
        }
        EXPECT_NEAR(scintillating_code_jitter_chips(code, cn0, s4) / row.number("sigma_dll_chips"), 1, tolerance);
        EXPECT_NEAR(scintillating_phase_jitter(carrier, cn0, s4).deg() / row.number("sigma_pll_deg_Bn10x"), 1,
                    tolerance);
    }
}

TEST(Scintillation, OfNothingIsThermalNoise) {
    EXPECT_DOUBLE_EQ(scintillating_phase_jitter({}, DbHz(40), 0).rad(), phase_jitter({}, DbHz(40)).rad());
    EXPECT_GT(scintillating_phase_jitter({}, DbHz(40), 0.7).rad(), phase_jitter({}, DbHz(40)).rad());
}

}  // namespace
}  // namespace skyloop
