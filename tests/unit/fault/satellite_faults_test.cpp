// Satellites, the air and channels that are wrong, and what a receiver makes of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "signal_fault_run.hpp"

namespace skyloop {
namespace {

using test::ArrivalBench;
using test::faulty_run_at_rest;
using test::FaultyRun;
using test::refusal_of;
using test::signal_fault;
using testing::HasSubstr;
using Names = std::vector<std::string>;

SatelliteId highest_used(const Trace& trace) {
    const SatelliteStatus* highest = nullptr;
    for (const SatelliteStatus& status : trace.epoch.fix.satellites)
        if (status.used && (highest == nullptr || status.elevation > highest->elevation)) highest = &status;
    return highest == nullptr ? SatelliteId{} : highest->id;
}

// Range error that a satellite's signal has in excess of that of a run without the fault, m.
double added_range(const Trace& faulty, const Trace& clean, SatelliteId id) {
    const auto range = [id](const Trace& trace) {
        for (const Observation& o : trace.epoch.observations.signals)
            if (o.satellite == id && o.pseudorange) return o.pseudorange->value();
        return std::nan("");
    };
    return range(faulty) - range(clean);
}

TEST(SatelliteFaults, AClockStepShortensTheRangeAndIsExcluded) {
    FaultyRun clean = faulty_run_at_rest(), run = faulty_run_at_rest();
    run.add(signal_fault("satellite_clock_step", {{"step_ns", 1000.}}), 20, 60);
    const Trace before = run.until(19);
    const SatelliteId sick = highest_used(before);
    const Trace trace = run.until(40), sound = clean.until(40);
    EXPECT_NEAR(added_range(trace, sound, sick), -299.8, 0.1);
    ASSERT_NE(test::status_of(trace, sick), nullptr);
    EXPECT_FALSE(test::status_of(trace, sick)->used);
    EXPECT_LT(test::fix_error_enu(trace).norm(), 20);
    const Trace after = run.until(90);
    EXPECT_NEAR(added_range(after, clean.until(90), sick), 0, 1e-6);
    EXPECT_TRUE(test::status_of(after, sick)->used);
}

TEST(SatelliteFaults, AClockDriftGrowsInRangeAndDoppler) {
    FaultyRun clean = faulty_run_at_rest(false), run = faulty_run_at_rest(false);
    run.add(signal_fault("satellite_clock_drift", {{"drift_ns_per_s", -10.}}), 20);
    const SatelliteId sick = highest_used(run.until(19));
    const Trace trace = run.until(40), sound = clean.until(40);
    EXPECT_NEAR(added_range(trace, sound, sick), 59.96, 0.05);
    for (std::size_t i = 0; i < trace.epoch.observations.signals.size(); ++i) {
        const Observation& faulty = trace.epoch.observations.signals[i];
        const Hertz shift = *faulty.doppler - *sound.epoch.observations.signals[i].doppler;
        const double expected = faulty.satellite == sick ? -10e-9 * faulty.carrier.value() : 0;
        EXPECT_NEAR(shift.value(), expected, 0.01);
        EXPECT_FALSE(faulty.slipped);
    }
}

TEST(SatelliteFaults, AWrongEphemerisShowsAsFarAsItLiesAlongTheLineOfSight) {
    FaultyRun clean = faulty_run_at_rest(false), run = faulty_run_at_rest(false);
    run.add(signal_fault("wrong_ephemeris", {{"radial_m", 500.}, {"growth_s", 10.}}), 20);
    const SatelliteId sick = highest_used(run.until(19));
    EXPECT_NEAR(added_range(run.until(25), clean.until(25), sick), -250, 10);
    // Nearly overhead the whole of a radial error is in the range.
    EXPECT_NEAR(added_range(run.until(40), clean.until(40), sick), -500, 20);
    EXPECT_FALSE(test::status_of(run.until(41), sick)->used);
}

TEST(SatelliteFaults, AlongTrackErrorsShowInThePositionOfThatSatellite) {
    FaultyRun run = faulty_run_at_rest(false);
    const Trace trace = run.until(0);
    const Fault fault = signal_fault("wrong_ephemeris", {{"along_track_m", 1000.}, {"satellite_count", 200.}});
    Arrivals edited = trace.arrivals;
    fault.arrivals(edited, {trace.truth.time, Seconds(0), 1, &trace.truth, &trace.sky});
    double most = 0;
    for (std::size_t i = 0; i < edited.satellites.size(); ++i) {
        // The same by geometry: the range to where the satellite is, less that to where its record puts it.
        const SatelliteInView& satellite = trace.sky.satellites[i];
        const Eigen::Vector3d place = satellite.position_at_transmission.vector();
        const Eigen::Vector3d inertial = satellite.velocity_at_transmission.vector() +
                                         earth_rotation_rate * Eigen::Vector3d(-place.y(), place.x(), 0);
        const Eigen::Vector3d up = place.normalized();
        const Eigen::Vector3d wrong = place + 1000 * (inertial - inertial.dot(up) * up).normalized();
        const double expected =
            (place - trace.truth.position.vector()).norm() - (wrong - trace.truth.position.vector()).norm();
        EXPECT_NEAR(edited.satellites[i].signal_in_space_error.value(), expected, 0.1);
        most = std::max(most, std::abs(expected));
    }
    EXPECT_GT(most, 100);
}

TEST(SatelliteFaults, UnhealthySatellitesAreTrackedAndNotUsed) {
    FaultyRun run = faulty_run_at_rest();
    run.add(signal_fault("unhealthy", {{"constellations", Names{"galileo"}}}), 20, 40);
    const auto use = [&run](double t) {
        int used = 0, tracked = 0, healthy = 0;
        for (const SatelliteStatus& status : run.until(t).epoch.fix.satellites) {
            if (status.id.constellation != Constellation::galileo) continue;
            used += status.used ? 1 : 0;
            tracked += status.cn0 ? 1 : 0;
            healthy += status.cn0 && status.healthy ? 1 : 0;
        }
        return std::array{used, tracked, healthy};
    };
    const auto before = use(19), sick = use(30), after = use(45);
    EXPECT_GT(before[0], 3);
    EXPECT_EQ(sick[0], 0);
    EXPECT_NEAR(sick[1], before[1], 1) << "a weak one may come or go by itself";
    EXPECT_EQ(sick[2], 0);
    EXPECT_NEAR(after[0], before[0], 1);
}

TEST(SatelliteFaults, AStormDelaysMoreThanTheReceiverKnows) {
    FaultyRun clean = faulty_run_at_rest(), run = faulty_run_at_rest();
    run.add(signal_fault("ionospheric_storm", {{"vertical_delay_m", 20.}}), 20, 90);
    const Trace trace = run.until(89), sound = clean.until(89);
    EXPECT_GT((test::fix_error_enu(trace) - test::fix_error_enu(sound)).norm(), 8);
    for (std::size_t i = 0; i < trace.arrivals.satellites.size(); ++i) {
        const Arrival& stormy = trace.arrivals.satellites[i];
        const double added = (stormy.iono_delay - sound.arrivals.satellites[i].iono_delay).value();
        EXPECT_GT(added, 19);
        EXPECT_LT(added, 70);
    }
    EXPECT_LT((test::fix_error_enu(run.until(200)) - test::fix_error_enu(clean.until(200))).norm(), 1);
}

TEST(SatelliteFaults, AStormOnItsRampTellsItsRate) {
    ArrivalBench bench;
    for (Arrival& arrival : bench.arrivals.satellites)
        arrival.iono_delay = Metres(4);
    FaultMoment moment{bench.truth.time, Seconds(5), 0.5, &bench.truth, &bench.sky};
    moment.strength_rate = 0.1;
    signal_fault("ionospheric_storm", {{"tec_factor", 3.}}).arrivals(bench.arrivals, moment);
    for (const Arrival& arrival : bench.arrivals.satellites) {
        EXPECT_NEAR(arrival.false_iono_delay.value(), 4, 1e-9);
        EXPECT_NEAR(arrival.false_iono_rate.value(), 0.8, 1e-9);
    }
}

TEST(SatelliteFaults, AStormScalesAndTilts) {
    ArrivalBench bench;
    for (Arrival& arrival : bench.arrivals.satellites)
        arrival.iono_delay = Metres(4);
    for (const Arrival& arrival :
         bench.after(signal_fault("ionospheric_storm", {{"tec_factor", 3.}}), 0, 0.5).satellites)
        EXPECT_NEAR(arrival.iono_delay.value(), 8, 1e-9);
    const Arrivals tilted =
        bench.after(signal_fault("ionospheric_storm", {{"gradient_mm_per_km", 10.}, {"gradient_towards_deg", 12.}}));
    // G01 stands at 12°, 34°: its ray pierces the shell 440 km north of here, and slants by 1.6.
    EXPECT_NEAR(tilted.satellites[0].iono_delay.value(), 4 + 4.4 * 1.62, 0.7);
    EXPECT_LT(tilted.satellites[5].iono_delay.value(), 1);  // at 203°: there is less, but no less than none
    EXPECT_GE(tilted.satellites[5].iono_delay.value(), 0);
    EXPECT_THAT(refusal_of("ionospheric_storm", {}), HasSubstr("no storm is told"));
}

// What a front of 300 mm/km over 50 km that stands on the meridian of 30° E and moves westwards adds overhead, so many
// km east of the meridian, at this time and a second later.
std::array<Arrival, 2> under_front(double east_km, double since_start) {
    Fault front = signal_fault("ionospheric_storm", {{"gradient_mm_per_km", 300.},
                                                     {"gradient_towards_deg", 90.},
                                                     {"front_at", std::vector{46.5, 30.}},
                                                     {"front_width_km", 50.},
                                                     {"front_speed_mps", 200.}});
    TruthState truth;
    truth.geodetic = Geodetic::degrees(46.5, 30 + east_km / (111.195 * std::cos(46.5 * std::numbers::pi / 180)), 0);
    Arrivals arrivals;
    arrivals.satellites.resize(1);
    std::array<Arrival, 2> both;
    for (int i = 0; i < 2; ++i) {
        truth.time = advanced(to_gps_time(2300, 200000), Seconds(since_start + i));
        arrivals.satellites[0] = {};
        arrivals.satellites[0].direction = {Angle(), Angle::degrees(90)};
        front.arrivals(arrivals, FaultMoment{truth.time, Seconds(since_start + i), 1, &truth});
        both[static_cast<std::size_t>(i)] = arrivals.satellites[0];
    }
    return both;
}

TEST(SatelliteFaults, AFrontIsOneForAllReceiversAndComesOn) {
    const auto added = [](double east_km, double since_start) {
        return under_front(east_km, since_start)[0].false_iono_delay.value();
    };
    EXPECT_NEAR(added(-30, 0), 0, 1e-9);
    EXPECT_NEAR(added(25, 0), 7.5, 0.05);
    EXPECT_NEAR(added(200, 0), 15, 1e-9);
    EXPECT_NEAR(added(25, 100), 13.5, 0.05);
    EXPECT_NEAR(added(-30, 250), 6, 0.05);
    EXPECT_NEAR(under_front(25, 0)[1].false_iono_rate.value(), 0.06, 1e-6);
    EXPECT_NEAR(under_front(200, 0)[1].false_iono_rate.value(), 0, 1e-9);
    EXPECT_THAT(refusal_of("ionospheric_storm", {{"vertical_delay_m", 3.}, {"front_speed_mps", 3.}}),
                HasSubstr("a front without gradient_mm_per_km"));
    EXPECT_THAT(refusal_of("ionospheric_storm", {{"gradient_mm_per_km", 3.}, {"front_at", std::vector{95., 3.}}}),
                HasSubstr("front_at"));
}

TEST(SatelliteFaults, ScintillationTearsThePhaseAndLeavesTheCode) {
    FaultyRun run = faulty_run_at_rest();
    run.add(signal_fault("scintillation", {{"s4", 0.9}, {"sigma_phi_rad", 0.8}}), 20, 40);
    const auto phases = [&run](double t) {
        int count = 0;
        const Trace trace = run.until(t);
        for (const Observation& o : trace.epoch.observations.signals)
            count += o.carrier_phase ? 1 : 0;
        EXPECT_EQ(trace.epoch.fix.type, FixType::fix_3d);
        return count;
    };
    EXPECT_GT(phases(19), 10);
    EXPECT_EQ(phases(30), 0);
    EXPECT_GT(phases(50), 10);
}

TEST(SatelliteFaults, PseudorangesStepAndRampInTheCodeAlone) {
    for (const auto& [name, values, expected] :
         {std::tuple("pseudorange_step", test::FaultValues{{"step_m", 40.}}, 40.),
          std::tuple("pseudorange_ramp", test::FaultValues{{"ramp_mps", 3.}}, 60.)}) {
        FaultyRun clean = faulty_run_at_rest(false), run = faulty_run_at_rest(false);
        const SatelliteId sick = highest_used(run.until(19));
        run.add(signal_fault(name, values), 20, 60);
        const Trace trace = run.until(40), sound = clean.until(40);
        EXPECT_NEAR(added_range(trace, sound, sick), expected, 1e-6) << name;
        for (std::size_t i = 0; i < trace.epoch.observations.signals.size(); ++i)
            EXPECT_EQ(trace.epoch.observations.signals[i].carrier_phase,
                      sound.epoch.observations.signals[i].carrier_phase);
        EXPECT_NEAR(added_range(run.until(61), clean.until(61), sick), 0, 1e-6) << name;
    }
}

TEST(SatelliteFaults, CyclesSlipAtTheirRateByWholeCycles) {
    FaultyRun clean = faulty_run_at_rest(false), run = faulty_run_at_rest(false);
    run.add(signal_fault("cycle_slips", {{"slips_per_minute", 6.}}), 20, 80);
    int slips = 0, signals = 0;
    for (double t = 20; t < 80; ++t) {
        const Trace trace = run.until(t), sound = clean.until(t);
        for (std::size_t i = 0; i < trace.epoch.observations.signals.size(); ++i) {
            const Observation& o = trace.epoch.observations.signals[i];
            slips += o.slipped ? 1 : 0;
            ++signals;
            if (!o.carrier_phase) continue;
            const double cycles = *o.carrier_phase - *sound.epoch.observations.signals[i].carrier_phase;
            EXPECT_NEAR(cycles, std::round(cycles), 1e-4);
        }
    }
    const double expected = signals / 60. * 6;
    EXPECT_NEAR(slips, expected, 5 * std::sqrt(expected));
}

// The receiver goes on counting from where it is: the end of the cause mends nothing, and breaks nothing.
TEST(SatelliteFaults, SlippedCountsStaySlippedAfterTheFault) {
    for (const bool flagged : {true, false}) {
        FaultyRun clean = faulty_run_at_rest(false), run = faulty_run_at_rest(false);
        run.add(signal_fault("cycle_slips", {{"slips_per_minute", 30.}, {"flagged", flagged}}), 20, 40);
        const auto lost = [&](double t) {
            const Trace trace = run.until(t), sound = clean.until(t);
            std::vector<double> cycles;
            for (std::size_t i = 0; i < trace.epoch.observations.signals.size(); ++i) {
                const Observation &o = trace.epoch.observations.signals[i], &s = sound.epoch.observations.signals[i];
                cycles.push_back(std::round(o.carrier_phase.value_or(0) - s.carrier_phase.value_or(0)));
                EXPECT_TRUE(t < 40 || !o.slipped) << to_string(o.satellite);
                EXPECT_LE(o.lock_time, s.lock_time);
            }
            return cycles;
        };
        const std::vector<double> last = lost(39);
        EXPECT_GT(std::count_if(last.begin(), last.end(), [](double cycles) { return cycles != 0; }), 5);
        EXPECT_EQ(lost(40), last);
        EXPECT_EQ(lost(60), last);
    }
}

TEST(SatelliteFaults, ErrorsThatAreNotToldAreRefused) {
    EXPECT_THAT(refusal_of("wrong_ephemeris", {}), HasSubstr("no error is told"));
    EXPECT_THAT(refusal_of("satellite_clock_step", {}), HasSubstr("missing"));
    EXPECT_THAT(refusal_of("pseudorange_step", {{"step_m", 1.}, {"satellites", Names{"X01"}}}), HasSubstr("'X01'"));
}

// Each kind says what it does and why; what it makes leaves nothing behind it, for edits come from the fault alone.
TEST(SignalFaultKinds, AreNamedAndExplained) {
    std::set<std::string_view> names;
    int count = 0;
    for (const FaultKind& kind : fault_kinds()) {
        if (kind.layer != FaultLayer::signals) continue;
        ++count;
        EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
        EXPECT_TRUE(kind.effect.ends_with('.') && kind.cause.ends_with('.')) << kind.name;
        EXPECT_NE(kind.make, nullptr) << kind.name;
        std::set<std::string_view> parameters;
        for (const ParameterSpec& spec : kind.parameters) {
            EXPECT_TRUE(parameters.insert(spec.name).second) << kind.name << "." << spec.name;
            EXPECT_FALSE(spec.meaning.empty()) << kind.name << "." << spec.name;
            // Keys that the timeline has taken.
            for (const char* taken : {"kind", "name", "at", "after", "when", "every", "times", "receiver"})
                EXPECT_NE(spec.name, taken) << kind.name;
        }
    }
    EXPECT_GE(count, 19);
}

// All numbers of the arrivals that faults change.
std::vector<double> numbers_of(const Arrivals& arrivals) {
    std::vector<double> numbers;
    for (const Arrival& a : arrivals.satellites) {
        numbers.insert(numbers.end(),
                       {a.false_range.value(), a.false_range_rate.value(), a.iono_delay.value(),
                        a.signal_in_space_error.value(), a.range_rate_error.value(), a.interference_loss.value(),
                        a.cn0 ? a.cn0->value() : -1, a.amplitude_scintillation, a.phase_scintillation.rad(),
                        static_cast<double>(a.paths), a.cut_off ? 1. : 0.});
        for (const SignalArrival& signal : a.signals)
            numbers.push_back(signal.relative_power.value());
        for (const Echo& echo : a.echoes)
            numbers.push_back(echo.amplitude);
    }
    return numbers;
}

// A ramp begins at nothing and ends at the whole.
TEST(SignalFaultKinds, ChangeNothingAtAStrengthOfZero) {
    const std::vector<std::pair<std::string, test::FaultValues>> faults{
        {"outage", {}},
        {"cn0_drop", {{"attenuation_db", 10.}}},
        {"antenna_open", {}},
        {"antenna_short", {}},
        {"jamming", {{"j_to_s_db", 50.}}},
        {"jamming", {{"jammer_at", std::vector<double>{46.48, 30.73}}, {"eirp_dbw", 0.}}},
        {"multipath_burst", {{"share", 1.}}},
        {"surroundings", {{"around", std::string("urban")}}},
        {"spoof_takeover",
         {{"offset_m", std::vector<double>{100, 0, 0}}, {"aligned_s", 0.}, {"time_drift_ns_per_s", 10.}}},
        {"meaconing", {{"rebroadcast_at", std::vector<double>{46.48, 30.73}}}},
        {"spoof_satellite", {{"step_m", 100.}, {"ramp_mps", 1.}}},
        {"satellite_clock_step", {{"step_ns", 100.}}},
        {"satellite_clock_drift", {{"drift_ns_per_s", 100.}}},
        {"wrong_ephemeris", {{"radial_m", 100.}}},
        {"ionospheric_storm", {{"tec_factor", 3.}, {"vertical_delay_m", 5.}, {"gradient_mm_per_km", 100.}}},
        {"scintillation", {}}};
    const Trace trace = faulty_run_at_rest().until(0);
    const std::vector<double> untouched = numbers_of(trace.arrivals);
    for (const auto& [name, values] : faults) {
        for (const double strength : {0., 0.5, 1.}) {
            const Fault fault = signal_fault(name, values);
            Arrivals edited = trace.arrivals;
            // The second epoch: what is told by rates has one.
            for (const double t : {0., 1.}) {
                edited = trace.arrivals;
                fault.arrivals(edited, {advanced(trace.truth.time, Seconds(t)), Seconds(20 + t), strength, &trace.truth,
                                        &trace.sky});
            }
            const std::vector<double> numbers = numbers_of(edited);
            double most = numbers.size() == untouched.size() ? 0 : 1e9;
            for (std::size_t i = 0; most < 1e9 && i < numbers.size(); ++i)
                most = std::max(most, std::abs(numbers[i] - untouched[i]));
            if (strength == 0)
                EXPECT_LT(most, 1e-9) << name;
            else
                EXPECT_GT(most, 0.1) << name << " at " << strength;
        }
    }
}

// The same seed and name give the same edits, whatever happened before.
TEST(SignalFaultKinds, AreRepeatable) {
    const auto bytes = [](std::uint64_t seed) {
        FaultyRun run = faulty_run_at_rest();
        run.add(signal_fault("multipath_burst", {}, seed), 10, 40);
        run.add(signal_fault("cycle_slips", {{"slips_per_minute", 60.}}, seed), 10, 40);
        std::vector<double> seen;
        for (double t = 0; t < 45; ++t)
            for (const Observation& o : run.until(t).epoch.observations.signals)
                seen.insert(seen.end(), {o.pseudorange->value(), o.carrier_phase.value_or(0)});
        return seen;
    };
    EXPECT_EQ(bytes(3), bytes(3));
    EXPECT_NE(bytes(3), bytes(4));
}

}  // namespace
}  // namespace skyloop
