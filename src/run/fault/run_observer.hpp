/// Who watches a run: verdicts, recordings, displays.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/bytes.hpp"
#include "firmware/navigation_state.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "run/fault/command.hpp"
#include "run/fault/timeline.hpp"
#include "world/flow/trace.hpp"

namespace skyloop {

/// An epoch of one receiver, after its firmware has seen it. Valid during the call.
struct EpochSeen {
    GpsTime now;
    std::size_t station = 0;
    const Trace& trace;                         ///< what was true, and what the receiver solved, faults among it
    const firmware::NavigationState& reported;  ///< what it reports of that
    Nanoseconds lateness{0};
    std::optional<GpsTime> leaves{};  ///< when its messages begin to; nothing: the receiver says nothing of this epoch
};

/// A whole message on a wire, as the receiver heard or sent it, before the wire's own faults.
struct MessageSeen {
    GpsTime now;
    std::size_t station = 0, wire = 0;
    bool from_client = true;
    StreamKind kind = StreamKind::ubx;
    std::string_view name;  ///< "CFG-VALSET", "UBX-0F-01" for an unknown one, "PUBX,41", "GGA", "sso"
    ByteSpan bytes;
};

/// A fault begins or ends.
struct FaultSeen {
    GpsTime now;
    std::string_view name, kind;  ///< of the entry; "receiver_silent"
    int occurrence = 1;
    bool begins = true;
};

/// A command is carried out.
struct CommandSeen {
    GpsTime now;
    std::string_view name;  ///< of the entry; of a live one its verb
    const Command& command;
    std::string_view ignored{};  ///< why nothing comes of it: "outage is under way"; empty: it is done
};

/// What a scripted client makes of what it hears, when that changes.
struct BeliefSeen {
    GpsTime now;
    std::size_t station = 0, wire = 0;
    bool trusts = false;      ///< it would navigate by this receiver
    std::string_view reason;  ///< "no message for 2.0 s"
};

/// Told what happens, in the order of time, by the thread of the loop; nothing in here may wait.
class RunObserver {
public:
    virtual ~RunObserver() = default;
    virtual void on_epoch(const EpochSeen&) {}
    virtual void on_message(const MessageSeen&) {}
    /// Whether on_message() is of use to it: finding the messages in all bytes costs time. Fixed from the beginning.
    [[nodiscard]] virtual bool wants_messages() const { return false; }
    virtual void on_fault(const FaultSeen&) {}
    virtual void on_command(const CommandSeen&) {}
    virtual void on_belief(const BeliefSeen&) {}
};

}  // namespace skyloop
