#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/core/files.hpp"

#include "base/time/utc_time.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/navigation_files.hpp"
#include "run/scenario/board_files.hpp"
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

// A RINEX file or an almanac. @param near resolves the weeks of an almanac
Result<NavigationFile> read_file(const std::filesystem::path& path, GpsTime near) {
    const auto text = read_text_file(path);
    if (!text) return fail(text.error());
    if (!is_almanac(*text)) return read_navigation(*text, path.string());
    auto almanac = read_almanac(*text, path.string(), near);
    if (!almanac) return fail(almanac.error());
    NavigationFile file;
    file.records.assign(almanac->begin(), almanac->end());
    return file;
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
    for (const std::filesystem::path& path : scenario.sky.navigation) {
        auto file = read_file(path, near);
        if (!file) return fail(file.error());
        warnings.insert(warnings.end(), file->warnings.begin(), file->warnings.end());
        all.records.insert(all.records.end(), file->records.begin(), file->records.end());
        add_ionosphere(all.ionosphere, file->ionosphere);
        all.description += (all.description.empty() ? "" : " ") + path.filename().string();
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

// Those that the receivers of the run solve with; SBAS adds to them and is no solution alone. Where a board is not
// found, which is told when it is opened, all.
std::set<Constellation> solving_constellations(const Scenario& scenario, const DataFolders& data) {
    using enum Constellation;
    std::set<Constellation> solving;
    for (const ReceiverEntry& entry : scenario.receivers) {
        std::vector<Constellation> tracked = entry.constellations;
        if (tracked.empty()) {
            const auto board = find_board(entry.board, board_folders(data));
            tracked = board ? board->constellations : std::vector{gps, galileo, beidou, qzss, glonass, navic};
        }
        solving.insert(tracked.begin(), tracked.end());
    }
    solving.erase(sbas);
    return solving;
}

// From the first record on, when four satellites of these systems first have orbits. A record that lies alone before
// all others would make a run begin where nothing can be solved. Where four never have: the first record.
std::optional<GpsTime> first_solvable(const NavigationData& data, const std::set<Constellation>& systems) {
    constexpr std::ptrdiff_t enough = 4;
    const std::optional<GpsTime> first = data.first_epoch();
    if (!first) return std::nullopt;
    const bool before_toe = data.selection().rule == EphemerisRule::nearest;
    std::vector<SatelliteId> satellites = data.satellites();
    std::erase_if(satellites, [&](SatelliteId id) { return !systems.contains(id.constellation); });
    std::vector<GpsTime> beginnings;
    for (const SatelliteRecords& satellite : data.records())
        for (const Ephemeris& r : satellite.records)
            beginnings.push_back(std::max(
                *first, toe_of(r) - (before_toe ? to_nanoseconds(data.selection().validity_of(r)) : Nanoseconds(0))));
    std::sort(beginnings.begin(), beginnings.end());
    const auto found = std::find_if(beginnings.begin(), beginnings.end(), [&](GpsTime t) {
        return std::count_if(satellites.begin(), satellites.end(),
                             [&](SatelliteId id) { return data.ephemeris(id, t).has_value(); }) >= enough;
    });
    return found == beginnings.end() ? first : *found;
}

// The instant at which a run with these data begins.
GpsTime start_of(const Scenario& scenario, const NavigationData& data, const DataFolders& folders, GpsTime now) {
    if (scenario.run.start) return *scenario.run.start;
    if (scenario.run.start_now || scenario.sky.rebase_navigation) return now;
    return first_solvable(data, solving_constellations(scenario, folders)).value_or(now);
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
    LoadedNavigation loaded{std::make_unique<NominalSky>(nominal_constellations(scenario)), {}, {}};
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

Result<LoadedNavigation> load_navigation(const Scenario& scenario, GpsTime now, const DataFolders& folders) {
    if (scenario.sky.navigation.empty()) return load_nominal(scenario, now);
    LoadedNavigation loaded;
    auto read = read_navigation_files(scenario, scenario.run.start.value_or(now), loaded.warnings);
    if (!read) return fail(read.error());
    NavigationData& data = *read;
    loaded.start = start_of(scenario, data, folders, now);
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

}  // namespace skyloop::inline run
