/// Words for whoever reads standard error.
#pragma once

#include <string_view>

namespace skyloop {

/// Writes to standard error. That nobody reads it, or that its disk is full, is no reason to end: unlike
/// fmt::print() this never throws because of it.
void say(std::string_view text);

}  // namespace skyloop
