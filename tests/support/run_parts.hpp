/// Small runs for tests: scenarios from text, wires of memory, and a clock that never waits.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "run/emulator/assembly.hpp"
#include "run/scenario/board_files.hpp"
#include "run/scenario/scenario_file.hpp"
#include "support/memory_transport.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/navigation_data.hpp"

namespace skyloop::test {

/// Does not wait, but lets the loop look at the wires every `tick` of simulated time, as the real clock does.
class TickingPacer : public Pacer {
public:
    TickingPacer(GpsTime start, Nanoseconds tick) : start_(start), tick_(tick) {}
    std::optional<Nanoseconds> wait_until(GpsTime) override { return Nanoseconds(0); }
    [[nodiscard]] Nanoseconds tick(bool) const override { return tick_; }
    [[nodiscard]] std::int64_t monotonic_ns(GpsTime now) const override { return (now - start_).count(); }

private:
    GpsTime start_;
    Nanoseconds tick_;
};

inline Scenario emulator_scenario(std::string_view text) {
    const auto scenario = read_scenario(text, "test.toml");
    EXPECT_TRUE(scenario) << scenario.error().message;
    return scenario ? *scenario : Scenario{};
}

/// Boards from the sources; the geoid where the build has made it.
inline DataFolders emulator_data() { return {{std::filesystem::path(SKYLOOP_SOURCE_DIR), built_data()}}; }

inline std::string content_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    EXPECT_TRUE(stream) << file;
    std::stringstream content;
    content << stream.rdbuf();
    return content.str();
}

inline std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

/// The cells of one row; an empty last one counts.
inline std::vector<std::string> cells_of(const std::string& row) {
    std::vector<std::string> cells(1);
    for (const char c : row)
        c == ',' ? cells.emplace_back() : cells.back() += c, void();
    return cells;
}

/// A recording that has begun.
inline Result<Recorder> recorder_in(const std::filesystem::path& folder, std::size_t wires = 1) {
    auto recorder = Recorder::claim(folder);
    if (!recorder) return recorder;
    if (const auto begun = recorder->begin({wires}); !begun) return fail(begun.error());
    return recorder;
}

/// A run whose one wire ends in memory.
struct MemoryRun {
    std::unique_ptr<Emulator> emulator;
    MemoryTransport* wire = nullptr;
    GpsTime start;
};

/// What a MemoryRun is made of besides its scenario, which must have a start.
struct MemoryRunParts {
    Nanoseconds tick{0};  ///< zero: one look at the wire per epoch
    std::optional<Recorder> recorder;
    LineState line{true, std::nullopt};
};

/// The receiver of a scenario as the assembly makes it, without wires.
inline Station::Parts station_parts(const Scenario& scenario, std::size_t index, GpsTime start) {
    const ReceiverEntry& entry = scenario.receivers.at(index);
    auto board = find_board(entry.board, board_folders(emulator_data()));
    EXPECT_TRUE(board);
    SimulationSetup setup{std::make_shared<NominalConstellation>(), nullptr, start, DataFolders{}, index};
    setup.warm_start = board->timing.warm_start;
    auto simulation = make_simulation(scenario, setup);
    EXPECT_TRUE(simulation);
    if (entry.baud) board->baud = *entry.baud;
    if (entry.export_limits) board->export_limits = *entry.export_limits;
    ReceiverSettings settings = receiver_settings(scenario, *board, index);
    firmware::Receiver receiver(std::move(*board), {entry.rate_hz.value_or(0), std::move(settings), 1, false});
    return {std::move(*simulation), std::move(receiver), {}, {}};
}

inline MemoryRun memory_run(const Scenario& scenario, MemoryRunParts parts = {}) {
    MemoryRun run;
    run.start = scenario.run.start.value();
    Station::Parts station = station_parts(scenario, 0, run.start);
    station.recorder = std::move(parts.recorder);
    auto wire = std::make_unique<MemoryTransport>();
    wire->set_line(parts.line);
    run.wire = wire.get();
    station.wires.push_back(
        {firmware::PortId::uart1, Link(std::move(wire), port_speed(station.receiver, firmware::PortId::uart1))});
    std::vector<Station> stations;
    stations.emplace_back(std::move(station));
    run.emulator = std::make_unique<Emulator>(
        Emulator::Parts{std::move(stations), std::make_unique<TickingPacer>(run.start, parts.tick)}, run.start);
    return run;
}

}  // namespace skyloop::test
