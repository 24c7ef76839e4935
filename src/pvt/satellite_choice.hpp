/// Which satellites a receiver solves with that has no time for all of them, or better ones.
#pragma once

#include <optional>
#include <span>

#include "skyloop/flow/observations.hpp"
#include "skyloop/flow/receiver_settings.hpp"
#include "skyloop/pvt/integrity.hpp"

namespace skyloop {

/// Leaves `settings.most_satellites` satellites with pseudoranges, those whose strongest signal is; the others stay
/// tracked. Of equally strong ones those that come first.
void keep_strongest(Observations& observations, const ReceiverSettings& settings);

/// Solves with the ranges alone that the ionosphere does not touch, where they make a position of a sound geometry and
/// one of them is left to check it; with all ranges otherwise, and where all are of one kind. The mixture would have of
/// the ionosphere whatever the model leaves of it.
std::optional<CheckedSolution> solve_free_of_ionosphere(IntegrityMonitor& monitor, std::span<RangeEquation> equations,
                                                        const SinglePointSetup& setup);

}  // namespace skyloop
