#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "detail/scenario_keys.hpp"
#include "detail/table_reader.hpp"
#include "world/city/land_use.hpp"

namespace skyloop::inline run {
namespace {

constexpr double longest_way_m = 1e9, longest_time_s = 1e10;
constexpr double standard_ramp_m = 20;

void read_channel_numbers(TableReader& table, ChannelParameters& p) {
    table.number("distance_scale", p.distance_scale, {0.01, 100}, "of the environment's lengths of way");
    table.number("bad_odds", p.bad_odds, {0, 1000}, "factor on the environment's odds of a bad state");
    table.quantity("good_loss_db", p.good_loss, {-30, 100}, "more loss of the direct signal in the good state");
    table.quantity("bad_loss_db", p.bad_loss, {-30, 100}, "more loss of the direct signal in the bad state");
    table.number("shadowing_scale", p.shadowing_scale, {0, 10}, "of the environment's σ of shadowing within a state");
    table.quantity("diffuse_db", p.diffuse, {-60, 30}, "more power of the scattered signal than the environment's");
    table.degrees("reach_deg", p.reach, {1, 180}, "angle in the sky from which obstacles are independent");
    table.quantity("creep_mps", p.creep, {0, 10}, "speed at which states and shadows pass an antenna at rest");
    table.quantity("beat_hz", p.beat, {0, 100}, "σ of the echoes' frequencies at rest");
    table.quantity("averaging_s", p.averaging, {0, 100}, "time over which a receiver averages fading");
    table.quantity("echo_delay_m", p.echo_delay, {0, 1e4}, "mean excess of the echoes");
    table.quantity("echo_length_m", p.echo_length, {0.1, 1e4}, "way over which an echo changes");
    table.degrees("wall_deg", p.wall, {0, 89},
                  "mean elevation of the tops of a street's walls, in place of the environment's odds; 0: none");
    table.degrees("wall_spread_deg", p.wall_spread, {0.1, 90}, "its standard deviation along the street");
    table.degrees("street_deg", p.street, {-360, 360},
                  {"azimuth of the street between the walls", "that of the motion, by the seed before any"});
}

template <class Quantity>
void read_end(TableReader& table, std::string_view key, Quantity from, Quantity& to, double longest) {
    std::optional<Quantity> given;
    table.quantity(key, given, {0, longest}, {"where they end", "the end of the run"});
    if (given && !(from < *given))
        table.mistake(key,
                      fmt::format("is {:g}; expected more than {:g}, where they begin", given->value(), from.value()));
    to = given.value_or(to);
}

StretchOfWay read_way(TableReader& table) {
    StretchOfWay way;
    table.quantity("from_m", way.from, {0, longest_way_m}, "where they begin, metres travelled since the start");
    read_end(table, "to_m", way.from, way.to, longest_way_m);
    return way;
}

StretchOfTime read_time(TableReader& table) {
    StretchOfTime time;
    table.quantity("from_s", time.from, {0, longest_time_s}, "when they begin, seconds after the start of the run");
    read_end(table, "to_s", time.from, time.to, longest_time_s);
    return time;
}

StretchOfPlace read_place(TableReader& table) {
    const auto corners = table.polygon("inside", "they hold inside this polygon, [[latitude, longitude], …]");
    if (!corners) return {};
    const EarthPolygon polygon(*corners);
    if (const auto sound = check_polygon(polygon); !sound) table.mistake("inside", sound.error());
    return {{polygon}};
}

void read_extent(TableReader& table, SurroundingsStretch& stretch) {
    const StretchOfWay way = read_way(table);
    const StretchOfTime time = read_time(table);
    StretchOfPlace place = read_place(table);
    for (const std::string_view key : {"from_m", "to_m"})
        for (const std::string_view other : {"from_s", "to_s", "inside"})
            table.not_both(key, other);
    for (const std::string_view key : {"from_s", "to_s"})
        table.not_both(key, "inside");
    table.needs_one_of({"land_use", "from_m", "to_m", "from_s", "to_s", "inside"},
                       "has neither from_m, to_m, from_s, to_s nor inside; expected where or when they hold");
    if (table.has("inside"))
        stretch.extent = std::move(place);
    else if (table.has("from_s") || table.has("to_s"))
        stretch.extent = time;
    else
        stretch.extent = way;
}

void read_ramp(TableReader& table, SurroundingsStretch& stretch) {
    const bool timed = std::holds_alternative<StretchOfTime>(stretch.extent);
    double metres = standard_ramp_m, seconds = 2;
    table.where(!timed, "without from_s and to_s", [&] {
        table.number("ramp_m", metres, {0, longest_way_m}, "way over which they come and go");
    });
    table.where(timed, "with from_s or to_s", [&] {
        table.number("ramp_s", seconds, {0, longest_time_s}, "time over which they come and go");
    });
    stretch.ramp = timed ? seconds : metres;
}

struct LandUseWord {
    std::string_view tag;  // of OpenStreetMap (wiki, "Key:landuse", "Key:natural", "Key:aeroway")
    Surroundings around;
};

// Ours. Of an area with several of them the first.
constexpr LandUseWord land_uses[] = {{"natural=wood", Surroundings::forest},
                                     {"landuse=forest", Surroundings::forest},
                                     {"landuse=residential", Surroundings::residential},
                                     {"landuse=commercial", Surroundings::urban},
                                     {"landuse=retail", Surroundings::urban},
                                     {"landuse=industrial", Surroundings::urban},
                                     {"landuse=farmland", Surroundings::rural},
                                     {"landuse=farmyard", Surroundings::rural},
                                     {"landuse=meadow", Surroundings::rural},
                                     {"landuse=orchard", Surroundings::rural},
                                     {"landuse=vineyard", Surroundings::rural},
                                     {"landuse=allotments", Surroundings::rural},
                                     {"natural=water", Surroundings::open_sky},
                                     {"aeroway=aerodrome", Surroundings::open_sky}};
// Of areas that overlap the later one counts: woods lie in towns, lakes in woods.
constexpr Surroundings land_use_order[] = {Surroundings::rural, Surroundings::residential, Surroundings::urban,
                                           Surroundings::forest, Surroundings::open_sky};

Result<LandUse> known_land_use(const std::filesystem::path& file) {
    std::vector<std::string_view> tags;
    for (const LandUseWord& use : land_uses)
        tags.push_back(use.tag);
    return read_land_use(file, tags);
}

std::vector<SurroundingsStretch> stretches_of_land(const std::vector<LandUseArea>& areas, double ramp) {
    std::map<Surroundings, StretchOfPlace> places;
    for (const LandUseArea& area : areas) {
        const auto use = std::ranges::find(land_uses, std::string_view(area.use), &LandUseWord::tag);
        places[use->around].polygons.emplace_back(area.outer, area.holes);
    }
    std::vector<SurroundingsStretch> stretches;
    for (const Surroundings around : land_use_order)
        if (const auto place = places.find(around); place != places.end())
            stretches.push_back({channel_of(around), std::move(place->second), ramp});
    return stretches;
}

// Nothing where the table names no file.
std::optional<std::vector<SurroundingsStretch>> read_land_use_file(TableReader& table, Scenario& scenario,
                                                                   const std::filesystem::path& folder) {
    std::filesystem::path file;
    table.file_path("land_use", folder, file, "in place of kind and where: areas of an OpenStreetMap file");
    constexpr std::array refused{"kind", "from_m", "to_m", "from_s", "to_s", "inside", "ramp_s", "channel"};
    for (const std::string_view key : refused)
        table.not_both("land_use", key);
    table.needs_one_of({"kind", "land_use"}, "has neither kind nor land_use; expected what is around the antenna");
    if (file.empty()) return std::nullopt;
    for (const std::string_view key : refused)
        table.has_been_read(key);
    scenario.model.modern.tables.push_back(file);
    double ramp = standard_ramp_m;
    table.number("ramp_m", ramp, {0, longest_way_m});
    const auto land = known_land_use(file);
    if (!land) return table.mistake("land_use", land.error()), std::vector<SurroundingsStretch>();
    if (land->cut > 0)
        scenario.warnings.push_back(fmt::format("{}{} of {} areas end outside of the file: left out",
                                                table.told_at("land_use"), land->cut, land->cut + land->areas.size()));
    return stretches_of_land(land->areas, ramp);
}

SurroundingsStretch read_stretch(TableReader& table) {
    SurroundingsStretch stretch;
    const auto kind = table.choice("kind", surroundings_names, "what is around the antenna");
    if (kind) stretch.channel = channel_of(static_cast<Surroundings>(*kind));
    read_extent(table, stretch);
    read_ramp(table, stretch);
    table.table("channel", "numbers of their channel, in place of those of kind",
                [&](TableReader& t) { read_channel_keys(t, stretch.channel); });
    return stretch;
}

void read_stretches(TableReader& table, Scenario& scenario, const std::filesystem::path& folder) {
    std::vector<SurroundingsStretch>& stretches = scenario.model.modern.propagation.stretches;
    if (const auto land = read_land_use_file(table, scenario, folder))
        stretches.insert(stretches.end(), land->begin(), land->end());
    else
        stretches.push_back(read_stretch(table));
}

}  // namespace

void read_channel_keys(TableReader& table, ChannelParameters& p) {
    table.word("environment",
               {{"none", std::nullopt},
                {"urban", P681Environment::urban},
                {"suburban", P681Environment::suburban},
                {"village", P681Environment::village},
                {"wooded", P681Environment::wooded},
                {"residential", P681Environment::residential}},
               p.environment, {"statistics of ITU-R P.681-11; none: no channel", "that of surroundings"});
    table.where(p.environment.has_value(), "with surroundings that have a channel, or with environment",
                [&] { read_channel_numbers(table, p); });
    table.quantity("cover_db", p.cover, {0, 200},
                   {"loss of what is all around, as a tunnel's rock", "0; tunnel 60, garage 22"});
    table.where(p.cover > Decibels(0), "with cover_db", [&] {
        table.quantity("opening_side_m", p.opening_side, {0, 1000},
                       "of the openings where such surroundings begin and end, to each side of the antenna");
        table.quantity("opening_height_m", p.opening_height, {0, 1000}, "of the openings, above the antenna");
    });
}

void read_surroundings(TableReader& top, Scenario& scenario, const std::filesystem::path& folder) {
    ModernSettings& modern = scenario.model.modern;
    const std::size_t before = top.idle_keys().size();
    top.tables("surroundings", "surroundings along the way; of those that overlap, the last",
               [&](TableReader& t) { read_stretches(t, scenario, folder); });
    const std::vector<std::string>& idle = top.idle_keys();
    modern.idle_keys.insert(modern.idle_keys.end(), idle.begin() + static_cast<std::ptrdiff_t>(before), idle.end());
    if (scenario.model.sensor_model && !modern.propagation.stretches.empty())
        top.mistake("surroundings", "have no effect on a sensor model; expected model.kind = \"modern\"");
}

}  // namespace skyloop::inline run
