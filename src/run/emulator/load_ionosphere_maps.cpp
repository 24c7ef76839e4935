#include "detail/load_ionosphere_maps.hpp"

#include <fmt/format.h>

#include "base/time/utc_time.hpp"
#include "receiver/error_model/model_effects.hpp"
#include "world/rinex/ionex_file.hpp"

namespace skyloop {

std::filesystem::path acting_ionosphere_maps(const Scenario& scenario) {
    if (const auto& model = scenario.model.sensor_model) {
        const bool take_maps = takes_electron_content(*model) && scenario.atmosphere.tec_source == TecSource::ionex;
        return take_maps ? scenario.tec_maps : std::filesystem::path();
    }
    const ModernSettings settings = effective(scenario.model.modern);
    const ModernPropagationParameters& propagation = settings.propagation;
    const bool act =
        propagation.ionosphere_model.model == IonosphereModel::ionex && propagation.ionosphere.factor() != 0;
    return act ? settings.ionosphere_maps : std::filesystem::path();
}

Result<std::optional<NamedIonosphereMaps>> load_ionosphere_maps(const std::filesystem::path& file) {
    if (file.empty()) return std::nullopt;
    auto maps = read_ionex_file(file);
    if (!maps) return fail(maps.error());
    return NamedIonosphereMaps{file.string(), std::move(*maps)};
}

TimeSpan span_of_tables(const Scenario& scenario, GpsTime start) {
    return {start, advanced(start, scenario.run.duration.value_or(Seconds(0)))};
}

std::optional<std::string> warning_of_last_map(const Scenario& scenario) {
    if (scenario.run.duration) return std::nullopt;
    const std::filesystem::path file = acting_ionosphere_maps(scenario);
    if (file.empty()) return std::nullopt;
    const auto maps = read_ionex_file(file);
    if (!maps || maps->maps.empty()) return std::nullopt;  // which load_ionosphere_maps() and check_coverage() tell
    return fmt::format(
        "{}: its maps reach to {}; the run has no end, and from then on the last of them holds, turned with the Sun",
        file.string(), format_utc(to_utc(maps->maps.back().time, LeapSeconds::announced()), 0));
}

}  // namespace skyloop
