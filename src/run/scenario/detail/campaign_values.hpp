/// Values of keys as texts.
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <optional>
#include <string>

#include "run/scenario/campaign_settings.hpp"

namespace skyloop {

/// The one text of a value, whatever way it was written: of numbers the shortest that is the same number, of texts with
/// everything beyond printable ASCII escaped. Nothing for tables and what holds them.
std::optional<std::string> toml_text(const toml::node& node);
/// Nothing as toml_text().
std::optional<CampaignValue> campaign_value(const toml::node& node);
/// Calls `use` with the node that the text of a value stands for. The text is one of toml_text().
void with_toml_value(const CampaignValue& value, const std::function<void(const toml::node&)>& use);

}  // namespace skyloop
