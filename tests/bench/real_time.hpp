/// What benchmarks against the clock share.
#pragma once

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/threads.hpp"

namespace skyloop::bench {

inline constexpr std::int64_t wire_ms = 1'000'000;
inline constexpr std::int64_t wire_second = 1000 * wire_ms;
inline constexpr std::int64_t settled_after = 2 * wire_second;

// Who runs: so many receivers of one board.
struct Fleet {
    std::size_t receivers;
    const char* board;
    int rate_hz;
    unsigned baud;
    [[nodiscard]] std::int64_t period() const { return wire_second / rate_hz; }
};

// Durations, ns, and what share of them is below.
class Durations {
public:
    void add(std::int64_t ns) { all_.push_back(ns); }
    [[nodiscard]] std::size_t count() const { return all_.size(); }
    /// In µs. @param share 0 … 1
    [[nodiscard]] double at(double share) {
        if (all_.empty()) return std::nan("");
        std::sort(all_.begin(), all_.end());
        const auto index = static_cast<std::size_t>(std::ceil(share * static_cast<double>(all_.size()))) - 1;
        return static_cast<double>(all_[std::min(index, all_.size() - 1)]) * 1e-3;
    }

private:
    std::vector<std::int64_t> all_;
};

inline double wire_seconds() {
    const char* const given = std::getenv("SKYLOOP_BENCH_SECONDS");
    return given != nullptr ? std::max(3.0, std::atof(given)) : 20;
}

inline double cpu_of_thread() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The text of a board with another number behind the first `key`.
inline std::string with_number(std::string text, const std::string& key, const std::string& number) {
    const std::size_t at = text.find(key + " = ") + key.size() + 3;
    return text.replace(at, text.find_first_not_of("0123456789.", at) - at, number);
}

// The profile of a board that may go at this rate and says at once what it knows: a receiver's own latency, tens of
// milliseconds that the emulator keeps, would hide ours.
inline std::string board_for(const Fleet& fleet, const std::filesystem::path& folder) {
    const auto source =
        std::filesystem::path(SKYLOOP_SOURCE_DIR) / "boards/receivers" / (std::string(fleet.board) + ".toml");
    std::string text = with_number(read_text_file(source).value(), "max_rate_hz", std::to_string(fleet.rate_hz));
    text = with_number(with_number(std::move(text), "solution_latency_s", "0.0"), "latency_deviation_s", "0.0");
    const auto copy = folder / (std::string(fleet.board) + ".toml");
    std::ofstream(copy) << text;
    return copy.string();
}

// p50, p99 and p99.9, µs, and how many times those of the bare loop.
inline void tell(benchmark::State& state, const std::string& name, Durations& ours, Durations& bare) {
    for (const auto& [label, share] : {std::pair{"p50", 0.5}, {"p99", 0.99}, {"p99.9", 0.999}}) {
        state.counters[fmt::format("{}_{}_us", name, label)] = ours.at(share);
        state.counters[fmt::format("{}_{}_bare_us", name, label)] = bare.at(share);
        state.counters[fmt::format("{}_{}_ratio", name, label)] = ours.at(share) / bare.at(share);
    }
}

}  // namespace skyloop::bench
