// The ionosphere by two carriers, weighed against the model.
#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <tuple>

#include "plain_navigation.hpp"
#include "world/gnss/shell_ionosphere.hpp"

namespace skyloop {
namespace {

using test::antenna;
using test::error_of;
using test::later;
using test::measure;
using test::plain;
using test::receiver_at;
using test::sample_time;
using test::SyntheticSky;
using test::TrueReceiver;

constexpr double zenith_delay_m = 12;  // which the model of an ordinary day does not know

// All signals behind it, each code with white noise.
Observations measured_through(const SyntheticSky& sky, const TrueReceiver& receiver, double noise_m,
                              std::mt19937& dice) {
    test::MeasureOptions options;
    options.all_signals = true;
    const auto delay = [](double share) {
        return [share](const SatelliteId&, const SkyDirection& d, Hertz carrier) {
            const double slant = 1 + 16 * std::pow(0.53 - d.elevation.rad() / std::numbers::pi, 3);  // IS-GPS-200
            return share * ionosphere_delay_at(Metres(zenith_delay_m * slant), carrier).value();
        };
    };
    Observations observations = measure(sky, receiver, options, delay(1));
    // The phase comes early by as much.
    const Observations phases = measure(sky, receiver, options, delay(-1));
    std::normal_distribution<double> noise(0, noise_m);
    for (std::size_t i = 0; i < observations.signals.size(); ++i) {
        observations.signals[i].carrier_phase = phases.signals[i].carrier_phase;
        *observations.signals[i].pseudorange += Metres(noise(dice));
    }
    std::sort(observations.signals.begin(), observations.signals.end(), [](const Observation& a, const Observation& b) {
        return std::tie(a.satellite, a.signal) < std::tie(b.satellite, b.signal);
    });
    return observations;
}

NavigationParameters with_memory(Seconds memory) {
    NavigationParameters parameters = plain(FilterKind::none);
    parameters.corrections.ionosphere = IonosphereCorrection::klobuchar;
    parameters.corrections.default_ionosphere = true;
    parameters.corrections.ionosphere_memory = memory;
    return parameters;
}

TEST(TwoBandIonosphere, LeavesLittleOfADelayThatTheModelDoesNotKnow) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    std::mt19937 dice(1);
    const Observations observations = measured_through(sky, receiver, 0, dice);
    const auto error = [&](Seconds memory) {
        NavigationEngine engine(with_memory(memory), {&sky});
        return error_of(engine.solve(observations, {}), receiver);
    };
    EXPECT_GT(error(Seconds(0)), 5);
    EXPECT_LT(error(Seconds(600)), 2) << "at once, by all satellites together";
}

TEST(TwoBandIonosphere, GrowsExactAndStaysQuietAsItAverages) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    TrueReceiver receiver = receiver_at(antenna, sample_time);
    std::mt19937 dice(2);
    NavigationEngine engine(with_memory(Seconds(600)), {&sky});
    NavigationParameters combined = with_memory(Seconds(0));
    combined.corrections.ionosphere_free = true;
    NavigationEngine combining(combined, {&sky});
    double averaged = 0, single = 0;
    for (int second = 0; second < 700; ++second) {
        const TrueReceiver now = later(receiver, second);
        const Observations observations = measured_through(sky, now, 1, dice);
        const double e = error_of(engine.solve(observations, {}), now);
        const double of_combination = error_of(combining.solve(observations, {}), now);
        if (second < 600) continue;
        averaged += e * e;
        single += of_combination * of_combination;
    }
    EXPECT_LT(std::sqrt(averaged / 100), 1.2);
    EXPECT_LT(averaged, 0.4 * single) << "against the combination of each epoch";
}

TEST(TwoBandIonosphere, BeginsAnewAfterALongAbsence) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    std::mt19937 dice(4);
    NavigationEngine engine(with_memory(Seconds(600)), {&sky});
    for (const double second : {0.0, 1.0, 100.0, 101.0}) {
        const TrueReceiver now = later(receiver, second);
        EXPECT_LT(error_of(engine.solve(measured_through(sky, now, 0, dice), {}), now), 2) << second;
    }
}

TEST(TwoBandIonosphere, ServesTheSatellitesWithOneSignalToo) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    std::mt19937 dice(3);
    Observations observations = measured_through(sky, receiver, 0, dice);
    std::erase_if(observations.signals, [](const Observation& o) {
        return o.satellite.constellation != Constellation::galileo &&
               o.signal != first_signal(o.satellite.constellation);
    });
    NavigationEngine engine(with_memory(Seconds(600)), {&sky});
    const Fix fix = engine.solve(observations, {});
    EXPECT_LT(error_of(fix, receiver), 4);
    EXPECT_GT(fix.satellites_used(), 20);
}

}  // namespace
}  // namespace skyloop
