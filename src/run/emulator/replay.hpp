/// A recording once more, onto wires.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "run/emulator/link.hpp"
#include "run/emulator/read_recording.hpp"
#include "run/emulator/timing.hpp"

namespace skyloop::inline run {

/// Plays recorded ports, each onto a wire of its own. What clients send is read and forgotten.
class Replay {
public:
    struct Parts {
        std::vector<RecordedPort> ports;
        std::vector<std::unique_ptr<Transport>> wires;  ///< one a port
        PortSpeed
            baud{};  ///< of the lines, bit/s: a client at another one hears garble; nothing: as the clients set it
        double speed = 1;  ///< recorded seconds per second
    };
    explicit Replay(Parts parts);

    /// Asked again and again: true ends the waiting and the play.
    using Stop = std::function<bool()>;
    /// Waits until each wire has a client.
    void await_clients(const Stop& stop);
    /// Plays to the end of the recording, or until every wire has ended. At last it gives clients half a second to read
    /// what is left, since a wire that is closed takes with it what was not read.
    void play(const Stop& stop);

    [[nodiscard]] const std::vector<Link>& links() const { return links_; }
    [[nodiscard]] std::vector<Link>& links() { return links_; }
    /// How much later than due writes left.
    [[nodiscard]] const LatenessHistogram& lateness() const { return lateness_; }
    [[nodiscard]] std::uint64_t writes() const { return writes_; }

private:
    [[nodiscard]] std::optional<Nanoseconds> next_write() const;
    [[nodiscard]] bool all_ended() const;
    void look(Nanoseconds now);
    void write_due(Nanoseconds now, Nanoseconds late);

    Parts parts_;
    std::vector<Link> links_;
    std::vector<std::size_t> done_;  // writes of each port
    LatenessHistogram lateness_;
    std::uint64_t writes_ = 0;
};

}  // namespace skyloop::inline run
