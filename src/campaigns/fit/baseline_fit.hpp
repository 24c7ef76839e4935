/// Which fractions of the delays bring the sensor model's errors nearest to a receiver's.
#pragma once

#include "campaigns/fit/baseline_run.hpp"
#include "study/analysis/statistics.hpp"

namespace skyloop::inline campaigns {

/// What was found.
struct BaselineFit {
    BaselineFractions fractions;  ///< with six digits of the larger one
    double difference = 0;        ///< D of comparison_percent() with them, percent
    bool at_limit = false;        ///< more than largest_fraction would have been nearer
};

/// The fractions with the least difference between the horizontal errors of `run` with them and `real`, by the
/// article's measure (MODELS.md D-17). Where several are as near, to a hundredth of a percent, those whose proportion
/// is nearest to the calibrated preset's.
///
/// One run says all: with the proportion of both fractions given, mean and standard deviation grow with their size, so
/// that the best size is where one of the two meets the receiver's; the proportions from 0 to 90° are scanned.
/// @param real of the horizontal radial error; its mean and standard deviation are larger than 0
BaselineFit fit_fractions(const BaselineRun& run, const SampleStatistics& real);

}  // namespace skyloop::inline campaigns
