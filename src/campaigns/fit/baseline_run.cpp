#include "campaigns/fit/baseline_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/geo/local_frame.hpp"
#include "receiver/error_model/baseline.hpp"

namespace skyloop::inline campaigns {
namespace {

BaselineFractions fractions_of(const BaselineParameters& preset) {
    return {preset.iono_fraction, preset.tropo_fraction};
}

// σ²_uere as the model itself computes it.
double variance_with(const EpochSeen& seen, const BaselineParameters& parameters) {
    const double sigma = uere_scale(seen.trace.epoch.fix, seen.trace.arrivals, parameters).sigma_uere.value();
    return sigma * sigma;
}

// Of a variance that is a quadratic form of the two fractions its three coefficients.
DelaySpread spread_of(const EpochSeen& seen, BaselineParameters parameters) {
    const auto with = [&](double iono, double tropo) {
        parameters.iono_fraction = iono;
        parameters.tropo_fraction = tropo;
        return variance_with(seen, parameters);
    };
    DelaySpread spread{with(1, 0), with(0, 1), 0};
    spread.both = (with(1, 1) - spread.iono - spread.tropo) / 2;
    return spread;
}

// Keeps the errors of the run. State: seven numbers an epoch with a fix.
class ErrorKeeper : public RunObserver {
public:
    ErrorKeeper(BaselineRun& run, const BaselineParameters& parameters, const FitWatch& watch)
        : run_(run), parameters_(parameters), watch_(watch) {}
    void on_epoch(const EpochSeen& seen) override {
        if (watch_.on_epoch) watch_.on_epoch();
        const Fix& fix = seen.trace.epoch.fix;
        if (!fix.has_position()) return;
        const Eigen::Vector3d enu = LocalFrame(seen.trace.truth.geodetic).to_enu(to_ecef(fix.position)).vector();
        run_.errors.east.push_back(enu.x());
        run_.errors.north.push_back(enu.y());
        run_.errors.up.push_back(enu.z());
        run_.errors.horizontal.push_back(std::hypot(enu.x(), enu.y()));
        run_.errors.spatial.push_back(enu.norm());
        run_.spreads.push_back(spread_of(seen, parameters_));
    }

private:
    BaselineRun& run_;
    const BaselineParameters& parameters_;
    const FitWatch& watch_;
};

}  // namespace

BaselineFractions BaselineFractions::strict() { return fractions_of(BaselineParameters::strict()); }
BaselineFractions BaselineFractions::calibrated() { return fractions_of(BaselineParameters::calibrated()); }

std::string baseline_scenario(const FitConditions& conditions, const BaselineFractions& fractions,
                              std::string_view remarks) {
    return conditions_text(conditions, remarks) +
           fmt::format(
               "[model]\nname = \"baseline\"\n\n[model.baseline]\niono_fraction = {:.6g}\ntropo_fraction = {:.6g}\n\n"
               "[[receiver]]\nrate_hz = 1\n",
               fractions.iono, fractions.tropo);
}

std::vector<double> BaselineRun::horizontal_with(const BaselineFractions& other) const {
    std::vector<double> values(errors.horizontal.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double own = spreads[i].variance(fractions);
        values[i] = own > 0 ? errors.horizontal[i] * std::sqrt(spreads[i].variance(other) / own) : 0;
    }
    return values;
}

Result<BaselineRun> run_baseline(const FitConditions& conditions, const BaselineFractions& fractions,
                                 const DataFolders& data, const FitWatch& watch) {
    const auto scenario = read_fit_scenario(baseline_scenario(conditions, fractions));
    if (!scenario) return fail(scenario.error());
    BaselineRun run;
    run.fractions = fractions;
    run.errors.reference = ReferenceKind::truth;
    ErrorKeeper keeper(run, scenario->model.baseline, watch);
    auto notes = run_to_end(*scenario, conditions, data, keeper, watch);
    if (!notes) return fail(notes.error());
    run.navigation = std::move(notes->navigation);
    run.warnings = std::move(notes->warnings);
    if (run.errors.horizontal.size() < 2)
        return fail(too_few_fixes(conditions, run.navigation, run.errors.horizontal.size()));
    return run;
}

}  // namespace skyloop::inline campaigns
