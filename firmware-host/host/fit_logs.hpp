/// What both kinds of `skyloop fit` have in common: options, the logs, progress, figures.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "campaigns/fit/fit_run.hpp"
#include "messages.hpp"
#include "study/analysis/standing_log.hpp"
#include "study/plot/scatter_plot.hpp"

namespace skyloop::host {

/// What was typed.
struct FitOptions {
    std::string log, start, reference, out = ".";
    std::string model = "baseline", preset = "consumer", board, surroundings;  ///< the last three of modern alone
    std::vector<std::string> constellations;
    std::vector<std::string> nav, check;
    double interval = 0;  ///< s; 0: as the logs say
    std::size_t skip = 0, count = 0;
    bool check_rest = false;
    Verbosity verbosity;
};

/// Of one terminal line, rewritten, and asked after each epoch whether the user wants to stop.
class FitProgress {
public:
    explicit FitProgress(const Messages& messages);
    ~FitProgress() { clear(); }
    FitProgress(const FitProgress&) = delete;
    FitProgress& operator=(const FitProgress&) = delete;

    void expect(double epochs) { expected_ += epochs; }
    [[nodiscard]] FitWatch watch() {
        return {&stop_, [this] { count(); }};
    }
    void clear() const;

private:
    void count();

    bool shown_;
    std::atomic<bool> stop_{false};
    std::uint64_t done_ = 0;
    double expected_ = 1;
    std::chrono::steady_clock::time_point last_{};
};

/// What is fitted to, and what the fit is held against.
struct FitLogs {
    StandingLog log;
    std::vector<StandingLog> checks;
};

FitConditions conditions_of(const StandingLog& log, const FitOptions& options);
std::string figures_text(const SampleStatistics& s);
SampleStatistics figures_of(const std::vector<double>& values);
/// The article's percentage of what the model makes against the log.
ComparisonPercent percent_of(const SampleStatistics& model, const StandingLog& log);

/// What a fit found.
struct FitOutput {
    std::vector<std::string> warnings;
    std::string scenario;
    ScatterCloud cloud;  ///< of the model, for the figure
    std::function<void()> print;
};
using FitModel = std::function<Result<FitOutput>(const FitLogs&, const FitOptions&, FitProgress&)>;
/// `skyloop fit`: reads the logs, fits, writes both files and prints. @return what the program ends with
int fit_logs(const FitOptions& options, const FitModel& fit);
/// A FitModel.
Result<FitOutput> fit_modern_model(const FitLogs& logs, const FitOptions& options, FitProgress& progress);

}  // namespace skyloop::host
