/// Values of options, read more strictly than CLI11 does.
#pragma once

#include <CLI/CLI.hpp>

namespace skyloop::host {

/// Holds every option of `program` and of its subcommands that takes a number to plain ones: whole numbers are decimal
/// digits alone, within the range that the option declares (CLI::Range) or that its type has; others are finite.
void check_numbers(CLI::App& program);
/// Lets every option of `program` that takes a text refuse an empty one, as an unset variable of a script leaves it,
/// and another option in its place; those that take one of some words name them and the nearest.
void check_words(CLI::App& program);

}  // namespace skyloop::host
