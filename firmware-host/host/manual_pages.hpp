/// Pages about commands, made from their table of options.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "option_table.hpp"

namespace skyloop::host {

/// The manual page skyloop-NAME(1), in the macros of man(7).
std::string manual_page(const CommandRow& command, std::string_view version);

/// All commands with their options as one page of Markdown; hidden ones are left out.
std::string commands_markdown(std::span<const CommandRow> commands);

}  // namespace skyloop::host
