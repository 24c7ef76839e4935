/// One run of an assembled emulator, from its first message to its exit code.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "messages.hpp"
#include "run/emulator/assembly.hpp"
#include "run_options.hpp"

namespace skyloop::host {

class RunWatch;

/// Says the warnings, runs until the end or a signal, says what happened.
class RunSession {
public:
    /// @param assembly outlives the session
    RunSession(const Messages& messages, Assembly& assembly);
    /// Says which sources fly the vehicles, and lets time stand still until each has spoken where nothing else says
    /// where its vehicle is.
    void await_feeds() const;
    /// Time stands still until each port has a client, or the run is to end.
    void await_clients() const;
    /// Exit code: 0, 3 when an expectation was not met, or 1 when a recording or a wire could not be written.
    int run(const Scenario& scenario, RunWatch& watch);

    /// "port 0", "port 1 (uart2)", "rover: port 0": what messages call a wire.
    [[nodiscard]] std::string port_name(const Station& station, std::size_t wire) const;

private:
    // Every wire has ended, and nothing else is left for which the run would go on.
    [[nodiscard]] bool in_vain(const RunWatch& watch) const;
    // The loop. What it says meanwhile is written by a thread of its own.
    void go(Emulator& emulator, RunWatch& watch);
    // Exit code: 1 where one of them could not be written.
    int tell_outputs(RunWatch& watch) const;
    void tell_that_it_was_cut() const;
    void tell_counts(const Station& station) const;
    void tell_overload(const Station& station) const;
    void tell_corrections(const CorrectionsWire& wire, const std::string& name) const;
    void tell_wire(const Station& station, std::size_t wire) const;
    // What the buildings around a receiver have to say that has not been said yet.
    std::optional<std::string> new_notice(std::size_t station);
    // What has happened to its wires and its power since the last call.
    std::vector<std::string> wire_news(std::size_t station);
    void tell_power(const Station& station) const;
    void tell_feeds() const;
    // "rover: " when there are several receivers.
    [[nodiscard]] std::string prefix(const Station& station) const;
    const Messages& messages_;
    Assembly& assembly_;
    std::set<std::size_t> noticed_;  // stations whose notice has been said
};

/// From here on SIGINT, SIGTERM and SIGHUP end a run in order, SIGHUP not where it was ignored before. Called before
/// any port is opened, so that none is left.
void catch_stop_signals();
/// One of them has come.
bool stop_was_asked();

/// The wall clock as GPS time: read once, at the start.
GpsTime wall_clock();

}  // namespace skyloop::host
