/// Files in a tar archive that lies in memory.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop {

/// Regular files by name, as views of `bytes`; links, folders and devices are left out, and names that lead outside.
/// ustar, pax and GNU names (POSIX.1-2017 pax; GNU tar manual, "Basic Tar Format"). Nothing is written anywhere.
/// Fails with `input` when a header is damaged or a file ends early.
Result<std::map<std::string, std::string_view>> tar_members(std::string_view bytes, std::string_view name);

}  // namespace skyloop
