/// A connection to a live source of truth, and the paths of its vehicles.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/core/result.hpp"
#include "motion/trajectory/live_path.hpp"
#include "motion/trajectory/source_clock.hpp"
#include "run/fault/command.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop::inline run {

/// How a source is reached. By udp_request we speak first, from a port that others know, and hear the host at whichever
/// port it answers from.
enum class FeedWire { udp_listen, udp_connect, udp_request, tcp_listen, tcp_connect, serial, udp_relay, tcp_relay };

/// A source as users write it: "udp-json:5000", "flightgear:5503", "gpsd:localhost", … Of IPv6 "udp-json:[::1]:5000".
struct FeedAddress {
    std::string text;     ///< as it was written
    std::string dialect;  ///< for make_dialect()
    FeedWire wire = FeedWire::udp_listen;
    std::string host = "127.0.0.1";  ///< or the serial device
    std::uint16_t port = 0;
    std::uint16_t own_port = 0;  ///< udp_request: ours, or any free one where it is taken
    std::uint32_t baud = 0;      ///< serial
    std::string to_host;         ///< relays: where the other end is
    std::uint16_t to_port = 0;
    bool hears_target = false;  ///< relays: truth comes from the other end; else from who connects to us
};

/// Fails with `usage`: what was found and what is expected. docs/feeds.md lists all.
Result<FeedAddress> parse_feed_address(std::string_view text);

/// What the run asks of its feed.
struct FeedSettings {
    FeedContext context{};
    ClockMode clock = ClockMode::realtime;
    LivePathSettings path{};
    /// Starts its thread; empty: an ordinary one.
    std::function<std::thread(std::function<void()>)> thread{};
};

/// What a feed has counted, for the end of a run.
struct FeedCounts {
    std::uint64_t messages = 0;  ///< datagrams, or pieces of a stream
    std::uint64_t bytes = 0;
    std::uint64_t samples = 0;
    std::uint64_t statements = 0;         ///< samples, and FeedNews::others
    std::uint64_t refused = 0;            ///< whole, and of no use
    std::uint64_t strangers = 0;          ///< datagrams of others than the one that is listened to
    std::uint64_t overflowed = 0;         ///< samples dropped because the loop did not take them
    std::uint64_t dropped_by_kernel = 0;  ///< SO_RXQ_OVFL
    std::uint64_t restarts = 0;           ///< of the source's clock
    std::uint64_t lost = 0;               ///< statements that the source counted and that have not come in their turn
};

/// A source on a thread of its own: it hears, decodes and answers; the loop takes what has come without waiting.
/// Listens on loopback unless a host is given; a lost connection is made again; time stamps are the kernel's.
class TruthFeed {
public:
    /// Listens, or begins to connect, when it returns. Fails with `outside` when the address cannot be used.
    static Result<std::unique_ptr<TruthFeed>> open(const FeedAddress& address, const FeedSettings& settings);
    virtual ~TruthFeed() = default;

    /// The path of one of the source's vehicles; empty: of the first that it speaks of. Before begin().
    virtual std::shared_ptr<LivePath> path(const std::string& vehicle) = 0;
    /// The same with settings of its own, where nobody has asked for this vehicle before.
    virtual std::shared_ptr<LivePath> path(const std::string& vehicle, const LivePathSettings& settings) = 0;
    /// The run waits until every path has a sample: somebody has no place before. A run that follows then starts with
    /// the newest statement about each of them. Before begin().
    virtual void wait_for_all() = 0;
    /// The run starts. @param steady_ns the steady clock at that instant
    virtual void begin(GpsTime start, std::int64_t steady_ns) = 0;
    /// The run is at `now` when the steady clock reads `steady_ns`: after a pause or a change of speed.
    virtual void set_run(GpsTime now, std::int64_t steady_ns) = 0;

    /// Puts what has come into the paths; by the loop's thread, never waits. @return what the source asks of the run
    virtual std::vector<Command> pump() = 0;
    /// Waits until something has come, at most so long; follow and lock_step. @return something has
    virtual bool wait(std::chrono::nanoseconds longest) = 0;
    /// How far the run may go: follow: the newest sample; lock_step: the newest step. Nothing: not at all yet.
    [[nodiscard]] virtual std::optional<GpsTime> horizon() const = 0;
    /// lock_step: the run has done all up to the horizon; answers the source. @param bytes that the run has put out
    virtual void stepped(std::uint64_t bytes) = 0;
    /// lock_step, while the run waits for a vehicle's first place: steps so far are answered, there was nothing to do
    /// for them, and the next statement is the start of the run.
    virtual void skip_steps() = 0;
    /// lock_step: a step is not answered yet. The source waits for us, and has nothing to say meanwhile.
    [[nodiscard]] virtual bool is_waited_on() const = 0;
    /// The source has said that it is over; where it spoke of several vehicles, none of them has come for 1.5 s since.
    [[nodiscard]] virtual bool ended() const = 0;
    /// True between FeedNews::paused = true and false.
    [[nodiscard]] virtual bool paused() const = 0;

    [[nodiscard]] virtual FeedCounts counts() const = 0;
    [[nodiscard]] virtual const SourceClock& clock() const = 0;
    /// What happened since the last call, a sentence each: connected, lost, refused statements, silent, jumped.
    virtual std::vector<std::string> take_news() = 0;
    /// "udp-json:127.0.0.1:5000"; "xplane:127.0.0.1:49000 (own port 49005)"
    [[nodiscard]] virtual std::string description() const = 0;
    /// As the system gave it, for listeners and udp_request.
    [[nodiscard]] virtual std::uint16_t port() const = 0;
};

}  // namespace skyloop::inline run
