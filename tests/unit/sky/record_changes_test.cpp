#include "world/sky/observe_sky.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/geodetic.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

const GpsTime noon = to_gps_time(2300, 43200.0);

// A satellite whose records of every two hours, the nearest serving, differ by so much: along the track, and in the
// clock.
struct Steps {
    double along_m = 0, clock_ns = 0;
};

NavigationData stepping(const Steps& steps) {
    std::vector<Ephemeris> records;
    for (int i = -1; i <= 1; ++i) {
        KeplerEphemeris r;
        r.satellite = {Constellation::gps, 5};
        r.toe = r.toc = noon + std::chrono::hours(2 * i);
        r.iode = i + 10;
        r.sqrt_a = 5153.6;
        r.e = 0.01;
        r.i0 = 0.96;
        const double motion = std::sqrt(gravitational_constant_gps) / std::pow(r.sqrt_a, 3);
        r.m0 = motion * 7200 * i + steps.along_m * i / (r.sqrt_a * r.sqrt_a);
        r.omega0 = 1.2;
        r.af0 = 1e-5 + steps.clock_ns * 1e-9 * i;
        records.emplace_back(r);
    }
    return {records, std::nullopt, "stepping"};
}

// Under its way at noon and an hour later, and moving.
TruthState below(GpsTime time, const NavigationSource& source) {
    const auto record = source.ephemeris({Constellation::gps, 5}, noon).value();
    const Eigen::Vector3d up = satellite_state(record, noon + minutes(60)).position.vector().normalized();
    TruthState truth;
    truth.time = time;
    truth.velocity = Velocity<Ecef>(120, -30, 40);
    const Eigen::Vector3d moved = truth.velocity.vector() * difference(time, noon).value();
    truth.position = Position<Ecef>(Eigen::Vector3d(up * 6.378e6 + moved));
    truth.geodetic = to_geodetic(truth.position);
    return truth;
}

SatelliteInView seen(SkyObserver& observer, GpsTime time, const NavigationSource& source) {
    const SkyView sky = observer.observe(below(time, source), source);
    EXPECT_EQ(sky.satellites.size(), 1U);
    return sky.satellites.empty() ? SatelliteInView() : sky.satellites.front();
}

double plain(const SatelliteInView& s) { return s.range.value() - speed_of_light * s.clock_bias.value(); }
double joined(const SatelliteInView& s) { return plain(s) + s.earlier_records.range.value(); }
double joined_rate(const SatelliteInView& s) {
    return s.range_rate.value() - speed_of_light * s.clock_drift + s.earlier_records.range_rate.value();
}

// The first instant of the record of two o'clock.
const GpsTime change = noon + minutes(60);

TEST(RecordChanges, TheRangeGoesOnWhereTheRecordSteps) {
    const NavigationData source = stepping({4, 3});
    SkyObserver observer;
    SatelliteInView last = seen(observer, change - milliseconds(100), source);
    EXPECT_EQ(last.earlier_records.range, Metres(0));
    double largest = 0, step = 0;
    for (int i = 0; i <= 3100; ++i) {
        const SatelliteInView now = seen(observer, change + milliseconds(100 * i), source);
        // The mean of the two rates, whose own change is that of an orbit.
        const double foretold = 0.05 * (joined_rate(last) + joined_rate(now));
        EXPECT_NEAR(joined(now) - joined(last), foretold, 2e-5) << i;
        step = std::max(step, std::abs(plain(now) - plain(last) - foretold));
        largest = std::max(largest, std::abs(now.earlier_records.range.value()));
        last = now;
    }
    EXPECT_GT(step, 0.8);  // of the record itself, 3 ns and some of the 4 m
    EXPECT_NEAR(largest, step, 0.01);
    EXPECT_EQ(last.earlier_records.range, Metres(0));
    EXPECT_EQ(last.earlier_records.range_rate, MetresPerSecond(0));
}

TEST(RecordChanges, WhoeverLooksFirstAfterwardsSeesTheSame) {
    const NavigationData source = stepping({4, 3});
    SkyObserver followed;
    for (int i = -20; i <= 320; ++i) {
        const GpsTime now = change + seconds(i) + milliseconds(7);
        const SatelliteInView here = seen(followed, now, source);
        SkyObserver fresh;
        EXPECT_EQ(here.earlier_records.range, seen(fresh, now, source).earlier_records.range) << i;
        if (i >= 0 && i < 299) {
            EXPECT_NE(here.earlier_records.range, Metres(0)) << i;
        }
    }
}

TEST(RecordChanges, LooksAgainWhenTimeGoesBack) {
    const NavigationData source = stepping({4, 3});
    SkyObserver observer;
    const auto at = [&](Nanoseconds later) { return seen(observer, change + later, source).earlier_records.range; };
    const Metres first = at(seconds(10));
    EXPECT_EQ(at(seconds(400)), Metres(0));
    EXPECT_EQ(at(seconds(10)), first);
    EXPECT_EQ(at(seconds(-1)), Metres(0));
}

TEST(RecordChanges, EqualOrbitsLeaveNothing) {
    const NavigationData source = stepping({});
    SkyObserver observer;
    for (int i = -1; i < 300; i += 7)
        EXPECT_NEAR(seen(observer, change + seconds(i), source).earlier_records.range.value(), 0, 1e-6);
}

TEST(RecordChanges, WhatIsTooFarApartJumps) {
    const NavigationData source = stepping({0, 200});
    SkyObserver observer;
    EXPECT_FALSE(seen(observer, change - seconds(1), source).earlier_records.jumped);
    for (int i = 0; i < 300; i += 20) {
        const EarlierRecords earlier = seen(observer, change + seconds(i), source).earlier_records;
        EXPECT_EQ(earlier.range, Metres(0));
        EXPECT_EQ(earlier.jumped, change);
    }
    EXPECT_FALSE(seen(observer, change + seconds(300), source).earlier_records.jumped);
}

}  // namespace
}  // namespace skyloop
