#include "campaigns/fit/fit_run.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/time/utc_time.hpp"
#include "run/emulator/assembly.hpp"
#include "run/scenario/scenario_file.hpp"

namespace skyloop::inline campaigns {
namespace {

std::string navigation_text(const std::vector<std::filesystem::path>& files) {
    std::string text;
    for (const std::filesystem::path& file : files)
        text += (text.empty() ? "" : ", ") + quoted_value(std::filesystem::absolute(file).string()).toml;
    return text.empty() ? text : fmt::format("\n[sky]\nnavigation = [{}]\n", text);
}

}  // namespace

std::string conditions_text(const FitConditions& conditions, std::string_view remarks) {
    const Geodetic& at = conditions.place;
    return fmt::format(
        "{}[run]\nstart = {}\nduration_s = {}\nseed = {}\n{}\n"
        "[trajectory]\nkind = \"fixed\"\nat = [{:.9f}, {:.9f}, {:.4f}]\n\n",
        remarks, utc_text(conditions.start, 3), std::ceil(conditions.length.value()), conditions.seed,
        navigation_text(conditions.navigation), at.latitude.deg(), at.longitude.deg(),
        at.height.above_ellipsoid.value());
}

Result<Scenario> read_fit_scenario(const std::string& text) { return read_scenario(text, "fit.toml"); }

Result<FitRunNotes> run_to_end(const Scenario& scenario, const FitConditions& conditions, const DataFolders& data,
                               RunObserver& observer, const FitWatch& watch) {
    RunMode mode;
    mode.virtual_time = true;
    mode.now = conditions.start;
    mode.open_ports = false;
    auto assembly = assemble(scenario, data, mode);
    if (!assembly) return fail(assembly.error());
    assembly->emulator->add_observer(&observer);
    const std::atomic<bool> nobody{false};
    const std::atomic<bool>& stop = watch.stop != nullptr ? *watch.stop : nobody;
    assembly->emulator->run_until(assembly->end.value_or(conditions.start), stop);
    if (stop) return fail(ErrorCode::outside, "stopped before its end");
    return FitRunNotes{assembly->emulator->simulation().navigation().description(), assembly->warnings};
}

Error too_few_fixes(const FitConditions& conditions, const std::string& navigation, std::size_t fixes) {
    return {ErrorCode::input,
            fmt::format("{}: the model has {} fixes with these orbits at {}; expected the day's merged file, of which "
                        "the model takes the records of the two hours before",
                        navigation, fixes, utc_text(conditions.start))};
}

}  // namespace skyloop::inline campaigns
