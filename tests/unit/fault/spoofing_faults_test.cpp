// False signals: what they make of the ranges, and of the fix.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion/trajectory/geometric_paths.hpp"
#include "run/fault/detail/false_place.hpp"
#include "signal_fault_run.hpp"

namespace skyloop {
namespace {

using test::faulty_run_at_rest;
using test::FaultyRun;
using testing::HasSubstr;
using Numbers = std::vector<double>;

TEST(FalsePlace, RangesAreThoseThatAnAntennaThereWouldSee) {
    const test::FourSystems systems;
    TruthState here = test::truth_at(test::fault_test_place(), test::signal_fault_start), there = here;
    there.geodetic = Geodetic::degrees(46.9, 30.2, 1500);
    there.position = to_ecef(there.geodetic);
    there.velocity = Velocity<Ecef>(20, -30, 15);
    const SkyView sky = observe_sky(here, systems), told = observe_sky(there, systems);
    int compared = 0;
    for (const SatelliteInView& satellite : sky.satellites)
        for (const SatelliteInView& same : told.satellites) {
            if (!(same.id == satellite.id)) continue;
            ++compared;
            const RangeAndRate seen = light_time_range(satellite, {there.position, there.velocity});
            EXPECT_NEAR(seen.range.value(), same.range.value(), 1e-3);
            EXPECT_NEAR(seen.rate.value(), same.range_rate.value(), 1e-3);
            const RangeAndRate own = light_time_range(satellite, {here.position, here.velocity});
            EXPECT_NEAR(own.range.value(), satellite.range.value(), 1e-6);
            EXPECT_NEAR(own.rate.value(), satellite.range_rate.value(), 1e-6);
        }
    EXPECT_GT(compared, 15);
}

TEST(FalsePlace, AWayBeginsAndEndsAtRest) {
    const SmoothWay way{Metres(100), MetresPerSecond(5), 0.5};
    EXPECT_EQ(way.after(Seconds(-1)), Metres(0));
    EXPECT_NEAR(way.after(Seconds(2)).value(), 1, 1e-9);
    EXPECT_NEAR(way.after(Seconds(15)).value(), 50, 1e-9);
    EXPECT_NEAR(way.after(Seconds(28)).value(), 99, 1e-9);
    EXPECT_EQ(way.after(Seconds(30)), Metres(100));
    const SmoothWay never_fast{Metres(2), MetresPerSecond(5), 0.5};
    EXPECT_NEAR(never_fast.after(Seconds(2)).value(), 1, 1e-9);
    EXPECT_EQ(never_fast.after(Seconds(4)), Metres(2));
    EXPECT_EQ((SmoothWay{Metres(0), MetresPerSecond(5), 0.5}).after(Seconds(9)), Metres(0));
}

// How far the ranges that are used are from fitting each other, m.
double largest_residual(const Trace& trace) {
    double most = 0;
    for (const SatelliteStatus& status : trace.epoch.fix.satellites)
        if (status.used && status.residual) most = std::max(most, std::abs(status.residual->value()));
    return most;
}

int excluded_by_raim(const Trace& trace) {
    int count = 0;
    for (const SatelliteStatus& status : trace.epoch.fix.satellites)
        count += status.cn0 && status.healthy && !status.used && status.elevation > Angle::degrees(6) ? 1 : 0;
    return count;
}

TEST(SpoofingFaults, ATakeoverDrawsTheFixAwayAndNothingNoticesIt) {
    FaultyRun run = faulty_run_at_rest();
    run.add(test::signal_fault("spoof_takeover",
                               {{"offset_m", Numbers{300, -400, -20}}, {"pull_off_mps", 5.}, {"aligned_s", 10.}}),
            20, 180);
    const double clean_residual = largest_residual(run.until(19));
    EXPECT_LT(test::fix_error_enu(run.until(29)).norm(), 20);  // aligned
    for (double t = 30; t <= 150; t += 5) {
        const Trace trace = run.until(t);
        ASSERT_EQ(trace.epoch.fix.type, FixType::fix_3d) << t;
        EXPECT_EQ(excluded_by_raim(trace), 0) << t;
        EXPECT_LT(largest_residual(trace), clean_residual + 18) << t;  // echoes near the horizon have a σ of 7.5 m
        EXPECT_EQ(trace.epoch.front_end.spoofing, SpoofingIndication::none);
    }
    const Eigen::Vector3d error = test::fix_error_enu(run.until(175));
    EXPECT_NEAR(error.x(), -400, 15);
    EXPECT_NEAR(error.y(), 300, 15);
    EXPECT_NEAR(error.z(), 20, 25);
    EXPECT_LT(test::fix_error_enu(run.until(280)).norm(), 20);
}

TEST(SpoofingFaults, ATakeoverIsSmoothInPositionAndVelocity) {
    FaultyRun run = faulty_run_at_rest(false);
    run.add(test::signal_fault("spoof_takeover",
                               {{"offset_m", Numbers{0, 200, 0}}, {"pull_off_mps", 4.}, {"aligned_s", 5.}}),
            10);
    Eigen::Vector3d last = test::fix_error_enu(run.until(14));
    for (double t = 15; t < 90; ++t) {
        const Trace trace = run.until(t);
        const Eigen::Vector3d error = test::fix_error_enu(trace);
        EXPECT_LT((error - last).norm(), 4.8) << t;
        EXPECT_LT(trace.epoch.fix.speed.value(), 4.5) << t;
        for (const Observation& o : trace.epoch.observations.signals)
            EXPECT_FALSE(o.slipped) << t;
        last = error;
    }
    EXPECT_NEAR(last.x(), 200, 1);
}

TEST(SpoofingFaults, ATakeoverToAPlaceEndsThere) {
    FaultyRun run = faulty_run_at_rest();
    run.add(
        test::signal_fault(
            "spoof_takeover",
            {{"to", Numbers{46.4800, 30.7326}}, {"pull_off_mps", 10.}, {"aligned_s", 0.}, {"detected_after_s", 30.}}),
        10);
    EXPECT_EQ(run.until(35).epoch.front_end.spoofing, SpoofingIndication::none);
    const Trace there = run.until(120);
    EXPECT_EQ(there.epoch.front_end.spoofing, SpoofingIndication::indicated);
    EXPECT_NEAR(there.epoch.fix.position.latitude.deg(), 46.4800, 2e-4);
    EXPECT_NEAR(there.epoch.fix.position.longitude.deg(), 30.7326, 2e-4);
    EXPECT_NEAR(there.epoch.fix.position.height.above_ellipsoid.value(), 50, 30);
}

TEST(SpoofingFaults, TimeIsDrawnAwayAlone) {
    FaultyRun clean = faulty_run_at_rest(false), run = faulty_run_at_rest(false);
    run.add(test::signal_fault("spoof_takeover", {{"time_drift_ns_per_s", 20.}, {"aligned_s", 0.}}), 10);
    const Trace late = run.until(60), sound = clean.until(60);
    const double nanosecond = speed_of_light * 1e-9;
    EXPECT_NEAR((late.epoch.fix.clock_bias - sound.epoch.fix.clock_bias).value() / nanosecond, 1000, 5);
    EXPECT_NEAR((late.epoch.fix.clock_drift - sound.epoch.fix.clock_drift).value() / nanosecond, 20, 1);
    EXPECT_LT(test::fix_error_enu(late).norm(), 1);
}

TEST(SpoofingFaults, MeaconingShowsThePlaceOfTheOtherAntennaAndALateClock) {
    FaultyRun clean = faulty_run_at_rest(false), run = faulty_run_at_rest(false);
    run.add(test::signal_fault("meaconing", {{"rebroadcast_at", Numbers{46.4900, 30.7326, 80.}}, {"delay_us", 2.}}), 10,
            60);
    const Trace sound = clean.until(59), trace = run.until(59);
    EXPECT_NEAR(trace.epoch.fix.position.latitude.deg(), 46.4900, 1e-5);
    EXPECT_NEAR(trace.epoch.fix.position.height.above_ellipsoid.value(), 80, 2);
    // 2 µs and the 1400.7 m from there.
    const double way = (to_ecef(Geodetic::degrees(46.4900, 30.7326, 80)) - trace.truth.position).length().value();
    EXPECT_NEAR((trace.epoch.fix.clock_bias - sound.epoch.fix.clock_bias).value(), 599.6 + way, 2);
    EXPECT_LT(test::fix_error_enu(run.until(61 + 60)).norm(), 1);
}

// What moves away from the repeater hears its clock run late, in the Doppler as in the ranges.
TEST(SpoofingFaults, MeaconingShiftsTheDopplerOfAMovingReceiverAsItsRangesGrow) {
    const Circle::Shape shape{test::fault_test_place(), Metres(300), MetresPerSecond(30), Angle::degrees(0)};
    FaultyRun run(std::make_unique<Circle>(test::signal_fault_start, shape), false);
    run.add(test::signal_fault("meaconing", {{"rebroadcast_at", Numbers{46.4900, 30.7326, 80.}}}), 10, 60);
    const auto fix_at = [&run](double t) { return run.until(t).epoch.fix; };
    Fix before = fix_at(19);
    double fastest = 0;
    for (int t = 20; t < 40; ++t) {
        const Fix fix = fix_at(t);
        const double grown = (fix.clock_bias - before.clock_bias).value();
        EXPECT_NEAR(grown, (fix.clock_drift + before.clock_drift).value() / 2, 0.3) << t;
        fastest = std::max(fastest, std::abs(grown));
        before = fix;
    }
    EXPECT_GT(fastest, 15);
}

TEST(SpoofingFaults, AJumpBreaksTheCountOfCyclesOnce) {
    FaultyRun run = faulty_run_at_rest(false);
    run.add(test::signal_fault("meaconing", {{"delay_us", 1.}}), 30);
    const auto slips = [&run](double t) {
        int count = 0;
        for (const Observation& o : run.until(t).epoch.observations.signals)
            count += o.slipped ? 1 : 0;
        return count;
    };
    EXPECT_EQ(slips(29), 0);
    EXPECT_GT(slips(30), 10);
    EXPECT_EQ(slips(31), 0);
}

// Along a ramp the Doppler is that of the ranges, so that the count of cycles goes on.
TEST(SpoofingFaults, DopplerFollowsTheRangesAlongRamps) {
    const std::vector<std::pair<const char*, test::FaultValues>> stories{
        {"spoof_satellite", {{"step_m", 100.}, {"ramp_mps", 2.}, {"satellite_count", 3.}}},
        {"meaconing", {{"delay_us", 1.}}},
        {"meaconing", {{"rebroadcast_at", Numbers{46.4900, 30.7326, 80.}}}},
        {"spoof_takeover", {{"time_drift_ns_per_s", 20.}, {"aligned_s", 0.}}}};
    for (const auto& [name, values] : stories) {
        FaultyRun run = faulty_run_at_rest(false);
        run.add(test::signal_fault(name, values), 30, 1e9, 10);
        std::vector<Observation> before = run.until(31).epoch.observations.signals;
        int compared = 0;
        for (int t = 32; t < 40; ++t) {
            const std::vector<Observation> now = run.until(t).epoch.observations.signals;
            for (const Observation& o : now)
                for (const Observation& last : before) {
                    if (!(o.satellite == last.satellite) || o.signal != last.signal) continue;
                    ASSERT_TRUE(o.pseudorange && o.doppler);
                    const double wavelength = speed_of_light / o.carrier.value();
                    const double by_doppler = -wavelength * (*o.doppler + *last.doppler).value() / 2;
                    EXPECT_NEAR((*o.pseudorange - *last.pseudorange).value(), by_doppler, 0.5) << name << " " << t;
                    EXPECT_FALSE(o.slipped) << name << " " << t;
                    ++compared;
                }
            before = now;
        }
        EXPECT_GT(compared, 80) << name;
    }
}

TEST(SpoofingFaults, ASingleFalseSatelliteIsExcluded) {
    FaultyRun run = faulty_run_at_rest();
    const Trace before = run.until(19);
    run.add(test::signal_fault("spoof_satellite", {{"step_m", 150.}}), 20, 60);
    const Trace spoofed = run.until(40);
    EXPECT_EQ(spoofed.epoch.fix.type, FixType::fix_3d);
    EXPECT_EQ(excluded_by_raim(before), 0);
    EXPECT_EQ(excluded_by_raim(spoofed), 1);
    EXPECT_LT(test::fix_error_enu(spoofed).norm(), 20);
    EXPECT_EQ(excluded_by_raim(run.until(70)), 0);
}

TEST(SpoofingFaults, AFlappingIndicationComesAndGoes) {
    const Fault fault =
        test::signal_fault("spoof_flapping", {{"period_s", 2.}, {"indication", std::string("several")}});
    EXPECT_FALSE(fault.arrivals);
    int flips = 0;
    SpoofingIndication last = SpoofingIndication::none;
    for (int tenths = 0; tenths < 100; ++tenths) {
        Epoch epoch;
        fault.epoch(epoch, {test::signal_fault_start, Seconds(tenths / 10.)});
        flips += epoch.front_end.spoofing != last ? 1 : 0;
        last = epoch.front_end.spoofing;
        EXPECT_TRUE(last == SpoofingIndication::none || last == SpoofingIndication::several);
    }
    EXPECT_EQ(flips, 10);
}

TEST(SpoofingFaults, StoriesThatAreNotToldOrToldTwiceAreRefused) {
    using test::refusal_of;
    EXPECT_THAT(refusal_of("spoof_takeover", {}), HasSubstr("nothing is to be taken over"));
    EXPECT_THAT(refusal_of("spoof_takeover", {{"to", Numbers{46, 30}}, {"offset_m", Numbers{1, 2, 3}}}),
                HasSubstr("both"));
    EXPECT_THAT(refusal_of("spoof_takeover", {{"to", Numbers{96, 30}}}), HasSubstr("latitude"));
    EXPECT_THAT(refusal_of("spoof_takeover", {{"offset_m", Numbers{1, 2}}}), HasSubstr("expected"));
    EXPECT_THAT(refusal_of("meaconing", {{"rebroadcast_at", Numbers{-91, 30}}}), HasSubstr("latitude"));
    EXPECT_THAT(refusal_of("spoof_satellite", {}), HasSubstr("no range is told"));
    EXPECT_THAT(
        refusal_of("spoof_satellite", {{"step_m", 1.}, {"satellites", std::string("G01")}, {"satellite_count", 2.}}),
        HasSubstr("both"));
    EXPECT_THAT(refusal_of("spoof_satellite", {{"step_m", 1.}, {"satellite_count", 1.5}}), HasSubstr("whole"));
}

}  // namespace
}  // namespace skyloop
