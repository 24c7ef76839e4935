#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/core/files.hpp"
#include "base/time/utc_time.hpp"
#include "detail/modern_assembly.hpp"
#include "detail/navigation_start.hpp"
#include "motion/tracks/read_track.hpp"
#include "receiver/pvt/single_point.hpp"
#include "run/emulator/assembly.hpp"
#include "run/scenario/board_files.hpp"
#include "world/rinex/ionex_file.hpp"
#include "world/sky/observe_sky.hpp"

namespace skyloop::inline run {
namespace {

// A hot start takes seconds; one that has to hear its orbits first, half a minute of every satellite.
constexpr Nanoseconds first_fix_time = std::chrono::seconds(60);
// Satellites rise and set slowly.
constexpr Nanoseconds look_again = std::chrono::minutes(5);

// The first row of a recorded path.
std::optional<Geodetic> first_place_of(const FileSettings& file, const DataFolders& folders) {
    const auto text = read_text_file(file.path);
    if (!text) return std::nullopt;
    std::vector<std::string> unsaid;
    const auto geoid = find_geoid(folders, unsaid);
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text->data()), text->size());
    const auto track = read_track(bytes, file.path.string(), {geoid.get(), file.origin});
    if (!track) return std::nullopt;
    const auto row = std::find_if(track->points.begin(), track->points.end(),
                                  [](const TrackRow& r) { return r.position.vector().allFinite(); });
    return row == track->points.end() ? std::nullopt : std::optional(to_geodetic(row->position));
}

std::optional<Geodetic> place_of_start(const Scenario& scenario, const DataFolders& folders) {
    const TrajectorySettings& way = trajectory_of(scenario, 0);
    if (const auto* live = std::get_if<LiveSettings>(&way)) return live->at;
    if (const auto* file = std::get_if<FileSettings>(&way))
        return scenario.run.start ? std::nullopt : first_place_of(*file, folders);
    return make_trajectory(way, GpsTime{})->at(GpsTime{}).geodetic;
}

// Enough for three coordinates and a clock of each system that they are of: a satellite that is alone in its system
// brings no more than its clock takes.
bool is_enough(const std::array<int, clock_count>& satellites) {
    int beyond_clocks = 0;
    for (const int count : satellites)
        beyond_clocks += std::max(count - 1, 0);
    return beyond_clocks >= 3;
}

// When orbits begin to serve, ascending.
std::vector<GpsTime> beginnings_of(const NavigationData& data, GpsTime earliest) {
    const bool before_toe = data.selection().rule == EphemerisRule::nearest;
    std::vector<GpsTime> beginnings;
    for (const SatelliteRecords& satellite : data.records())
        for (const Ephemeris& r : satellite.records)
            beginnings.push_back(std::max(
                earliest, toe_of(r) - (before_toe ? to_nanoseconds(data.selection().validity_of(r)) : Nanoseconds(0))));
    std::sort(beginnings.begin(), beginnings.end());
    beginnings.erase(std::unique(beginnings.begin(), beginnings.end()), beginnings.end());
    return beginnings;
}

// From `earliest` on. What has orbits only gets less between two beginnings, so one looks no further where it is too
// little.
std::optional<GpsTime> first_solvable(const NavigationData& data, const SolvableSky& sky, GpsTime earliest) {
    const SolvableSky anywhere = sky.anywhere();
    const std::vector<GpsTime> beginnings = beginnings_of(data, earliest);
    for (std::size_t i = 0; i < beginnings.size(); ++i) {
        const GpsTime end = i + 1 < beginnings.size() ? beginnings[i + 1] : GpsTime::max();
        for (GpsTime t = beginnings[i]; t < end && anywhere.solvable(data, t); t += look_again)
            if (sky.solvable(data, t) && sky.solvable(data, t + first_fix_time)) return t;
    }
    return std::nullopt;
}

// The last instant up to `end` at which there are orbits enough; nothing where there never are.
std::optional<GpsTime> last_with_orbits(const NavigationData& data, const SolvableSky& sky, GpsTime end) {
    std::vector<GpsTime> ends;
    for (const SatelliteRecords& satellite : data.records())
        for (const Ephemeris& r : satellite.records)
            ends.push_back(std::min(end, toe_of(r) + to_nanoseconds(data.selection().validity_of(r))));
    std::sort(ends.begin(), ends.end());
    const SolvableSky anywhere = sky.anywhere();
    const auto last = std::find_if(ends.rbegin(), ends.rend(), [&](GpsTime t) { return anywhere.solvable(data, t); });
    return last == ends.rend() ? std::nullopt : std::optional(*last);
}

std::string system_list(const SolvableSky& sky) {
    std::vector<std::string_view> names;
    for (const Constellation system : sky.systems)
        names.push_back(constellation_name(system));
    return fmt::format("{}", fmt::join(names, ", "));
}

constexpr std::string_view remedy = "--start moves the run, --rebase-nav the data";

// Why the sky cannot be solved at the start. Where the start was chosen, it cannot at any time.
std::string scarcity(const Scenario& scenario, const NavigationData& data, const SolvableSky& sky, GpsTime start) {
    const bool told = scenario.run.start || scenario.run.start_now || scenario.sky.rebase_navigation;
    const bool hidden = sky.anywhere().solvable(data, start);
    std::string text = told ? fmt::format("no fix is to be expected at the start, {}: ", utc_text(start))
                            : "no fix is to be expected: ";
    text += fmt::format("too few satellites of {} ", system_list(sky));
    text += hidden ? fmt::format("with orbits stand above {:g} degrees at {:.4f}, {:.4f}", sky.mask.deg(),
                                 sky.place->latitude.deg(), sky.place->longitude.deg())
                   : "have orbits";
    text += told ? " then" : " at any time of the navigation data";
    if (hidden) text += "; --at moves the antenna";
    if (told) text += fmt::format("{}{}", hidden ? ", " : "; ", remedy);
    return text;
}

// Where the maps of the ionosphere begin, too, of a run that takes them.
GpsTime earliest_start(const Scenario& scenario, const NavigationData& data, GpsTime now) {
    GpsTime earliest = data.first_epoch().value_or(now);
    const std::filesystem::path file = acting_ionosphere_maps(scenario);
    if (file.empty()) return earliest;
    const auto maps = read_ionex_file(file);
    if (maps && !maps->maps.empty()) earliest = std::max(earliest, maps->maps.front().time);
    return earliest;
}

}  // namespace

SolvableSky SolvableSky::of(const Scenario& scenario, const DataFolders& folders) {
    using enum Constellation;
    SolvableSky sky;
    sky.place = place_of_start(scenario, folders);
    sky.mask = scenario.sky.elevation_mask.value_or(Angle::degrees(5));
    sky.one_clock = scenario.model.sensor_model.has_value();
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i) {
        const ReceiverEntry& entry = scenario.receivers[i];
        const auto board = find_board(entry.board, board_folders(folders));
        if (i == 0 && board && !scenario.sky.elevation_mask && !scenario.model.sensor_model)
            sky.mask = board->elevation_mask;
        std::vector<Constellation> tracked = entry.constellations;
        if (tracked.empty())
            tracked = board ? board->constellations : std::vector{gps, galileo, beidou, qzss, glonass, navic};
        sky.systems.insert(tracked.begin(), tracked.end());
    }
    sky.systems.erase(sbas);
    return sky;
}

bool SolvableSky::solvable(const NavigationSource& source, GpsTime time) const {
    std::array<int, clock_count> satellites{};
    const auto count = [&](SatelliteId id) { ++satellites[one_clock ? 0 : clock_of(id.constellation)]; };
    for (const SatelliteId id : source.satellites()) {
        if (!systems.contains(id.constellation)) continue;
        const auto record = source.ephemeris(id, time);
        if (record && is_healthy(*record)) count(id);
    }
    if (!place || !is_enough(satellites)) return is_enough(satellites);
    satellites.fill(0);
    const TruthState truth{time, to_ecef(*place), {}, *place};
    for (const SatelliteInView& satellite : observe_sky(truth, source).satellites)
        if (systems.contains(satellite.id.constellation) && satellite.healthy && satellite.elevation >= mask)
            count(satellite.id);
    return is_enough(satellites);
}

GpsTime start_of(const Scenario& scenario, const NavigationData& data, const SolvableSky& sky, GpsTime now) {
    if (scenario.run.start) return *scenario.run.start;
    if (scenario.run.start_now || scenario.sky.rebase_navigation) return now;
    const GpsTime earliest = earliest_start(scenario, data, now);
    if (const auto seen = first_solvable(data, sky, earliest)) return *seen;
    return first_solvable(data, sky.anywhere(), earliest).value_or(earliest);
}

std::vector<std::string> time_warnings(const Scenario& scenario, const NavigationData& data, const SolvableSky& sky,
                                       GpsTime start) {
    const auto span = data.span();
    if (!span) return {};
    if (start < span->first || start > span->last)
        return {fmt::format("the run starts outside the navigation data, which spans {} to {}: no fix there; {}",
                            utc_text(span->first), utc_text(span->last), remedy)};
    std::vector<std::string> warnings;
    if (!sky.solvable(data, start)) warnings.push_back(scarcity(scenario, data, sky, start));
    if (!scenario.run.duration) return warnings;
    const GpsTime end = advanced(start, *scenario.run.duration);
    const auto last = last_with_orbits(data, sky, end);
    if (last && *last >= start && *last < end)
        warnings.push_back(
            fmt::format("the run outlasts the navigation data: after {}, too few satellites of {} have orbits; {}",
                        utc_text(*last), system_list(sky), remedy));
    return warnings;
}

}  // namespace skyloop::inline run
