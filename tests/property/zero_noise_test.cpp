// Without noise and delay the fix is the truth: of all systems, anywhere, at any time, at rest and on the move.
#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "support/modern_run.hpp"

namespace skyloop::test {
namespace {

constexpr double largest_error_m = 1e-3;

struct Case {
    Geodetic place;
    GpsTime start;
};

// Places and times all over the globe and the years from 1999 to 2038, and the corners of both.
std::vector<Case> cases() {
    RandomStream random(7, "zero noise");
    std::vector<Case> all;
    for (int i = 0; i < 60; ++i) {
        const double latitude = std::asin(2 * random.uniform() - 1) * 180 / 3.14159265358979;
        all.push_back(
            {Geodetic::degrees(latitude, 360 * random.uniform() - 180, 9000 * random.uniform() - 400),
             to_gps_time(1024 + static_cast<int>(2000 * random.uniform()), std::floor(604800 * random.uniform()))});
    }
    const GpsTime rollover = to_gps_time(2048, 0.0) - std::chrono::seconds(3);
    for (const auto& [latitude, longitude] :
         {std::pair{90.0, 0.0}, {-90.0, 0.0}, {89.99999, 77.0}, {0.0, 180.0}, {0.0, -179.9999999}, {0.0, 0.0}})
        all.push_back({Geodetic::degrees(latitude, longitude, 10), rollover});
    const GpsTime midnight = to_gps_time({2016, 12, 31, 23, 59, 57, 0}, LeapSeconds::announced());
    all.push_back({Geodetic::degrees(46.4775, 30.7326, 77), midnight});
    return all;
}

class StraightFlight : public Trajectory {
public:
    StraightFlight(const Geodetic& from, GpsTime start, const Velocity<Enu>& velocity)
        : from_(to_ecef(from)), velocity_(LocalFrame(from).to_ecef(velocity)), start_(start) {}
    [[nodiscard]] TruthState at(GpsTime time) const override {
        const Position<Ecef> place(from_.vector() + difference(time, start_).value() * velocity_.vector());
        return {time, place, velocity_, to_geodetic(place)};
    }

private:
    Position<Ecef> from_;
    Velocity<Ecef> velocity_;
    GpsTime start_;
};

void expect_truth(const Trace& trace, const std::string& what) {
    ASSERT_EQ(trace.epoch.fix.type, FixType::fix_3d) << what;
    const double error = (to_ecef(trace.epoch.fix.position) - trace.truth.position).length().value();
    EXPECT_LT(error, largest_error_m) << what;
    EXPECT_EQ(trace.epoch.fix.time, trace.truth.time) << what;
    EXPECT_GE(trace.epoch.fix.satellites_used(), 12) << what;
}

TEST(ZeroNoise, TheFixIsTheTruthAtRest) {
    for (const Case& c : cases()) {
        Simulation simulation = errorless_run(std::make_unique<FixedPoint>(c.place));
        for (int k = 0; k < 6; ++k)
            expect_truth(simulation.run(c.start + std::chrono::seconds(k), all_systems()),
                         std::to_string(c.place.latitude.deg()) + " " + std::to_string(c.place.longitude.deg()));
    }
}

TEST(ZeroNoise, TheFixIsTheTruthInFlight) {
    for (const Case& c : cases()) {
        Simulation simulation =
            errorless_run(std::make_unique<StraightFlight>(c.place, c.start, Velocity<Enu>(180, -140, 6)));
        for (int k = 0; k < 12; ++k) {
            const Trace trace = simulation.run(c.start + std::chrono::milliseconds(500 * k), all_systems());
            expect_truth(trace, "in flight");
            const VelocityNed& v = trace.epoch.fix.velocity;
            const Velocity<Ecef> velocity =
                LocalFrame(trace.epoch.fix.position).to_ecef(Velocity<Enu>(v.east, v.north, -v.down));
            EXPECT_LT((velocity.vector() - trace.truth.velocity.vector()).norm(), 1e-3);
        }
    }
}

// Whatever the receiver's clock does, and whichever system is alone.
TEST(ZeroNoise, TheClockDoesNotMatter) {
    for (const auto steering :
         {ClockSteering::free_running, ClockSteering::millisecond_jumps, ClockSteering::continuous}) {
        ModernSettings settings = ModernSettings::of(ModernPreset::consumer);
        settings.errors = false;
        settings = effective(settings);
        settings.measurement.receiver_clock.enabled = true;
        settings.measurement.clock.steering = steering;
        settings.measurement.clock.drift = MetresPerSecond(30000);
        Simulation simulation = modern_run(settings, std::make_unique<FixedPoint>(Geodetic::degrees(-33.9, 151.2, 20)));
        const GpsTime start = to_gps_time(2400, 302400.0);
        for (int k = 0; k < 30; ++k)
            expect_truth(simulation.run(start + std::chrono::seconds(k), all_systems()), "clock");
    }
}

TEST(ZeroNoise, OneSystemIsEnough) {
    const GpsTime start = to_gps_time(2400, 302400.0);
    for (const Constellation c :
         {Constellation::gps, Constellation::galileo, Constellation::beidou, Constellation::glonass}) {
        Simulation simulation = errorless_run(std::make_unique<FixedPoint>(Geodetic::degrees(52, 13, 100)));
        ReceiverSettings settings;
        settings.signals = {{c, first_signal(c)}};
        const Trace trace = simulation.run(start, settings);
        ASSERT_EQ(trace.epoch.fix.type, FixType::fix_3d) << constellation_name(c);
        EXPECT_LT((to_ecef(trace.epoch.fix.position) - trace.truth.position).length().value(), largest_error_m);
    }
}

}  // namespace
}  // namespace skyloop::test
