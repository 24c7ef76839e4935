/// What a fuzz body promises of its subject.
#pragma once

#include <cstdlib>

namespace skyloop {

/// Ends the program, which the fuzzer takes for a finding, where the promise is broken.
inline void require(bool promise) {
    if (!promise) std::abort();
}

}  // namespace skyloop
