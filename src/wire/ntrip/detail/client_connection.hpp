/// One conversation with a caster at a time.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "client_inbox.hpp"
#include "wire/ntrip/ntrip_address.hpp"
#include "wire/ntrip/ntrip_answer.hpp"

namespace skyloop::inline wire {

/// What a caster is asked.
struct ClientQuestion {
    const NtripAddress& address;
    std::string mount;  ///< empty: the source table
    int version = 2;    ///< of NTRIP
    std::chrono::seconds position_every{10};
};

/// What became of a conversation that is over.
struct ClientOutcome {
    bool connected = false;               ///< somebody listens there
    bool streamed = false;                ///< what was asked for was granted
    bool brought = false;                 ///< corrections came
    std::optional<NtripVerdict> verdict;  ///< nothing: no answer came
    std::string problem;                  ///< why it is over, where no verdict says so
    std::string table;                    ///< that came in place of corrections
};

/// Sockets, names and timers of one thread.
class ClientLine {
public:
    ClientLine();
    ~ClientLine();
    ClientLine(const ClientLine&) = delete;
    ClientLine& operator=(const ClientLine&) = delete;

    /// Asks, and hands on what comes until it ends.
    ClientOutcome converse(const ClientQuestion& question, ClientInbox& inbox);
    void rest(double seconds);
    /// From any thread: what is under way ends, and nothing more begins.
    void stop();
    [[nodiscard]] bool stopped() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace skyloop::inline wire
