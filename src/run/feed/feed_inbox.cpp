#include "detail/feed_inbox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace skyloop {

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

}  // namespace skyloop
