/// Errors that go together, for the tests of the receiver.
#pragma once

#include "world/flow/fix.hpp"

namespace skyloop::firmware {

/// Of a solution whose height and clock go together most of all, as those of satellites above do.
inline ErrorCorrelation sample_correlation() {
    ErrorCorrelation correlation;
    // clang-format off
    correlation.position_clock <<  1.0,  0.2, -0.4, -0.3,
                                   0.2,  1.0,  0.1,  0.05,
                                  -0.4,  0.1,  1.0,  0.9,
                                  -0.3,  0.05, 0.9,  1.0;
    correlation.velocity <<  1.0, 0.2, -0.3,
                             0.2, 1.0,  0.1,
                            -0.3, 0.1,  1.0;
    // clang-format on
    return correlation;
}

}  // namespace skyloop::firmware
