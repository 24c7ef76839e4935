#include "run/scenario/scenario_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/core/text_file.hpp"
#include "base/time/utc_time.hpp"
#include "detail/scenario_keys.hpp"
#include "run/scenario/scenario_changes.hpp"

namespace skyloop {
namespace {

void read_run_keys(TableReader& run, RunSettings& settings) {
    const auto start = run.utc("start", {"when the run begins: ISO 8601 in UTC, or \"now\"",
                                         "now; with navigation data when four satellites first have orbits"});
    if (start == "now") {
        settings.start_now = true;
    } else if (start) {
        const auto utc = parse_instant(*start);
        if (utc)
            settings.start = to_gps_time(*utc, LeapSeconds::announced());
        else
            run.mistake("start", utc.error().message + ", or \"now\"");
    }
    run.quantity("duration_s", settings.duration, {std::numeric_limits<double>::min(), longest_run_s},
                 {"length of the run", "until stopped"});
    run.integer("seed", settings.seed, NumberRange::not_negative(),
                "the same scenario, seed and inputs give the same bytes");
    run.number("speed", settings.speed, {1e-3, 1e6}, "`skyloop run` only: simulated seconds per second");
}

void read_sky_keys(TableReader& sky, SkySettings& settings, const std::filesystem::path& folder) {
    std::vector<std::string> files;
    sky.text_or_texts("navigation", files,
                      {"navigation files: RINEX 2, 3 or 4, YUMA or SEM almanac, packed too", "nominal constellation"});
    for (const std::string& file : files) {
        if (file.empty()) sky.mistake("navigation", "is empty; expected the path of a file");
        settings.navigation.push_back(folder / file);
    }
    sky.boolean("rebase_navigation", settings.rebase_navigation,
                "move the data by whole days to the start time, keeping its time of day");
    read_constellation_list(sky, "constellations", settings.constellations,
                            {"which systems of the data send", "all; gps and qzss for sensor models"});
    sky.degrees("elevation_mask_deg", settings.elevation_mask, {0, 90},
                {"elevation mask: a satellite exactly at it is used", "the board's; 5 for sensor models"});
    sky.word("ephemeris_rule", {{"forward", EphemerisRule::forward}, {"nearest", EphemerisRule::nearest}},
             settings.ephemeris_rule,
             {"the newest healthy record that is not of the future, or the nearest one", "by the model"});
    sky.quantity("ephemeris_validity_s", settings.ephemeris_validity, {1, 14 * 86400.0},
                 {"largest age of any record", "by the system"});
}

// What a run may be refused for when it is put together.
void remember_places(TableReader& table, std::string_view name, ToldPlaces& told_at) {
    for (const std::string& key : table.keys())
        told_at[fmt::format("{}.{}", name, key)] = table.told_at(key);
}

bool is_live(const TrajectorySettings& trajectory) { return std::holds_alternative<LiveSettings>(trajectory); }

// A source gives places on the Earth, or metres of a map of its own.
void refuse_idle_frame(TableReader& top) {
    if (top.has("frame"))
        top.mistake("frame",
                    "has no effect on a live trajectory; expected no [frame], and trajectory.origin where the "
                    "source gives local metres");
}

bool is_all_live(const Scenario& scenario) {
    const auto& receivers = scenario.receivers;
    return std::all_of(receivers.begin(), receivers.end(), [&](const ReceiverEntry& receiver) {
        return is_live(receiver.trajectory.value_or(scenario.trajectory));
    });
}

}  // namespace

std::string told_place(const Scenario& scenario, std::string_view key, std::string_view otherwise) {
    const auto place = scenario.told_at.find(key);
    return place != scenario.told_at.end() ? place->second : fmt::format("{}: ", otherwise);
}

void read_top_keys(TableReader& top, Scenario& scenario, const std::filesystem::path& folder) {
    top.table("run", "when, how long, how fast", [&](TableReader& t) {
        read_run_keys(t, scenario.run);
        remember_places(t, "run", scenario.told_at);
    });
    top.table("sky", "which satellites there are", [&](TableReader& t) {
        read_sky_keys(t, scenario.sky, folder);
        remember_places(t, "sky", scenario.told_at);
    });
    const TrajectoryContext context{read_frame(top), folder};
    if (auto path = read_trajectory_keys(top, {"where the vehicle is", "fixed, in Odessa"}, context, scenario.warnings))
        scenario.trajectory = std::move(*path);
    top.table("model", "how a fix is made", [&](TableReader& t) { read_model_keys(t, scenario.model, folder); });
    top.table("atmosphere", "clouds and rain; and the air of the sensor models", [&](TableReader& t) {
        read_atmosphere_keys(t, scenario, folder);
        scenario.atmosphere_keys = t.keys();
        remember_places(t, "atmosphere", scenario.told_at);
    });
    top.table("scene", "buildings and ground around the antenna", [&](TableReader& t) {
        read_scene_keys(t, scenario.scene, folder);
        remember_places(t, "scene", scenario.told_at);
    });
    read_receivers(top, scenario, context);
    if (is_all_live(scenario)) refuse_idle_frame(top);
    read_outputs(top, scenario);
    read_timeline(top, scenario);
    read_expectations(top, scenario);
    read_campaign(top, scenario.campaign);
}

void read_constellation_list(TableReader& table, const char* key, std::vector<Constellation>& constellations,
                             KeyText text) {
    const auto found = table.choices(key, constellation_names, text);
    if (!found) return;
    constellations.clear();
    for (const std::size_t index : *found)
        constellations.push_back(static_cast<Constellation>(index));
}

Result<Scenario> read_scenario(std::string_view text, const std::filesystem::path& file) {
    return read_changed_scenario(text, file, {});
}

Result<Scenario> read_scenario_file(const std::filesystem::path& file) {
    ScenarioReading reading = read_file_with_mistakes(file, {});
    if (reading.mistakes) return fail(*reading.mistakes);
    return std::move(reading.scenario);
}

Result<TrajectorySettings> read_trajectory_file(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                                std::span<const ScenarioChange> changes) {
    const auto text = read_text_file(file);
    if (!text) return fail(text.error());
    std::optional<TrajectorySettings> trajectory;
    const auto read_keys = [&](TableReader& top) {
        if (!top.has("trajectory")) top.mistake_here("no [trajectory] table in this file");
        trajectory = read_trajectory_keys(top, {}, {read_frame(top), file.parent_path()}, warnings);
        if (trajectory && is_live(*trajectory)) refuse_idle_frame(top);
    };
    const auto change = [&](toml::table& table, MistakeList& mistakes) { apply_changes(table, mistakes, changes); };
    const auto read = read_toml(*text, file.string(), read_keys, change);
    if (!read) return fail(read.error());
    return trajectory.value_or(FixedSettings{});
}

}  // namespace skyloop
