/// Numbers on the command line, read more strictly than CLI11 does.
#pragma once

#include <CLI/CLI.hpp>

namespace skyloop::host {

/// Holds every option of `program` and of its subcommands that takes a number to plain ones: whole numbers are decimal
/// digits alone, within the range that the option declares (CLI::Range) or that its type has; others are finite.
void check_numbers(CLI::App& program);

}  // namespace skyloop::host
