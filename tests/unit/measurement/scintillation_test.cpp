#include "receiver/measurement/tracking_jitter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/core/random.hpp"
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

TEST(Scintillation, PowerHasTheMomentsThatAreAskedFor) {
    RandomStream random(7, "scintillating power");
    for (const double s4 : {0.1, 0.4, 0.7, 1.0}) {
        constexpr int draws = 200'000;
        double sum = 0, squares = 0;
        for (int i = 0; i < draws; ++i) {
            const double in_phase = random.normal(), quadrature = random.normal();
            const double power = scintillating_power(s4, in_phase, quadrature);
            ASSERT_GE(power, 0);
            sum += power;
            squares += power * power;
        }
        const double mean = sum / draws;
        EXPECT_NEAR(mean, 1, 0.01) << s4;
        EXPECT_NEAR(std::sqrt(squares / draws / (mean * mean) - 1), s4, 0.01);
    }
    EXPECT_EQ(scintillating_power(0, 3, 3), 1);
    EXPECT_EQ(scintillating_power(2, 1, 1), scintillating_power(1, 1, 1));
}

TEST(Scintillation, OfNothingIsThermalNoise) {
    EXPECT_DOUBLE_EQ(scintillating_phase_jitter({}, DbHz(40), 0).rad(), phase_jitter({}, DbHz(40)).rad());
    EXPECT_GT(scintillating_phase_jitter({}, DbHz(40), 0.7).rad(), phase_jitter({}, DbHz(40)).rad());
}

}  // namespace
}  // namespace skyloop
