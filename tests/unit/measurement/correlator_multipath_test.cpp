#include "receiver/measurement/correlator_multipath.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "measured_sky.hpp"
#include "support/oracle_table.hpp"

namespace skyloop::test {
namespace {

constexpr double l1_wavelength = speed_of_light / carrier_frequency_l1;

EchoedSignal gps_l1(double spacing = 0.25) {
    EchoedSignal signal;
    signal.carrier = Hertz(carrier_frequency_l1);
    signal.code_loop.spacing_chips = spacing;
    return signal;
}

/// An echo whose carrier lags by `lag` in all.
Echo echo_of(double amplitude, double excess_m, Angle lag) {
    Echo echo;
    echo.amplitude = amplitude;
    echo.excess = Metres(excess_m);
    echo.phase = lag - Angle::radians(2 * std::numbers::pi * std::fmod(excess_m / l1_wavelength, 1));
    return echo;
}

TEST(CorrelatorMultipath, SettlesWhereEveryOracleRowSays) {
    for (const OracleRow& row : oracle_rows("multipath_code_error.csv")) {
        SCOPED_TRACE(row.id());
        const EchoedSignal signal = gps_l1(row.number("spacing_chips"));
        const double chip = signal.code_loop.chip_length().value();
        const std::array echoes{echo_of(row.number("relative_amplitude"), row.number("delay_chips") * chip,
                                        Angle::radians(row.number("phase_rad")))};
        EXPECT_NEAR(correlator_multipath(echoes, signal).code.value(), row.number("error_m_CA"),
                    row.number("tol_chips") * chip + 1e-6);
    }
}

TEST(CorrelatorMultipath, NothingComesOfNothing) {
    const CorrelatorMultipath none = correlator_multipath({}, gps_l1());
    EXPECT_EQ(none.code.value(), 0);
    EXPECT_EQ(none.phase.value(), 0);
    EXPECT_EQ(none.strength.value(), 0);
    EXPECT_EQ(none.distortion, 0);
    const std::array late{echo_of(0.9, 600, Angle())};
    EXPECT_EQ(correlator_multipath(late, gps_l1()).code.value(), 0) << "two chips late";
    EXPECT_EQ(correlator_multipath(late, gps_l1()).strength.value(), 0);
}

TEST(CorrelatorMultipath, AddsPhasors) {
    for (const double lag_deg : {0.0, 60.0, 90.0, 180.0, 250.0}) {
        SCOPED_TRACE(lag_deg);
        const std::array echoes{echo_of(0.4, 0, Angle::degrees(lag_deg))};
        const std::complex<double> sum = 1.0 + std::polar(0.4, Angle::degrees(lag_deg).rad());
        const CorrelatorMultipath effect = correlator_multipath(echoes, gps_l1());
        EXPECT_NEAR(effect.phase.value(), std::arg(sum) / (2 * std::numbers::pi) * l1_wavelength, 1e-12);
        EXPECT_NEAR(effect.strength.value(), 20 * std::log10(std::abs(sum)), 1e-12);
        EXPECT_NEAR(effect.code.value(), 0, 1e-9);
    }
    EXPECT_GT(correlator_multipath(std::array{echo_of(0.4, 0, Angle::degrees(90))}, gps_l1()).phase.value(), 0)
        << "an echo that lags makes the carrier's path longer";
}

TEST(CorrelatorMultipath, EchoesThatCancelEverythingLeaveNoInfinity) {
    const std::array echoes{echo_of(1, 0, Angle::degrees(180))};
    const CorrelatorMultipath effect = correlator_multipath(echoes, gps_l1());
    EXPECT_NEAR(effect.strength.value(), -60, 1e-6);
    EXPECT_TRUE(std::isfinite(effect.code.value()));
    EXPECT_TRUE(std::isfinite(effect.distortion));
}

TEST(CorrelatorMultipath, LoopsDoNotFollowAFastBeat) {
    Echo echo = echo_of(0.3, 60, Angle());
    const double resting = correlator_multipath(std::array{echo}, gps_l1()).code.value();
    // A loop of 0.5 Hz is down to 1/√2 at 2·0.5/π Hz.
    echo.excess_rate = MetresPerSecond(2 * 0.5 / std::numbers::pi * l1_wavelength);
    EXPECT_NEAR(correlator_multipath(std::array{echo}, gps_l1()).code.value(), resting / std::sqrt(2.0), 1e-9);
    echo.excess_rate = MetresPerSecond(-20);
    EXPECT_LT(correlator_multipath(std::array{echo}, gps_l1()).code.value(), 0.01 * resting);
}

TEST(CorrelatorMultipath, ARayBeforeTheTrackedOneShortensTheRange) {
    const std::array early{echo_of(0.3, -40, Angle())}, late{echo_of(0.3, 40, Angle())};
    const double before = correlator_multipath(early, gps_l1()).code.value();
    EXPECT_NEAR(before, -correlator_multipath(late, gps_l1()).code.value(), 1e-9);
    EXPECT_LT(before, -1);
}

// BOC(1,1)'s correlation by its definition: the product of two square waves of half a chip.
double boc_by_definition(double x) {
    const double a = std::abs(x);
    if (a >= 1) return 0;
    constexpr int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps, shifted = t + a;
        if (shifted >= 1) break;
        sum += (t < 0.5) == (shifted < 0.5) ? 1 : -1;
    }
    return sum / steps;
}

TEST(CorrelatorMultipath, HearsTheSteeperPeakOfBoc) {
    EchoedSignal galileo = gps_l1();
    galileo.boc = true;
    const double chip = galileo.code_loop.chip_length().value(), half = galileo.code_loop.spacing_chips / 2;
    for (const double delay : {0.02, 0.3, 0.8}) {
        SCOPED_TRACE(delay);
        const std::array echoes{echo_of(0.3, delay * chip, Angle())};
        const auto discriminator = [&](double x) {
            const auto both = [&](double y) { return boc_by_definition(y) + 0.3 * boc_by_definition(y - delay); };
            return both(x - half) - both(x + half);
        };
        double low = -0.1, high = 0.1;
        for (int i = 0; i < 30; ++i)
            (discriminator((low + high) / 2) > 0) == (discriminator(low) > 0) ? low = (low + high) / 2
                                                                              : high = (low + high) / 2;
        EXPECT_NEAR(correlator_multipath(echoes, galileo).code.value(), low * chip, 0.1);
    }
    const std::array late{echo_of(0.3, 0.8 * chip, Angle())};
    EXPECT_NEAR(std::abs(correlator_multipath(late, galileo).code.value()),
                correlator_multipath(late, gps_l1()).code.value() / 3, 0.1)
        << "a third of the slope there";
}

TEST(CorrelatorMultipath, TellsASkewPeak) {
    const double chip = gps_l1().code_loop.chip_length().value();
    const double weak =
        std::abs(correlator_multipath(std::array{echo_of(0.1, 0.5 * chip, Angle())}, gps_l1(0.1)).distortion);
    const double strong =
        std::abs(correlator_multipath(std::array{echo_of(0.5, 0.5 * chip, Angle())}, gps_l1(0.1)).distortion);
    EXPECT_NEAR(weak, 0.05, 0.01);
    EXPECT_GT(strong, 3 * weak);
}

// ---- What a channel makes of it.

Arrivals with_echoes(const std::vector<Echo>& echoes) {
    Arrivals arrivals = plain_arrivals({g07});
    arrivals.satellites[0].echoes_known = true;
    arrivals.satellites[0].echoes = echoes;
    return arrivals;
}

const MeasurementParameters& multipath_alone() {
    static const MeasurementParameters parameters = [] {
        MeasurementParameters p = without_errors();
        p.multipath.enabled = true;
        p.cn0_resolution = Decibels(0);
        return p;
    }();
    return parameters;
}

TEST(SceneMultipath, EntersCodePhaseAndStrength) {
    const Echo echo = echo_of(0.4, 30, Angle::degrees(40));
    const CorrelatorMultipath effect = correlator_multipath(
        std::array{echo}, {CodeLoop{}, CarrierLoop{Hertz(15), Seconds(0.02)}, Hertz(carrier_frequency_l1), false});
    const Measurement clean = MeasuredRun(multipath_alone()).epochs(with_echoes({}), 3);
    const Measurement echoed = MeasuredRun(multipath_alone()).epochs(with_echoes({echo}), 3);
    const Observation& a = *observation_of(clean, g07, Signal::l1);
    const Observation& b = *observation_of(echoed, g07, Signal::l1);
    EXPECT_NEAR((*b.pseudorange - *a.pseudorange).value(), effect.code.value(), 1e-6);
    EXPECT_GT(effect.code.value(), 3);
    EXPECT_NEAR((*b.carrier_phase - *a.carrier_phase) * l1_wavelength, effect.phase.value(), 1e-6);
    EXPECT_NEAR((b.cn0 - a.cn0).value(), effect.strength.value(), 1e-9);
    EXPECT_EQ(a.correlation_distortion, 0.0);
    EXPECT_GT(*b.correlation_distortion, 0.001) << "little: it moves the whole peak";
    EXPECT_EQ(echoed.terms.signals.front().multipath, effect.code);
}

TEST(SceneMultipath, TakesThePlaceOfTheStatisticalOne) {
    const Measurement scene = MeasuredRun(multipath_alone()).epochs(with_echoes({}), 3);
    const Measurement nowhere = MeasuredRun(multipath_alone()).epochs(plain_arrivals({g07}), 3);
    EXPECT_EQ(scene.terms.signals.front().multipath.value(), 0);
    EXPECT_NE(nowhere.terms.signals.front().multipath.value(), 0);
    EXPECT_FALSE(observation_of(nowhere, g07, Signal::l1)->correlation_distortion);
}

TEST(SceneMultipath, IsScaledAndSwitchedOffWithItsTerm) {
    const std::vector<Echo> echoes{echo_of(0.4, 30, Angle())};
    MeasurementParameters half = multipath_alone();
    half.multipath.scale = 0.5;
    const Metres all = MeasuredRun(multipath_alone()).epochs(with_echoes(echoes), 3).terms.signals.front().multipath;
    EXPECT_EQ(MeasuredRun(half).epochs(with_echoes(echoes), 3).terms.signals.front().multipath, all * 0.5);
    const Measurement off = MeasuredRun(without_errors()).epochs(with_echoes(echoes), 3);
    EXPECT_EQ(off.terms.signals.front().multipath.value(), 0);
    EXPECT_EQ(off.observations.signals.front().cn0.value(), 45);
}

TEST(SceneMultipath, ALongerRayMovesTheFrequencyToo) {
    Arrivals direct = with_echoes({}), reflected = with_echoes({});
    reflected.satellites[0].line_of_sight = false;
    reflected.satellites[0].excess_path = Metres(31.5);
    reflected.satellites[0].excess_rate = MetresPerSecond(4);
    const Measurement a = MeasuredRun(multipath_alone()).epochs(direct, 3);
    const Measurement b = MeasuredRun(multipath_alone()).epochs(reflected, 3);
    const Observation& straight = *observation_of(a, g07, Signal::l1);
    const Observation& detour = *observation_of(b, g07, Signal::l1);
    EXPECT_NEAR((*detour.pseudorange - *straight.pseudorange).value(), 31.5, 1e-6);
    EXPECT_NEAR((*detour.doppler - *straight.doppler).value(), -4 / l1_wavelength, 1e-6);
}

TEST(SceneMultipath, AnotherRayBreaksTheCountOfCycles) {
    Arrivals blocked = with_echoes({});
    Arrival& arrival = blocked.satellites[0];
    arrival.line_of_sight = false;
    arrival.excess_path = Metres(20);
    arrival.excess_rate = MetresPerSecond(3);
    MeasuredRun run(multipath_alone());
    (void)run.epochs(blocked, 8);
    arrival.excess_path = Metres(23);
    EXPECT_FALSE(observation_of(run.epoch(blocked), g07, Signal::l1)->slipped) << "the ray that it was";
    arrival.excess_path = Metres(41);
    EXPECT_TRUE(observation_of(run.epoch(blocked), g07, Signal::l1)->slipped);
}

}  // namespace
}  // namespace skyloop::test
