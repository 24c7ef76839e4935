/// Of errors that are a sum of causes, the figures with any scale of each.
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

#include "campaigns/fit/modern_run.hpp"

namespace skyloop::inline campaigns {

/// Runs of one seed that differ in the scale of one cause each.
struct ScaledRuns {
    ModernRun base;  ///< with the scales about which it is
    struct Changed {
        std::size_t cause = 0;
        double by = 0;  ///< scale less that of the base
        ModernRun run;
    };
    std::vector<Changed> changed;
};

/// The position's error is nearly linear in those of the ranges: e(s) = e(s₀) + Σ (sₖ − s₀ₖ) ∂e/∂sₖ, the derivatives
/// being differences of two runs with the same random numbers. Variances and lagged products are then quadratic forms
/// of the scales, and cost nothing to be asked again.
class ErrorParts {
public:
    /// @param about the scales of the base runs
    /// @param placed as of fit_figures()
    ErrorParts(const std::vector<ScaledRuns>& seeds, const CauseScales& about, bool placed);
    /// With other scales, the mean of all seeds' products.
    [[nodiscard]] FitFigures figures(const CauseScales& scales) const;

private:
    static constexpr int parts = 1 + static_cast<int>(fitted_causes.size());
    using Form = Eigen::Matrix<double, parts, parts>;
    using Part = Eigen::Matrix<double, parts, 1>;
    static constexpr std::size_t axes = 3;
    struct AxisForms {
        Form variance = Form::Zero(), squares = Form::Zero();
        std::array<Form, fitted_lags.size()> lagged{};
    };
    void add(const ScaledRuns& runs);
    [[nodiscard]] SpreadFigures spread(std::size_t first_axis, std::size_t count, const Part& scale) const;

    CauseScales about_;
    bool placed_;
    double seeds_;
    std::array<AxisForms, axes> forms_{};
    std::array<bool, fitted_lags.size()> long_enough_{};
};

}  // namespace skyloop::inline campaigns
