/// Which files a vehicle's command is made of.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace skyloop {

/// The words of a command for /bin/sh that have a slash and are programs, seen from the working folder: regular files
/// that may be executed, begin with `#!`, or end in .py, .sh or .lua. Not what it writes, with `>` or by an option as a
/// log is named: that is another after each run. Nothing is expanded: $HOME/sitl is no file.
std::vector<std::string> programs_of_command(std::string_view command);

}  // namespace skyloop
