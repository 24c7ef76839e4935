// What a dialect has heard beside samples.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "run/feed/feed_dialect.hpp"

namespace skyloop {

// Those of one kind: Command, FeedMilestone, FeedPause, FeedEnd.
template <class Kind>
std::vector<Kind> asides_of(const FeedNews& news) {
    std::vector<Kind> found;
    for (const FeedAside& aside : news.asides)
        if (const auto* what = std::get_if<Kind>(&aside.what)) found.push_back(*what);
    return found;
}

// What was said last of the source's clock: it stands, or goes on.
inline std::optional<bool> pause_told(const FeedNews& news) {
    const auto told = asides_of<FeedPause>(news);
    return told.empty() ? std::nullopt : std::optional(told.back().paused);
}

}  // namespace skyloop
