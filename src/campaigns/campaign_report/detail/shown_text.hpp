/// Texts of a database as they are shown.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace skyloop {

/// `text` on one line: control characters and what is not UTF-8 as '?', after `most` characters cut with "…".
std::string shown_text(std::string_view text, std::size_t most = 200);

}  // namespace skyloop
