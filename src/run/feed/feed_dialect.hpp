/// How live sources of truth speak.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "base/geo/geoid.hpp"
#include "base/geo/simulator_frames.hpp"
#include "motion/trajectory/trajectory.hpp"
#include "run/fault/command.hpp"

namespace skyloop::inline run {

/// Lock-step: the run may go on to a time of the source's clock.
struct FeedMilestone {
    Nanoseconds until{0};
};
/// The source's clock stands still, or goes on.
struct FeedPause {
    bool paused = false;
};
/// The source says goodbye.
struct FeedEnd {};
/// What a source says beside its samples; a command is what it asks of the run.
struct FeedAside {
    std::variant<Command, FeedMilestone, FeedPause, FeedEnd> what{};
    std::size_t samples = 0;  ///< of FeedNews::samples so many were said before
};

/// What came of the bytes that a dialect heard.
struct FeedNews {
    std::vector<TruthSample> samples{};  ///< in the order in which they came
    std::vector<FeedAside> asides{};     ///< the same
    std::vector<Bytes> answers{};        ///< for the sender
    std::size_t others =
        0;  ///< lines that were understood and are no samples, where a dialect has such: the source is there
    std::size_t refused = 0;  ///< statements that were whole and could not be used
    std::string refusal{};    ///< why, of the first of them, a sentence
    std::uint64_t lost = 0;   ///< statements that the source counted and that have not come
    std::string remark{};     ///< what the user should be told, in one line; once per dialect

    /// Said after all that there is so far.
    template <class What>
    void add_aside(What what) {
        asides.push_back({std::move(what), samples.size()});
    }
};

/// How a source's "height above the sea" is meant, which knows no geoid (FEEDS.md 1.15).
enum class SeaLevel { geoid, ellipsoid };

/// What a dialect is told of its surroundings.
struct FeedContext {
    const Geoid* geoid = nullptr;  ///< outlives the dialect; null: heights above the sea are taken as ellipsoidal
    SeaLevel sea_level = SeaLevel::geoid;
    std::optional<Geodetic> origin{};  ///< of sources that count in local metres
    std::optional<LocalMap> map{};     ///< how their metres lie on the Earth; nothing: as the source is known to mean
    bool smooth = false;               ///< positions of receivers (nmea, ubx, gpsd) go through a causal filter
    std::string vehicle{};             ///< that is wanted, of sources that must be asked for one; empty: any
    double rate_hz = 50;               ///< asked of sources that can be asked
    bool datagrams = false;            ///< what is heard at once is whole; else it is a piece of a stream
};

/// One kind of source, without a socket and without a clock: bytes in, samples and answers out.
///
/// State: what is left of a message that came in pieces, and what earlier messages said.
class FeedDialect {
public:
    virtual ~FeedDialect() = default;
    /// Takes a datagram, or the next piece of a stream. Any bytes may come; nothing is thrown.
    /// @param received_ns when, on our steady clock
    virtual FeedNews hear(ByteSpan bytes, std::int64_t received_ns) = 0;
    /// What is to be said unasked: at first when the connection stands, then every second (subscriptions, heartbeats).
    virtual std::vector<Bytes> say() { return {}; }
    /// Lock-step: the run has done what a FeedMilestone allowed. @param until that time @param bytes put out
    /// meanwhile by its receivers @return answers
    virtual std::vector<Bytes> stepped(Nanoseconds until, std::uint64_t bytes) {
        (void)until, (void)bytes;
        return {};
    }
    /// The connection was lost: what was left of a message is forgotten.
    virtual void reconnected() {}
};

/// The dialects by name: "json", "flightgear", … Null for an unknown one.
std::unique_ptr<FeedDialect> make_dialect(std::string_view name, const FeedContext& context);
/// Whether its sources can lead a run in lock-step: it knows FeedMilestone.
bool knows_steps(std::string_view dialect);

}  // namespace skyloop::inline run
