#include "campaigns/fit/modern_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>
#include <utility>

#include "campaigns/fit/error_parts.hpp"

namespace skyloop::inline campaigns {
namespace {

// Where a receiver may be at rest for ten minutes with a fix, the usual ones first.
constexpr std::array resting_places{Surroundings::open_sky,     Surroundings::residential, Surroundings::rural,
                                    Surroundings::forest,       Surroundings::urban,       Surroundings::urban_canyon,
                                    Surroundings::indoor_window};
constexpr std::size_t candidates = 2, rounds = 2, seeds_of_trial = 2;
constexpr std::size_t least_reports = 30;  // of satellites in ten degrees of elevation

template <class Take>
void for_common_bins(const SignalStrengthByElevation& a, const SignalStrengthByElevation& b, Take&& take) {
    for (std::size_t i = 0; i < SignalStrengthByElevation::bins; ++i)
        if (std::min(a.bin(i).n(), b.bin(i).n()) >= least_reports) take(a.bin(i), b.bin(i));
}

// By how much the log's signals are weaker, the mean over the elevations.
double weaker_db(const SignalStrengthByElevation& model, const SignalStrengthByElevation& log) {
    RunningStatistics differences;
    for_common_bins(model, log, [&](const auto& of_model, const auto& of_log) {
        differences.add(of_model.mean() - of_log.mean());
    });
    return differences.mean();
}

// 3 dB of a bin and 1.5 satellites count as two hours of one receiver do.
void add_distances_of_signals(std::vector<double>& distances, const ModernTrial& trial, const FitTarget& target) {
    constexpr double bin_db = 3, spread_db = 2, satellites = 1.5;
    const SignalStrengthByElevation& signals = trial.runs.front().signals;
    const double level = weaker_db(signals, target.signals);
    for_common_bins(signals, target.signals, [&](const auto& of_model, const auto& of_log) {
        distances.push_back((of_model.mean() - level - of_log.mean()) / bin_db);
        distances.push_back((of_model.std() - of_log.std()) / spread_db);
    });
    if (target.satellites_used.n() > 0)
        distances.push_back((trial.runs.front().satellites_used.mean() - target.satellites_used.mean()) / satellites);
}

double root_mean_square(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value * value;
    return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

void judge(ModernTrial& trial, const FitTarget& target) {
    std::vector<double> distances = figure_distances(trial.figures, target.figures);
    add_distances_of_signals(distances, trial, target);
    trial.misfit = root_mean_square(distances);
    const double size = size_ratio(trial.figures, target.figures);
    distances = figure_distances(enlarged(trial.figures, size), target.figures);
    distances.push_back(std::log(size));
    add_distances_of_signals(distances, trial, target);
    trial.unlikeness = root_mean_square(distances);
}

// The causes that act, and how far a scale may be from 1 before it counts as much as two hours differ, in e-folds.
struct FreeScales {
    std::vector<std::size_t> causes;
    explicit FreeScales(Surroundings surroundings) {
        for (std::size_t cause = 0; cause < fitted_causes.size(); ++cause)
            if (acts(cause, surroundings)) causes.push_back(cause);
    }
    [[nodiscard]] double believed(std::size_t i) const { return fitted_causes[causes[i]] == "ionosphere" ? 0.5 : 1.0; }
    [[nodiscard]] CauseScales scales(const Eigen::VectorXd& logarithms) const {
        constexpr double farthest = 3.5;  // a factor of 33
        CauseScales scales{1, 1, 1, 1, 1};
        for (std::size_t i = 0; i < causes.size(); ++i)
            scales[causes[i]] = std::exp(std::clamp(logarithms[static_cast<Eigen::Index>(i)], -farthest, farthest));
        return scales;
    }
    [[nodiscard]] Eigen::VectorXd logarithms(const CauseScales& scales) const {
        Eigen::VectorXd values(static_cast<Eigen::Index>(causes.size()));
        for (std::size_t i = 0; i < causes.size(); ++i)
            values[static_cast<Eigen::Index>(i)] = std::log(scales[causes[i]]);
        return values;
    }
};

// What Eigen's minimiser asks for.
struct Distances {
    using Scalar = double;
    using InputType = Eigen::VectorXd;
    using ValueType = Eigen::VectorXd;
    using JacobianType = Eigen::MatrixXd;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

    const ErrorParts& parts;
    const FitFigures& wanted;
    const FreeScales& free;

    [[nodiscard]] int inputs() const { return static_cast<int>(free.causes.size()); }
    [[nodiscard]] int values() const { return inputs() + static_cast<int>(figure_distances(wanted, wanted).size()); }
    int operator()(const InputType& at, ValueType& distances) const {
        const std::vector<double> figures = figure_distances(parts.figures(free.scales(at)), wanted);
        distances.setZero(values());
        for (std::size_t i = 0; i < free.causes.size(); ++i)
            distances[static_cast<Eigen::Index>(i)] = at[static_cast<Eigen::Index>(i)] / free.believed(i);
        for (std::size_t i = 0; i < figures.size(); ++i)
            distances[inputs() + static_cast<Eigen::Index>(i)] = figures[i];
        return 0;
    }
};

CauseScales best_scales(const ErrorParts& parts, const FitFigures& wanted, const ModernFitSettings& from) {
    const FreeScales free(from.surroundings);
    Eigen::NumericalDiff<Distances> function(Distances{parts, wanted, free}, 1e-10);
    Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Distances>> minimiser(function);
    Eigen::VectorXd at = free.logarithms(from.scales);
    minimiser.minimize(at);
    return free.scales(at);
}

class ModernFitter {
public:
    ModernFitter(const ModernFitRequest& request, const FitTarget& target, const DataFolders& data,
                 const FitWatch& watch)
        : request_(request), target_(target), data_(data), watch_(watch) {}

    Result<ModernFit> fit() {
        ModernFit fit;
        if (auto done = try_surroundings(fit); !done) return fail(done.error());
        std::optional<ModernTrial> best;
        for (std::size_t i = 0; i < std::min(candidates, started_.size()); ++i) {
            auto improved = improve(std::move(started_[i]));
            if (!improved) return fail(improved.error());
            if (!best || improved->misfit < best->misfit) best = std::move(*improved);
        }
        fit.after = std::move(*best);
        return fit;
    }

private:
    Result<ModernTrial> run(const ModernFitSettings& settings) {
        ModernTrial trial;
        trial.settings = settings;
        std::vector<ScaledRuns> seeds;
        FitConditions conditions = request_.conditions;
        for (std::uint64_t i = 0; i < seeds_of_trial; ++i, ++conditions.seed) {
            auto one = run_modern(conditions, request_.receiver, settings, data_, watch_);
            if (!one) return fail(one.error());
            seeds.push_back({std::move(*one), {}});
        }
        trial.figures = ErrorParts(seeds, settings.scales, target_.placed).figures(settings.scales);
        for (ScaledRuns& seed : seeds)
            trial.runs.push_back(std::move(seed.base));
        judge(trial, target_);
        return trial;
    }

    // The preset under an open sky is what the fit is told against, even where other surroundings are asked for.
    Result<void> try_surroundings(ModernFit& fit) {
        auto before = run({});
        if (!before) return fail(before.error());
        fit.before = *before;
        std::vector<Surroundings> places(resting_places.begin(), resting_places.end());
        if (request_.surroundings) places = {*request_.surroundings};
        for (const Surroundings place : places) {
            auto trial = place == Surroundings::open_sky ? Result<ModernTrial>(*before) : run({place});
            // Where the model has no fix the receiver, which had some, was not.
            if (!trial && trial.error().code == ErrorCode::input && places.size() > 1) continue;
            if (!trial) return fail(trial.error());
            started_.push_back(std::move(*trial));
        }
        std::stable_sort(started_.begin(), started_.end(),
                         [](const auto& a, const auto& b) { return a.unlikeness < b.unlikeness; });
        for (const ModernTrial& one : started_)
            fit.tried.push_back({one.settings, {}, one.figures, one.misfit, one.unlikeness});
        return {};
    }

    // The level of the signals first, since errors follow it.
    Result<ModernTrial> with_level(ModernTrial trial) {
        const double weaker = weaker_db(trial.runs.front().signals, target_.signals);
        const double loss = ModernSettings::of(request_.receiver.preset).propagation.link.implementation_loss.value();
        ModernFitSettings settings = trial.settings;
        settings.weaker = Decibels(std::round(100 * std::max(weaker, -loss)) / 100);
        constexpr double least_db =
            1.5;  // the mean of satellites, each with a power of its own, is off by half of that
        return std::abs(settings.weaker.value()) < least_db ? std::move(trial) : run(settings);
    }

    Result<ModernTrial> improve(ModernTrial start) {
        auto best = with_level(std::move(start));
        constexpr double near_enough = 1;
        for (std::size_t round = 0; round < rounds && best && best->misfit > near_enough; ++round) {
            const auto settings = better_settings(*best);
            if (!settings) return fail(settings.error());
            auto trial = run(*settings);
            if (!trial) return fail(trial.error());
            if (trial->misfit >= best->misfit) break;
            best = std::move(trial);
        }
        return best;
    }

    Result<ModernFitSettings> better_settings(const ModernTrial& trial) {
        constexpr double changed_to = 0.5;
        std::vector<ScaledRuns> seeds;
        FitConditions conditions = request_.conditions;
        for (const ModernRun& base : trial.runs) {
            ScaledRuns& scaled = seeds.emplace_back(ScaledRuns{base, {}});
            for (const std::size_t cause : FreeScales(trial.settings.surroundings).causes) {
                ModernFitSettings settings = trial.settings;
                settings.scales[cause] *= changed_to;
                auto changed = run_modern(conditions, request_.receiver, settings, data_, watch_);
                if (!changed) return fail(changed.error());
                scaled.changed.push_back(
                    {cause, settings.scales[cause] - trial.settings.scales[cause], std::move(*changed)});
            }
            ++conditions.seed;
        }
        ModernFitSettings found = trial.settings;
        found.scales = best_scales(ErrorParts(seeds, trial.settings.scales, target_.placed), target_.figures, found);
        for (double& scale : found.scales)  // as the scenario has them
            scale = std::round(scale * 1000) / 1000;
        return found;
    }

    const ModernFitRequest& request_;
    const FitTarget& target_;
    const DataFolders& data_;
    const FitWatch& watch_;
    std::vector<ModernTrial> started_;  // the best first
};

}  // namespace

FitTarget target_of(const StandingLog& log) {
    FitTarget target;
    target.placed = log.errors.reference != ReferenceKind::own_mean;
    target.figures = fit_figures(log.errors, fix_times(log.series), target.placed);
    target.signals = log.series.signal_strength();
    for (const FixSample& sample : log.series.samples)
        if (sample.has_fix && sample.satellites_used)
            target.satellites_used.add(static_cast<double>(*sample.satellites_used));
    return target;
}

std::size_t most_runs(const ModernFitRequest& request) {
    const std::size_t places = request.surroundings ? 1 : resting_places.size();
    const std::size_t improved = std::min(candidates, places) * (1 + rounds * (fitted_causes.size() + 1));
    return (1 + places + improved) * seeds_of_trial;
}

Result<ModernFit> fit_modern(const ModernFitRequest& request, const FitTarget& target, const DataFolders& data,
                             const FitWatch& watch) {
    return ModernFitter(request, target, data, watch).fit();
}

}  // namespace skyloop::inline campaigns
