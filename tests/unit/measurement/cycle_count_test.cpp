// Breaks of the count of cycles, seen through the engine.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "measured_sky.hpp"

namespace skyloop {
namespace {

using test::e03;
using test::g07;
using test::MeasuredRun;
using test::plain_arrivals;
using test::without_errors;

// Only the slips, `per_hour` in good conditions.
MeasurementParameters only_slips(double per_hour) {
    MeasurementParameters parameters = without_errors();
    parameters.cycle_slips.enabled = true;
    parameters.slips_per_hour = per_hour;
    return parameters;
}

int slips_in(MeasuredRun& run, const Arrivals& arrivals, int epochs) {
    int slips = 0;
    for (int i = 0; i < epochs; ++i) {
        const Measurement measured = run.epoch(arrivals);
        slips += measured.observations.signals.at(0).slipped ? 1 : 0;
    }
    return slips;
}

TEST(CycleCount, SlipsAsOftenAsItIsTold) {
    for (const double period : {1.0, 0.1}) {
        SCOPED_TRACE(period);
        MeasuredRun run(only_slips(72), period);
        run.epochs(plain_arrivals({e03}), 30);
        const int epochs = static_cast<int>(50000 / period);  // 1000 slips
        EXPECT_NEAR(slips_in(run, plain_arrivals({e03}), epochs), 1000, 130);
    }
}

TEST(CycleCount, ASlipIsAWholeNumberOfCyclesAndIsTold) {
    MeasuredRun run(only_slips(360));
    double before = 0;
    Seconds lock;
    int slips = 0;
    run.epochs(plain_arrivals({g07}), 20);
    for (int i = 0; i < 3000; ++i) {
        const Measurement measured = run.epoch(plain_arrivals({g07}));
        const Observation& o = measured.observations.signals.at(0);
        ASSERT_TRUE(o.carrier_phase && o.half_cycle_resolved);
        if (i > 0) {
            const double change = *o.carrier_phase - before;
            EXPECT_NEAR(change, std::round(change), 1e-9);
            EXPECT_EQ(std::abs(change) > 0.5, o.slipped);
            EXPECT_LE(std::abs(change), 2.1);
            EXPECT_EQ(o.lock_time, o.slipped ? Seconds(0) : lock + Seconds(1));
        }
        slips += o.slipped ? 1 : 0;
        before = *o.carrier_phase;
        lock = o.lock_time;
    }
    EXPECT_NEAR(slips, 300, 80);
}

TEST(CycleCount, AnUnresolvedHalfCycleIsTakenOutAndTold) {
    int halves = 0;
    constexpr int runs = 100;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        MeasuredRun run(only_slips(0), 1, seed);
        double before = 0;
        for (int i = 0; i < 12; ++i) {
            const Measurement measured = run.epoch(plain_arrivals({g07}));
            const Observation& o = measured.observations.signals.at(0);
            const double wavelength = speed_of_light / o.carrier.value();
            const double cycles =
                o.carrier_phase.value_or(0) - plain_arrivals({g07}).satellites[0].range.value() / wavelength;
            if (i >= 7) {
                ASSERT_TRUE(o.half_cycle_resolved);
                ASSERT_NEAR(cycles, std::round(cycles), 1e-6);
            }
            if (i == 7) {
                const double change = std::abs(cycles - before);
                EXPECT_NEAR(change, o.slipped ? 0.5 : 0.0, 1e-6);
                EXPECT_EQ(o.lock_time, o.slipped ? Seconds(0) : Seconds(6));
                halves += o.slipped ? 1 : 0;
            } else {
                EXPECT_FALSE(o.slipped);
            }
            before = cycles;
        }
    }
    EXPECT_NEAR(halves, runs / 2, 20);
}

TEST(CycleCount, AnUnresolvedCarrierSlipsByHalves) {
    MeasurementParameters parameters = only_slips(360);
    parameters.acquisition.half_cycle_after = Seconds(1e6);
    MeasuredRun run(parameters);
    double before = run.epochs(plain_arrivals({g07}), 5).observations.signals.at(0).carrier_phase.value_or(0);
    int odd = 0;
    for (int i = 0; i < 1000; ++i) {
        const Measurement measured = run.epoch(plain_arrivals({g07}));
        const Observation& o = measured.observations.signals.at(0);
        ASSERT_FALSE(o.half_cycle_resolved);
        const double halves = 2 * (o.carrier_phase.value_or(0) - before);
        EXPECT_NEAR(halves, std::round(halves), 1e-9);
        EXPECT_EQ(std::abs(halves) > 0.5, o.slipped);
        odd += std::abs(std::remainder(halves, 2)) > 0.5 ? 1 : 0;
        before = o.carrier_phase.value_or(0);
    }
    EXPECT_GT(odd, 30);
}

TEST(CycleCount, WeakSignalsSlipByThemselves) {
    MeasurementParameters parameters = only_slips(0);
    parameters.acquisition.phase_loss_threshold = DbHz(15);
    parameters.acquisition.loss_threshold = DbHz(15);
    const auto slips_at = [&](double cn0) {
        MeasuredRun run(parameters);
        run.epochs(plain_arrivals({e03}), 20);
        return slips_in(run, plain_arrivals({e03}, cn0), 20000);
    };
    EXPECT_EQ(slips_at(45), 0);
    EXPECT_EQ(slips_at(28), 0);
    // σ = √(15/cn (1 + 25/cn)): 24.4° at 20.5 dB-Hz; 2·15·erfc(90°/(√2 σ)) = 0.0067/s.
    const double cn = std::pow(10, 2.05), sigma = std::sqrt(15 / cn * (1 + 25 / cn));
    const double expected = 20000 * 30 * std::erfc(1.5707963 / (1.4142136 * sigma));
    EXPECT_GT(expected, 50);
    EXPECT_NEAR(slips_at(20.5) / expected, 1, 0.35);
    EXPECT_GT(slips_at(19.5), 2 * slips_at(20.5));
}

TEST(CycleCount, ScintillationBringsSlips) {
    MeasuredRun run(only_slips(0));
    Arrivals arrivals = plain_arrivals({e03}, 40);
    run.epochs(arrivals, 20);
    EXPECT_EQ(slips_in(run, arrivals, 5000), 0);
    arrivals.satellites[0].phase_scintillation = Angle::radians(0.5);
    EXPECT_GT(slips_in(run, arrivals, 5000), 20);
}

TEST(CycleCount, SwitchedOffItNeverBreaks) {
    MeasurementParameters parameters = without_errors();
    parameters.slips_per_hour = 3600;
    MeasuredRun run(parameters);
    Arrivals arrivals = plain_arrivals({g07});
    arrivals.satellites[0].phase_scintillation = Angle::radians(1);
    run.epoch(arrivals);
    const double phase = run.epoch(arrivals).observations.signals.at(0).carrier_phase.value_or(0);
    for (int i = 0; i < 200; ++i) {
        const Measurement measured = run.epoch(arrivals);
        EXPECT_FALSE(measured.observations.signals.at(0).slipped);
        EXPECT_NEAR(measured.observations.signals.at(0).carrier_phase.value_or(0), phase, 0.95)
            << "one radian of scintillation, 1 σ, is no cycle";
    }
}

TEST(CycleCount, EachLockHasAnIntegerOfItsOwn) {
    MeasuredRun run(without_errors());
    const Observation first = run.epochs(plain_arrivals({g07}), 3).observations.signals.at(0);
    run.epoch(Arrivals{});
    const Observation again = run.epochs(plain_arrivals({g07}), 3).observations.signals.at(0);
    ASSERT_TRUE(first.carrier_phase && again.carrier_phase);
    const double change = *again.carrier_phase - *first.carrier_phase;
    EXPECT_NEAR(change, std::round(change), 1e-9);
    EXPECT_GT(std::abs(change), 0.5);
    EXPECT_TRUE(again.slipped);
}

}  // namespace
}  // namespace skyloop
