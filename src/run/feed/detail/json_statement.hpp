// One statement of skyloop-truth/1 (FEEDS.md 3.3), read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/json.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop::inline run {

// The one object that a line is. Fails with `input`: no JSON, no object, nested deeper than 16.
Result<JsonData> read_statement(std::string_view line);

// A member; null when it is absent or null.
const JsonData* statement_member(const JsonData& statement, const char* key);
// A text member; nothing when it is absent. Fails when it is something else.
Result<std::optional<std::string>> statement_text(const JsonData& statement, const char* key);
// A whole number.
Result<std::optional<std::int64_t>> statement_whole(const JsonData& statement, const char* key);
// "t" or "t_ns"; at most 127 years of either sign.
Result<std::optional<Nanoseconds>> statement_time(const JsonData& statement);
// "lla" with its "h_ref".
Result<Geodetic> statement_place(const JsonData& statement, const FeedContext& context);

// Where, how fast and how turned: all of a truth statement but its vehicle, time and counters.
// @param origin of "ned" and "enu"
Result<TruthSample> statement_sample(const JsonData& statement, const std::optional<Geodetic>& origin,
                                     const FeedContext& context);

// The command that an event asks for: its name is a command or a kind of fault, its args are their parameters.
Result<Command> statement_event(const JsonData& statement);

}  // namespace skyloop::inline run
