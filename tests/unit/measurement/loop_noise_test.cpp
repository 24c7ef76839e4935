// How large the errors of tracking are and how long they last, seen through the engine.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "measured_sky.hpp"
#include "receiver/measurement/tracking_jitter.hpp"

namespace skyloop {
namespace {

using test::all_signals;
using test::e03;
using test::g07;
using test::MeasuredRun;
using test::plain_arrival;
using test::plain_arrivals;
using test::without_errors;

// A series of one error.
struct Series {
    std::vector<double> values;

    [[nodiscard]] double deviation() const {
        double square = 0;
        for (const double v : values)
            square += v * v;
        return std::sqrt(square / static_cast<double>(values.size()));
    }
    // About zero, the known mean.
    [[nodiscard]] double correlation(std::size_t lag) const {
        double product = 0, square = 0;
        for (std::size_t i = 0; i + lag < values.size(); ++i) {
            product += values[i] * values[i + lag];
            square += values[i] * values[i];
        }
        return product / square;
    }
};

// The errors of the first satellite's first signal.
struct ErrorSeries {
    Series code, phase, doppler, multipath;
};

ErrorSeries errors_of(MeasuredRun& run, const Arrivals& arrivals, int epochs) {
    ErrorSeries result;
    for (int i = 0; i < epochs; ++i) {
        const Measurement measured = run.epoch(arrivals);
        const SignalTerms& terms = measured.terms.signals.at(0);
        result.code.values.push_back(terms.code_noise.value());
        result.phase.values.push_back(terms.phase_noise.value());
        result.doppler.values.push_back(terms.doppler_noise.value());
        result.multipath.values.push_back(terms.multipath.value());
    }
    return result;
}

MeasurementParameters plain_parameters() {
    MeasurementParameters parameters;
    parameters.receiver_clock.enabled = false;
    return parameters;
}

double l1_metres(Angle phase) { return phase.rad() / (2 * std::numbers::pi) * speed_of_light / carrier_frequency_l1; }

// Hz: two readings of the phase, and 3 mm/s of the oscillator.
double doppler_over_window(const MeasurementParameters& parameters, double cn0) {
    const double cycles = phase_jitter(parameters.phase_loop, DbHz(cn0)).rad() / (2 * std::numbers::pi);
    return std::hypot(std::numbers::sqrt2 * cycles / parameters.doppler_window.value(),
                      0.003 * carrier_frequency_l1 / speed_of_light);
}

TEST(LoopNoise, HasTheDeviationOfItsLoopsAtEachStrength) {
    const MeasurementParameters parameters = plain_parameters();
    for (const double cn0 : {30.0, 38.0, 48.0}) {
        SCOPED_TRACE(cn0);
        MeasuredRun run(parameters);
        const ErrorSeries errors = errors_of(run, plain_arrivals({g07}, cn0), 40000);
        EXPECT_NEAR(errors.code.deviation() / code_jitter(parameters.code_loop, DbHz(cn0)).value(), 1, 0.02);
        EXPECT_NEAR(errors.phase.deviation() / l1_metres(phase_jitter(parameters.phase_loop, DbHz(cn0))), 1, 0.02);
        EXPECT_NEAR(errors.doppler.deviation() / doppler_over_window(parameters, cn0), 1, 0.02);
    }
}

TEST(LoopNoise, RemembersForAQuarterOfTheInverseBandwidth) {
    MeasuredRun slow(plain_parameters(), 1), fast(plain_parameters(), 0.1);
    const ErrorSeries at_1_hz = errors_of(slow, plain_arrivals({g07}), 40000);
    const ErrorSeries at_10_hz = errors_of(fast, plain_arrivals({g07}), 80000);
    // B = 0.5 Hz: τ = 0.5 s; 15 Hz: 17 ms; 5 Hz: 50 ms.
    EXPECT_NEAR(at_1_hz.code.correlation(1), std::exp(-2.0), 0.02);
    EXPECT_NEAR(at_10_hz.code.correlation(1), std::exp(-0.2), 0.01);
    EXPECT_NEAR(at_10_hz.code.correlation(5), std::exp(-1.0), 0.03);
    EXPECT_NEAR(at_10_hz.phase.correlation(1), std::exp(-6.0), 0.015);
    EXPECT_NEAR(at_10_hz.doppler.correlation(1), std::exp(-2.0), 0.015);
    EXPECT_NEAR(at_10_hz.code.deviation() / at_1_hz.code.deviation(), 1, 0.04);
}

TEST(LoopNoise, DopplerIsThatOfTheFrequencyLoopWithoutAWindow) {
    MeasurementParameters parameters = plain_parameters();
    parameters.doppler_window = Seconds(0);
    MeasuredRun run(parameters);
    const ErrorSeries errors = errors_of(run, plain_arrivals({g07}, 38), 40000);
    EXPECT_NEAR(errors.doppler.deviation() / frequency_jitter(parameters.frequency_loop, DbHz(38)).value(), 1, 0.02);
}

TEST(LoopNoise, ACodeLoopBeginsWideAndNarrows) {
    MeasurementParameters parameters = plain_parameters();
    parameters.code_loop.bandwidth = Hertz(0.02);
    parameters.multipath_model.floor = Metres(0);
    MeasuredRun run(parameters);
    const Arrivals arrivals = plain_arrivals({g07}, 40);
    const auto reported = [&] { return run.epoch(arrivals).observations.signals.at(0).pseudorange_deviation.value(); };
    run.epoch(arrivals);
    const double young = reported();
    run.epochs(arrivals, 30);
    EXPECT_GT(young, 1.2 * reported());
}

TEST(LoopNoise, DopplerGivesAStaticVelocityOfMillimetres) {
    MeasuredRun run(plain_parameters());
    const ErrorSeries errors = errors_of(run, plain_arrivals({g07}, 45), 10000);
    const double speed = speed_of_light / carrier_frequency_l1 * errors.doppler.deviation();
    EXPECT_GT(speed, 0.005);
    EXPECT_LT(speed, 0.02);
}

TEST(LoopNoise, MultipathFollowsElevationAndItsTime) {
    const MeasurementParameters parameters = plain_parameters();
    for (const double elevation : {5.0, 20.0, 80.0}) {
        SCOPED_TRACE(elevation);
        Arrivals arrivals = plain_arrivals({g07});
        arrivals.satellites[0].direction.elevation = Angle::degrees(elevation);
        MeasuredRun run(parameters, 30);
        const ErrorSeries errors = errors_of(run, arrivals, 40000);
        EXPECT_NEAR(errors.multipath.deviation() / (0.5 + std::exp(-elevation / 10)), 1, 0.04);
        EXPECT_NEAR(errors.multipath.correlation(1), std::exp(-30.0 / 120), 0.02);
        EXPECT_NEAR(errors.multipath.correlation(4), std::exp(-1.0), 0.03);
    }
}

TEST(LoopNoise, MotionShortensMultipath) {
    const auto correlation = [](double speed) {
        Arrivals arrivals = plain_arrivals({g07});
        arrivals.antenna_speed = MetresPerSecond(speed);
        MeasuredRun run(plain_parameters());
        return errors_of(run, arrivals, 40000).multipath.correlation(1);
    };
    EXPECT_NEAR(correlation(1.0), std::exp(-1.0 / 120), 0.005);
    EXPECT_NEAR(correlation(1.1), std::exp(-1.0 / 5), 0.02);
}

TEST(LoopNoise, ModulationsDifferAsTheirLoopsDo) {
    MeasuredRun run(plain_parameters());
    run.settings = all_signals();
    const Measurement measured = run.epochs(plain_arrivals({g07, e03}), 3);
    MeasurementParameters no_floor = plain_parameters();
    no_floor.multipath_model.floor = Metres(0);
    MeasuredRun bare(no_floor);
    bare.settings = all_signals();
    const Measurement loops = bare.epochs(plain_arrivals({g07, e03}), 3);
    const auto deviation = [&](SatelliteId id, Signal signal) {
        return test::observation_of(loops, id, signal)->pseudorange_deviation.value();
    };
    const double l1 = code_jitter(CodeLoop{}, DbHz(45)).value();
    EXPECT_NEAR(deviation(g07, Signal::l1), l1, 1e-12);
    EXPECT_NEAR(deviation(e03, Signal::l1), 0.6 * l1, 1e-12);
    CodeLoop wide;
    wide.chip_rate = Hertz(10.23e6);
    wide.front_end_bandwidth = Hertz(20.46e6);
    EXPECT_NEAR(deviation(g07, Signal::l5), code_jitter(wide, DbHz(45)).value(), 1e-12);
    EXPECT_LT(deviation(g07, Signal::l5), l1 / 3);
    EXPECT_NEAR(measured.observations.signals[0].pseudorange_deviation.value(), std::hypot(l1, 0.5), 1e-12);
}

TEST(LoopNoise, TheReceiverKnowsItsLoops) {
    const MeasurementParameters parameters = plain_parameters();
    MeasuredRun run(parameters);
    const Observation o = run.epochs(plain_arrivals({g07}, 40), 3).observations.signals.at(0);
    EXPECT_NEAR(o.doppler_deviation.value(), doppler_over_window(parameters, 40), 1e-12);
    const double thermal = phase_jitter(parameters.phase_loop, DbHz(40)).rad() / (2 * std::numbers::pi);
    EXPECT_NEAR(o.carrier_phase_deviation, thermal, 1e-12);
    // RTKLIB takes no phase of more than five times 0.004 cycles from RXM-RAWX.
    EXPECT_LT(run.epochs(plain_arrivals({g07}, 32), 3).observations.signals.at(0).carrier_phase_deviation, 5.5 * 0.004);
    MeasuredRun silent(without_errors());
    EXPECT_EQ(silent.epoch(plain_arrivals({g07}, 40)).observations.signals[0].pseudorange_deviation,
              o.pseudorange_deviation)
        << "it does not know which errors were switched off";
}

TEST(LoopNoise, ScintillationMultipliesTheJitter) {
    const MeasurementParameters parameters = plain_parameters();
    constexpr double strong = 65;  // it is held through the deepest fade
    Arrivals arrivals = plain_arrivals({g07}, strong);
    arrivals.satellites[0].amplitude_scintillation = 0.65;
    arrivals.satellites[0].phase_scintillation = Angle::radians(0.15);
    MeasuredRun run(parameters);
    const ErrorSeries errors = errors_of(run, arrivals, 40000);
    const CodeLoop& loop = parameters.code_loop;
    const double growth = scintillating_code_jitter_chips(loop, DbHz(strong), 0.65) /
                          scintillating_code_jitter_chips(loop, DbHz(strong), 0);
    EXPECT_GT(growth, 1.2);
    EXPECT_NEAR(errors.code.deviation() / (growth * code_jitter(loop, DbHz(strong)).value()), 1, 0.02);
    const double thermal = scintillating_phase_jitter(parameters.phase_loop, DbHz(strong), 0.65).rad();
    EXPECT_NEAR(errors.phase.deviation() / l1_metres(Angle::radians(std::hypot(thermal, 0.15))), 1, 0.02);
    EXPECT_GT(errors.phase.correlation(1), 0.1) << "scintillation lasts longer than the loop's noise";
}

TEST(LoopNoise, ScintillationFadesWhatIsReported) {
    MeasurementParameters parameters = plain_parameters();
    parameters.cn0_resolution = Decibels(0);
    Arrivals arrivals = plain_arrivals({g07}, 45);
    MeasuredRun run(parameters);
    EXPECT_EQ(run.epoch(arrivals).observations.signals[0].cn0.value(), 45);
    arrivals.satellites[0].amplitude_scintillation = 0.5;
    double sum = 0, squares = 0, deepest = 0;
    constexpr int epochs = 20000;
    for (int i = 0; i < epochs; ++i) {
        const Measurement measured = run.epoch(arrivals);
        ASSERT_EQ(measured.observations.signals.size(), 1U) << "strong enough to be held through every fade";
        const double power = std::pow(10, (measured.observations.signals[0].cn0.value() - 45) / 10);
        sum += power;
        squares += power * power;
        deepest = std::min(deepest, 10 * std::log10(power));
    }
    EXPECT_NEAR(sum / epochs, 1, 0.03);
    EXPECT_NEAR(std::sqrt(squares / epochs - std::pow(sum / epochs, 2)), 0.5, 0.03);
    EXPECT_LT(deepest, -10);
    arrivals.satellites[0].amplitude_scintillation = 0;
    EXPECT_EQ(run.epoch(arrivals).observations.signals[0].cn0.value(), 45);
}

// What the code and phase of a scintillating signal are told with these dice; equal for equal dice.
struct Scintillating {
    double phase_m = 0, cn0 = 0, code_m = 0;
};
Scintillating scintillating_with(const MeasurementParameters& parameters) {
    Arrivals arrivals = plain_arrivals({g07}, 55);
    arrivals.satellites[0].amplitude_scintillation = 0.4;
    arrivals.satellites[0].phase_scintillation = Angle::radians(0.1);
    MeasuredRun run(parameters);
    const Measurement measured = run.epochs(arrivals, 20);
    const SignalTerms& terms = measured.terms.signals.at(0);
    return {terms.phase_noise.value(), measured.observations.signals[0].cn0.value(), terms.code_noise.value()};
}

TEST(LoopNoise, ScintillationIsATermOfItsOwn) {
    MeasurementParameters parameters = plain_parameters();
    parameters.cn0_resolution = Decibels(0);
    const Scintillating plain = scintillating_with(parameters);
    MeasurementParameters other = parameters;
    other.code_noise.seed = 99;
    EXPECT_EQ(scintillating_with(other).cn0, plain.cn0) << "another cause's dice";
    EXPECT_NE(scintillating_with(other).code_m, plain.code_m);
    other = parameters;
    other.scintillation.seed = 99;
    EXPECT_NE(scintillating_with(other).cn0, plain.cn0);
    EXPECT_NE(scintillating_with(other).phase_m, plain.phase_m);
    other = parameters;
    other.phase_noise.enabled = false;
    const double alone = scintillating_with(other).phase_m;
    EXPECT_NE(alone, 0);
    other.phase_noise.enabled = true;
    other.phase_noise.scale = 3;
    EXPECT_NEAR(scintillating_with(other).phase_m - alone, 3 * (plain.phase_m - alone), 1e-12);
}

TEST(LoopNoise, AnInterruptedSignalKeepsItsDistribution) {
    // Lost and found again every few epochs: the processes take longer steps, and stay what they are.
    MeasurementParameters parameters = plain_parameters();
    parameters.acquisition.reacquisition = Seconds(0);
    parameters.acquisition.reacquisition_growth = 0;
    MeasuredRun run(parameters);
    const Arrivals present = plain_arrivals({g07}), absent;
    double code = 0, multipath = 0;
    constexpr int seen = 30000;
    for (int i = 0; i < seen; ++i) {
        run.epochs(absent, 7);
        const SignalTerms terms = run.epoch(present).terms.signals.at(0);
        code += terms.code_noise.value() * terms.code_noise.value() / seen;
        multipath += terms.multipath.value() * terms.multipath.value() / seen;
    }
    EXPECT_NEAR(std::sqrt(code) / code_jitter(parameters.code_loop, DbHz(45)).value(), 1, 0.02);
    EXPECT_NEAR(std::sqrt(multipath) / (0.5 + std::exp(-4.5)), 1, 0.06);
}

// Slow errors of the code are the same at the same seconds, whatever the rate.
TEST(LoopNoise, ADayIsTheSameAtOneAndAtTenHertz) {
    MeasurementParameters parameters;
    parameters.code_loop.bandwidth = Hertz(0.01);
    MeasuredRun seldom(parameters), often(parameters, 0.1);
    const Arrivals arrivals = plain_arrivals({g07});
    const ErrorSeries once = errors_of(seldom, arrivals, 300);
    const ErrorSeries tenfold = errors_of(often, arrivals, 3000);
    for (std::size_t i = 0; i < 300; ++i) {
        EXPECT_EQ(once.multipath.values[i], tenfold.multipath.values[10 * i]) << i;
        EXPECT_NEAR(once.code.values[i], tenfold.code.values[10 * i], 1e-9) << i;
    }
    EXPECT_GT(once.multipath.deviation(), 0.1);
}

}  // namespace
}  // namespace skyloop
