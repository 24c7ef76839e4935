/// Who watches a run: verdicts, recordings, displays.
/// Which receivers of a run have fallen silent.
/// What observers make of an epoch that they are shown.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/units.hpp"
#include "firmware/core/navigation_state.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "run/fault/command.hpp"
#include "run/fault/timeline.hpp"
#include "world/flow/trace.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline run {

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

/// A receiver that has reported no epoch for so long tells its users nothing: what it said before is no fix of now.
inline constexpr Seconds silent_after{2};

/// Takes the epochs of a run. State: when each receiver reported last; before its first report the run's start.
class SilenceWatch {
public:
    explicit SilenceWatch(GpsTime start) : start_(start) {}

    /// @param now of the epoch; of one receiver it never goes back
    /// @return whether the receiver reports nothing of it, nor has for silent_after
    bool is_silent(const EpochSeen& seen, GpsTime now) {
        GpsTime& told_at = told_at_.try_emplace(seen.station, start_).first->second;
        if (seen.leaves) told_at = now;
        return difference(now, told_at) >= silent_after;
    }

private:
    GpsTime start_;
    std::map<std::size_t, GpsTime> told_at_;  // by station
};

/// One satellite above the antenna, and what the receiver makes of it.
struct SatelliteSeen {
    SatelliteId id;
    Angle azimuth, elevation;
    Reception state = Reception::line_of_sight;
    bool used = false;    ///< in the solution
    bool healthy = true;  ///< by its broadcast
    int paths = 1;        ///< rays that arrive
    [[nodiscard]] bool in_sight() const { return state == Reception::line_of_sight || state == Reception::shadowed; }
    /// C/N0 of each signal that the receiver tracks; of a sensor model the first signal's alone.
    std::vector<std::pair<Signal, DbHz>> signals;
};

/// East, north, up.
struct EnuError {
    Metres east, north, up;
};

/// All satellites above the horizon, in the order of the trace.
std::vector<SatelliteSeen> satellites_seen(const EpochSeen& seen);

/// Fix − truth. Only for a fix that has a position.
EnuError enu_error(const TruthState& truth, const Fix& fix);

}  // namespace skyloop::inline run
