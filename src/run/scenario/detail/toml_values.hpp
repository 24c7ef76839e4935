/// TOML texts to tables, and values of keys to texts.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "run/scenario/campaign_settings.hpp"

namespace skyloop::inline run {

/// How many parts a key or header has at most; with one in whose inline table it stands, they count together.
inline constexpr std::size_t most_key_parts = 256;

/// toml::parse() for texts from anywhere: what it does with the tables of a dotted key takes stack for each part.
/// @param file its name, for the places in its errors
/// Throws toml::parse_error, for a key of more than most_key_parts, too.
toml::table parsed_toml(std::string_view text, std::string_view file = {});

/// The one text of a value, whatever way it was written: of numbers the shortest that is the same number, of texts with
/// everything beyond printable ASCII escaped. Nothing for tables and what holds them.
std::optional<std::string> toml_text(const toml::node& node);
/// Nothing as toml_text().
std::optional<CampaignValue> campaign_value(const toml::node& node);
/// Calls `use` with the node that the text of a value stands for. The text is one of toml_text().
void with_toml_value(const CampaignValue& value, const std::function<void(const toml::node&)>& use);

}  // namespace skyloop::inline run
