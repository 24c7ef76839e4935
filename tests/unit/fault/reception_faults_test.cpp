// What arrives no longer, or weaker, and what a receiver makes of that.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "signal_fault_run.hpp"

namespace skyloop {
namespace {

using test::ArrivalBench;
using test::arriving;
using test::asked_signal_fault;
using test::FaultValues;
using test::refusal_of;
using test::signal_fault;
using testing::HasSubstr;
using Texts = std::vector<std::string>;

int left_after(const FaultValues& values) { return arriving(ArrivalBench().after(signal_fault("outage", values))); }

TEST(ReceptionFaults, OutageTakesWhatIsSelected) {
    EXPECT_EQ(left_after({}), 0);
    EXPECT_EQ(left_after({{"constellations", Texts{"gps"}}}), 0);
    EXPECT_EQ(left_after({{"constellations", Texts{"galileo"}}}), 10);
    EXPECT_EQ(left_after({{"satellites", Texts{"G02", "G07", "E02"}}}), 8);
    // Azimuths 12, 57, 95 … 341: a sector across north, and one across south.
    EXPECT_EQ(left_after({{"azimuth_from_deg", 300.}, {"azimuth_to_deg", 20.}}), 7);
    EXPECT_EQ(left_after({{"azimuth_from_deg", -60.}, {"azimuth_to_deg", 20.}}), 7);
    EXPECT_EQ(left_after({{"azimuth_from_deg", 20.}, {"azimuth_to_deg", 300.}}), 3);
    EXPECT_EQ(left_after({{"azimuth_from_deg", 0.}, {"azimuth_to_deg", 360.}}), 0);
    EXPECT_EQ(left_after({{"azimuth_from_deg", 180.}, {"azimuth_to_deg", -180.}}), 0);
    EXPECT_EQ(left_after({{"azimuth_from_deg", 300.}, {"azimuth_to_deg", -340.}}), 7) << "as from 300 to 20";
    EXPECT_EQ(left_after({{"azimuth_from_deg", -340.}, {"azimuth_to_deg", 300.}}), 3);
    EXPECT_EQ(left_after({{"elevation_to_deg", 20.}}), 7);
    EXPECT_EQ(left_after({{"elevation_from_deg", 20.}, {"elevation_to_deg", 50.}}), 6);
}

TEST(ReceptionFaults, OutageOfASignalLeavesTheOthers) {
    const ArrivalBench bench;
    for (const Arrival& arrival : bench.after(signal_fault("outage", {{"signals", Texts{"L1"}}})).satellites) {
        EXPECT_EQ(arrival.paths, 1);
        EXPECT_TRUE(arrival.cut_off);  // for models of one signal
        EXPECT_FALSE(arrival.signals[0].arrives);
        EXPECT_TRUE(arrival.signals[1].arrives && arrival.signals[2].arrives);
    }
    for (const Arrival& arrival : bench.after(signal_fault("outage", {{"signals", Texts{"L5"}}})).satellites) {
        EXPECT_FALSE(arrival.cut_off || arrival.signals[2].arrives);
    }
    EXPECT_EQ(left_after({{"signals", Texts{"L1", "L2", "L5"}}}), 0);
}

TEST(ReceptionFaults, OutageFadesWhileItIsRamped) {
    const Arrivals half = ArrivalBench().after(signal_fault("outage"), 0, 0.5);
    EXPECT_EQ(arriving(half), 10);
    for (const Arrival& arrival : half.satellites)
        EXPECT_NEAR(arrival.cn0.value().value(), 15, 1e-9);
}

TEST(ReceptionFaults, SelectorsThatContradictEachOtherAreRefused) {
    EXPECT_THAT(refusal_of("outage", {{"azimuth_from_deg", 10.}}), HasSubstr("one end"));
    EXPECT_THAT(refusal_of("outage", {{"azimuth_from_deg", -350.}, {"azimuth_to_deg", 350.}}), "");
    EXPECT_THAT(refusal_of("outage", {{"azimuth_from_deg", -360.}, {"azimuth_to_deg", 360.}}),
                HasSubstr("two directions"));
    EXPECT_THAT(refusal_of("outage", {{"azimuth_from_deg", 10.}, {"azimuth_to_deg", 10.}}),
                HasSubstr("two directions"));
    EXPECT_THAT(refusal_of("outage", {{"elevation_from_deg", 30.}, {"elevation_to_deg", 20.}}), HasSubstr("above"));
    EXPECT_THAT(refusal_of("outage", {{"satellites", Texts{"G7"}}}), HasSubstr("'G7'"));
    EXPECT_THAT(refusal_of("outage", {{"satellites", Texts{"G07"}}, {"constellations", Texts{"galileo"}}}),
                HasSubstr("leaves out"));
    EXPECT_THAT(refusal_of("outage", {{"constellations", Texts{"gsp"}}}), HasSubstr("expected"));
}

TEST(ReceptionFaults, Cn0DropTakesDecibelsOffTheSelectedSignals) {
    const ArrivalBench bench;
    const Arrivals all = bench.after(signal_fault("cn0_drop", {{"attenuation_db", 12.}}), 0, 0.5);
    EXPECT_NEAR(all.satellites[3].cn0->value(), 39, 1e-9);
    EXPECT_NEAR(all.satellites[3].signals[1].relative_power.value(), 0, 1e-9);
    EXPECT_NEAR(all.satellites[3].power_offset.value(), -6, 1e-9);
    const Arrivals second = bench.after(signal_fault("cn0_drop", {{"attenuation_db", 12.}, {"signals", Texts{"L2"}}}));
    EXPECT_NEAR(second.satellites[3].cn0->value(), 45, 1e-9);
    EXPECT_NEAR(second.satellites[3].signals[1].relative_power.value(), -12, 1e-9);
    EXPECT_NEAR(second.satellites[3].signals[2].relative_power.value(), 0, 1e-9);
}

double jammed_cn0(const FaultValues& values, double since_start = 0, double strength = 1) {
    return ArrivalBench().after(signal_fault("jamming", values), since_start, strength).satellites[0].cn0->value();
}

TEST(ReceptionFaults, JammingTakesWhatTheFormulaSays) {
    // −10 log10(10^−4.51 + 10^2.5/(1.5·1.023e6)) is 36.3 dB-Hz of 45.1.
    EXPECT_NEAR(jammed_cn0({{"j_to_s_db", 25.}}), 45 - 8.84, 0.05);
    EXPECT_LT(jammed_cn0({{"j_to_s_db", 25.}, {"spectrum", std::string("narrow")}}), jammed_cn0({{"j_to_s_db", 25.}}));
    EXPECT_GT(jammed_cn0({{"j_to_s_db", 25.}, {"spectrum", std::string("wide")}}), jammed_cn0({{"j_to_s_db", 25.}}));
    EXPECT_LT(jammed_cn0({{"j_to_s_db", 60.}}), 10);
    // Ramped in it comes from nothing; fast pulses count by their average.
    EXPECT_NEAR(jammed_cn0({{"j_to_s_db", 25.}}, 0, 0), 45, 1e-9);
    EXPECT_GT(jammed_cn0({{"j_to_s_db", 25.}}, 0, 0.8), jammed_cn0({{"j_to_s_db", 25.}}));
    EXPECT_NEAR(jammed_cn0({{"j_to_s_db", 35.}, {"pulse_duty", 0.1}}), jammed_cn0({{"j_to_s_db", 25.}}), 1e-9);
}

TEST(ReceptionFaults, TwoJammersAddTheirPowers) {
    const ArrivalBench bench;
    const Fault jammer = signal_fault("jamming", {{"j_to_s_db", 40.}});
    Arrivals twice = bench.after(jammer);
    jammer.arrivals(twice, {bench.truth.time, Seconds(0), 1, &bench.truth, &bench.sky});
    const double loss = 45 - twice.satellites[0].cn0->value();
    EXPECT_NEAR(twice.satellites[0].interference_loss.value(), loss, 1e-9);
    EXPECT_NEAR(loss, 45 - jammed_cn0({{"j_to_s_db", 43.0103}}), 0.01);
}

TEST(ReceptionFaults, JammersPulseAndSweep) {
    const FaultValues pulsed{{"j_to_s_db", 60.}, {"pulse_s", 10.}, {"pulse_duty", 0.3}};
    EXPECT_LT(jammed_cn0(pulsed, 1.9), 10);
    EXPECT_NEAR(jammed_cn0(pulsed, 3.1), 45, 1e-9);
    EXPECT_LT(jammed_cn0(pulsed, 10.1), 10);
    // L1 lies at 0.92 of the band, and the sweep passes it once in 100 s, for 20 s.
    const FaultValues swept{{"j_to_s_db", 60.}, {"sweep_s", 100.}};
    EXPECT_NEAR(jammed_cn0(swept, 50), 45, 1e-9);
    EXPECT_LT(jammed_cn0(swept, 92), 10);
    EXPECT_LT(jammed_cn0(swept, 0), 10);
    EXPECT_NEAR(jammed_cn0(swept, 10), 45, 1e-9);
}

// Whatever the phase of its pulses or passes against the epochs: of fast ones the epochs see the average.
TEST(ReceptionFaults, FastPulsesAndSweepsAreAveraged) {
    const double mean = jammed_cn0({{"j_to_s_db", 60.}, {"pulse_duty", 0.1}});
    for (const double period : {0.001, 0.02, 0.1, 0.5})
        for (const double phase : {0., 0.005, 0.05, 0.099, 20.3})
            EXPECT_NEAR(jammed_cn0({{"j_to_s_db", 60.}, {"pulse_duty", 0.1}, {"pulse_s", period}}, phase), mean, 1e-6)
                << period << " " << phase;
    const double swept = jammed_cn0({{"j_to_s_db", 60.}, {"pulse_duty", 0.2}});
    for (const double phase : {0., 0.0005, 0.0317, 20.3})
        EXPECT_NEAR(jammed_cn0({{"j_to_s_db", 60.}, {"sweep_s", 0.001}}, phase), swept, 1e-6) << phase;
}

// Ten epochs a second see single pulses of half a second, and the edge of one as its share.
TEST(ReceptionFaults, EpochsAverageOverTheirOwnPeriod) {
    const ArrivalBench bench;
    const Fault fault = signal_fault("jamming", {{"j_to_s_db", 60.}, {"pulse_s", 1.}, {"pulse_duty", 0.55}});
    std::vector<double> cn0;
    for (int epoch = 0; epoch < 20; ++epoch)
        cn0.push_back(bench.after(fault, 0.1 * epoch).satellites[0].cn0->value());
    const double on = jammed_cn0({{"j_to_s_db", 60.}}), half = jammed_cn0({{"j_to_s_db", 60.}, {"pulse_duty", 0.5}});
    for (const int epoch : {1, 2, 3, 4, 10, 14})
        EXPECT_NEAR(cn0[static_cast<std::size_t>(epoch)], on, 1e-6) << epoch;
    EXPECT_NEAR(cn0[5], half, 1e-3);
    EXPECT_NEAR(cn0[15], half, 1e-3);
    for (const int epoch : {6, 9, 16, 19})
        EXPECT_NEAR(cn0[static_cast<std::size_t>(epoch)], 45, 1e-6) << epoch;
}

TEST(ReceptionFaults, AJammerAtAPlaceWeakensWithTheSquareOfItsDistance) {
    const auto ratio_at = [](double east_m) {
        const ArrivalBench bench;
        const Geodetic there = to_geodetic(LocalFrame(bench.truth.geodetic).to_ecef(Position<Enu>(east_m, 0, 0)));
        const double height = there.height.above_ellipsoid.value();
        const Fault fault = signal_fault(
            "jamming", {{"jammer_at", std::vector<double>{there.latitude.deg(), there.longitude.deg(), height}},
                        {"eirp_dbw", 0.}});
        return std::pow(10, bench.after(fault).satellites[0].interference_loss.value() / 10) - 1;
    };
    EXPECT_NEAR(ratio_at(1000) / ratio_at(2000), 4, 0.01);
    // 0 dBW over 1 km at L1: 96.4 dB less, so 60.6 dB over −157 dBW.
    EXPECT_NEAR(10 * std::log10(ratio_at(1000)), 60.6 + 45.1 - 10 * std::log10(1.5 * 1.023e6), 0.1);
}

TEST(ReceptionFaults, AJammerOfOneBandIsSeenByTheMonitorOnly) {
    const ArrivalBench bench;
    const Fault fault = signal_fault("jamming", {{"j_to_s_db", 50.}, {"signals", Texts{"L5"}}});
    const Arrivals jammed = bench.after(fault);
    EXPECT_NEAR(jammed.satellites[0].cn0->value(), 45, 1e-9);
    EXPECT_LT(jammed.satellites[0].signals[2].relative_power.value(), -30);
    Epoch epoch;
    fault.epoch(epoch, {bench.truth.time});
    EXPECT_GT(epoch.front_end.lower_interference.value(), 30);
    EXPECT_EQ(epoch.front_end.interference, Decibels(0)) << "the band of L1 is clean";
}

TEST(ReceptionFaults, JammersThatAreNotToldAreRefused) {
    EXPECT_THAT(refusal_of("jamming", {}), HasSubstr("no jammer is told"));
    const std::vector<double> place{46., 30.};
    EXPECT_THAT(refusal_of("jamming", {{"j_to_s_db", 30.}, {"jammer_at", place}}), HasSubstr("both"));
    EXPECT_THAT(refusal_of("jamming", {{"jammer_at", place}}), HasSubstr("without eirp_dbw"));
    EXPECT_THAT(refusal_of("jamming", {{"j_to_s_db", 30.}, {"eirp_dbw", 0.}}), HasSubstr("without jammer_at"));
    EXPECT_THAT(refusal_of("jamming", {{"jammer_at", std::vector<double>{91., 0.}}, {"eirp_dbw", 0.}}),
                HasSubstr("latitude"));
    EXPECT_THAT(refusal_of("jamming", {{"j_to_s_db", 30.}, {"pulse_s", 1.}}), HasSubstr("pulse_duty"));
    EXPECT_THAT(refusal_of("jamming", {{"j_to_s_db", 30.}, {"sweep_duty", 0.5}}), HasSubstr("sweep_s"));
}

TEST(ReceptionFaults, AnAntennaThatIsBrokenHearsNothingAndSaysSo) {
    const ArrivalBench bench;
    for (const auto& [name, status] :
         {std::pair("antenna_open", AntennaStatus::open), std::pair("antenna_short", AntennaStatus::short_circuit)}) {
        const Fault fault = signal_fault(name);
        EXPECT_EQ(arriving(bench.after(fault)), 0);
        Epoch epoch;
        fault.epoch(epoch, {bench.truth.time});
        EXPECT_EQ(epoch.front_end.antenna, status);
    }
    const Arrivals weak = bench.after(signal_fault("antenna_open", {{"attenuation_db", 15.}}));
    EXPECT_EQ(arriving(weak), 10);
    EXPECT_NEAR(weak.satellites[0].cn0->value(), 30, 1e-9);
}

TEST(ReceptionFaults, AMultipathBurstGivesEchoesToAShareOfTheSatellites) {
    const ArrivalBench bench;
    const Fault fault = signal_fault("multipath_burst", {{"share", 0.5}});
    int echoes = 0;
    for (int span = 0; span < 40; ++span)
        for (const Arrival& arrival : bench.after(fault, span * 5 + 0.5).satellites) {
            EXPECT_EQ(arrival.echoes.empty(), !arrival.echoes_known);
            if (arrival.echoes.empty()) continue;
            ++echoes;
            EXPECT_GT(arrival.echoes[0].excess.value(), 0);
            EXPECT_LT(arrival.echoes[0].excess.value(), 63);
            EXPECT_LE(arrival.echoes[0].amplitude, 0.7);
        }
    EXPECT_NEAR(echoes, 200, 45);  // of 400, 4.5 σ
    // Within one span an echo moves by its rate, and the same name makes the same echoes.
    const Fault all = signal_fault("multipath_burst", {{"share", 1.}});
    const Echo first = bench.after(all, 1).satellites[0].echoes[0],
               second = bench.after(all, 2).satellites[0].echoes[0];
    EXPECT_NEAR((second.excess - first.excess).value(), first.excess_rate.value(), 1e-9);
    EXPECT_EQ(first.phase, second.phase);
}

// A sensor model whose arrivals are edited after its link budget.
Fix sensor_fix(ErrorModelKind kind, const Fault* fault) {
    ErrorModelSettings settings;
    settings.kind = kind;
    const ArrivalBench bench;
    Arrivals arrivals = fault ? bench.after(*fault) : bench.arrivals;
    return make_error_model(settings)->fix(bench.truth, bench.sky, arrivals);
}

TEST(ReceptionFaults, EverySensorModelLosesWhatIsTakenFromIt) {
    const Fault all = signal_fault("outage"), first = signal_fault("outage", {{"signals", Texts{"L1"}}}),
                some = signal_fault("outage", {{"satellites", Texts{"G01", "G02"}}}),
                jammer = signal_fault("jamming", {{"j_to_s_db", 60.}}),
                sick = signal_fault("unhealthy", {{"satellites", Texts{"G01", "G02"}}});
    for (const ErrorModelKind kind : error_model_kinds()) {
        SCOPED_TRACE(error_model_name(kind));
        EXPECT_EQ(sensor_fix(kind, nullptr).satellites_used(), 10);
        EXPECT_FALSE(sensor_fix(kind, &all).has_position());
        EXPECT_FALSE(sensor_fix(kind, &first).has_position());
        EXPECT_FALSE(sensor_fix(kind, &jammer).has_position());
        EXPECT_EQ(sensor_fix(kind, &some).satellites_used(), 8);
        const Fix fix = sensor_fix(kind, &sick);
        EXPECT_EQ(fix.satellites_used(), 8);
        EXPECT_FALSE(fix.satellites[0].healthy);
    }
}

TEST(ReceptionFaults, TheFixIsLostInAnOutageAndComesBack) {
    test::FaultyRun run = test::faulty_run_at_rest();
    run.add(signal_fault("outage"), 20, 40);
    EXPECT_TRUE(run.until(19).epoch.fix.has_position());
    const Trace lost = run.until(30);
    EXPECT_EQ(lost.epoch.fix.type, FixType::none);
    EXPECT_TRUE(lost.epoch.observations.signals.empty());
    const Trace back = run.until(50);
    ASSERT_EQ(back.epoch.fix.type, FixType::fix_3d);
    EXPECT_LT(test::fix_error_enu(back).norm(), 20);
}

TEST(ReceptionFaults, OneSystemMayGoAlone) {
    test::FaultyRun run = test::faulty_run_at_rest();
    run.add(signal_fault("outage", {{"constellations", Texts{"gps"}}}), 20, 40);
    const int before = run.until(19).epoch.fix.satellites_used();
    const Trace without = run.until(30);
    EXPECT_EQ(without.epoch.fix.type, FixType::fix_3d);
    EXPECT_LT(without.epoch.fix.satellites_used(), before - 3);
    for (const Observation& o : without.epoch.observations.signals)
        EXPECT_NE(o.satellite.constellation, Constellation::gps);
}

TEST(ReceptionFaults, SecondSignalsLiveWithoutTheFirst) {
    test::FaultyRun run = test::faulty_run_at_rest();
    run.settings().signals = {{Constellation::gps, Signal::l1}, {Constellation::gps, Signal::l2}};
    run.add(signal_fault("outage", {{"signals", Texts{"L1"}}}), 20, 60);
    run.add(signal_fault("outage"), 30, 35);
    (void)run.until(19);
    for (const double t : {25., 50.}) {
        const Trace trace = run.until(t);
        EXPECT_EQ(trace.epoch.fix.type, FixType::fix_3d) << t;
        for (const Observation& o : trace.epoch.observations.signals)
            EXPECT_EQ(o.signal, Signal::l2);
    }
}

TEST(ReceptionFaults, StrongJammingEndsTheFixAndShowsInTheMonitor) {
    test::FaultyRun run = test::faulty_run_at_rest();
    run.add(signal_fault("jamming", {{"j_to_s_db", 60.}}), 20, 40);
    EXPECT_EQ(run.until(19).epoch.front_end.interference, Decibels(0));
    const Trace jammed = run.until(30);
    EXPECT_EQ(jammed.epoch.fix.type, FixType::none);
    EXPECT_GT(jammed.epoch.front_end.interference.value(), 35);
    const Trace back = run.until(55);
    EXPECT_EQ(back.epoch.fix.type, FixType::fix_3d);
    EXPECT_EQ(back.epoch.front_end.interference, Decibels(0));
}

TEST(ReceptionFaults, WeakJammingLowersCn0AndKeepsTheFix) {
    test::FaultyRun run = test::faulty_run_at_rest();
    run.add(signal_fault("jamming", {{"j_to_s_db", 25.}}), 20);
    const auto mean_cn0 = [](const Trace& trace) {
        double sum = 0;
        for (const Observation& o : trace.epoch.observations.signals)
            sum += o.cn0.value();
        return sum / static_cast<double>(trace.epoch.observations.signals.size());
    };
    const double before = mean_cn0(run.until(19));
    const Trace jammed = run.until(30);
    EXPECT_EQ(jammed.epoch.fix.type, FixType::fix_3d);
    EXPECT_NEAR(before - mean_cn0(jammed), 8, 2.5);
}

TEST(ReceptionFaults, EchoesMoveRangesByMetres) {
    const auto worst = [](bool burst) {
        test::FaultyRun run = test::faulty_run_at_rest(true);
        if (burst) run.add(signal_fault("multipath_burst", {{"share", 1.}}), 20);
        (void)run.until(19);
        double most = 0;
        for (int t = 20; t < 50; ++t)
            for (const SignalTerms& terms : run.until(t).measurement.signals)
                most = std::max(most, std::abs(terms.multipath.value()));
        return most;
    };
    EXPECT_GT(worst(true), worst(false) + 3);
}

}  // namespace
}  // namespace skyloop
