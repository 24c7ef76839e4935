#include "base/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

TEST(GaussMarkovStep, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("gauss_markov_discrete.csv")) {
        SCOPED_TRACE(row.id());
        const GaussMarkovStep step =
            gauss_markov_step({row.number("sigma"), Seconds(row.number("tau_s"))}, Seconds(row.number("dt_s")));
        EXPECT_NEAR(step.phi / row.number("phi"), 1, row.number("tol_rel"));
        EXPECT_NEAR(step.noise / row.number("q_std"), 1, row.number("tol_rel"));
    }
}

TEST(GaussMarkovStep, TwoHalfStepsAreOneWholeStep) {
    const GaussMarkovParameters p{3, Seconds(100)};
    const GaussMarkovStep whole = gauss_markov_step(p, Seconds(10)), half = gauss_markov_step(p, Seconds(5));
    EXPECT_NEAR(half.phi * half.phi, whole.phi, 1e-15);
    EXPECT_NEAR(std::hypot(half.phi * half.noise, half.noise), whole.noise, 1e-14);
}

TEST(GaussMarkovStep, WithoutCorrelationTimeItIsWhite) {
    EXPECT_EQ(gauss_markov_step({3, Seconds(0)}, Seconds(1)).phi, 0);
    EXPECT_EQ(gauss_markov_step({3, Seconds(0)}, Seconds(1)).noise, 3);
}

TEST(GaussMarkov, HasItsVarianceAndAutocorrelation) {
    GaussMarkov process({2, Seconds(20)}, RandomStream(1, "test"));
    std::vector<double> x;
    for (int i = 0; i < 200000; ++i)
        x.push_back(process.advance(Seconds(1)));
    double power = 0, lagged = 0;
    for (std::size_t i = 20; i < x.size(); ++i) {
        power += x[i] * x[i];
        lagged += x[i] * x[i - 20];
    }
    EXPECT_NEAR(std::sqrt(power / static_cast<double>(x.size())), 2, 0.06);
    EXPECT_NEAR(lagged / power, std::exp(-1), 0.03);
}

TEST(GaussMarkov, StartsStationaryAndStandsStillWithoutTime) {
    double power = 0;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        const double start = GaussMarkov({2, Seconds(1e6)}, RandomStream(seed, "start")).value();
        power += start * start / 2000;
    }
    EXPECT_NEAR(std::sqrt(power), 2, 0.12);
    GaussMarkov process({2, Seconds(20)}, RandomStream(1, "test"));
    GaussMarkov same = process;
    const double before = process.value();
    EXPECT_EQ(process.advance(Seconds(0)), before);
    EXPECT_EQ(process.advance(Seconds(1)), same.advance(Seconds(1)));
}

}  // namespace
}  // namespace skyloop
