/// Shell completions, made from the table of options.
#pragma once

#include <span>
#include <string>

#include "option_table.hpp"

namespace skyloop::host {

/// A file for bash-completion's folder: bash 4.4 or later, with nothing else needed.
std::string bash_completion(std::span<const CommandRow> commands);

/// A file `_skyloop` for zsh's fpath.
std::string zsh_completion(std::span<const CommandRow> commands);

}  // namespace skyloop::host
