/// What a caller says of its vehicle, in our frames and units.
#pragma once

#include "answer.hpp"
#include "base/geo/geoid.hpp"
#include "base/geo/local_frame.hpp"
#include "motion/trajectory/truth_sample.hpp"

namespace skyloop {

/// What the positions of a caller refer to.
struct TruthFrames {
    const Geoid* geoid = nullptr;  ///< null: heights above sea level are not understood
    const LocalFrame* local = nullptr;
};

/// Its time is left to the caller. Fails with SKY_E_ARG for fields that contradict each other, SKY_E_UNSUPPORTED for
/// ones that are not known, SKY_E_RANGE for numbers that are not finite or out of their bounds, SKY_E_STATE for a
/// height above sea level without a geoid.
Answer<TruthSample> truth_sample(const sky_truth& truth, const TruthFrames& frames);

}  // namespace skyloop
