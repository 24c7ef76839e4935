/// Bytes to and from the outside world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline wire {

/// What the other end of a wire is doing.
struct LineState {
    bool connected = false;             ///< somebody listens
    std::optional<std::uint32_t> baud;  ///< the other end's line speed, bit/s; nothing where a wire has no speed
};

/// What a wire tells its owner of itself: nothing, unless it says so.
class WireReports {
public:
    virtual ~WireReports() = default;
    /// What has happened to the wire since the last call and its owner should hear at once, in sentences.
    virtual std::vector<std::string> take_news() { return {}; }
    /// What has ended the wire for good since it was opened, in one sentence; empty while nothing has. From then on it
    /// takes nothing.
    [[nodiscard]] virtual std::string failure() const { return {}; }
    /// What its owner should know at the end of a run, in one sentence; empty: nothing.
    [[nodiscard]] virtual std::string notice() const { return {}; }
    /// What is known of the other end and its settings, in a few words that change as it does; empty: nothing.
    [[nodiscard]] virtual std::string other_end() const { return {}; }
};

/// What a client makes of the receiver that it hears.
struct ClientBelief {
    bool trusts = false;  ///< it would navigate by this receiver
    std::string reason;
};

/// The other end of a wire that lives in simulated time: a client inside the program.
class SimulatedEnd {
public:
    virtual ~SimulatedEnd() = default;
    /// The simulated time, before each look at the wire.
    virtual void tell_time(GpsTime now) = 0;
    /// When it acts next, after `now`; nothing while it waits.
    [[nodiscard]] virtual std::optional<GpsTime> acts_at(GpsTime now) const = 0;
    /// What it believes, once after each change.
    virtual std::optional<ClientBelief> new_belief() { return std::nullopt; }
};

/// One wire. None of its functions waits, unless allow_waiting() has been called.
class Transport : public WireReports {
public:
    /// Offers bytes; gives how many were taken. Bytes offered while nobody is connected are taken and lost, as on a
    /// wire.
    virtual std::size_t write(ByteSpan bytes) = 0;
    /// What has come in since the last call.
    virtual Bytes read() = 0;
    virtual LineState line() = 0;
    /// For people: "/path/to/tty (pty)".
    [[nodiscard]] virtual std::string description() const = 0;

    /// Nothing refuses the run any more: what was there before it may make room.
    virtual void begin() {}
    /// In virtual time nothing comes late: from now on write() may wait for a reader rather than lose bytes. Wires that
    /// have a client's own pace, such as a terminal, go on as before.
    virtual void allow_waiting() {}
    /// Tells the wire the receiver's own speed: at first, so that a client that sets none finds the right one, and
    /// after each change, before the first bytes of the new speed.
    virtual void set_receiver_baud(std::uint32_t) {}
    /// Pulls the plug of a wire whose other end can see that, or puts it back. Others go on: nothing is sent or heard
    /// then.
    virtual void set_plugged(bool) {}
    /// Its other end, where that lives in simulated time; else null.
    virtual SimulatedEnd* simulated_end() { return nullptr; }
};

}  // namespace skyloop::inline wire
