/// What a led run remembers of itself, for those who ask.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "run/emulator/assembly.hpp"
#include "run/emulator/status_board.hpp"

namespace skyloop::inline run {

/// What a receiver has told its users.
struct Report {
    std::shared_ptr<const firmware::NavigationState> state;
    TruthState truth;      ///< at its epoch
    bool expired = false;  ///< silent_after ago: the state is without a fix
};

/// Keeps the last epoch of each receiver and what has happened to the run. Messages on the wires are not looked for.
class RunWatcher : public RunObserver {
public:
    /// @param stations outlive it
    RunWatcher(StatusSetup setup, const std::vector<Station>& stations, StatusSources sources);
    void on_epoch(const EpochSeen& seen) override;
    void on_fault(const FaultSeen& seen) override;
    void on_command(const CommandSeen& seen) override;
    void on_belief(const BeliefSeen& seen) override { board_.on_belief(seen); }

    /// Of the last epoch of a receiver; nothing before the first.
    [[nodiscard]] const std::optional<Trace>& trace(std::size_t station) const { return traces_[station]; }
    /// The last that a receiver reported, without a fix once that is silent_after ago; null before the first.
    [[nodiscard]] const Report* report(std::size_t station) const;
    /// The run has been led on: what status() tells is not what it told before.
    void went_on() { stale_ = true; }
    /// recent_status_json() of now; the same text until the run goes on, so that it can be measured and fetched.
    [[nodiscard]] std::string status(GpsTime now);
    /// How often the vehicles have been moved by a command.
    [[nodiscard]] std::uint64_t moves() const { return moves_; }
    /// A fault of this name has begun or ended.
    [[nodiscard]] bool has_seen(const std::string& fault) const { return faults_.contains(fault); }

private:
    const std::vector<Station>& stations_;
    std::vector<std::optional<Trace>> traces_;
    std::vector<std::optional<Report>> reports_;
    SilenceWatch silence_;
    std::set<std::string> faults_;
    std::uint64_t moves_ = 0;
    bool stale_ = true;
    std::int64_t clock_ns_ = 0;  // of the board: late enough each time for everything to be due
    StatusBoard board_;
};

}  // namespace skyloop::inline run
