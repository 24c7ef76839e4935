/// Words for a shell.
#pragma once

#include <string>
#include <string_view>

namespace skyloop {

/// One word of a POSIX shell (IEEE Std 1003.1, Shell Command Language, 2.2.2): as it is where nothing in it means
/// anything to a shell, else between single quotes.
std::string shell_quoted(std::string_view word);

}  // namespace skyloop
