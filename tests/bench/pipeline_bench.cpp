/// What one epoch costs, and its parts.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <array>
#include <atomic>

#include "base/time/utc_time.hpp"
#include "bench/thread_time.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "run/emulator/assembly.hpp"
#include "support/four_systems.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"
#include "world/propagation/modern_effects.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/sky/observe_sky.hpp"

namespace {

using namespace skyloop;
using bench::thread_seconds;
using enum Constellation;

const GpsTime bench_start = to_gps_time({2026, 3, 1, 12, 0, 0, 0}, LeapSeconds::announced());
const GpsTime real_start = to_gps_time({2023, 1, 1, 12, 0, 0, 0}, LeapSeconds::announced());
const std::filesystem::path real_day =
    std::filesystem::path(SKYLOOP_SHARED_DATA) / "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz";

// @param sensor_model nothing: modern
Scenario open_sky(std::optional<ErrorModelKind> sensor_model) {
    Scenario scenario;
    scenario.run.start = bench_start;
    scenario.run.duration = Seconds(1e6);
    scenario.model.sensor_model = sensor_model;
    return scenario;
}

DataFolders bench_data() { return {{test::built_data()}}; }

double peak_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

void satellite_position(benchmark::State& state) {
    const NominalConstellation constellation;
    const KeplerEphemeris ephemeris = *constellation.record({gps, 7}, bench_start);
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
    auto navigation = load_navigation(scenario, bench_start);
    std::vector<std::string> warnings;
    const auto geoid = find_geoid(bench_data(), warnings);
    auto made = make_simulation(scenario, {std::move(navigation->source), geoid.get(), bench_start});
    Simulation& simulation = *made;
    GpsTime time = bench_start;
    std::size_t in_view = 0;
    for (auto _ : state) {
        time += Nanoseconds(1'000'000'000);
        in_view = simulation.run(time, {}).sky.satellites.size();
    }
    state.counters["in_view"] = static_cast<double>(in_view);
    state.counters["epochs/s"] =
        benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(epoch, baseline, ErrorModelKind::baseline);
BENCHMARK_CAPTURE(epoch, ideal, ErrorModelKind::ideal);

// A real day of these systems, or the made-up four where the shared data is absent.
struct ModernBench {
    explicit ModernBench(std::vector<Constellation> constellations) {
        scenario = open_sky(std::nullopt);
        scenario.sky.constellations = constellations;
        if (std::filesystem::exists(real_day)) {
            scenario.sky.navigation = {real_day};
            scenario.run.start = real_start;
            source = std::move(load_navigation(scenario, real_start)->source);
        } else {
            source = std::make_unique<test::FourSystems>(constellations);
        }
        start = scenario.run.start.value();
        std::vector<std::string> warnings;
        geoid = find_geoid(bench_data(), warnings);
        settings = effective(scenario.model.modern);
    }
    Simulation simulation() {
        return std::move(*make_simulation(scenario, {std::move(source), geoid.get(), start, bench_data()}));
    }
    // The numbers repeat after an hour, for which every record is at hand.
    [[nodiscard]] GpsTime at(std::int64_t index) const { return start + std::chrono::seconds(index % 3600); }

    Scenario scenario;
    std::unique_ptr<NavigationSource> source;
    std::unique_ptr<Geoid> geoid;
    ModernSettings settings;
    GpsTime start;
};

// An hour of epochs of the modern profile: sky, effects, measurement, solution.
void modern_hour(benchmark::State& state, const std::vector<Constellation>& constellations) {
    std::size_t satellites = 0, epochs = 0;
    for (auto _ : state) {
        state.PauseTiming();
        ModernBench bench(constellations);
        Simulation simulation = bench.simulation();
        state.ResumeTiming();
        for (std::int64_t k = 0; k < 3600; ++k)
            satellites += simulation.run(bench.at(k), {}).epoch.observations.signals.size();
        epochs += 3600;
    }
    state.counters["tracked"] = static_cast<double>(satellites) / static_cast<double>(epochs);
    state.counters["epochs/s"] = benchmark::Counter(static_cast<double>(epochs), benchmark::Counter::kIsRate);
    state.counters["peak_MB"] = peak_megabytes();
}
BENCHMARK_CAPTURE(modern_hour, gps, {gps})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(modern_hour, gps_galileo, {gps, galileo})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(modern_hour, four_systems, {gps, galileo, beidou, glonass})->Unit(benchmark::kMillisecond);

// One part of the epochs of an hour; the parts before it are made beforehand.
enum class Part { sky, effects, measurement, solution };

void modern_part(benchmark::State& state, Part part) {
    ModernBench bench({gps, galileo, beidou, glonass});
    FixedPoint place(std::get<FixedSettings>(bench.scenario.trajectory).at);
    SkyObserver observer;
    ModernContext context;
    context.broadcast = bench.source->ionosphere();
    context.receiver_correction = IonosphereModel::klobuchar;
    context.geoid = bench.geoid.get();
    auto effects = std::move(*modern_effects(bench.settings.propagation, context));
    MeasurementEngine measurement(bench.settings.measurement, 1);
    NavigationEngine navigation(bench.settings.navigation, {bench.source.get(), bench.geoid.get()});
    std::int64_t k = 0;
    for (auto _ : state) {
        const TruthState truth = place.at(bench.at(0) + std::chrono::seconds(k++));
        std::array<double, 5> from{};
        from[0] = thread_seconds();
        const SkyView sky = observer.observe(truth, *bench.source);
        from[1] = thread_seconds();
        Arrivals arrivals = free_space(sky);
        for (const auto& effect : effects)
            effect->apply(arrivals, sky, truth);
        from[2] = thread_seconds();
        const Measurement measured = measurement.measure(arrivals, truth.time, {});
        from[3] = thread_seconds();
        benchmark::DoNotOptimize(navigation.solve(measured.observations, {}));
        from[4] = thread_seconds();
        const auto index = static_cast<std::size_t>(part);
        state.SetIterationTime(from[index + 1] - from[index]);
    }
}
BENCHMARK_CAPTURE(modern_part, sky, Part::sky)->UseManualTime()->Iterations(3600);
BENCHMARK_CAPTURE(modern_part, effects, Part::effects)->UseManualTime()->Iterations(3600);
BENCHMARK_CAPTURE(modern_part, measurement, Part::measurement)->UseManualTime()->Iterations(3600);
BENCHMARK_CAPTURE(modern_part, solution, Part::solution)->UseManualTime()->Iterations(3600);

void nmea_sentences(benchmark::State& state) {
    const Scenario scenario = open_sky(ErrorModelKind::baseline);
    auto navigation = load_navigation(scenario, bench_start);
    auto simulation = make_simulation(scenario, {std::move(navigation->source), nullptr, bench_start});
    firmware::NavigationState one;
    one.epoch = simulation->run(bench_start, {}).epoch;
    one.fix_ok = one.ever_had_fix = one.position_known = true;
    one.time = {true, true, true, true, Seconds(25e-9)};
    firmware::BoardProfile board;
    board.constellations = {gps};
    const firmware::ReceiverConfig config =
        firmware::receiver_config(firmware::ConfigStore(firmware::factory_config(board)), board);
    const firmware::ReportContext context{board, config, one};
    std::uint64_t count = 0;
    for (auto _ : state)
        for (std::uint8_t sentence = 0; sentence < 9; ++sentence)
            if (sentence != 6) count += make_message({0xF0, sentence}, context).size();
    state.counters["sentences/s"] = benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsRate);
}
BENCHMARK(nmea_sentences);

// A whole run on the virtual clock, receiver and recording included: simulated seconds per second.
void simulated_hour(benchmark::State& state, std::optional<ErrorModelKind> sensor_model) {
    const auto folder = std::filesystem::temp_directory_path() / "skyloop-bench";
    for (auto _ : state) {
        RunMode mode;
        mode.virtual_time = true;
        mode.open_ports = false;
        mode.record = folder;
        auto assembly = assemble(open_sky(sensor_model), bench_data(), mode);
        if (!assembly->emulator->begin()) return state.SkipWithError("the recording cannot be written");
        const std::atomic<bool> stop{false};
        assembly->emulator->run_until(advanced(bench_start, Seconds(3600)), stop);
    }
    std::filesystem::remove_all(folder);
    state.counters["realtime_ratio"] =
        benchmark::Counter(3600.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(simulated_hour, baseline, ErrorModelKind::baseline)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(simulated_hour, modern, std::nullopt)->Unit(benchmark::kMillisecond);

}  // namespace
