/// Which files a vehicle's command is made of.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace skyloop {

/// The words of a command for /bin/sh that have a slash and are regular files, seen from the working folder; not those
/// that it writes with `>`. Nothing is expanded: $HOME/sitl and *.parm are no files.
std::vector<std::string> files_of_command(std::string_view command);

}  // namespace skyloop
