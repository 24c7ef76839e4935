#include "world/propagation/precise_effects.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "modern_sky.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/sun_and_moon.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::after;
using test::april_noon;
using test::odessa_place;

// DEHANTTIDEINEL.F of the software of the IERS Conventions (2010), its test cases: all terms of the two steps. Sun and
// Moon stand where the cases have them, which is not where they stood then.
TEST(SolidTide, IsThatOfTheIersWithin2Millimetres) {
    struct Case {
        UtcTime time;
        Position<Ecef> place, sun, moon;
        Eigen::Vector3d moved;
    };
    for (const Case& c : {Case{{2009, 4, 13, 0, 0, 0},
                               {4075578.385, 931852.890, 4801570.154},
                               {137859926952.015, 54228127881.4350, 23509422341.6960},
                               {-179996231.920342, -312468450.131567, -169288918.592160},
                               {0.07700420357108125891, 0.06304056321824967613, 0.05516568152597246810}},
                          Case{{2012, 7, 13, 0, 0, 0},
                               {1112189.660, -4842955.026, 3985352.284},
                               {-54537460436.2357, 130244288385.279, 56463429031.5996},
                               {300396716.912, 243238281.451, 120548075.939},
                               {-0.02036831479592075833, 0.05658254776225972449, -0.07597679676871742227}},
                          Case{{2015, 7, 15, 0, 0, 0},
                               {1112200.5696, -4842957.8511, 3985345.9122},
                               {100210282451.6279, 103055630398.3160, 56855096480.4475},
                               {369817604.4348, 1897917.5258, 120804980.8284},
                               {0.00509570869172363845, 0.0828663025983528700, -0.0636634925404189617}}}) {
        const Angle turned = Angle::radians(sidereal_time(to_gps_time(c.time, LeapSeconds::announced())));
        const Eigen::Vector3d moved = solid_tide(c.place, {c.sun, c.moon, turned}).vector();
        EXPECT_LT((moved - c.moved).norm(), 0.002) << c.time.year;
        EXPECT_GT(moved.norm(), 0.08);
    }
}

TEST(SolidTideEffect, ShortensWhatStandsWhereThePlaceIsMovedTo) {
    SkyView sky;
    sky.satellites.push_back(test::satellite_at({Constellation::gps, 1}, 0, 90));
    const TruthState truth = test::truth_of(odessa_place, april_noon);
    SolidTideEffect effect({});
    const Displacement<Ecef> moved = solid_tide(truth.position, TideRaisers::at(truth.time));
    const double up = LocalFrame(truth.geodetic).to_enu(moved).vector().z();
    EXPECT_NEAR(after(effect, sky, truth).satellites[0].solid_tide.value(), -up, 1e-4);
    EXPECT_GT(std::abs(up), 0.01);
    ErrorTerm off;
    off.enabled = false;
    SolidTideEffect none(off);
    EXPECT_EQ(after(none, sky, truth).satellites[0].solid_tide.value(), 0);
}

// An antenna on the equator, a satellite at its zenith: as the Sun goes round the axis, the satellite turns with it.
TEST(WindUp, TurnsWithTheSatellite) {
    const Geodetic place = Geodetic::degrees(0, 0, 0);
    const Position<Ecef> antenna = to_ecef(place), satellite(2.6e7, 0, 0);
    const auto at = [&](double degrees) {
        const double a = degrees * std::numbers::pi / 180;
        return wind_up_cycles(satellite, antenna, place, Position<Ecef>(0, 1e15 * std::cos(a), 1e15 * std::sin(a)));
    };
    const double first = at(10);
    for (const double degrees : {20., 100., 170.}) {
        const double turned = at(degrees) - first;
        EXPECT_NEAR(std::abs(std::remainder(turned, 1)), std::abs(std::remainder((degrees - 10) / 360, 1)), 1e-6);
    }
    EXPECT_NEAR(at(10), at(370), 1e-9);
}

TEST(CarrierWindUp, GoesOnOverWholeCycles) {
    CarrierWindUp effect({});
    SkyView sky;
    sky.satellites.push_back(test::satellite_at({Constellation::gps, 1}, 120, 60));
    // A year of Suns in an hour: no satellite turns like that, but the phase has to go on.
    double last = 0, least = 0, most = 0;
    for (int day = 0; day < 366; ++day) {
        const TruthState truth = test::truth_of(odessa_place, april_noon + day * 86400s);
        const double cycles = after(effect, sky, truth).satellites[0].wind_up;
        if (day > 0) {
            EXPECT_LT(std::abs(cycles - last), 0.1) << day;
        }
        last = cycles;
        least = std::min(least, cycles);
        most = std::max(most, cycles);
    }
    EXPECT_GT(most - least, 0.3);
}

std::shared_ptr<const AntennaCatalogue> one_satellite_antenna() {
    AntennaCalibration antenna;
    PhaseCentre l1, l2;
    l1.offset = {0.4, 0.1, 2};
    l1.zenith_step = Angle::degrees(1);
    l1.by_zenith = std::vector<double>(15, 0.003);
    l2.offset = {0, 0, 1};
    antenna.add(Constellation::gps, 1, l1);
    antenna.add(Constellation::gps, 2, l2);
    auto catalogue = std::make_shared<AntennaCatalogue>();
    catalogue->satellites.add({Constellation::gps, 1}, {GpsTime::min(), std::nullopt, antenna});
    return catalogue;
}

TEST(SatelliteAntennaPhase, MovesTheEndOfTheRange) {
    SkyView sky;
    sky.satellites.push_back(test::satellite_at({Constellation::gps, 1}, 200, 35));
    sky.satellites.push_back(test::satellite_at({Constellation::gps, 2}, 100, 35));
    const TruthState truth = test::truth_of(odessa_place, april_noon);
    SatelliteAntennaPhase effect(one_satellite_antenna(), {});
    EXPECT_EQ(after(effect, sky, truth).satellites[0].signals[0].satellite_antenna.value(), 0)
        << "a record tells the phase centre";
    for (SatelliteInView& satellite : sky.satellites)
        satellite.record_error = RecordError{};
    const Arrivals arrivals = after(effect, sky, truth);
    EXPECT_EQ(arrivals.satellites[1].signals[0].satellite_antenna.value(), 0) << "not in the catalogue";

    // Where the phase centre is, and from there to the antenna.
    const SatelliteInView& seen = sky.satellites[0];
    const Eigen::Vector3d place = turned_by(seen.position_at_transmission.vector(), seen.travel_time.value());
    const SatelliteAxes axes = yaw_steering(Position<Ecef>(place), sun_position(truth.time));
    const auto longer = [&](const Eigen::Vector3d& o) {
        const Eigen::Vector3d centre = place + o.x() * axes.x + o.y() * axes.y + o.z() * axes.z;
        return (centre - truth.position.vector()).norm() - (place - truth.position.vector()).norm();
    };
    const auto& signals = arrivals.satellites[0].signals;
    EXPECT_NEAR(signals[0].satellite_antenna.value(), longer({0.4, 0.1, 2}) + 0.003, 1e-6);
    EXPECT_NEAR(signals[1].satellite_antenna.value(), longer({0, 0, 1}), 1e-6);
    EXPECT_LT(signals[1].satellite_antenna.value(), -0.95) << "nearer than the centre of mass";
}

TEST(ReceiverAntennaPhase, MovesTheOtherEnd) {
    AntennaCalibration antenna;
    PhaseCentre centre;
    centre.offset = {0.01, -0.02, 0.1};  // north, east, up
    centre.by_zenith = std::vector<double>(19, 0);
    centre.by_zenith[11] = 0.004;  // 55° from the zenith
    antenna.add(Constellation::gps, 1, centre);
    ReceiverAntennaPhase effect(antenna, {});
    SkyView sky;
    sky.satellites.push_back(test::satellite_at({Constellation::gps, 1}, 90, 35));
    sky.satellites.push_back(test::satellite_at({Constellation::galileo, 1}, 0, 90));
    const Arrivals arrivals = after(effect, sky, test::truth_of(odessa_place, april_noon));
    const double e = 35 * std::numbers::pi / 180;
    EXPECT_NEAR(arrivals.satellites[0].signals[0].receiver_antenna.value(),
                0.02 * std::cos(e) - 0.1 * std::sin(e) + 0.004, 1e-9);
    EXPECT_NEAR(arrivals.satellites[1].signals[0].receiver_antenna.value(), -0.1, 1e-9) << "by that of GPS";
}

}  // namespace
}  // namespace skyloop
