#include <fmt/format.h>

#include <algorithm>

#include "skyloop/emulator/assembly.hpp"
#include "skyloop/gnss/foreign_records.hpp"
#include "skyloop/gnss/navigation_data.hpp"
#include "skyloop/gnss/nominal_constellation.hpp"
#include "skyloop/rinex/navigation_file.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop {
namespace {

struct ReadRecords {
    std::vector<KeplerEphemeris> records;
    std::optional<KlobucharCoefficients> klobuchar;
    std::string description;
};

Result<ReadRecords> read_all(const std::vector<std::filesystem::path>& files, std::vector<std::string>& warnings) {
    ReadRecords all;
    for (const std::filesystem::path& path : files) {
        auto file = read_navigation_file(path);
        if (!file) return fail(file.error());
        warnings.insert(warnings.end(), file->warnings.begin(), file->warnings.end());
        all.records.insert(all.records.end(), file->records.begin(), file->records.end());
        if (!all.klobuchar) all.klobuchar = file->klobuchar;
        all.description += (all.description.empty() ? "" : " ") + path.filename().string();
    }
    for (const DroppedRecord& dropped : drop_foreign_records(all.records))
        warnings.push_back(dropped.reason);
    return all;
}

void keep_constellations(std::vector<KeplerEphemeris>& records, const std::vector<Constellation>& wanted) {
    if (wanted.empty()) return;
    std::erase_if(records, [&](const KeplerEphemeris& r) {
        return std::find(wanted.begin(), wanted.end(), r.satellite.constellation) == wanted.end();
    });
}

EphemerisSelection selection_of(const Scenario& scenario) {
    // The article takes the record of the hour that has begun; every other model takes the nearest.
    const EphemerisRule own =
        scenario.model.kind == ErrorModelKind::baseline ? EphemerisRule::forward : EphemerisRule::nearest;
    return {scenario.sky.ephemeris_rule.value_or(own), scenario.sky.ephemeris_validity};
}

// The instant at which a run begins.
GpsTime start_of(const Scenario& scenario, const NavigationSource& source, GpsTime now, bool default_to_now) {
    const RunSettings& run = scenario.run;
    if (run.start) return *run.start;
    const auto span = source.span();
    if (run.start_now || default_to_now || scenario.sky.rebase_navigation || !span) return now;
    return span->first;
}

// Far inside what 64-bit nanoseconds since 1980 can count, which ends in 2272.
Result<void> check_end(const RunSettings& run, GpsTime start) {
    constexpr double latest_s = 290 * 365.25 * 86400;
    const double end_s = difference(start, GpsTime{}).value() + run.duration.value_or(Seconds(0)).value();
    if (end_s < latest_s) return {};
    return fail(ErrorCode::usage, fmt::format("a run of {:g} s from {} ends after 2269; expected a shorter one",
                                              run.duration.value_or(Seconds(0)).value(),
                                              format_utc(to_utc(start, LeapSeconds::announced()), 0)));
}

std::string span_text(const TimeSpan& span) {
    const LeapSeconds& leap = LeapSeconds::announced();
    return fmt::format("{} to {}", format_utc(to_utc(span.first, leap), 0), format_utc(to_utc(span.last, leap), 0));
}

void warn_outside(const Scenario& scenario, const LoadedNavigation& loaded, std::vector<std::string>& warnings) {
    const auto span = loaded.source->span();
    if (!span) return;
    const GpsTime end = scenario.run.duration ? advanced(loaded.start, *scenario.run.duration) : loaded.start;
    if (loaded.start >= span->first && end <= span->last) return;
    warnings.push_back(fmt::format(
        "the run {} the navigation data, which spans {}: no fix there; --start moves the run, --rebase-nav the data",
        loaded.start < span->first || loaded.start > span->last ? "starts outside" : "outlasts", span_text(*span)));
}

Result<LoadedNavigation> load_nominal(const Scenario& scenario, GpsTime now, bool default_to_now) {
    const auto& wanted = scenario.sky.constellations;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), Constellation::gps) == wanted.end())
        return fail(
            ErrorCode::usage,
            "sky.constellations leaves out gps, but the nominal constellation is GPS; give navigation data with --nav");
    if (scenario.sky.rebase_navigation)
        return fail(ErrorCode::usage, "--rebase-nav moves navigation data, but there is none; give it with --nav");
    LoadedNavigation loaded{std::make_unique<NominalConstellation>(), {}, {}};
    loaded.start = start_of(scenario, *loaded.source, now, default_to_now);
    if (const auto checked = check_end(scenario.run, loaded.start); !checked) return fail(checked.error());
    return loaded;
}

}  // namespace

Result<LoadedNavigation> load_navigation(const Scenario& scenario, GpsTime now, bool default_to_now) {
    if (scenario.sky.navigation.empty()) return load_nominal(scenario, now, default_to_now);
    LoadedNavigation loaded;
    auto all = read_all(scenario.sky.navigation, loaded.warnings);
    if (!all) return fail(all.error());
    keep_constellations(all->records, scenario.sky.constellations);
    if (all->records.empty())
        return fail(ErrorCode::input,
                    fmt::format("{}: no record of the wanted constellations is left", all->description));

    NavigationData data(std::move(all->records), all->klobuchar, all->description, selection_of(scenario));
    loaded.start = start_of(scenario, data, now, default_to_now);
    if (const auto checked = check_end(scenario.run, loaded.start); !checked) return fail(checked.error());
    if (scenario.sky.rebase_navigation) {
        auto moved = rebased(data, loaded.start);
        if (!moved) return fail(moved.error());
        data = std::move(*moved);
    }
    loaded.source = std::make_unique<NavigationData>(std::move(data));
    warn_outside(scenario, loaded, loaded.warnings);
    return loaded;
}

}  // namespace skyloop
