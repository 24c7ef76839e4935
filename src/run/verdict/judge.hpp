/// Watches a run and says what became of its expectations.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/core/watchdog_process.hpp"
#include "run/fault/run_observer.hpp"
#include "run/verdict/expectation.hpp"
#include "run/verdict/verdict.hpp"

namespace skyloop::inline run {

/// The run that is judged.
struct JudgedRun {
    GpsTime start;
    std::vector<std::string> receivers;            ///< names, by station
    bool live = false;                             ///< against the clock: probes may run
    std::vector<std::string> probe_environment{};  ///< "SKYLOOP_PORT=/dev/pts/3": added to the environment of probes
    OrphanWatchdog* orphans = nullptr;             ///< ends the probes of a program that is killed; null: nobody does
};

/// Follows every expectation at every receiver that it is about.
///
/// A message's or an epoch's time that lies before one that came earlier counts as that earlier time. Where an
/// expectation is about several receivers it passes when it passes at each. Memory does not grow with the run: of
/// instants that are still to be looked at an expectation keeps 1024, and fails when more come. State: of each
/// expectation, and the probes that run in threads of their own.
class Judge : public RunObserver {
public:
    Judge(std::vector<Expectation> expectations, JudgedRun run);
    /// Kills the probes that still run.
    ~Judge() override;
    Judge(const Judge&) = delete;
    Judge& operator=(const Judge&) = delete;

    void on_epoch(const EpochSeen& seen) override;
    void on_message(const MessageSeen& seen) override;
    /// True where an expectation is about messages, or silence.
    [[nodiscard]] bool wants_messages() const override;
    void on_fault(const FaultSeen& seen) override;
    void on_command(const CommandSeen& seen) override;
    void on_belief(const BeliefSeen& seen) override;
    /// Time goes on without anything to see. Starts the probes that are due.
    void advance(GpsTime now);

    /// How it stands, in the order of the expectations: failed for good; passed so far, where another occurrence may
    /// still fail; undecided, without evidence, while it cannot be told. Never waits; for the thread that observes.
    [[nodiscard]] std::vector<Verdict> so_far() const;

    /// The run is over: one verdict per expectation, in their order. Probes that still run are killed, and undecided.
    /// Called once; nothing may be observed afterwards. Waits for the ends of killed probes, at most some tenths of a
    /// second.
    /// @param end RunEnd::cut leaves undecided what was to last to the end of the run, or waits for an event
    std::vector<Verdict> finish(GpsTime now, RunEnd end = RunEnd::over);

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace skyloop::inline run
