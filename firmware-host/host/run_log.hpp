/// What happened in a run beside its epochs and bytes, a line each.
#pragma once

#include <filesystem>

#include "base/core/result.hpp"
#include "run/emulator/output_file.hpp"
#include "run/fault/run_observer.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::host {

/// Writes commands.jsonl: faults that begin and end, commands with their source, beliefs of scripted clients; JSON,
/// each with `gps_ns`, nanoseconds of GPS time since 1980-01-06.
class RunLog : public RunObserver {
public:
    static Result<RunLog> create(const std::filesystem::path& folder, GpsTime start);

    void on_fault(const FaultSeen& seen) override;
    void on_command(const CommandSeen& seen) override;
    void on_belief(const BeliefSeen& seen) override;
    void flush() { file_.flush(); }
    [[nodiscard]] const std::optional<Error>& failure() const { return file_.failure(); }

private:
    RunLog(OutputFile file, GpsTime start) : file_(std::move(file)), start_(start) {}

    OutputFile file_;
    GpsTime start_;
};

/// Lets a run begin when a recorded one did, and carries out its live commands again at their instants. Fails with
/// `outside` or `input`, naming file and line.
Result<void> repeat_run(const std::filesystem::path& folder, Scenario& scenario);

}  // namespace skyloop::host
