#include "receiver/pvt/single_point.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/core/random.hpp"
#include "synthetic_sky.hpp"

namespace skyloop {
namespace {

using test::measure;
using test::receiver_at;
using test::sample_time;
using test::synthetic_sky;
using test::TrueReceiver;

std::vector<RangeEquation> equations_of(const NavigationSource& sky, const Observations& observations) {
    BroadcastTransmitters transmitters(sky);
    std::vector<RangeEquation> equations;
    for (const Observation& o : observations.signals) {
        const auto t = transmitters.at(o.satellite, o.signal, observations.receive_time, *o.pseudorange);
        if (t) equations.push_back({o.satellite, *t, *o.pseudorange, o.carrier, Metres(0), false});
    }
    return equations;
}

std::vector<DopplerEquation> dopplers_of(const Observations& observations, const std::vector<RangeEquation>& equations,
                                         const SinglePoint& point) {
    std::vector<DopplerEquation> shifts;
    for (std::size_t i = 0; i < equations.size(); ++i) {
        const Observation& o = observations.signals[i];
        const RangeOutcome& r = point.ranges[i];
        shifts.push_back({r.line, r.satellite, r.satellite_velocity, equations[i].transmitter.clock_drift,
                          MetresPerSecond(-speed_of_light / o.carrier.value() * o.doppler->value()),
                          MetresPerSecond(0.05)});
    }
    return shifts;
}

double error_of(const SinglePoint& point, const TrueReceiver& receiver) {
    return (point.position.vector() - receiver.position).norm();
}

struct Place {
    double latitude, longitude, height;
};

TEST(SinglePoint, FindsPerfectReceiversAnywhereFromTheEarthsCentre) {
    const auto sky = synthetic_sky(sample_time, test::four_systems);
    for (const Place& p :
         {Place{46.5, 30.7, 50}, Place{90, 0, 10}, Place{-90, 0, 2800}, Place{0, 180, 0},
          Place{-33, -179.9999999, 1000}, Place{89.9999, 45, 0}, Place{10, 20, 1e6}, Place{5, -70, -100}}) {
        for (const int minutes : {0, 13, -14}) {
            TrueReceiver receiver = receiver_at(Geodetic::degrees(p.latitude, p.longitude, p.height),
                                                sample_time + std::chrono::minutes(minutes));
            receiver.velocity = {40, -30, 20};
            const Observations observations = measure(sky, receiver);
            const auto equations = equations_of(sky, observations);
            ASSERT_GT(equations.size(), 15U);
            const auto point = solve_single_point(equations, {.time = receiver.time});
            ASSERT_TRUE(point);
            EXPECT_LT(error_of(*point, receiver), 1e-6) << p.latitude << ' ' << p.longitude;
            EXPECT_NEAR(point->clock().value(), receiver.clock_bias_m, 1e-6);
            EXPECT_EQ(point->used, static_cast<int>(equations.size()));
            EXPECT_LT(point->statistic, 1e-10);

            const auto velocity = solve_velocity(dopplers_of(observations, equations, *point));
            ASSERT_TRUE(velocity);
            EXPECT_LT((velocity->velocity.vector() - receiver.velocity).norm(), 1e-6);
            EXPECT_NEAR(velocity->clock_drift.value(), receiver.clock_drift_mps, 1e-6);
        }
    }
}

TEST(SinglePoint, CrossesTheEndOfTheWeek) {
    const GpsTime sunday = to_gps_time(2048, 0.0);
    const auto sky = synthetic_sky(sunday - std::chrono::minutes(5), test::four_systems);
    for (const int tenths : {-2, -1, 0, 1}) {
        const TrueReceiver receiver =
            receiver_at(Geodetic::degrees(-20, 100, 30), sunday + tenths * std::chrono::milliseconds(100));
        const auto point = solve_single_point(equations_of(sky, measure(sky, receiver)), {.time = receiver.time});
        ASSERT_TRUE(point);
        EXPECT_LT(error_of(*point, receiver), 1e-6);
    }
}

TEST(SinglePoint, GivesEachSystemItsClockAndLeavesOutWhoStandsAlone) {
    auto sky = synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver receiver = receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    test::MeasureOptions options;
    options.biases = std::vector<double>{0, 3, -8, 5};
    Observations observations = measure(sky, receiver, options);
    // Of Galileo one satellite stays.
    bool kept = false;
    std::erase_if(observations.signals, [&](const Observation& o) {
        if (o.satellite.constellation != Constellation::galileo) return false;
        return std::exchange(kept, true);
    });
    const auto equations = equations_of(sky, observations);
    const auto point = solve_single_point(equations, {.time = sample_time});
    ASSERT_TRUE(point);
    // The instants of transmission are taken from ranges with these biases in them.
    EXPECT_LT(error_of(*point, receiver), 1e-5);
    EXPECT_FALSE(point->clocks[1]);
    EXPECT_NEAR((*point->clocks[2] - *point->clocks[0]).value(), -8, 1e-5);
    EXPECT_NEAR((*point->clocks[3] - *point->clocks[0]).value(), 5, 1e-5);
    EXPECT_EQ(point->used, static_cast<int>(equations.size()) - 1);
    for (std::size_t i = 0; i < equations.size(); ++i)
        EXPECT_EQ(point->ranges[i].used, equations[i].satellite.constellation != Constellation::galileo);
    EXPECT_EQ(point->redundancy, point->used - 6);
}

TEST(SinglePoint, HasTheDopsOfOneClock) {
    const auto sky = synthetic_sky(sample_time, {Constellation::gps});
    const TrueReceiver receiver = receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    const auto point = solve_single_point(equations_of(sky, measure(sky, receiver)), {.time = sample_time});
    ASSERT_TRUE(point);
    std::vector<SkyDirection> directions;
    for (const RangeOutcome& r : point->ranges)
        directions.push_back(r.direction);
    const auto dop = dilution_of_precision(directions);
    ASSERT_TRUE(dop);
    EXPECT_NEAR(point->dop.gdop, dop->gdop, 1e-8);
    EXPECT_NEAR(point->dop.pdop, dop->pdop, 1e-8);
    EXPECT_NEAR(point->dop.hdop, dop->hdop, 1e-8);
    EXPECT_NEAR(point->dop.vdop, dop->vdop, 1e-8);
    EXPECT_NEAR(point->dop.tdop, dop->tdop, 1e-8);
    EXPECT_NEAR(point->dop.edop, dop->edop, 1e-8);
    EXPECT_NEAR(point->dop.ndop, dop->ndop, 1e-8);
}

// East, north and one clock are left of the unknowns.
TEST(SinglePoint, HasTheDopsOfTheTwoDirectionsThatAHeldHeightLeaves) {
    const auto sky = synthetic_sky(sample_time, {Constellation::gps});
    const TrueReceiver receiver = receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    auto equations = equations_of(sky, measure(sky, receiver));
    equations.resize(3);
    SinglePointSetup held{.time = sample_time};
    held.held_height = HeldHeight{EllipsoidalHeight{Metres(80)}, Metres(4)};
    held.start = Position<Ecef>(receiver.position);
    const auto point = solve_single_point(equations, held);
    ASSERT_TRUE(point);
    Eigen::Matrix3d rows;
    for (int i = 0; i < 3; ++i) {
        const SkyDirection& d = point->ranges[static_cast<std::size_t>(i)].direction;
        const double cos_el = std::cos(d.elevation.rad());
        rows.row(i) << cos_el * std::sin(d.azimuth.rad()), cos_el * std::cos(d.azimuth.rad()), 1;
    }
    const Eigen::Matrix3d q = (rows.transpose() * rows).inverse();
    EXPECT_NEAR(point->dop.edop, std::sqrt(q(0, 0)), 1e-6);
    EXPECT_NEAR(point->dop.ndop, std::sqrt(q(1, 1)), 1e-6);
    EXPECT_NEAR(point->dop.hdop, std::sqrt(q(0, 0) + q(1, 1)), 1e-6);
    EXPECT_NEAR(point->dop.tdop, std::sqrt(q(2, 2)), 1e-6);
    EXPECT_GT(point->dop.hdop, 0.5);
    for (const double unknown : {point->dop.gdop, point->dop.pdop, point->dop.vdop})
        EXPECT_TRUE(std::isnan(unknown));
    const Eigen::Vector3d up = LocalFrame(to_geodetic(point->position)).to_ecef(Displacement<Enu>(0, 0, 1)).vector();
    EXPECT_NEAR(up.dot(point->covariance * up), 16, 1e-6);
}

TEST(SinglePoint, NeedsARangeForEachUnknown) {
    const auto sky = synthetic_sky(sample_time, {Constellation::gps});
    const TrueReceiver receiver = receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    auto equations = equations_of(sky, measure(sky, receiver));
    ASSERT_GE(equations.size(), 5U);
    equations.resize(4);
    const auto four = solve_single_point(equations, {.time = sample_time});
    ASSERT_TRUE(four);
    EXPECT_EQ(four->redundancy, 0);
    equations.resize(3);
    EXPECT_FALSE(solve_single_point(equations, {.time = sample_time}));

    SinglePointSetup held{.time = sample_time};
    held.held_height = HeldHeight{EllipsoidalHeight{Metres(80)}, Metres(2)};
    EXPECT_FALSE(solve_single_point(equations, held)) << "a height needs a place";
    held.start = Position<Ecef>(Eigen::Vector3d(receiver.position + Eigen::Vector3d(500, 300, -200)));
    const auto flat = solve_single_point(equations, held);
    ASSERT_TRUE(flat);
    EXPECT_LT(error_of(*flat, receiver), 1e-6);
    EXPECT_TRUE(flat->height_held);
    equations.resize(2);
    EXPECT_FALSE(solve_single_point(equations, held));
    EXPECT_FALSE(solve_single_point({}, {.time = sample_time}));
}

TEST(SinglePoint, RefusesTheSameDirectionFourTimes) {
    const auto sky = synthetic_sky(sample_time, {Constellation::gps});
    const TrueReceiver receiver = receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    const auto equations = equations_of(sky, measure(sky, receiver));
    const std::vector<RangeEquation> same(5, equations.front());
    EXPECT_FALSE(solve_single_point(same, {.time = sample_time}));
}

TEST(SinglePoint, MasksLowAndUnhealthySatellites) {
    auto sky = synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver receiver = receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    auto equations = equations_of(sky, measure(sky, receiver));
    equations[3].transmitter.healthy = false;
    equations[3].pseudorange += Metres(1000);
    const auto point = solve_single_point(equations, {.time = sample_time, .elevation_mask = Angle::degrees(20)});
    ASSERT_TRUE(point);
    EXPECT_LT(error_of(*point, receiver), 1e-6);
    for (std::size_t i = 0; i < equations.size(); ++i)
        EXPECT_EQ(point->ranges[i].used, i != 3 && point->ranges[i].direction.elevation >= Angle::degrees(20));
    EXPECT_NEAR(point->ranges[3].residual.value(), 1000, 1e-3);
}

TEST(SinglePoint, HasNoSolutionWhereTheMaskLeavesTooFew) {
    const auto sky = synthetic_sky(sample_time, {Constellation::gps});
    const TrueReceiver receiver = receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    auto equations = equations_of(sky, measure(sky, receiver));
    const auto point = solve_single_point(equations, {.time = sample_time});
    ASSERT_TRUE(point);
    // Three that are high and one that is low find each other, and the mask then takes the low one away.
    std::vector<RangeEquation> high, low;
    for (std::size_t i = 0; i < equations.size(); ++i)
        (point->ranges[i].direction.elevation >= Angle::degrees(25) ? high : low).push_back(equations[i]);
    ASSERT_GE(high.size(), 3U);
    ASSERT_GE(low.size(), 1U);
    high.resize(3);
    high.push_back(low.front());
    EXPECT_TRUE(solve_single_point(high, {.time = sample_time}));
    EXPECT_FALSE(solve_single_point(high, {.time = sample_time, .elevation_mask = Angle::degrees(25)}));
}

TEST(SinglePoint, TakesOffWhatTheSameFormulasPutOn) {
    auto sky = synthetic_sky(sample_time, test::four_systems);
    sky.air.gps = default_klobuchar_coefficients();
    sky.air.beidou = default_klobuchar_coefficients();
    sky.air.galileo = std::array<double, 3>{80, 0.3, 0.002};
    const Geodetic place = Geodetic::degrees(46, 30, 80);
    const TrueReceiver receiver = receiver_at(place, sample_time);
    for (const auto ionosphere : {IonosphereCorrection::klobuchar, IonosphereCorrection::broadcast})
        for (const auto troposphere : {TroposphereCorrection::saastamoinen, TroposphereCorrection::niell}) {
            const RangeCorrections corrections({ionosphere, troposphere}, {sky.air});
            const SiteCorrections site = corrections.at(place, sample_time);
            double most = 0;
            const Observations observations =
                measure(sky, receiver, {}, [&](const SatelliteId& id, const SkyDirection& d, Hertz carrier) {
                    const double delay =
                        site.ionosphere(id.constellation, d, carrier).value() + site.troposphere(d.elevation).value();
                    most = std::max(most, delay);
                    return delay;
                });
            EXPECT_GT(most, 20);
            SinglePointSetup setup{.time = sample_time, .elevation_mask = Angle::degrees(4)};
            const auto equations = equations_of(sky, observations);
            const auto raw = solve_single_point(equations, setup);
            setup.corrections = &corrections;
            const auto corrected = solve_single_point(equations, setup);
            ASSERT_TRUE(raw && corrected);
            EXPECT_GT(error_of(*raw, receiver), 3);
            EXPECT_LT(error_of(*corrected, receiver), 1e-6);
        }
}

TEST(SinglePoint, SolvesClocksWhereTheAntennaWasSurveyed) {
    const auto sky = synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver receiver = receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    auto equations = equations_of(sky, measure(sky, receiver));
    equations.resize(1);
    SinglePointSetup setup{.time = sample_time};
    EXPECT_FALSE(solve_clocks(equations, setup));
    setup.start = Position<Ecef>(receiver.position);
    const auto clocks = solve_clocks(equations, setup);
    ASSERT_TRUE(clocks);
    EXPECT_NEAR(clocks->clock().value(), receiver.clock_bias_m, 1e-6);
    EXPECT_EQ(clocks->used, 1);
    EXPECT_EQ(clocks->dop.tdop, 1);
}

TEST(SinglePoint, TellsTheDilutionOfTheTimeThatItSolvesAlone) {
    const auto sky = synthetic_sky(sample_time, {Constellation::gps});
    const TrueReceiver receiver = receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    auto equations = equations_of(sky, measure(sky, receiver));
    ASSERT_GE(equations.size(), 4u);
    equations.resize(4);
    const auto clocks = solve_clocks(equations, {.time = sample_time, .start = Position<Ecef>(receiver.position)});
    ASSERT_TRUE(clocks);
    EXPECT_DOUBLE_EQ(clocks->dop.tdop, 1 / std::sqrt(static_cast<double>(clocks->used)));
    EXPECT_EQ(clocks->dop.gdop, clocks->dop.tdop);
}

TEST(SinglePointVelocity, HoldsTheVerticalForThreeShifts) {
    const auto sky = synthetic_sky(sample_time, {Constellation::gps});
    const Geodetic place = Geodetic::degrees(46, 30, 80);
    TrueReceiver receiver = receiver_at(place, sample_time);
    receiver.velocity = LocalFrame(place).to_ecef(Velocity<Enu>(12, -7, 0)).vector();
    const Observations observations = measure(sky, receiver);
    const auto equations = equations_of(sky, observations);
    const auto point = solve_single_point(equations, {.time = sample_time});
    ASSERT_TRUE(point);
    auto shifts = dopplers_of(observations, equations, *point);
    shifts.resize(3);
    EXPECT_FALSE(solve_velocity(shifts));
    const Eigen::Vector3d up = LocalFrame(place).to_ecef(Displacement<Enu>(0, 0, 1)).vector();
    const auto velocity = solve_velocity(shifts, up);
    ASSERT_TRUE(velocity);
    EXPECT_LT((velocity->velocity.vector() - receiver.velocity).norm(), 1e-6);
}

}  // namespace
}  // namespace skyloop
