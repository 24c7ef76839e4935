/// Words for a shell.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace skyloop {

/// One word of a POSIX shell (IEEE Std 1003.1, Shell Command Language, 2.2.2): as it is where nothing in it means
/// anything to a shell, else between single quotes.
std::string shell_quoted(std::string_view word);
/// The same of a file's name, which a program does not take for an option where it begins with a dash.
std::string shell_quoted_path(std::string_view path);
/// A command of words that a shell reads back as they were.
std::string shell_quoted(const std::vector<std::string>& words);

}  // namespace skyloop
