/// Kinds of a start by their names.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "world/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// In the order of StartKind.
inline constexpr std::array<std::string_view, 3> start_kind_names{"cold", "warm", "hot"};

/// One of start_kind_names, as faults and commands name them; nothing for any other word.
inline std::optional<StartKind> start_kind(std::string_view word) {
    for (std::size_t i = 0; i < start_kind_names.size(); ++i)
        if (start_kind_names[i] == word) return static_cast<StartKind>(i);
    return std::nullopt;
}

}  // namespace skyloop::firmware
