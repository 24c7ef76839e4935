/// What a board holds, for people and programs.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop::inline run {

/// All of a board, with what it takes from others and every default filled in: `name`, `files`, `aliases`, `sources`;
/// an object for each table of its file; `messages` with the rates of each port from the factory on, in the order in
/// which they leave; `items`: how many, of which list, and those whose value differs from that of the table of items.
/// Fails as find_board().
Result<std::string> board_json(std::string_view name, std::span<const std::filesystem::path> directories);

/// The same as tables of text.
Result<std::string> board_text(std::string_view name, std::span<const std::filesystem::path> directories);

}  // namespace skyloop::inline run
