// What the channel of surroundings costs: at most 10 µs for each satellite and epoch.
#include <benchmark/benchmark.h>

#include "world/propagation/surroundings_effect.hpp"

namespace {

using namespace skyloop;

void channel_of_a_satellite(benchmark::State& state) {
    SurroundingsParameters parameters;
    parameters.everywhere.environment = P681Environment::urban;
    SurroundingsEffect effect(parameters, {}, 1);
    SkyView sky;
    for (int number = 1; number <= 32; ++number) {
        SatelliteInView satellite;
        satellite.id = {Constellation::gps, number};
        satellite.azimuth = Angle::degrees(11.0 * number);
        satellite.elevation = Angle::degrees(5 + 2.5 * number);
        satellite.range = Metres(22e6);
        sky.satellites.push_back(satellite);
    }
    TruthState truth;
    truth.geodetic = Geodetic::degrees(48, 11, 500);
    for (auto _ : state) {
        truth.time += std::chrono::seconds(1);
        truth.geodetic.latitude = truth.geodetic.latitude + Angle::radians(1e-6);
        state.PauseTiming();
        Arrivals arrivals = free_space(sky);
        state.ResumeTiming();
        effect.apply(arrivals, sky, truth);
        benchmark::DoNotOptimize(arrivals);
    }
    // Per satellite.
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(sky.satellites.size()));
}
BENCHMARK(channel_of_a_satellite);

}  // namespace
