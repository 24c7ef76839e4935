/// A probe in a thread of its own.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/core/process.hpp"
#include "expectation_tracker.hpp"
#include "run/verdict/expectation.hpp"

namespace skyloop::inline run {

/// "command 'gpspipe -w -n 5' exits 0".
std::string probe_text(const Probe& probe);

/// Runs the probe's command, anew until it succeeds where the probe says so, and keeps what came of it.
class ProbeRun {
public:
    /// @param group hears of the command's processes; may be empty
    ProbeRun(Probe probe, std::vector<std::string> environment, ProcessGroupListener group);
    /// Kills what still runs.
    ~ProbeRun();
    ProbeRun(const ProbeRun&) = delete;
    ProbeRun& operator=(const ProbeRun&) = delete;

    [[nodiscard]] bool is_over() const { return over_; }
    /// What came of it, once it is over; until then undecided.
    [[nodiscard]] Finding found() const { return over_ ? finding_ : Finding{}; }
    /// Kills what still runs and gives what came of it: undecided where the command had time left.
    Finding finish();

private:
    void work();
    // Nothing: the end of the run came before it had decided.
    std::optional<bool> try_once();
    void keep(Outcome outcome, std::string evidence);
    void keep_undecided();

    const Probe probe_;
    const std::vector<std::string> environment_;
    const ProcessGroupListener group_;
    std::atomic<bool> cancelled_ = false, over_ = false;
    std::mutex mutex_;
    Finding finding_;  // guarded by mutex_
    std::thread thread_;
};

}  // namespace skyloop::inline run
