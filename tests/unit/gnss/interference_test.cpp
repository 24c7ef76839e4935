#include "world/gnss/signal.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

TEST(Interference, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("interference_cn0.csv")) {
        SCOPED_TRACE(row.id());
        const DbHz left = cn0_under_interference(DbHz(row.number("cn0_dBHz")), Decibels(row.number("j_over_s_dB")),
                                                 {row.number("Q"), Hertz(row.number("chip_rate_Hz"))});
        EXPECT_NEAR(left.value(), row.number("cn0_eff_dBHz"), row.number("tol_dB"));
    }
}

TEST(Interference, OfThirtyDecibelsLeavesThirtyTwo) {
    EXPECT_NEAR(cn0_under_interference(DbHz(45), Decibels(30)).value(), 31.7, 0.05);
    EXPECT_NEAR(cn0_under_interference(DbHz(45), Decibels(40)).value(), 21.8, 0.1);
    EXPECT_NEAR(cn0_under_interference(DbHz(45), Decibels(-100)).value(), 45, 1e-6);
}

}  // namespace
}  // namespace skyloop
