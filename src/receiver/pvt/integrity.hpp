/// Whether the residuals of a solution are what noise makes, and which satellite is at fault when they are not.
/// Which satellites a receiver solves with that has no time for all of them, or better ones.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "receiver/pvt/navigation_parameters.hpp"
#include "receiver/pvt/single_point.hpp"
#include "world/flow/observations.hpp"

namespace skyloop::inline receiver {

/// PDOP up to which a geometry is sound; ours.
inline constexpr double soundest_pdop = 6;

/// The value that a chi-square variable exceeds with the given probability, x of Q(ν/2, x/2).
/// @param degrees of freedom, from 1  @param probability above 0, below 1
double chi_square_threshold(int degrees, double probability);

/// What the residuals say.
struct ResidualTest {
    bool consistent = true;  ///< the test was passed, after all exclusions; true without redundancy
    double of_all = 1;       ///< √(Σ r²/σ² / redundancy) before any exclusion; 1 without redundancy
};

/// A solution whose residuals were looked at.
struct CheckedSolution {
    SinglePoint solution;
    std::vector<SatelliteId> excluded;
    ResidualTest test;
};

/// Receiver autonomous integrity monitoring.
///
/// State: thresholds that were computed once.
class IntegrityMonitor {
public:
    explicit IntegrityMonitor(const IntegrityParameters& parameters);
    [[nodiscard]] double threshold(int degrees);
    /// Solves, tests Σ r²/σ² against chi-square, and while that fails excludes the satellite with the largest
    /// normalised residual, which is the one whose absence lowers the sum most. Excluded equations are marked.
    std::optional<CheckedSolution> solve(std::span<RangeEquation> equations, const SinglePointSetup& setup);

private:
    IntegrityParameters parameters_;
    std::vector<double> thresholds_;  // by degrees of freedom
};

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

}  // namespace skyloop::inline receiver
