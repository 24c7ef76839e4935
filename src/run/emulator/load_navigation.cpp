#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/core/files.hpp"

#include "base/time/utc_time.hpp"
#include "detail/navigation_start.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/navigation_files.hpp"
#include "world/broadcast/daily_navigation.hpp"
#include "world/gnss/foreign_records.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/nominal_sky.hpp"
#include "world/rinex/almanac_file.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::inline run {
namespace {

struct ReadRecords {
    std::vector<Ephemeris> records;
    BroadcastIonosphere ionosphere;
    std::string description;
};

// The first file that tells of a system wins.
void add_ionosphere(BroadcastIonosphere& all, const BroadcastIonosphere& more) {
    if (!all.gps) all.gps = more.gps;
    if (!all.qzss) all.qzss = more.qzss;
    if (!all.beidou) all.beidou = more.beidou;
    if (!all.navic) all.navic = more.navic;
    if (!all.galileo) all.galileo = more.galileo;
}

// The middle of the records; those of a RINEX file know their week.
std::optional<GpsTime> middle_toe(const std::vector<Ephemeris>& records) {
    if (records.empty()) return std::nullopt;
    std::vector<GpsTime> times;
    for (const Ephemeris& record : records)
        times.push_back(toe_of(record));
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    return *middle;
}

// Weeks of an almanac may be reduced modulo 1024. Where nobody tells the time of the run, it is not of the future.
GpsTime time_of_almanacs(const Scenario& scenario, GpsTime now) {
    constexpr Nanoseconds half_rollover = std::chrono::weeks(511);
    return scenario.run.start.value_or(scenario.run.start_now ? now : now - half_rollover);
}

// The article's reference system is GPS (MODELS.md, R-03), which QZSS extends; with its sensor model, and those that it
// is compared with, the others are asked for by name.
std::vector<Constellation> wanted_constellations(const Scenario& scenario) {
    using enum Constellation;
    if (!scenario.sky.constellations.empty()) return scenario.sky.constellations;
    if (scenario.model.sensor_model) return {gps, qzss};
    return {gps, sbas, galileo, beidou, qzss, glonass, navic};
}

std::string constellation_list(const std::vector<Constellation>& constellations) {
    std::vector<std::string_view> names;
    for (const Constellation c : constellations)
        names.push_back(constellation_name(c));
    return fmt::format("{}", fmt::join(names, ", "));
}

// Leaves the records of the wanted systems; fails when there are none.
Result<void> keep_constellations(ReadRecords& all, const Scenario& scenario) {
    const std::vector<Constellation> wanted = wanted_constellations(scenario);
    std::set<Constellation> present;
    for (const Ephemeris& r : all.records)
        present.insert(satellite_of(r).constellation);
    std::erase_if(all.records, [&](const Ephemeris& r) {
        return std::find(wanted.begin(), wanted.end(), satellite_of(r).constellation) == wanted.end();
    });
    if (!all.records.empty()) return {};
    return fail(
        ErrorCode::input,
        fmt::format("{}: found records of {}; expected some of {}, the constellations of this run: name others "
                    "in sky.constellations",
                    all.description, constellation_list({present.begin(), present.end()}), constellation_list(wanted)));
}

// A line for each satellite; for a file that is full of them one line with all satellites.
void warn_of_foreign_records(const std::vector<DroppedRecord>& dropped, std::vector<std::string>& warnings) {
    constexpr std::size_t most_lines = 6;
    std::map<SatelliteId, std::vector<const DroppedRecord*>> satellites;
    for (const DroppedRecord& d : dropped)
        satellites[satellite_of(d.record)].push_back(&d);
    if (satellites.size() <= most_lines) {
        for (const auto& [satellite, own] : satellites)
            warnings.push_back(own.size() == 1
                                   ? own.front()->reason
                                   : fmt::format("{}; {} more of it likewise", own.front()->reason, own.size() - 1));
        return;
    }
    std::vector<std::string> counts;
    for (const auto& [satellite, own] : satellites)
        counts.push_back(fmt::format("{} {}", to_string(satellite), own.size()));
    warnings.push_back(
        fmt::format("{} records are not of the satellite that they name, as the first: {}; by satellite {}",
                    dropped.size(), dropped.front().reason, fmt::join(counts, ", ")));
}

Result<ReadRecords> read_all(const Scenario& scenario, GpsTime near, std::vector<std::string>& warnings) {
    ReadRecords all;
    std::vector<std::pair<std::string, std::string>> almanacs;  // name, text
    for (const std::filesystem::path& path : scenario.sky.navigation) {
        all.description += (all.description.empty() ? "" : " ") + path.filename().string();
        auto text = read_text_file(path);
        if (!text) return fail(text.error());
        if (is_almanac(*text)) {
            almanacs.emplace_back(path.string(), std::move(*text));
            continue;
        }
        const auto file = read_navigation(*text, path.string());
        if (!file) return fail(file.error());
        warnings.insert(warnings.end(), file->warnings.begin(), file->warnings.end());
        all.records.insert(all.records.end(), file->records.begin(), file->records.end());
        add_ionosphere(all.ionosphere, file->ionosphere);
    }
    near = middle_toe(all.records).value_or(near);
    for (const auto& [name, text] : almanacs) {
        const auto records = read_almanac(text, name, near);
        if (!records) return fail(records.error());
        all.records.insert(all.records.end(), records->begin(), records->end());
    }
    if (const Result<void> kept = keep_constellations(all, scenario); !kept) return fail(kept.error());
    warn_of_foreign_records(drop_foreign_records(all.records), warnings);
    return all;
}

EphemerisSelection selection_of(const Scenario& scenario) {
    // The article takes the record of the hour that has begun; every other model takes the nearest.
    const EphemerisRule own =
        scenario.model.sensor_model == ErrorModelKind::baseline ? EphemerisRule::forward : EphemerisRule::nearest;
    return {scenario.sky.ephemeris_rule.value_or(own), scenario.sky.ephemeris_validity};
}

// Far inside what 64-bit nanoseconds since 1980 can count, which ends in 2272.
Result<void> check_end(const RunSettings& run, GpsTime start) {
    constexpr double latest_s = 290 * 365.25 * 86400;
    const double end_s = difference(start, GpsTime{}).value() + run.duration.value_or(Seconds(0)).value();
    if (end_s < latest_s) return {};
    return fail(ErrorCode::usage, fmt::format("a run of {:g} s from {} ends after 2269; expected a shorter one",
                                              run.duration.value_or(Seconds(0)).value(), utc_text(start)));
}

// The article's sky is GPS alone, and its nominal one has no others.
std::vector<Constellation> nominal_constellations(const Scenario& scenario) {
    if (scenario.sky.constellations.empty() && scenario.model.sensor_model) return {Constellation::gps};
    return wanted_constellations(scenario);
}

Result<LoadedNavigation> load_nominal(const Scenario& scenario, GpsTime now) {
    if (scenario.sky.rebase_navigation)
        return fail(ErrorCode::usage, told_place(scenario, "sky.rebase_navigation", "--rebase-nav") +
                                          "moves navigation data, but there is none; expected some, by sky.navigation "
                                          "or --nav");
    LoadedNavigation loaded;
    loaded.source = std::make_unique<NominalSky>(nominal_constellations(scenario));
    loaded.start = scenario.run.start.value_or(now);
    if (const auto checked = check_end(scenario.run, loaded.start); !checked) return fail(checked.error());
    return loaded;
}

}  // namespace

Result<NavigationData> read_navigation_files(const Scenario& scenario, GpsTime near,
                                             std::vector<std::string>& warnings) {
    const auto all = read_all(scenario, near, warnings);
    if (!all) return fail(all.error());
    return NavigationData(all->records, all->ionosphere, all->description, selection_of(scenario));
}

namespace {

Result<LoadedNavigation> load_files(const Scenario& scenario, GpsTime now, const DataFolders& folders) {
    LoadedNavigation loaded;
    auto read = read_navigation_files(scenario, time_of_almanacs(scenario, now), loaded.warnings);
    if (!read) return fail(read.error());
    NavigationData& data = *read;
    const SolvableSky sky = SolvableSky::of(scenario, folders);
    loaded.start = start_of(scenario, data, sky, now);
    if (const auto checked = check_end(scenario.run, loaded.start); !checked) return fail(checked.error());
    if (scenario.sky.rebase_navigation) {
        auto moved = rebased(data, loaded.start);
        if (!moved) return fail(moved.error());
        data = std::move(*moved);
    }
    for (std::string& warning : time_warnings(scenario, data, sky, loaded.start))
        loaded.warnings.push_back(std::move(warning));
    loaded.files = scenario.sky.navigation;
    loaded.source = std::make_unique<NavigationData>(std::move(data));
    return loaded;
}

// The file of the start's day where it has orbits then, else the nominal sky; it is told which.
Result<LoadedNavigation> load_automatic(const Scenario& asked, GpsTime now, const DataFolders& folders) {
    if (asked.sky.rebase_navigation)
        return fail(ErrorCode::usage, told_place(asked, "sky.rebase_navigation", "--rebase-nav") +
                                          "moves navigation data, and \"auto\" takes those of the run's own day; "
                                          "expected one of them");
    Scenario scenario = asked;
    scenario.run.start = asked.run.start.value_or(now);
    const auto file = cached_navigation(folders, *scenario.run.start);
    std::string why = file ? "" : file.error().message;
    if (file) {
        scenario.sky.navigation = {*file};
        auto loaded = load_files(scenario, now, folders);
        if (!loaded) return loaded;
        loaded->notes.push_back(fmt::format("navigation: {}, of the cache", loaded->source->description()));
        const auto span = loaded->source->span();
        if (span && *scenario.run.start <= span->last) return loaded;
        why = fmt::format("{}: ends before the start of the run; skyloop fetch-nav gets what has come since",
                          file->string());
    }
    auto loaded = load_nominal(asked, now);
    if (loaded) loaded->warnings.push_back("the sky is the nominal one: " + why);
    return loaded;
}

}  // namespace

Result<std::filesystem::path> cached_navigation(const DataFolders& folders, GpsTime time) {
    const GpsTime day = day_of(time);
    const std::string remedy = fmt::format("skyloop fetch-nav --date {} gets it", day_text(day));
    if (folders.cache.empty())
        return fail(ErrorCode::outside, "no cache of navigation files: neither XDG_CACHE_HOME nor HOME names a folder");
    std::filesystem::path file = cached_navigation_path(folders.cache, day);
    std::error_code absent;
    if (std::filesystem::exists(file, absent)) return file;
    return fail(ErrorCode::outside, fmt::format("{}: no navigation file of this day; {}", file.string(), remedy));
}

Result<LoadedNavigation> load_navigation(const Scenario& scenario, GpsTime now, const DataFolders& folders) {
    if (scenario.sky.automatic_navigation) return load_automatic(scenario, now, folders);
    if (scenario.sky.navigation.empty()) return load_nominal(scenario, now);
    return load_files(scenario, now, folders);
}

}  // namespace skyloop::inline run
