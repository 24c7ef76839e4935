/// Boards that extend others.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <span>
#include <vector>

#include "table_reader.hpp"

namespace skyloop::inline run {

/// Lays the board that `board` extends under it, that which this one extends, and so on: what is written nearer to the
/// board stands, a list as a whole; `aliases` are of one board alone. A mistake for a parent that is not found, that
/// cannot be read, or that extends the board in turn.
/// @param file of the board
/// @param directories that are searched for `receivers/<name>.toml`, behind the folder of the file that names it
/// @return the files of the parents, the nearest first
/// Throws toml::parse_error for one that is not TOML.
std::vector<std::filesystem::path> lay_parents_under(toml::table& board, const std::filesystem::path& file,
                                                     std::span<const std::filesystem::path> directories,
                                                     MistakeList& mistakes);

}  // namespace skyloop::inline run
