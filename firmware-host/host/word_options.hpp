/// Values of options that are no numbers, as the command line tells them.
#pragma once

#include <CLI/CLI.hpp>

namespace skyloop::host {

/// Lets every option of `program` that takes a text refuse an empty one, as an unset variable of a script leaves it,
/// and another option in its place; those that take one of some words name them and the nearest.
void check_words(CLI::App& program);

}  // namespace skyloop::host
