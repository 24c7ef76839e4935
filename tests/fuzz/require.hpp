/// What a fuzz body promises of its subject.
#pragma once

#include <cstdlib>
#include <string_view>

namespace skyloop {

/// Ends the program, which the fuzzer takes for a finding, where the promise is broken.
inline void require(bool promise) {
    if (!promise) std::abort();
}

/// As an error or a warning is.
inline bool is_one_line(std::string_view text) { return !text.empty() && text.find('\n') == std::string_view::npos; }

}  // namespace skyloop
