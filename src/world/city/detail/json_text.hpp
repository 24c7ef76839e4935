/// JSON from strangers.
#pragma once

#include <string_view>

#include "base/core/json.hpp"
#include "base/core/result.hpp"

namespace skyloop::inline world {

/// What a name is of.
enum class JsonText { file, line };

/// Fails with `input` and "NAME:LINE:COLUMN: …" for what is no JSON, is cut, or nests deeper than a hundred levels;
/// "NAME:COLUMN: …" where the name is that of a line.
Result<JsonData> parse_json(std::string_view text, std::string_view name, JsonText extent = JsonText::file);

/// A member of an object; null when it has none or is no object.
const JsonData& member(const JsonData& value, const char* key);

/// A text member, empty when there is none.
std::string_view text_member(const JsonData& value, const char* key);

}  // namespace skyloop::inline world
