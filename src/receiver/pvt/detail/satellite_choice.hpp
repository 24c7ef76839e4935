/// Which satellites a receiver solves with that has no time for all of them, or better ones.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "receiver/pvt/integrity.hpp"
#include "world/flow/observations.hpp"

namespace skyloop {

/// Of the ranges that a solution has used, which alone tells what can be used, leaves those of the `most` strongest
/// signals for another solution; of equally strong ones those that come first. False where there are not more of them,
/// or `most` is 0. @param observations behind the equations
bool keep_strongest(const SinglePoint& point, std::size_t most, std::vector<RangeEquation>& equations,
                    std::vector<const Observation*>& observations);

/// Solves with the ranges alone that the ionosphere does not touch, where they make a position of a sound geometry and
/// one of them is left to check it; with all ranges otherwise, and where all are of one kind. The mixture would have of
/// the ionosphere whatever the model leaves of it.
std::optional<CheckedSolution> solve_free_of_ionosphere(IntegrityMonitor& monitor, std::span<RangeEquation> equations,
                                                        const SinglePointSetup& setup);

}  // namespace skyloop
