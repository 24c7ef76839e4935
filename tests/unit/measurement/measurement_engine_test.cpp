#include "receiver/measurement/measurement_engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "measured_sky.hpp"

namespace skyloop {
namespace {

using test::all_signals;
using test::e03;
using test::g07;
using test::g12;
using test::MeasuredRun;
using test::observation_of;
using test::plain_arrival;
using test::plain_arrivals;
using test::without_errors;

constexpr double light = speed_of_light;

Arrival delayed_arrival() {
    Arrival arrival = plain_arrival(g07);
    arrival.range_rate = MetresPerSecond(-512.25);
    arrival.clock_bias = Seconds(-1.23456789e-4);
    arrival.clock_drift = 3e-12;
    arrival.signal_in_space_error = Metres(0.375);
    arrival.range_rate_error = MetresPerSecond(0.002);
    arrival.iono_delay = Metres(7.5);
    arrival.tropo_delay = Metres(3.25);
    for (std::size_t i = 0; i < arrival.signals.size(); ++i)
        arrival.signals[i].group_delay = Seconds(-5e-9 * static_cast<double>(i + 1));
    return arrival;
}

TEST(MeasurementEngine, WithoutErrorsThePseudorangeIsExact) {
    MeasuredRun run(without_errors());
    Arrivals arrivals = plain_arrivals({g07});
    arrivals.satellites[0].clock_bias = Seconds(3.2e-4);
    arrivals.satellites[0].signals[0].group_delay = Seconds(-1.1e-8);
    for (int i = 0; i < 5; ++i) {
        const Measurement measured = run.epoch(arrivals);
        const Observation* o = observation_of(measured, g07, Signal::l1);
        ASSERT_TRUE(o && o->pseudorange && o->doppler);
        EXPECT_NEAR(o->pseudorange->value(), 22'345'678.9012 - light * 3.2e-4 - light * 1.1e-8, 1e-7);
        EXPECT_EQ(measured.terms.clock_bias, Metres(0));
        EXPECT_EQ(measured.terms.clock_drift, MetresPerSecond(0));
        const SignalTerms& terms = measured.terms.signals.at(0);
        EXPECT_EQ(terms.code_noise, Metres(0));
        EXPECT_EQ(terms.multipath, Metres(0));
        EXPECT_EQ(terms.phase_noise, Metres(0));
        EXPECT_EQ(terms.doppler_noise, Hertz(0));
        EXPECT_EQ(*o->doppler, Hertz(0));
    }
}

TEST(MeasurementEngine, LooksForTheSbasSatellitesOfTheScanMask) {
    constexpr SatelliteId s20{Constellation::sbas, 20}, s23{Constellation::sbas, 23};
    MeasuredRun run(without_errors());
    run.settings.sbas_scan_mask = 0x8;  // PRN 123
    const Measurement masked = run.epochs(plain_arrivals({g07, s20, s23}), 30);
    EXPECT_TRUE(observation_of(masked, g07, Signal::l1));
    EXPECT_TRUE(observation_of(masked, s23, Signal::l1));
    EXPECT_FALSE(observation_of(masked, s20, Signal::l1));
    run.settings.sbas_scan_mask = 0;
    EXPECT_TRUE(observation_of(run.epochs(plain_arrivals({g07, s20, s23}), 30), s20, Signal::l1)) << "no mask: all";
}

TEST(MeasurementEngine, ReceiveTimeIsTheTrueInstantWithoutAClockError) {
    MeasuredRun run(without_errors());
    const GpsTime now = run.next_time();
    EXPECT_EQ(run.epoch(plain_arrivals({g07})).observations.receive_time, now);
}

TEST(MeasurementEngine, EveryDelayEntersWithItsSignAndFrequency) {
    MeasuredRun run(without_errors());
    run.settings = all_signals();
    Arrivals arrivals;
    arrivals.satellites.push_back(delayed_arrival());
    const Arrival& a = arrivals.satellites[0];
    const Measurement first = run.epochs(arrivals, 2), later = run.epoch(arrivals);
    ASSERT_EQ(first.observations.signals.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        const Observation& o = first.observations.signals[i];
        SCOPED_TRACE(static_cast<int>(o.signal));
        const double f = o.carrier.value(), wavelength = light / f;
        const double iono = 7.5 * std::pow(a.signals[0].carrier.value() / f, 2);
        const double geometry = a.range.value() - light * a.clock_bias.value() + 0.375 + 3.25;
        EXPECT_NEAR(o.pseudorange->value(), geometry + iono + light * a.signals[i].group_delay.value(), 1e-7);
        EXPECT_NEAR(o.doppler->value(), -f / light * (-512.25 + 0.002 - light * 3e-12), 1e-9);
        ASSERT_TRUE(o.carrier_phase);
        const double cycles = *o.carrier_phase - (geometry - iono) / wavelength;
        EXPECT_NEAR(cycles, std::round(cycles), 1e-6);
        EXPECT_GT(o.doppler->value(), 0) << "a satellite that comes nearer";
        EXPECT_NEAR(*later.observations.signals[i].carrier_phase, *o.carrier_phase, 1e-9) << "the same integer";
        EXPECT_FALSE(o.slipped);
    }
}

TEST(MeasurementEngine, CarrierAndCodeDivergeByTwiceTheIonosphere) {
    MeasuredRun run(without_errors());
    Arrivals arrivals = plain_arrivals({g07});
    const auto code_minus_carrier = [&](double iono) {
        arrivals.satellites[0].iono_delay = Metres(iono);
        const Measurement measured = run.epoch(arrivals);
        const Observation& o = measured.observations.signals.at(0);
        return o.pseudorange->value() - o.carrier_phase.value_or(0) * light / o.carrier.value();
    };
    code_minus_carrier(0);
    const double before = code_minus_carrier(5);
    EXPECT_NEAR(code_minus_carrier(9) - before, 2 * 4, 1e-6);
}

TEST(MeasurementEngine, PhaseIsTheIntegralOfDoppler) {
    MeasurementParameters parameters = without_errors();
    parameters.receiver_clock.enabled = true;
    parameters.clock.noise = {0, 0};
    parameters.clock.temperature.deviation = Kelvin(0);
    MeasuredRun run(parameters, 0.1);
    Arrivals arrivals = plain_arrivals({g07});
    Arrival& a = arrivals.satellites[0];
    const double start_range = a.range.value();
    double before_phase = 0, before_doppler = 0;
    for (int i = 0; i < 200; ++i) {
        const double t = 0.1 * i;
        a.range = Metres(start_range + 400 * t + 0.25 * t * t);
        a.range_rate = MetresPerSecond(400 + 0.5 * t);
        const Measurement measured = run.epoch(arrivals);
        const Observation& o = measured.observations.signals.at(0);
        if (i > 11) {
            const double mean = (before_doppler + o.doppler->value()) / 2;
            ASSERT_NEAR(*o.carrier_phase - before_phase, -mean * 0.1, 1e-5);
        }
        before_phase = o.carrier_phase.value_or(0);
        before_doppler = o.doppler->value();
    }
}

// Range and error step by opposite amounts where the broadcast record changes.
TEST(MeasurementEngine, AChangeOfTheRecordBreaksNoCount) {
    MeasuredRun run(without_errors());
    Arrivals arrivals = plain_arrivals({g07});
    const Observation before = *observation_of(run.epochs(arrivals, 40), g07, Signal::l1);
    Arrival& arrival = arrivals.satellites[0];
    arrival.range += Metres(4);
    arrival.signal_in_space_error = arrival.earlier_records.range = Metres(-4);
    arrival.range_rate_error = arrival.earlier_records.range_rate = MetresPerSecond(0.02);
    const Observation after = *observation_of(run.epoch(arrivals), g07, Signal::l1);
    EXPECT_FALSE(after.slipped);
    EXPECT_EQ(after.lock_time, before.lock_time + Seconds(1));
    EXPECT_NEAR(*after.carrier_phase, *before.carrier_phase, 1e-5);
    // The same without a change: the signal itself has jumped.
    arrival.signal_in_space_error = Metres(0);
    EXPECT_TRUE(observation_of(run.epoch(arrivals), g07, Signal::l1)->slipped);
}

TEST(MeasurementEngine, ARecordOfAnotherOrbitBreaksTheCount) {
    MeasuredRun run(without_errors());
    Arrivals arrivals = plain_arrivals({g07});
    EXPECT_FALSE(observation_of(run.epochs(arrivals, 40), g07, Signal::l1)->slipped);
    arrivals.satellites[0].earlier_records.jumped = run.next_time() - std::chrono::milliseconds(200);
    const Observation there = *observation_of(run.epoch(arrivals), g07, Signal::l1);
    EXPECT_TRUE(there.slipped);
    EXPECT_EQ(there.lock_time, Seconds(0));
    EXPECT_FALSE(observation_of(run.epoch(arrivals), g07, Signal::l1)->slipped);
}

// A fault's ionosphere goes against the carrier: by a rate the Doppler tells it, at once it breaks the count.
TEST(MeasurementEngine, AStormIsCountedWhereItsRateIsToldAndElseBreaksTheCount) {
    MeasuredRun run(without_errors());
    Arrivals arrivals = plain_arrivals({g07});
    Arrival& arrival = arrivals.satellites[0];
    Observation before = *observation_of(run.epochs(arrivals, 40), g07, Signal::l1);
    const double calm = before.doppler->value();
    arrival.false_iono_rate = MetresPerSecond(2);
    for (int i = 1; i <= 5; ++i) {
        arrival.iono_delay = arrival.false_iono_delay = Metres(2 * i);
        const Observation after = *observation_of(run.epoch(arrivals), g07, Signal::l1);
        EXPECT_FALSE(after.slipped) << i;
        EXPECT_NEAR(after.doppler->value() - calm, 2 * after.carrier.value() / light, 1e-6);
        EXPECT_NEAR(*after.carrier_phase - *before.carrier_phase, calm - after.doppler->value(), 1e-5);
        before = after;
    }
    arrival.false_iono_rate = MetresPerSecond(0);
    arrival.iono_delay = arrival.false_iono_delay = Metres(0);
    EXPECT_TRUE(observation_of(run.epoch(arrivals), g07, Signal::l1)->slipped);
}

TEST(MeasurementEngine, MillisecondJumpsKeepTagAndRangesTogether) {
    MeasurementParameters parameters = without_errors();
    parameters.receiver_clock.enabled = true;
    parameters.clock.steering = ClockSteering::millisecond_jumps;
    parameters.clock.bias = Metres(0.49e-3 * light);
    MeasuredRun run(parameters);
    const Arrivals arrivals = plain_arrivals({g07});
    int jumps = 0;
    for (int i = 0; i < 4100; ++i) {
        const GpsTime now = run.next_time();
        const Measurement measured = run.epoch(arrivals);
        const Observation& o = measured.observations.signals.at(0);
        const double tag = difference(measured.observations.receive_time, now).value();
        ASSERT_NEAR(tag, measured.terms.clock_bias.value() / light, 0.51e-9);
        ASSERT_NEAR(o.pseudorange->value() - light * tag, arrivals.satellites[0].range.value(), 0.16);
        ASSERT_NEAR(o.pseudorange->value() - measured.terms.clock_bias.value(), arrivals.satellites[0].range.value(),
                    1e-7);
        ASSERT_LE(std::abs(tag), 0.5e-3 + 1e-9);
        EXPECT_FALSE(o.slipped);
        jumps += measured.observations.clock_was_set ? 1 : 0;
    }
    EXPECT_GE(jumps, 2);
    EXPECT_LE(jumps, 4);
}

TEST(MeasurementEngine, ObservationsAscendAndTermsGoWithThem) {
    MeasuredRun run(MeasurementParameters{});
    run.settings = all_signals();
    const Measurement measured = run.epochs(plain_arrivals({g07, g12, e03}), 5);
    ASSERT_EQ(measured.observations.signals.size(), 9u);
    ASSERT_EQ(measured.terms.signals.size(), 9u);
    const auto key = [](const Observation& o) { return std::tuple(o.satellite, o.signal); };
    for (std::size_t i = 0; i < 9; ++i) {
        const Observation& o = measured.observations.signals[i];
        if (i > 0) {
            EXPECT_LT(key(measured.observations.signals[i - 1]), key(o));
        }
        EXPECT_EQ(measured.terms.signals[i].satellite, o.satellite);
        EXPECT_EQ(measured.terms.signals[i].signal, o.signal);
    }
}

TEST(MeasurementEngine, OnlySignalsOfTheSettingsAreTracked) {
    MeasuredRun run(MeasurementParameters{});
    const Arrivals arrivals = plain_arrivals({g07, e03});
    EXPECT_EQ(run.epoch(arrivals).observations.signals.size(), 2u);
    run.settings.signals = {{Constellation::gps, Signal::l5}};
    const Measurement measured = run.epochs(arrivals, 3);
    ASSERT_EQ(measured.observations.signals.size(), 1u);
    EXPECT_EQ(measured.observations.signals[0].signal, Signal::l5);
}

TEST(MeasurementEngine, NumbersOfASignalDoNotDependOnTheOthers) {
    MeasuredRun alone(MeasurementParameters{}), among(MeasurementParameters{});
    among.settings = all_signals();
    for (int i = 0; i < 30; ++i) {
        const Measurement a = alone.epoch(plain_arrivals({g12}));
        const Measurement b = among.epoch(i % 3 == 0 ? plain_arrivals({g07, g12, e03}) : plain_arrivals({g12, e03}));
        const Observation* one = observation_of(a, g12, Signal::l1);
        const Observation* other = observation_of(b, g12, Signal::l1);
        ASSERT_TRUE(one && other);
        EXPECT_EQ(one->pseudorange, other->pseudorange);
        EXPECT_EQ(one->carrier_phase, other->carrier_phase);
        EXPECT_EQ(one->doppler, other->doppler);
    }
}

TEST(MeasurementEngine, OneTermHasDiceOfItsOwn) {
    MeasurementParameters other;
    other.code_noise.seed = 99;
    MeasuredRun a(MeasurementParameters{}), b(other);
    const Measurement first = a.epochs(plain_arrivals({g07}), 3), second = b.epochs(plain_arrivals({g07}), 3);
    EXPECT_NE(first.terms.signals[0].code_noise, second.terms.signals[0].code_noise);
    EXPECT_EQ(first.terms.signals[0].multipath, second.terms.signals[0].multipath);
    EXPECT_EQ(first.terms.signals[0].doppler_noise, second.terms.signals[0].doppler_noise);
    EXPECT_EQ(first.terms.clock_bias, second.terms.clock_bias);
}

TEST(MeasurementEngine, TermsScale) {
    MeasurementParameters doubled;
    for (ErrorTerm* term : {&doubled.code_noise, &doubled.phase_noise, &doubled.doppler_noise, &doubled.multipath,
                            &doubled.receiver_clock})
        term->scale = 2;
    MeasuredRun a(MeasurementParameters{}), b(doubled);
    const Measurement one = a.epochs(plain_arrivals({g07}), 4), two = b.epochs(plain_arrivals({g07}), 4);
    const SignalTerms &x = one.terms.signals[0], &y = two.terms.signals[0];
    EXPECT_NEAR(y.code_noise.value(), 2 * x.code_noise.value(), 1e-12);
    EXPECT_NEAR(y.multipath.value(), 2 * x.multipath.value(), 1e-12);
    EXPECT_NEAR(y.phase_noise.value(), 2 * x.phase_noise.value(), 1e-12);
    EXPECT_NEAR(y.doppler_noise.value(), 2 * x.doppler_noise.value(), 1e-12);
    EXPECT_NEAR(two.terms.clock_bias.value(), 2 * one.terms.clock_bias.value(), 1e-6);
    EXPECT_NEAR(two.terms.clock_drift.value(), 2 * one.terms.clock_drift.value(), 1e-9);
}

TEST(MeasurementEngine, TheTermsAreWhatIsWrongWithTheMeasurements) {
    MeasurementParameters parameters;
    MeasuredRun run(parameters), exact(without_errors());
    const Arrivals arrivals = plain_arrivals({g07, e03});
    for (int i = 0; i < 10; ++i) {
        const Measurement m = run.epoch(arrivals), truth = exact.epoch(arrivals);
        for (std::size_t s = 0; s < 2; ++s) {
            const Observation &o = m.observations.signals[s], &t = truth.observations.signals[s];
            const SignalTerms& terms = m.terms.signals[s];
            EXPECT_NEAR((*o.pseudorange - *t.pseudorange).value(),
                        m.terms.clock_bias.value() + terms.code_noise.value() + terms.multipath.value(), 1e-7);
            EXPECT_NEAR((*o.doppler - *t.doppler).value(),
                        -o.carrier.value() / light * m.terms.clock_drift.value() + terms.doppler_noise.value(), 1e-7);
            if (!o.carrier_phase) continue;
            const double expected = (m.terms.clock_bias.value() + terms.phase_noise.value() +
                                     parameters.multipath_model.phase_ratio * terms.multipath.value()) *
                                    o.carrier.value() / light;
            EXPECT_NEAR(std::remainder(*o.carrier_phase - *t.carrier_phase - expected, 0.5), 0, 1e-6);
        }
    }
}

TEST(MeasurementEngine, ReportedStrengthIsInWholeSteps) {
    MeasurementParameters parameters = without_errors();
    const Arrivals arrivals = plain_arrivals({g07}, 43.6);
    EXPECT_EQ(MeasuredRun(parameters).epoch(arrivals).observations.signals.at(0).cn0, DbHz(44));
    parameters.cn0_resolution = Decibels(0);
    EXPECT_EQ(MeasuredRun(parameters).epoch(arrivals).observations.signals.at(0).cn0, DbHz(43.6));
    parameters.cn0_resolution = Decibels(0.25);
    EXPECT_EQ(MeasuredRun(parameters).epoch(arrivals).observations.signals.at(0).cn0, DbHz(43.5));
    EXPECT_EQ(MeasuredRun(parameters).epoch(plain_arrivals({g07}, 120)).observations.signals.at(0).cn0, DbHz(63))
        << "a receiver's estimate ends somewhere";
    MeasuredRun falling(parameters);
    falling.epoch(arrivals);
    const Measurement gone = falling.epoch(plain_arrivals({g07}, -900));
    ASSERT_EQ(gone.observations.signals.size(), 1U);
    EXPECT_EQ(gone.observations.signals[0].cn0, DbHz(0)) << "at both ends";
}

TEST(MeasurementEngine, ASecondSignalHasItsOwnStrength) {
    Arrivals arrivals = plain_arrivals({g07}, 45);
    arrivals.satellites[0].signals[1].relative_power = Decibels(-4);
    MeasuredRun run(without_errors());
    run.settings = all_signals();
    const Measurement measured = run.epoch(arrivals);
    EXPECT_EQ(observation_of(measured, g07, Signal::l1)->cn0, DbHz(45));
    EXPECT_EQ(observation_of(measured, g07, Signal::l2)->cn0, DbHz(41));
}

TEST(MeasurementEngine, AReflectionBringsItsExcessPathInsteadOfMultipath) {
    MeasurementParameters parameters = without_errors();
    parameters.multipath.enabled = true;
    MeasuredRun run(parameters);
    Arrivals arrivals = plain_arrivals({g07});
    const double range = arrivals.satellites[0].range.value();
    const Measurement direct = run.epochs(arrivals, 3);
    EXPECT_NE(direct.terms.signals[0].multipath, Metres(0));
    arrivals.satellites[0].line_of_sight = false;
    arrivals.satellites[0].excess_path = Metres(31.5);
    const Measurement reflected = run.epoch(arrivals);
    EXPECT_EQ(reflected.terms.signals[0].multipath, Metres(0));
    EXPECT_NEAR(reflected.observations.signals[0].pseudorange->value(), range + 31.5, 1e-7);
    EXPECT_TRUE(reflected.observations.signals[0].slipped) << "another path, another phase";
    EXPECT_FALSE(run.epoch(arrivals).observations.signals[0].slipped);
}

TEST(MeasurementEngine, MovesWithItsState) {
    MeasurementEngine engine(MeasurementParameters{}, 1), same(MeasurementParameters{}, 1);
    const Arrivals arrivals = plain_arrivals({g07});
    engine.measure(arrivals, test::measured_start, {});
    same.measure(arrivals, test::measured_start, {});
    MeasurementEngine moved = std::move(engine);
    const GpsTime later = test::measured_start + Nanoseconds(1'000'000'000);
    EXPECT_EQ(moved.measure(arrivals, later, {}).observations.signals[0].pseudorange,
              same.measure(arrivals, later, {}).observations.signals[0].pseudorange);
}

}  // namespace
}  // namespace skyloop
