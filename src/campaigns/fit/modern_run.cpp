#include "campaigns/fit/modern_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace skyloop::inline campaigns {
namespace {

// Keeps errors and strengths of the run. State: three numbers an epoch.
class CourseKeeper : public RunObserver {
public:
    CourseKeeper(ModernRun& run, const FitWatch& watch) : run_(run), watch_(watch) {}
    void on_epoch(const EpochSeen& seen) override {
        if (watch_.on_epoch) watch_.on_epoch();
        const Fix& fix = seen.trace.epoch.fix;
        auto& enu = run_.enu.emplace_back();
        std::size_t used = 0;
        for (const SatelliteSeen& satellite : satellites_seen(seen)) {
            if (satellite.used) ++used;
            if (!satellite.signals.empty()) run_.signals.add({satellite.elevation, satellite.signals.front().second});
        }
        if (!fix.has_position()) return;
        const EnuError error = enu_error(seen.trace.truth, fix);
        enu.emplace(error.east.value(), error.north.value(), error.up.value());
        run_.satellites_used.add(static_cast<double>(used));
    }

private:
    ModernRun& run_;
    const FitWatch& watch_;
};

std::string receiver_text(const FitReceiver& receiver) {
    std::string text = "[[receiver]]\n", systems;
    if (!receiver.board.empty()) text += fmt::format("board = {}\n", quoted_value(receiver.board).toml);
    for (const std::string& one : receiver.constellations)
        systems += (systems.empty() ? "" : ", ") + quoted_value(one).toml;
    if (!systems.empty()) text += fmt::format("constellations = [{}]\n", systems);
    return text + "rate_hz = 1\n";
}

std::string terms_text(const ModernFitSettings& settings) {
    std::string text;
    for (std::size_t i = 0; i < fitted_causes.size(); ++i)
        if (acts(i, settings.surroundings) && settings.scales[i] != 1)
            text += fmt::format("{} = {{ scale = {:.4g} }}\n", fitted_causes[i], settings.scales[i]);
    return text.empty() ? text : "\n[model.modern.terms]\n" + text;
}

}  // namespace

bool acts(std::size_t cause, Surroundings surroundings) {
    return fitted_causes[cause] != "channel" || channel_of(surroundings).environment.has_value();
}

std::string modern_scenario(const FitConditions& conditions, const FitReceiver& receiver,
                            const ModernFitSettings& settings, std::string_view remarks) {
    const Decibels loss = ModernSettings::of(receiver.preset).propagation.link.implementation_loss + settings.weaker;
    const std::string link =
        settings.weaker.value() == 0
            ? ""
            : fmt::format("\n[model.modern.link]\nimplementation_loss_db = {:.2f}\n", std::max(loss.value(), 0.0));
    return conditions_text(conditions, remarks) +
           fmt::format("[model.modern]\npreset = \"{}\"\nsurroundings = \"{}\"\n{}{}\n",
                       modern_preset_names[static_cast<std::size_t>(receiver.preset)],
                       surroundings_names[static_cast<std::size_t>(settings.surroundings)], link,
                       terms_text(settings)) +
           receiver_text(receiver);
}

PositionErrors ModernRun::errors(bool placed) const {
    PositionErrors errors;
    errors.reference = placed ? ReferenceKind::truth : ReferenceKind::own_mean;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double n = 0;
    for (const auto& one : enu)
        if (one) mean += *one, ++n;
    mean = placed || n == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(mean / n);
    for (const auto& one : enu) {
        if (!one) continue;
        const Eigen::Vector3d error = *one - mean;
        errors.east.push_back(error.x());
        errors.north.push_back(error.y());
        errors.up.push_back(error.z());
        errors.horizontal.push_back(error.head<2>().norm());
        errors.spatial.push_back(error.norm());
    }
    return errors;
}

FixTimes ModernRun::times() const {
    FixTimes times;
    times.in_seconds = true;
    for (std::size_t second = 0; second < enu.size(); ++second)
        if (enu[second]) times.at.push_back(static_cast<double>(second));
    return times;
}

Result<ModernRun> run_modern(const FitConditions& conditions, const FitReceiver& receiver,
                             const ModernFitSettings& settings, const DataFolders& data, const FitWatch& watch) {
    const auto scenario = read_fit_scenario(modern_scenario(conditions, receiver, settings));
    if (!scenario) return fail(scenario.error());
    ModernRun run;
    CourseKeeper keeper(run, watch);
    auto notes = run_to_end(*scenario, conditions, data, keeper, watch);
    if (!notes) return fail(notes.error());
    run.notes = std::move(*notes);
    const auto fixes = static_cast<std::size_t>(
        std::count_if(run.enu.begin(), run.enu.end(), [](const auto& one) { return one.has_value(); }));
    if (fixes < 2) return fail(too_few_fixes(conditions, run.notes.navigation, fixes));
    return run;
}

}  // namespace skyloop::inline campaigns
