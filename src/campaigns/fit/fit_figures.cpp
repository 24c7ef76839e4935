#include "campaigns/fit/fit_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace skyloop::inline campaigns {
namespace {

// One axis, or both of the plane.
SpreadFigures spread_figures(std::span<const std::vector<double>* const> axes, const FixTimes& times, bool placed) {
    SpreadFigures figures;
    std::vector<TimeCorrelation> courses;
    std::vector<double> variances;
    double variance = 0, squares = 0;
    for (const std::vector<double>* axis : axes) {
        const SampleStatistics s = sample_statistics(*axis).value_or(SampleStatistics{});
        variances.push_back(s.std * s.std);
        variance += s.std * s.std;
        squares += s.rms * s.rms;
        courses.emplace_back(times, *axis);
    }
    figures.deviation = std::sqrt(variance);
    if (placed) figures.rms = std::sqrt(squares);
    for (std::size_t lag = 0; lag < fitted_lags.size() && variance > 0; ++lag) {
        double sum = 0;
        bool complete = true;
        for (std::size_t axis = 0; axis < courses.size(); ++axis) {
            if (variances[axis] == 0) continue;
            const auto one = courses[axis].at_lag(fitted_lags[lag]);
            complete = complete && one;
            if (one) sum += variances[axis] * one->value;
        }
        if (complete) figures.correlation[lag] = sum / variance;
    }
    return figures;
}

double log_ratio(double a, double b) {
    constexpr double smallest_m = 1e-4;
    return std::log(std::max(a, smallest_m)) - std::log(std::max(b, smallest_m));
}

// Of the log's sizes over the model's.
void add_size_ratios(RunningStatistics& ratios, const SpreadFigures& model, const SpreadFigures& log) {
    ratios.add(log_ratio(log.deviation, model.deviation));
    if (model.rms && log.rms) ratios.add(log_ratio(*log.rms, *model.rms));
}

void enlarge(SpreadFigures& figures, double by) {
    figures.deviation *= by;
    if (figures.rms) *figures.rms *= by;
}

// Relative to 10 %, and of a correlation to 0.1.
void add_distances(std::vector<double>& distances, const SpreadFigures& model, const SpreadFigures& log) {
    constexpr double chance = 0.1;
    distances.push_back(log_ratio(model.deviation, log.deviation) / chance);
    if (model.rms && log.rms) distances.push_back(log_ratio(*model.rms, *log.rms) / chance);
    for (std::size_t lag = 0; lag < fitted_lags.size(); ++lag)
        if (model.correlation[lag] && log.correlation[lag])
            distances.push_back((*model.correlation[lag] - *log.correlation[lag]) / chance);
}

void tell(std::vector<ToldFigure>& told, std::string_view what, const SpreadFigures& figures) {
    told.push_back({fmt::format("{} deviation, m", what), fmt::format("{:.2f}", figures.deviation)});
    told.push_back({fmt::format("{} rms, m", what), figures.rms ? fmt::format("{:.2f}", *figures.rms) : ""});
    for (std::size_t lag = 0; lag < fitted_lags.size(); ++lag)
        told.push_back({fmt::format("{} correlation, {:g} s", what, fitted_lags[lag]),
                        figures.correlation[lag] ? fmt::format("{:.2f}", *figures.correlation[lag]) : ""});
}

}  // namespace

FitFigures fit_figures(const PositionErrors& errors, const FixTimes& times, bool placed) {
    const std::array plane{&errors.east, &errors.north};
    const std::array height{&errors.up};
    return {spread_figures(plane, times, placed), spread_figures(height, times, placed)};
}

double size_ratio(const FitFigures& model, const FitFigures& log) {
    RunningStatistics ratios;
    add_size_ratios(ratios, model.horizontal, log.horizontal);
    add_size_ratios(ratios, model.vertical, log.vertical);
    return std::exp(ratios.mean());
}

FitFigures enlarged(FitFigures figures, double by) {
    enlarge(figures.horizontal, by);
    enlarge(figures.vertical, by);
    return figures;
}

std::vector<double> figure_distances(const FitFigures& model, const FitFigures& log) {
    std::vector<double> distances;
    add_distances(distances, model.horizontal, log.horizontal);
    add_distances(distances, model.vertical, log.vertical);
    return distances;
}

std::vector<ToldFigure> told_figures(const FitFigures& figures) {
    std::vector<ToldFigure> told;
    tell(told, "horizontal", figures.horizontal);
    tell(told, "vertical", figures.vertical);
    return told;
}

}  // namespace skyloop::inline campaigns
