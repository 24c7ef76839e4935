/// The ears of a feed's thread: its dialects, and what comes of what they hear.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "feed_inbox.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop {

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

}  // namespace skyloop
