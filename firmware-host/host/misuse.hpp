/// What was wrong with the words of a command line, in one line.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace skyloop::host {

/// What `error`, thrown by `program` as it read its words, says of them.
std::string misuse_text(const CLI::App& program, const CLI::ParseError& error);

/// What is wrong with an option whose value is empty behind its '=': the next word would be taken for it. Of
/// `--option=` alone; nothing where all have values.
std::optional<std::string> value_left_out(const std::vector<std::string>& words);

}  // namespace skyloop::host
