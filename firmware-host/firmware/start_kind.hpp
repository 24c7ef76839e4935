/// Kinds of a start by their names.
#pragma once

#include <optional>
#include <string_view>

#include "world/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// "cold", "warm", "hot", as faults and commands name them; nothing for any other word.
std::optional<StartKind> start_kind(std::string_view word);

}  // namespace skyloop::firmware
