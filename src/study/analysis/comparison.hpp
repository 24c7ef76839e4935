/// Two fix files side by side: statistics of both, their differences in percent and the article's agreement.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "study/analysis/fix_series.hpp"
#include "study/analysis/statistics.hpp"

namespace skyloop::inline study {

/// The error series that figures are made from, metres.
enum class ErrorQuantity { east, north, up, horizontal, spatial };
inline constexpr std::array error_quantities{ErrorQuantity::east, ErrorQuantity::north, ErrorQuantity::up,
                                             ErrorQuantity::horizontal, ErrorQuantity::spatial};

/// "east", "north", "up", "horizontal", "3d".
std::string_view error_quantity_name(ErrorQuantity quantity);
std::optional<ErrorQuantity> error_quantity_from_name(std::string_view name);
/// One of the series of `errors`.
const std::vector<double>& error_values(const PositionErrors& errors, ErrorQuantity quantity);

/// Statistics of one error series, metres.
struct QuantityStatistics {
    SampleStatistics figures;
    std::optional<double> correlation_samples;  ///< 1/e length of the autocorrelation, samples
    std::optional<Seconds> correlation_time;    ///< the same as a time; nothing when the sampling interval is not known
    std::optional<double> epoch_noise;          ///< see TimeCorrelation::epoch_noise()
    std::array<std::optional<LaggedCorrelation>, correlation_lags.size()> lagged;  ///< at correlation_lags
};

/// Everything about one file.
struct SeriesStatistics {
    std::string name;
    std::size_t samples = 0;
    std::size_t fixes = 0;
    std::optional<Seconds> interval;
    ReferenceKind reference = ReferenceKind::own_mean;
    std::optional<Geodetic> point;
    std::array<QuantityStatistics, error_quantities.size()> quantities;  ///< in the order of ErrorQuantity
    std::optional<SampleStatistics> satellites_used;  ///< of the fixes; nothing when the file does not tell
    SignalStrengthByElevation signal_strength;        ///< of all samples; empty: not told

    /// 50 % of the horizontal errors are not larger, metres.
    [[nodiscard]] double cep() const { return of(ErrorQuantity::horizontal).figures.median; }
    /// 95 % of the horizontal errors are not larger, metres.
    [[nodiscard]] double r95() const { return of(ErrorQuantity::horizontal).figures.p95; }
    [[nodiscard]] const QuantityStatistics& of(ErrorQuantity quantity) const {
        return quantities[static_cast<std::size_t>(quantity)];
    }
};

/// Statistics of the errors of `series` (see position_errors). Fails with `input` for fewer than two fixes.
Result<SeriesStatistics> series_statistics(const FixSeries& series,
                                           const std::optional<Geodetic>& point = std::nullopt);

/// What to compare and how.
struct ComparisonOptions {
    std::optional<Geodetic> reference;                   ///< for a file without truth
    ErrorQuantity quantity = ErrorQuantity::horizontal;  ///< of the article's figure
    std::size_t window = 0;                              ///< fixes of B in a window; 0: no windows
};

/// One figure of both files.
struct FigureDifference {
    ErrorQuantity quantity = ErrorQuantity::east;
    std::string_view figure;        ///< "mean", "std", "rms", "min", "max", "cep", "p95"
    double a = 0, b = 0;            ///< metres
    std::optional<double> percent;  ///< 100 · (a − b) / |b|; nothing where b is zero or small beside the errors
};

/// One window of B and how far A is from it.
struct WindowComparison {
    std::size_t first_sample = 0;                 ///< index in B
    std::optional<GpsTime> start;                 ///< nothing when B is not dated
    SampleStatistics figures;                     ///< of the chosen quantity
    std::optional<ComparisonPercent> difference;  ///< A against this window as the reference
};

/// Two windows of B against each other: how well reality repeats itself.
struct WindowPair {
    std::size_t reference = 0, candidate = 0;  ///< indices of windows
    std::optional<ComparisonPercent> difference;
};

/// The whole comparison; A is the candidate, B the reference.
struct Comparison {
    SeriesStatistics a, b;
    ErrorQuantity quantity = ErrorQuantity::horizontal;
    std::vector<FigureDifference> differences;
    /// Between the distributions of the errors, in the order of ErrorQuantity.
    std::array<DistributionDistance, error_quantities.size()> distances;
    std::optional<ComparisonPercent> article;  ///< of `quantity`; see comparison_percent()
    std::size_t window = 0;                    ///< fixes in a window; 0: none were asked for
    std::vector<WindowComparison> windows;
    std::vector<WindowPair> yardstick;  ///< every ordered pair of different windows
    std::vector<std::string> warnings;
};

/// Compares `a` with `b`. Fails with `input` for fewer than two fixes in a file, with `usage` when B holds not one
/// whole window or more than 200.
Result<Comparison> compare(const FixSeries& a, const FixSeries& b, const ComparisonOptions& options = {});

/// An aligned table for a terminal, ending in a newline.
std::string comparison_text(const Comparison& comparison);
/// One JSON object, indented, ending in a newline.
std::string comparison_json(const Comparison& comparison);

}  // namespace skyloop::inline study
