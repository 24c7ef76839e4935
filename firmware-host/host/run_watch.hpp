/// Who watches a run: its judge, its log, and whoever looks at it from outside.
/// What happened in a run beside its epochs and bytes, a line each.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/watchdog_process.hpp"
#include "messages.hpp"
#include "run/control/control_server.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/command_queue.hpp"
#include "run/emulator/run_caster.hpp"
#include "run/emulator/run_files.hpp"
#include "run/emulator/status_board.hpp"
#include "run/fault/run_observer.hpp"
#include "run/feed/mavlink_endpoint.hpp"
#include "run/output/run_output.hpp"
#include "run/scenario/scenario.hpp"
#include "run/verdict/judge.hpp"

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

/// What is asked of a watch.
struct WatchOptions {
    std::string control;                ///< "[HOST:]PORT"; empty: nobody from outside
    std::string token;                  ///< for them; empty: by the rules of ControlOptions
    std::string mavlink;                ///< "udp:14550"; empty: none
    bool live = false;                  ///< against the clock
    OrphanWatchdog* orphans = nullptr;  ///< ends the probes of a program that is killed; null: nobody does
};

/// Watches the emulator of an assembly. It must end before the assembly does.
class RunWatch {
public:
    /// Opens what is asked for, then begins the recordings, and fails as they do.
    /// @param commands that clients from outside ask for
    static Result<std::unique_ptr<RunWatch>> start(const Scenario& scenario, Assembly& assembly,
                                                   const WatchOptions& options, CommandQueue& commands);
    /// What to open in a browser; empty: nothing.
    [[nodiscard]] std::string url() const { return server_ ? server_->url() : std::string(); }
    /// Where MAVLink is spoken; empty: nowhere.
    [[nodiscard]] std::string mavlink() const { return mavlink_ ? mavlink_->description() : std::string(); }
    /// Where receivers' RTCM may be had, and as what; empty: nowhere.
    [[nodiscard]] std::string caster() const { return caster_ ? caster_->description() : std::string(); }
    /// What is told to other programs beside the wires.
    [[nodiscard]] const std::vector<std::unique_ptr<RunOutput>>& outputs() const { return outputs_; }
    /// What has happened to them since the last call, in sentences.
    std::vector<std::string> take_news();
    /// Somebody hears of the run, or leads it, whatever has become of its wires.
    [[nodiscard]] bool serves() const;
    /// The run is over: what still waits is told, and what became of all of it is kept in the assembly.
    void finish_outputs();
    /// The run is over: says the verdicts, and leaves verdicts.json and junit.xml in the recording.
    /// @return exit code: 3 where an expectation was not met
    int finish(const Messages& messages, RunEnd end);

private:
    RunWatch(const Scenario& scenario, Assembly& assembly) : scenario_(scenario), assembly_(assembly) {}
    Result<void> begin();
    void appoint_judge(const WatchOptions& options);
    Result<void> open_control(const WatchOptions& options, CommandQueue& commands);
    Result<void> open_mavlink(const std::string& address, CommandQueue& commands);
    Result<void> open_outputs(bool live);
    Result<void> open_caster(bool live);
    [[nodiscard]] std::vector<TimelineBar> planned_bars() const;
    int report(const Messages& messages, const std::vector<Verdict>& verdicts) const;

    const Scenario& scenario_;
    Assembly& assembly_;
    std::optional<RunLog> log_;
    std::unique_ptr<Judge> judge_;
    std::optional<std::vector<Verdict>> verdicts_;  // once the run is over
    std::unique_ptr<StatusBoard> board_;
    std::unique_ptr<ControlServer> server_;  // before board_ is gone
    std::unique_ptr<MavlinkEndpoint> mavlink_;
    std::vector<std::unique_ptr<RunOutput>> outputs_;
    std::optional<RunCaster> caster_;
};

}  // namespace skyloop::host
