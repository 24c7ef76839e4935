/// The ears of a feed's thread: its dialects, and what comes of what they hear.
/// What the thread of a feed hands over to the loop.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "run/feed/feed_dialect.hpp"

namespace skyloop::inline run {

/// Lock-step: the run may go on to `until`, of the source's clock.
struct FeedStep {
    Nanoseconds until{0};
    std::int64_t received_ns = 0;
    std::uint64_t speaker = 0;  ///< who is answered
};
/// One thing that a source has said, in the order in which it came.
using FeedItem = std::variant<TruthSample, Command, FeedStep, FeedPause, FeedEnd>;

/// A queue that its reader never waits for. Bounded: when the reader stays away, the older half of the samples goes.
class FeedInbox {
public:
    /// Takes all of `items`, which is empty then; by the feed's thread. @return samples that were dropped
    std::size_t put(std::vector<FeedItem>& items);
    /// Exchanges what waits with `taken`, which must be empty. False when nothing waits or the other side is at it.
    bool try_take(std::vector<FeedItem>& taken);
    /// Waits until something is there, at most so long.
    bool wait(std::chrono::nanoseconds longest);

    static constexpr std::size_t most_waiting = 32768;

private:
    std::mutex mutex_;
    std::condition_variable came_;
    std::vector<FeedItem> waiting_;
};

/// Sentences for the user. A source that misbehaves must not flood him: of each kind one in five seconds, beside those
/// that are said once, and at most 64 that wait.
class FeedNewsDesk {
public:
    enum class Kind { connection, refusal, drop, jump, clock, vehicle, other };
    /// @param sentence what happened; where it had to be kept back before, their number is added
    void tell(Kind kind, std::string sentence, std::int64_t now_ns);
    /// A sentence that is said once in a run: what was told before it does not keep it back.
    /// @return whether it was taken; else it may be told again
    bool tell_once(std::string sentence);
    /// Never waits: gives nothing while another thread tells.
    std::vector<std::string> take();

private:
    struct Limit {
        std::int64_t told_ns = 0;
        std::uint64_t kept_back = 0;
        bool any = false;
    };
    static constexpr std::size_t most_waiting = 64;

    std::mutex mutex_;
    Limit limits_[7];
    std::vector<std::string> waiting_;
};

/// FeedCounts, from two threads.
struct FeedTallies {
    std::atomic<std::uint64_t> messages{0}, bytes{0}, samples{0}, statements{0}, refused{0}, strangers{0},
        overflowed{0}, dropped_by_kernel{0}, restarts{0}, lost{0};
};

/// What a feed's thread and the loop share.
struct FeedDesk {
    FeedInbox inbox;
    FeedNewsDesk news;
    FeedTallies tallies;
};

/// Lets a dialect hear, for each speaker one where speakers have streams of their own. All but the constructor belongs
/// to the feed's thread.
class FeedHearer {
public:
    FeedHearer(std::string dialect, FeedContext context, FeedDesk& desk);

    struct Heard {
        std::vector<Bytes> answers;
        bool understood = false;  ///< nothing was refused
    };
    /// @param speaker 0 for datagrams
    Heard hear(std::uint64_t speaker, ByteSpan bytes, std::int64_t received_ns);
    std::vector<Bytes> say(std::uint64_t speaker);
    std::vector<Bytes> stepped(std::uint64_t speaker, Nanoseconds until, std::uint64_t bytes);
    /// The speaker is gone.
    void forget(std::uint64_t speaker);
    /// The connection to it was lost, and is made again.
    void reconnected(std::uint64_t speaker);
    /// Hands over what has been heard since the last time.
    void flush();
    void tell(FeedNewsDesk::Kind kind, std::string sentence);
    FeedTallies& tallies() { return desk_.tallies; }

private:
    FeedDialect& of(std::uint64_t speaker);
    void keep(FeedNews news, std::uint64_t speaker, std::int64_t received_ns);
    void keep(FeedAside aside, std::uint64_t speaker, std::int64_t received_ns);
    void end_pause(std::uint64_t speaker);

    std::string name_;
    FeedContext context_;
    FeedDesk& desk_;
    std::map<std::uint64_t, std::unique_ptr<FeedDialect>> dialects_;
    std::set<std::uint64_t> paused_;  ///< the speakers that have told of a pause
    std::set<std::string> remarks_;   ///< that have been told: speakers of one kind have the same
    std::vector<FeedItem> items_;
};

}  // namespace skyloop::inline run
