/// What displays are shown of a run, as plain data.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "run/fault/run_observer.hpp"
#include "world/flow/epoch.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/reference_station.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline run {

/// One wire of a receiver.
struct WireStatus {
    std::string port;         ///< "uart1"
    std::string description;  ///< "/dev/pts/3 (pty)"
    std::string other_end;    ///< "attached by 10.0.0.7:51022, 115200 8N1, DTR"; empty: nothing is known
    std::optional<std::uint32_t> baud;
    bool connected = false;                                     ///< a client listens
    std::uint64_t bytes_out = 0, bytes_in = 0, bytes_lost = 0;  ///< lost: the client did not read in time
    std::uint64_t bytes_unheard = 0, bytes_garbled = 0;         ///< nobody listened; at another speed
    std::uint64_t messages_sent = 0, messages_dropped = 0;      ///< dropped: the transmit buffer was full
    std::string belief;                                         ///< of a scripted client; empty: none
    bool trusted = false;                                       ///< … it would navigate by this receiver
};

/// What a receiver has of a base station, or of the base antenna of a moving pair, as it tells it.
struct CorrectionsStatus {
    CorrectionState solution = CorrectionState::none;  ///< what of them is in its solution
    Seconds age{0};                                    ///< of the base's data
    int station = 0;                                   ///< number of the base, 0 … 4095
    std::optional<Geodetic> base;                      ///< where it says it stands, right or wrong; nothing: not told
    std::optional<RelativePosition> baseline;          ///< from the base; nothing while none of it is in the solution
};

/// One receiver at its last epoch that was looked at.
struct ReceiverStatus {
    std::string name, board;
    double rate_hz = 0;
    GpsTime epoch{};
    std::uint64_t epochs = 0;
    Geodetic truth;
    MetresPerSecond true_speed;     ///< over the ground
    Fix fix;                        ///< as last reported, none after silent_after; its satellites are left out
    bool fix_ok = false;            ///< within the user's limits (gnssFixOK)
    std::optional<EnuError> error;  ///< reported − true, while there is a position
    /// Nothing before corrections have come in, and none of a receiver that has fallen silent.
    std::optional<CorrectionsStatus> corrections;
    int satellites_used = 0;
    int jamming_state = 0;  ///< 0 unknown, 1 ok, 2 warning, 3 critical
    int spoofing = 0;       ///< as NAV-STATUS spoofDetState
    Decibels interference;  ///< rise of the noise floor, in the band where it is larger
    Nanoseconds lateness{0};
    std::vector<SatelliteSeen> satellites;
    std::vector<WireStatus> wires;
};

/// A fault or command of the timeline, or a live one, with what is known of its times.
struct TimelineBar {
    std::string name, kind;  ///< "receiver_silent"; of a command its verb
    bool command = false;
    bool live = false;              ///< asked for while the run goes on
    int occurrence = 0;             ///< 0: has not begun
    std::optional<GpsTime> begins;  ///< or began
    std::optional<GpsTime> ends;    ///< or ended
    bool active = false;
    double strength = 0;   ///< 0 … 1, while active and while it fades afterwards
    std::string receiver;  ///< empty: all
    std::string words;     ///< how the scenario describes its times: "every 60 s"
};

/// What is known of one expectation.
struct VerdictStatus {
    std::string name, what;
    std::string state;   ///< "pending", "passed", "failed"; at the end of a run "undecided", "not run"
    std::string detail;  ///< why
};

/// A message on a wire, as kept for displays.
struct DialogueLine {
    std::uint64_t sequence = 0;  ///< from 1 on, without gaps
    GpsTime time{};
    std::size_t receiver = 0, wire = 0;
    bool from_client = true;
    StreamKind kind = StreamKind::ubx;
    std::string name;
    std::size_t size = 0;  ///< bytes of the message
    Bytes bytes;           ///< the first of them, at most dialogue_bytes
};
inline constexpr std::size_t dialogue_bytes = 1024;

/// How many messages of one name went one way over a wire since the start of the run.
struct MessageCount {
    std::size_t receiver = 0, wire = 0;
    bool from_client = true;
    StreamKind kind = StreamKind::ubx;
    std::string name;  ///< as of a DialogueLine
    std::uint64_t count = 0;
};

/// Something that happened once.
struct EventLine {
    std::uint64_t sequence = 0;  ///< from 1 on, without gaps
    GpsTime time{};
    std::string what;  ///< "fault begins", "fault ends", "command", "belief"
    std::string text;
};

/// How simulated time passes at the moment.
struct PaceStatus {
    bool paused = false;
    double speed = 1;  ///< simulated seconds per second
    bool virtual_time = false;
};

/// The run's own caster, and who hears it.
struct CasterStatus {
    std::string address;                                 ///< "127.0.0.1:2101 (BASE)"
    std::uint64_t clients = 0;                           ///< now
    std::uint64_t served = 0, refused = 0, dropped = 0;  ///< of all that came; dropped: they read too slowly
};

/// Everything at one instant. Immutable once published.
struct StatusSnapshot {
    std::uint64_t sequence = 0;  ///< grows with each snapshot
    std::uint64_t answers = 0;   ///< the last StatusBoard::ask() that it is an answer to
    GpsTime time{}, start{};
    std::optional<GpsTime> end;
    int leap_seconds = 18;  ///< GPST − UTC, s
    std::string title;      ///< of the scenario
    PaceStatus pace;
    std::vector<ReceiverStatus> receivers;
    std::vector<TimelineBar> timeline;
    std::vector<VerdictStatus> verdicts;
    std::optional<CasterStatus> caster;
    std::vector<std::shared_ptr<const DialogueLine>> dialogue;  ///< the last ones, ascending
    std::vector<MessageCount> messages;                         ///< of all that came, by receiver, wire, way and name
    std::vector<std::shared_ptr<const EventLine>> events;       ///< the last ones, ascending
};

}  // namespace skyloop::inline run
