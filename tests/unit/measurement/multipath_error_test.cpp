#include "receiver/measurement/correlator_multipath.hpp"

#include <gtest/gtest.h>

#include <array>

#include "receiver/measurement/tracking_jitter.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

TEST(MultipathCodeError, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("multipath_code_error.csv")) {
        SCOPED_TRACE(row.id());
        const std::array echo{SignalEcho{row.number("relative_amplitude"), row.number("delay_chips"),
                                         Angle::radians(row.number("phase_rad"))}};
        const double error = multipath_code_error_chips(echo, row.number("spacing_chips"));
        EXPECT_NEAR(error, row.number("error_chips"), row.number("tol_chips"));
        const double chip = CodeLoop{}.chip_length().value();
        EXPECT_NEAR(error * chip, row.number("error_m_CA"), row.number("tol_chips") * chip);
    }
}

TEST(MultipathCodeError, HasItsLimits) {
    const auto error = [](double amplitude, double delay, double phase_deg) {
        const std::array echo{SignalEcho{amplitude, delay, Angle::degrees(phase_deg)}};
        return multipath_code_error_chips(echo, 0.2);
    };
    EXPECT_EQ(multipath_code_error_chips({}, 0.2), 0);
    EXPECT_NEAR(error(0.5, 0.01, 0), 0.5 * 0.01 / 1.5, 1e-12);
    EXPECT_NEAR(error(0.5, 0.5, 0), 0.5 * 0.2 / 2, 1e-12);
    EXPECT_NEAR(error(0.5, 0.5, 180), -0.5 * 0.2 / 2, 1e-12);
    EXPECT_NEAR(error(0.5, 1.2, 0), 0, 1e-12);
}

TEST(MultipathCodeError, OppositeEchoesCancel) {
    const std::array echoes{SignalEcho{0.3, 0.4, Angle::degrees(0)}, SignalEcho{0.3, 0.4, Angle::degrees(180)}};
    EXPECT_NEAR(multipath_code_error_chips(echoes, 0.5), 0, 1e-12);
}

}  // namespace
}  // namespace skyloop
