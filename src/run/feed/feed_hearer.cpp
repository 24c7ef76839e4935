#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/core/threads.hpp"
#include "detail/feed_hearer.hpp"

namespace skyloop::inline run {

std::size_t FeedInbox::put(std::vector<FeedItem>& items) {
    if (items.empty()) return 0;
    std::size_t dropped = 0;
    {
        const std::lock_guard lock(mutex_);
        waiting_.insert(waiting_.end(), std::make_move_iterator(items.begin()), std::make_move_iterator(items.end()));
        if (waiting_.size() > most_waiting) {
            const auto half = waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_.size() / 2);
            const auto kept = std::stable_partition(waiting_.begin(), half, [](const FeedItem& item) {
                return !std::holds_alternative<TruthSample>(item);
            });
            dropped = static_cast<std::size_t>(half - kept);
            waiting_.erase(kept, half);
            // What is left are commands without end.
            if (waiting_.size() > 2 * most_waiting)
                waiting_.erase(waiting_.begin(), waiting_.end() - static_cast<std::ptrdiff_t>(most_waiting));
        }
    }
    items.clear();
    came_.notify_one();
    return dropped;
}

bool FeedInbox::try_take(std::vector<FeedItem>& taken) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || waiting_.empty()) return false;
    waiting_.swap(taken);
    return true;
}

bool FeedInbox::wait(std::chrono::nanoseconds longest) {
    std::unique_lock lock(mutex_);
    return came_.wait_for(lock, longest, [this] { return !waiting_.empty(); });
}

void FeedNewsDesk::tell(Kind kind, std::string sentence, std::int64_t now_ns) {
    constexpr std::int64_t distance_ns = 5'000'000'000;
    const std::lock_guard lock(mutex_);
    Limit& limit = limits_[static_cast<std::size_t>(kind)];
    if ((limit.any && now_ns - limit.told_ns < distance_ns) || waiting_.size() >= most_waiting) {
        ++limit.kept_back;
        return;
    }
    if (limit.kept_back > 0) sentence += fmt::format(" (and {} times before)", limit.kept_back);
    limit = {now_ns, 0, true};
    waiting_.push_back(std::move(sentence));
}

bool FeedNewsDesk::tell_once(std::string sentence) {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= most_waiting) return false;
    waiting_.push_back(std::move(sentence));
    return true;
}

std::vector<std::string> FeedNewsDesk::take() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock.owns_lock() ? std::exchange(waiting_, {}) : std::vector<std::string>();
}

FeedHearer::FeedHearer(std::string dialect, FeedContext context, FeedDesk& desk)
    : name_(std::move(dialect)), context_(std::move(context)), desk_(desk) {}

FeedDialect& FeedHearer::of(std::uint64_t speaker) {
    auto& dialect = dialects_[speaker];
    if (!dialect) dialect = make_dialect(name_, context_);
    return *dialect;
}

FeedHearer::Heard FeedHearer::hear(std::uint64_t speaker, ByteSpan bytes, std::int64_t received_ns) {
    desk_.tallies.messages += 1;
    desk_.tallies.bytes += bytes.size();
    FeedNews news = of(speaker).hear(bytes, received_ns);
    Heard heard{std::move(news.answers), news.refused == 0};
    keep(std::move(news), speaker, received_ns);
    return heard;
}

void FeedHearer::keep(FeedNews news, std::uint64_t speaker, std::int64_t received_ns) {
    desk_.tallies.samples += news.samples.size();
    desk_.tallies.statements += news.samples.size() + news.others;
    desk_.tallies.lost += news.lost;
    if (!news.remark.empty() && !remarks_.contains(news.remark) && desk_.news.tell_once(news.remark))
        remarks_.insert(std::move(news.remark));
    if (news.refused > 0) {
        desk_.tallies.refused += news.refused;
        tell(FeedNewsDesk::Kind::refusal, "refused: " + news.refusal);
    }
    auto aside = news.asides.begin();
    for (std::size_t i = 0; i <= news.samples.size(); ++i) {
        for (; aside != news.asides.end() && aside->samples <= i; ++aside)
            keep(std::move(*aside), speaker, received_ns);
        if (i < news.samples.size()) items_.emplace_back(std::move(news.samples[i]));
    }
}

void FeedHearer::keep(FeedAside aside, std::uint64_t speaker, std::int64_t received_ns) {
    if (const auto* step = std::get_if<FeedMilestone>(&aside.what))
        items_.emplace_back(FeedStep{step->until, received_ns, speaker});
    else if (auto* command = std::get_if<Command>(&aside.what))
        items_.emplace_back(std::move(*command));
    else if (const auto* pause = std::get_if<FeedPause>(&aside.what)) {
        if (pause->paused)
            paused_.insert(speaker);
        else
            paused_.erase(speaker);
        items_.emplace_back(*pause);
    } else
        items_.emplace_back(FeedEnd{});
}

std::vector<Bytes> FeedHearer::say(std::uint64_t speaker) { return of(speaker).say(); }

std::vector<Bytes> FeedHearer::stepped(std::uint64_t speaker, Nanoseconds until, std::uint64_t bytes) {
    const auto found = dialects_.find(speaker);
    return found == dialects_.end() ? std::vector<Bytes>() : found->second->stepped(until, bytes);
}

// A pause ends with the connection that told of it: nobody is left to do so.
void FeedHearer::end_pause(std::uint64_t speaker) {
    if (paused_.erase(speaker) > 0 && paused_.empty()) items_.emplace_back(FeedPause{false});
}

void FeedHearer::forget(std::uint64_t speaker) {
    dialects_.erase(speaker);
    end_pause(speaker);
}

void FeedHearer::reconnected(std::uint64_t speaker) {
    of(speaker).reconnected();
    end_pause(speaker);
}

void FeedHearer::flush() {
    const std::size_t dropped = desk_.inbox.put(items_);
    if (dropped == 0) return;
    desk_.tallies.overflowed += dropped;
    tell(FeedNewsDesk::Kind::drop, fmt::format("{} samples dropped: the run does not take them as fast", dropped));
}

void FeedHearer::tell(FeedNewsDesk::Kind kind, std::string sentence) {
    desk_.news.tell(kind, std::move(sentence), steady_clock_ns());
}

}  // namespace skyloop::inline run
