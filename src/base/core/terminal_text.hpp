/// Texts of files, as a terminal may have them.
#pragma once

#include <string>
#include <string_view>

namespace skyloop {

/// What would lead a terminal elsewhere, or break the line, as JSON writes it: \u001b. The rest as it stands.
std::string on_a_terminal(std::string_view text);

}  // namespace skyloop
