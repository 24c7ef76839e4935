/// What one epoch costs, and its parts.
#include <benchmark/benchmark.h>

#include <atomic>

#include "firmware/nmea_handler.hpp"
#include "skyloop/emulator/assembly.hpp"
#include "skyloop/gnss/nominal_constellation.hpp"
#include "skyloop/gnss/orbit.hpp"
#include "skyloop/sky/observe_sky.hpp"
#include "skyloop/time/utc_time.hpp"

namespace {

using namespace skyloop;

const GpsTime bench_start = to_gps_time({2026, 3, 1, 12, 0, 0, 0}, LeapSeconds::announced());

Scenario open_sky(ErrorModelKind kind) {
    Scenario scenario;
    scenario.run.start = bench_start;
    scenario.run.duration = Seconds(1e6);
    scenario.model.kind = kind;
    return scenario;
}

DataFolders bench_data() { return {{std::filesystem::path(SKYLOOP_BINARY_DIR) / "share" / "skyloop"}}; }

void satellite_position(benchmark::State& state) {
    const NominalConstellation constellation;
    const KeplerEphemeris ephemeris = *constellation.record({Constellation::gps, 7}, bench_start);
    GpsTime time = bench_start;
    for (auto _ : state) {
        time += Nanoseconds(1'000'000);
        benchmark::DoNotOptimize(satellite_state(ephemeris, time));
    }
}
BENCHMARK(satellite_position);

void sky_of_31_satellites(benchmark::State& state) {
    const NominalConstellation constellation;
    FixedPoint place(Geodetic::degrees(46.4775, 30.7326, 77));
    GpsTime time = bench_start;
    std::size_t in_view = 0;
    for (auto _ : state) {
        time += Nanoseconds(1'000'000'000);
        in_view = observe_sky(place.at(time), constellation).satellites.size();
    }
    state.counters["in_view"] = static_cast<double>(in_view);
}
BENCHMARK(sky_of_31_satellites);

// The whole pipeline of an epoch: truth, sky, propagation, fix.
void epoch(benchmark::State& state, ErrorModelKind kind) {
    const Scenario scenario = open_sky(kind);
    auto navigation = load_navigation(scenario, bench_start, true);
    std::vector<std::string> warnings;
    const auto geoid = find_geoid(bench_data(), warnings);
    auto made = make_simulation(scenario, std::move(navigation->source), geoid.get(), bench_start);
    Simulation& simulation = *made;
    GpsTime time = bench_start;
    std::size_t in_view = 0;
    for (auto _ : state) {
        time += Nanoseconds(1'000'000'000);
        in_view = simulation.run(time).sky.satellites.size();
    }
    state.counters["in_view"] = static_cast<double>(in_view);
    state.counters["epochs/s"] =
        benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(epoch, baseline, ErrorModelKind::baseline);
BENCHMARK_CAPTURE(epoch, ideal, ErrorModelKind::ideal);

void nmea_sentences(benchmark::State& state) {
    const Scenario scenario = open_sky(ErrorModelKind::baseline);
    auto navigation = load_navigation(scenario, bench_start, true);
    auto simulation = make_simulation(scenario, std::move(navigation->source), nullptr, bench_start);
    const Epoch one = simulation->run(bench_start).epoch;
    firmware::BoardProfile board;
    board.constellations = {Constellation::gps};
    for (int i = 0; i < 8; ++i)
        board.sentences.push_back({static_cast<firmware::NmeaSentence>(i), 1});
    firmware::NmeaHandler handler(board);
    std::uint64_t count = 0;
    std::uint64_t index = 0;
    for (auto _ : state)
        count += handler.sentences(one, index++).size();
    state.counters["sentences/s"] = benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsRate);
}
BENCHMARK(nmea_sentences);

// A whole run on the virtual clock, receiver and recording included: simulated seconds per second.
void simulated_hour(benchmark::State& state) {
    const auto folder = std::filesystem::temp_directory_path() / "skyloop-bench";
    for (auto _ : state) {
        RunMode mode;
        mode.virtual_time = true;
        mode.open_ports = false;
        mode.record = folder;
        auto assembly = assemble(open_sky(ErrorModelKind::baseline), bench_data(), mode);
        const std::atomic<bool> stop{false};
        assembly->emulator->run_until(advanced(bench_start, Seconds(3600)), stop);
    }
    std::filesystem::remove_all(folder);
    state.counters["realtime_ratio"] =
        benchmark::Counter(3600.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(simulated_hour)->Unit(benchmark::kMillisecond);

}  // namespace
