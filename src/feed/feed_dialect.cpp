#include "skyloop/feed/feed_dialect.hpp"

#include <array>

namespace skyloop {
namespace {

// One dialect.
struct NamedDialect {
    std::string_view name;
    std::unique_ptr<FeedDialect> (*make)(const FeedContext&);
};

constexpr std::array<NamedDialect, 0> dialects{};

}  // namespace

std::unique_ptr<FeedDialect> make_dialect(std::string_view name, const FeedContext& context) {
    for (const NamedDialect& dialect : dialects)
        if (dialect.name == name) return dialect.make(context);
    return nullptr;
}

}  // namespace skyloop
