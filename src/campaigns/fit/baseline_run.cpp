#include "campaigns/fit/baseline_run.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/error_model/baseline.hpp"
#include "run/emulator/assembly.hpp"
#include "run/fault/run_observer.hpp"
#include "run/scenario/scenario_file.hpp"

namespace skyloop::inline campaigns {
namespace {

constexpr std::string_view scenario_name = "fit.toml";

BaselineFractions fractions_of(const BaselineParameters& preset) {
    return {preset.iono_fraction, preset.tropo_fraction};
}

std::string navigation_text(const std::vector<std::filesystem::path>& files) {
    std::string text;
    for (const std::filesystem::path& file : files)
        text += (text.empty() ? "" : ", ") + quoted_value(std::filesystem::absolute(file).string()).toml;
    return text.empty() ? text : fmt::format("\n[sky]\nnavigation = [{}]\n", text);
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
    const Geodetic& at = conditions.place;
    return fmt::format(
        "{}[run]\nstart = {}\nduration_s = {}\nseed = {}\n{}\n"
        "[trajectory]\nkind = \"fixed\"\nat = [{:.9f}, {:.9f}, {:.4f}]\n\n"
        "[model]\nname = \"baseline\"\n\n[model.baseline]\niono_fraction = {:.6g}\ntropo_fraction = {:.6g}\n\n"
        "[[receiver]]\nrate_hz = 1\n",
        remarks, utc_text(conditions.start, 3), std::ceil(conditions.length.value()), conditions.seed,
        navigation_text(conditions.navigation), at.latitude.deg(), at.longitude.deg(),
        at.height.above_ellipsoid.value(), fractions.iono, fractions.tropo);
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
    const auto scenario = read_scenario(baseline_scenario(conditions, fractions), scenario_name);
    if (!scenario) return fail(scenario.error());
    RunMode mode;
    mode.virtual_time = true;
    mode.now = conditions.start;
    mode.open_ports = false;
    auto assembly = assemble(*scenario, data, mode);
    if (!assembly) return fail(assembly.error());
    BaselineRun run;
    run.fractions = fractions;
    run.errors.reference = ReferenceKind::truth;
    run.navigation = assembly->emulator->simulation().navigation().description();
    run.warnings = assembly->warnings;
    ErrorKeeper keeper(run, scenario->model.baseline, watch);
    assembly->emulator->add_observer(&keeper);
    const std::atomic<bool> nobody{false};
    const std::atomic<bool>& stop = watch.stop != nullptr ? *watch.stop : nobody;
    assembly->emulator->run_until(assembly->end.value_or(conditions.start), stop);
    if (stop) return fail(ErrorCode::outside, "stopped before its end");
    if (run.errors.horizontal.size() < 2)
        return fail(ErrorCode::input,
                    fmt::format("{}: the model has {} fixes with these orbits at {}; expected the day's merged "
                                "file, of which the model takes the records of the two hours before",
                                run.navigation, run.errors.horizontal.size(), utc_text(conditions.start)));
    return run;
}

}  // namespace skyloop::inline campaigns
