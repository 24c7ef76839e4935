/// What of a receiver's errors at rest is compared with a model's.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/analysis/statistics.hpp"

namespace skyloop::inline campaigns {

/// Lags at which the course of errors is compared, seconds.
inline constexpr std::array fitted_lags{10.0, 60.0, 300.0};

/// Figures of one plane or axis.
struct SpreadFigures {
    double deviation = 0;         ///< σ about the mean, m; of the plane √(σ_E² + σ_N²)
    std::optional<double> rms{};  ///< about the antenna's place, m; nothing: it is not known
    /// At fitted_lags; of the plane that of both axes, weighted by their variances. Nothing where the record is too
    /// short for the lag.
    std::array<std::optional<double>, fitted_lags.size()> correlation{};
};

/// All of them.
struct FitFigures {
    SpreadFigures horizontal, vertical;
};

/// The figures of errors. @param times of each of them
/// @param placed whether the errors are about the place of the antenna, not about their own mean
FitFigures fit_figures(const PositionErrors& errors, const FixTimes& times, bool placed);

/// By how much all of a model's errors would have to be larger to be as large as the log's: the mean over deviations
/// and rms, and the figures of errors that are.
double size_ratio(const FitFigures& model, const FitFigures& log);
FitFigures enlarged(FitFigures figures, double by);

/// How far a model's figures are from a log's: for each figure that both have the difference over what of it is chance
/// in an hour. 1: as far as two hours of one receiver (MEASURED: the standard deviations of five hours of a LEA-6
/// differ by 10 to 30 %).
std::vector<double> figure_distances(const FitFigures& model, const FitFigures& log);

/// A figure as it is told: its name and value, "" where there is none.
struct ToldFigure {
    std::string name, value;
};
std::vector<ToldFigure> told_figures(const FitFigures& figures);

}  // namespace skyloop::inline campaigns
