/// What reading a whole day of navigation data costs, against merely looking at its bytes.
#include <benchmark/benchmark.h>

#include <cstring>
#include <filesystem>

#include "base/core/files.hpp"
#include "world/gnss/foreign_records.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/rinex/navigation_file.hpp"
#include "world/rinex/precise_orbit_file.hpp"

namespace {

using namespace skyloop;

const std::filesystem::path bench_shared = SKYLOOP_SHARED_DATA;

// The text of a file of the shared data; where it is absent the benchmark ends with a word.
std::string shared_text(benchmark::State& state, const char* name) {
    auto text = read_text_file(bench_shared / name);
    if (!text) state.SkipWithError(text.error().message.c_str());
    return text ? std::move(*text) : std::string();
}

constexpr const char* whole_day = "nav/BRDC00IGS_R_20230010000_01D_MN.rnx.gz";

// The least that any reader of lines must do: find their ends.
void lines_of_a_day(benchmark::State& state) {
    const std::string text = shared_text(state, whole_day);
    for (auto _ : state) {
        std::size_t lines = 0;
        for (const char* at = text.data();
             (at = static_cast<const char*>(
                  std::memchr(at, '\n', static_cast<std::size_t>(text.data() + text.size() - at)))) != nullptr;
             ++at)
            ++lines;
        benchmark::DoNotOptimize(lines);
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(text.size()) * state.iterations());
}
BENCHMARK(lines_of_a_day)->Unit(benchmark::kMillisecond);

void records_of_a_day(benchmark::State& state) {
    const std::string text = shared_text(state, whole_day);
    std::size_t records = 0;
    for (auto _ : state) {
        const auto file = read_navigation(text, "day");
        records = file ? file->records.size() : 0;
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(text.size()) * state.iterations());
    state.counters["records"] = static_cast<double>(records);
}
BENCHMARK(records_of_a_day)->Unit(benchmark::kMillisecond);

// From the compressed file to a source of orbits: gzip, text, foreign records, order.
void day_ready_for_use(benchmark::State& state) {
    if (shared_text(state, whole_day).empty()) return;
    for (auto _ : state) {
        auto file = read_navigation_file(bench_shared / whole_day);
        drop_foreign_records(file->records);
        const NavigationData data(file->records, file->ionosphere, "day");
        benchmark::DoNotOptimize(data.record_count());
    }
}
BENCHMARK(day_ready_for_use)->Unit(benchmark::kMillisecond);

void precise_day(benchmark::State& state) {
    const std::string text = shared_text(state, "precise/COD0MGXFIN_20230010000_01D_05M_ORB.SP3.gz");
    for (auto _ : state)
        benchmark::DoNotOptimize(read_precise_orbits(text, "day"));
    state.SetBytesProcessed(static_cast<std::int64_t>(text.size()) * state.iterations());
}
BENCHMARK(precise_day)->Unit(benchmark::kMillisecond);

}  // namespace
