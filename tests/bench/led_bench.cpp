/// What a run costs that another program leads, over one that leads itself.
#include <benchmark/benchmark.h>
#include <time.h>

#include <array>
#include <atomic>
#include <cmath>

#include "run/emulator/assembly.hpp"
#include "run/scenario/scenario_file.hpp"
#include "skyloop.h"
#include "support/oracle_table.hpp"
#include "support/truth_on_circle.hpp"

namespace {

using namespace skyloop;

constexpr std::int64_t bench_seconds = 120;
constexpr const char* bench_scenario = R"(
[run]
start = 2026-03-01T12:00:00Z
[[receiver]]
rate_hz = 10
baud = 115200
)";

// Of this thread on the processor: other programs do not count.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// As skyloop simulate, but without a recording. @return seconds of the processor
double simulate_alone() {
    auto scenario = *read_scenario(bench_scenario, "bench.toml");
    scenario.run.duration = Seconds(static_cast<double>(bench_seconds));
    RunMode mode;
    mode.virtual_time = true;
    mode.open_ports = false;
    auto assembly = *assemble(scenario, {{test::built_data()}}, mode);
    const std::atomic<bool> stop{false};
    const double begin = processor_seconds();
    assembly.emulator->run_until(*assembly.end, stop);
    return processor_seconds() - begin;
}

sky_emulator* create_led() {
    sky_create_info info{};
    info.struct_size = sizeof info;
    info.abi_major = SKY_ABI_MAJOR;
    info.scenario_text = bench_scenario;
    const std::string data = test::built_data().string();
    info.data_dir = data.c_str();
    sky_emulator* emulator = nullptr;
    if (sky_create(&info, &emulator) != SKY_OK) std::abort();
    return emulator;
}

void say_truth(sky_emulator* emulator, std::int64_t now) {
    const sky_truth truth = test::truth_on_circle(now);
    if (sky_set_truth(emulator, &truth) != SKY_OK) std::abort();
}

// @return seconds of the processor
double lead(std::int64_t step, bool with_truth) {
    sky_emulator* emulator = create_led();
    std::array<char, 65536> bytes;
    const double begin = processor_seconds();
    for (std::int64_t now = 0; now <= bench_seconds * 1'000'000'000; now += step) {
        if (with_truth) say_truth(emulator, now);
        if (sky_advance(emulator, now, nullptr) != SKY_OK) std::abort();
        while (sky_read(emulator, 0, bytes.data(), bytes.size()) > 0) {
        }
    }
    const double seconds = processor_seconds() - begin;
    sky_destroy(emulator);
    return seconds;
}

// Alternating, so that a machine that changes its pace changes it for both.
void led_over_simulated(benchmark::State& state, std::int64_t step, bool with_truth) {
    double alone = 0, led = 0;
    std::int64_t runs = 0;
    for (auto _ : state) {
        alone += simulate_alone();
        led += lead(step, with_truth);
        ++runs;
    }
    const double epochs = 10.0 * static_cast<double>(bench_seconds * runs);
    state.counters["led_over_simulated"] = led / alone;
    state.counters["led_epochs/s"] = epochs / led;
}
BENCHMARK_CAPTURE(led_over_simulated, one_second_steps, 1'000'000'000, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(led_over_simulated, steps_of_20_ms_with_truth, 20'000'000, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(led_over_simulated, steps_of_2_ms_with_truth, 2'000'000, true)->Unit(benchmark::kMillisecond);

}  // namespace
