/// Whether the residuals of a solution are what noise makes, and which satellite is at fault when they are not.
#pragma once

#include <span>
#include <vector>

#include "receiver/pvt/navigation_parameters.hpp"
#include "receiver/pvt/single_point.hpp"

namespace skyloop {

/// The value that a chi-square variable exceeds with the given probability, x of Q(ν/2, x/2).
/// @param degrees of freedom, from 1  @param probability above 0, below 1
double chi_square_threshold(int degrees, double probability);

/// A solution whose residuals were looked at.
struct CheckedSolution {
    SinglePoint solution;
    std::vector<SatelliteId> excluded;
    bool consistent = true;  ///< by the test after all exclusions; true without redundancy
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

}  // namespace skyloop
