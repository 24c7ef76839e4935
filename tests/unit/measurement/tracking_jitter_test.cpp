#include "receiver/measurement/tracking_jitter.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

TEST(TrackingJitter, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("tracking_jitter.csv")) {
        SCOPED_TRACE(row.id());
        const DbHz cn0(row.number("cn0_dBHz"));
        const Hertz bandwidth(row.number("Bn_Hz"));
        const Seconds integration(row.number("T_s"));
        const CodeLoop code{bandwidth, row.number("D_chips"), integration, Hertz(row.number("Bfe_Hz")),
                            Hertz(row.number("chip_rate_Hz"))};
        const CarrierLoop carrier{bandwidth * 10, integration};
        const auto expect_close = [&](double value, const char* column) {
            EXPECT_NEAR(value / row.number(column), 1, row.number("tol_rel")) << column;
        };
        expect_close(code_jitter_chips(code, cn0), "sigma_dll_chips");
        expect_close(code_jitter(code, cn0).value(), "sigma_dll_m");
        expect_close(phase_jitter(carrier, cn0).deg(), "sigma_pll_deg");
        const Hertz frequency = frequency_jitter(carrier, cn0);
        expect_close(frequency.value(), "sigma_fll_Hz");
        expect_close(speed_of_light / carrier_frequency_l1 * frequency.value(), "sigma_velocity_L1_m_s");
    }
}

TEST(TrackingJitter, FallsWithTheSignalAndHasNoStepAtTheNarrowEdge) {
    CodeLoop loop;
    EXPECT_GT(code_jitter(loop, DbHz(30)).value(), 2 * code_jitter(loop, DbHz(40)).value());
    const double edge = loop.chip_rate.value() / loop.front_end_bandwidth.value();
    loop.spacing_chips = edge * (1 - 1e-9);
    const double below = code_jitter_chips(loop, DbHz(45));
    loop.spacing_chips = edge * (1 + 1e-9);
    EXPECT_NEAR(code_jitter_chips(loop, DbHz(45)) / below, 1, 1e-3);
    EXPECT_NEAR(loop.chip_length().value(), 293.05, 0.005);
}

TEST(TrackingJitter, DoublesInPowerNearTheThreshold) {
    const double high = frequency_jitter({}, DbHz(25)).value();
    EXPECT_NEAR(frequency_jitter({}, DbHz(25), 2).value() / high, 1.41421356, 1e-6);
}

}  // namespace
}  // namespace skyloop
