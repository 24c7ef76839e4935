#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/time/utc_time.hpp"
#include "run/emulator/assembly.hpp"
#include "world/rinex/antenna_file.hpp"
#include "world/rinex/bias_file.hpp"
#include "world/rinex/clock_file.hpp"
#include "world/rinex/precise_orbit_file.hpp"

namespace skyloop::inline run {
namespace {

// What the key is refused for, at its place.
tl::unexpected<Error> refuse_products(const Scenario& scenario, std::string_view why) {
    return fail(ErrorCode::usage, fmt::format("{}{}", told_place(scenario, "sky.orbits", "sky.orbits"), why));
}

// What stands in the way whatever the files hold.
Result<void> check_use(const Scenario& scenario, const LoadedNavigation& loaded) {
    if (scenario.model.sensor_model)
        return refuse_products(scenario,
                               "a sensor model takes the records for the truth; expected model.name = \"modern\"");
    if (loaded.files.empty())
        return refuse_products(scenario,
                               "the nominal sky is of no day; expected sky.navigation with the records of that day");
    if (scenario.sky.rebase_navigation)
        return refuse_products(scenario,
                               "products keep their day; expected no sky.rebase_navigation and no --rebase-nav");
    return {};
}

// A file that a key names and that cannot be opened is the key's mistake.
Error at_files_key(const Scenario& scenario, std::string_view key, Error error) {
    const auto place = scenario.told_at.find(key);
    if (error.code != ErrorCode::outside || place == scenario.told_at.end()) return error;
    return {ErrorCode::input, place->second + error.message};
}

// The tables of all files of a kind in one; nothing where there are no files.
template <class Table, class Read>
Result<std::optional<Table>> read_tables(const std::vector<std::filesystem::path>& paths, Read read) {
    std::optional<Table> all;
    for (const auto& path : paths) {
        Result<Table> table = read(path);
        if (!table) return fail(table.error());
        if (all)
            all->add(*table);
        else
            all = std::move(*table);
    }
    return all;
}

Result<PreciseOrbits> read_orbits(const std::filesystem::path& path) {
    auto file = read_precise_orbit_file(path);
    if (!file) return fail(file.error());
    return std::move(file->orbits);
}

Result<PreciseTruth> read_products(const Scenario& scenario) {
    const PreciseFiles& files = scenario.sky.precise;
    auto orbits = read_tables<PreciseOrbits>(files.orbits, read_orbits);
    if (!orbits) return fail(at_files_key(scenario, "sky.orbits", orbits.error()));
    auto clocks = read_tables<PreciseClocks>(files.clocks, read_clock_file);
    if (!clocks) return fail(at_files_key(scenario, "sky.clocks", clocks.error()));
    auto biases = read_tables<CodeBiases>(files.biases, read_bias_file);
    if (!biases) return fail(at_files_key(scenario, "sky.biases", biases.error()));
    PreciseTruth::Parts parts{std::move(**orbits), std::move(*clocks), nullptr, std::move(*biases)};
    if (!files.antennas.empty()) {
        auto antennas = read_antenna_file(files.antennas);
        if (!antennas) return fail(at_files_key(scenario, "sky.antennas", antennas.error()));
        parts.antennas = std::make_shared<const AntennaCatalogue>(std::move(*antennas));
    }
    return PreciseTruth(std::move(parts));
}

void warn_of_unknown(const PreciseTruth& precise, LoadedNavigation& loaded) {
    std::vector<std::string> unknown;
    for (const SatelliteId satellite : loaded.source->satellites())
        if (!precise.knows(satellite)) unknown.push_back(to_string(satellite));
    if (!unknown.empty())
        loaded.warnings.push_back(fmt::format(
            "sky.orbits has nothing of {}: their records stay the truth, less the made-up signal_in_space error",
            fmt::join(unknown, ", ")));
}

// Moves a start that nobody asked for into the span of the products.
Result<void> check_span(const Scenario& scenario, const TimeSpan& span, LoadedNavigation& loaded) {
    const bool own_start = scenario.run.start || scenario.run.start_now;
    if (!own_start) loaded.start = std::max(loaded.start, span.first);
    const GpsTime end = advanced(loaded.start, scenario.run.duration.value_or(Seconds(0)));
    if (loaded.start < span.first || end > span.last)
        return refuse_products(
            scenario, fmt::format("the run, {} to {}, is not within the time of the products; expected {} to {}",
                                  utc_text(loaded.start), utc_text(end), utc_text(span.first), utc_text(span.last)));
    if (!scenario.run.duration)
        loaded.warnings.push_back(
            fmt::format("the run has no end, and its precise products reach to {}: their satellites are gone then",
                        utc_text(span.last)));
    return {};
}

}  // namespace

Result<void> load_precise_truth(const Scenario& scenario, LoadedNavigation& loaded) {
    if (scenario.sky.precise.orbits.empty()) return {};
    if (const auto checked = check_use(scenario, loaded); !checked) return fail(checked.error());
    auto precise = read_products(scenario);
    if (!precise) return fail(precise.error());
    const std::optional<TimeSpan> span = precise->span();
    if (!span) return refuse_products(scenario, "orbits and clocks have no time in common");
    if (const auto checked = check_span(scenario, *span, loaded); !checked) return fail(checked.error());
    warn_of_unknown(*precise, loaded);
    loaded.precise = std::make_shared<const PreciseTruth>(std::move(*precise));
    return {};
}

}  // namespace skyloop::inline run
