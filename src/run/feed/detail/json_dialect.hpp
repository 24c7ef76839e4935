// Our own feed, lines of JSON: skyloop-truth/1 (FEEDS.md 3.3, docs/feeds.md).
#pragma once

#include <memory>

#include "run/feed/feed_dialect.hpp"

namespace skyloop {

std::unique_ptr<FeedDialect> make_json_dialect(const FeedContext& context);

}  // namespace skyloop
