// The kinds of [trajectory] but generated paths.
#include "detail/trajectory_kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace skyloop::inline run {
namespace {

void read_fixed(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    FixedSettings fixed;
    fixed.heading = read_heading(table);
    if (const auto at = places.read_needed(table, "at", {"place", "none"})) fixed.at = *at;
    trajectory = fixed;
}

void read_circle(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    CircleSettings circle;
    circle.heading = read_heading(table);
    if (const auto centre = places.read_needed(table, "centre", {"centre", "none"})) circle.shape.centre = *centre;
    table.quantity("radius_m", circle.shape.radius, {0.1, 1e6}, "of the circle");
    table.quantity("speed_mps", circle.shape.speed, {-12000, 12000},
                   "along the circle; a negative one runs anticlockwise");
    table.degrees("start_azimuth_deg", circle.shape.start_azimuth, {-360, 360},
                  "from the centre to the place at the start, clockwise from north");
    trajectory = circle;
}

void read_source_map(TableReader& table, LiveSettings& live) {
    static constexpr std::array<std::string_view, 5> maps{"source", "tangent", "ardupilot_flat", "px4_azimuthal",
                                                          "airsim_sphere"};
    live.origin = table.place(
        "origin",
        {"where the local metres of a source begin: latitude, longitude, height above the ellipsoid", "none"});
    const auto map =
        table.choice("local_map", maps,
                     "how a source's local metres lie on the Earth: as it means them, or by another's map", maps[0]);
    if (map.value_or(0) > 0) live.local_map = local_map_of_name(maps.at(*map));
}

void read_source_timing(TableReader& table, LiveSettings& live) {
    table.number("source_rate_hz", live.rate_hz, {0.1, 1000}, "asked of sources that can be asked");
    table.quantity("delay_s", live.delay, {0, 10}, "the path is this much late, so that slow sources are interpolated");
    table.quantity("lost_after_s", live.lost_after, {0.1, 1e7}, "silence of the source after which it is lost");
    table.word("when_lost",
               {{"hold", LostSource::hold},
                {"outage", LostSource::outage},
                {"pause", LostSource::pause},
                {"stop", LostSource::stop}},
               live.when_lost, "what then becomes of the run");
}

void read_live(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    LiveSettings live;
    live.heading = read_heading(table);
    table.text("source", live.source,
               {"who flies the vehicle: udp-json:29990, flightgear:5503, … (docs/feeds.md)", "none"});
    live.source_told_at = table.told_at("source");
    table.needs_one_of({"source"}, "kind \"live\" has no source; expected source = \"udp-json:29990\" or another");
    table.text("vehicle_id", live.vehicle, {"which one of the source's vehicles", "the first that it sends"});
    live.at = table.place(
        "at", {"where the vehicle stands until the source sends: latitude, longitude, height above the ellipsoid",
               "the run waits for the source"});
    table.word("clock",
               {{"realtime", ClockMode::realtime}, {"follow", ClockMode::follow}, {"lock_step", ClockMode::lock_step}},
               live.clock, "who leads: the wall clock, or the source's clock, or the source step by step");
    table.word("sea_level", {{"geoid", false}, {"ellipsoid", true}}, live.sea_is_ellipsoid,
               "what the source's heights above the sea count from");
    read_source_map(table, live);
    table.boolean("filtered", live.filtered, "places that a receiver measured (nmea, ubx, gpsd) go through a filter");
    read_source_timing(table, live);
    if (live.source.starts_with("ardupilot-json:") && !live.origin)
        places.warn(live.source +
                    ": [trajectory] has no origin; places in metres from the physics are refused, and only those with "
                    "latitude, longitude and altitude are taken: expected origin = SITL's --home");
    trajectory = live;
}

void read_vehicle_class(TableReader& table, FileSettings& file) {
    if (const auto index = table.choice("vehicle", track_vehicle_names(),
                                        {"how it stands where the rows tell no attitude", "upright"}))
        file.vehicle = static_cast<VehicleClass>(*index);
}

void read_file_track(TableReader& table, PlaceReader& places, const std::filesystem::path& folder,
                     TrajectorySettings& trajectory) {
    FileSettings file;
    file.heading_given = table.has("heading_deg");
    file.heading = read_heading(table);
    table.file_path("path", folder, file.path,
                    {"the recorded track beside the scenario's file: CSV, GPX, KML, NMEA, IGC and others", "none"});
    file.path_told_at = table.told_at("path");
    table.needs_one_of({"path"}, "kind \"file\" has no path; expected path = \"track.csv\"");
    table.word("time", {{"run", false}, {"recorded", true}}, file.keeps_time,
               "the track begins with the run, or keeps the times it was recorded at");
    table.quantity("gap_s", file.gap, {1e-3, 1e7}, "stretches without rows longer than this are gaps, and reported");
    file.origin = places.read(
        table, "origin", {"where the local metres of a track begin, and the ground of its heights above it", "none"});
    table.word("gap",
               {{"bridge", GapPolicy::bridge},
                {"hold", GapPolicy::hold},
                {"compress", GapPolicy::compress},
                {"outage", GapPolicy::outage}},
               file.gap_policy,
               "what becomes of a gap: a way across it; a stand and a jump; its time is left out; a way across it "
               "without signals");
    table.quantity("start_delay_s", file.playback.delay, {0, 1e7}, "the vehicle stands at its beginning for so long");
    table.quantity("skip_s", file.playback.skip, {0, 1e9}, "part of the track that is left out at its beginning");
    table.number("time_scale", file.playback.time_scale, {1e-3, 1e3}, "playback speed: 2 is twice as fast");
    table.word("end", {{"hold", EndOfPath::hold}, {"stop", EndOfPath::stop}, {"loop", EndOfPath::loop}},
               file.playback.end, "after the last row: the vehicle stands there, the run ends, or the track repeats");
    read_vehicle_class(table, file);
    table.word(
        "smooth", {{"none", Smoothing::none}, {"noise", Smoothing::noise}, {"sensor", Smoothing::sensor}},
        file.smoothing,
        "move the rows onto a smooth path: by the noise that they show, or as positions of a satellite receiver");
    table.quantity("speed_mps", file.route_speed, {1e-2, 12000},
                   {"along the way of a track without times", "the plan's or the vehicle's"});
    file.route_told = table.has("speed_mps") || table.has("route_tolerance_m");
    table.quantity("route_tolerance_m", file.route_tolerance, {0, 1e5},
                   "of a file without times: places this near to the way between the others are left out, and the "
                   "others passed as near");
    trajectory = file;
}

// What a kind's reader may need.
struct KindReading {
    TableReader& table;
    PlaceReader& places;
    const std::filesystem::path& folder;
    TrajectorySettings& trajectory;
};

struct TrajectoryKind {
    std::string_view name;
    void (*read)(const KindReading&);
};

constexpr std::array kinds{
    TrajectoryKind{"fixed", [](const KindReading& k) { read_fixed(k.table, k.places, k.trajectory); }},
    TrajectoryKind{"waypoints", [](const KindReading& k) { read_waypoints(k.table, k.places, k.trajectory); }},
    TrajectoryKind{"circle", [](const KindReading& k) { read_circle(k.table, k.places, k.trajectory); }},
    TrajectoryKind{"file", [](const KindReading& k) { read_file_track(k.table, k.places, k.folder, k.trajectory); }},
    TrajectoryKind{"live", [](const KindReading& k) { read_live(k.table, k.places, k.trajectory); }},
};

void read_kind(const KindReading& reading) {
    std::vector<std::string_view> names;
    for (const TrajectoryKind& kind : kinds)
        names.push_back(kind.name);
    const std::size_t others = names.size();
    const auto shapes = path_shape_names();
    // Waypoints come first of the shapes, and are one of the kinds above, too.
    names.insert(names.end(), shapes.begin() + 1, shapes.end());
    names.emplace_back("sequence");
    const auto kind = reading.table.choice("kind", names, "the shape of the way");
    reading.table.needs_one_of({"kind"},
                               fmt::format("has no kind; expected kind = \"{}\"", fmt::join(names, "\", \"")));
    if (!kind) {
        // What other keys there may be is the kind's to say.
        for (const std::string& key : reading.table.keys())
            reading.table.has_been_read(key);
        return;
    }
    if (*kind < others) return kinds[*kind].read(reading);
    if (*kind + 1 == names.size()) return read_sequence(reading.table, reading.places, reading.trajectory);
    read_generated(reading.table, reading.places, *kind - others + 1, reading.trajectory);
}

}  // namespace

std::optional<LevelFrame> read_frame(TableReader& top) {
    std::optional<LevelFrame> frame;
    top.table("frame", "where the coordinates of a game level lie on the Earth", [&](TableReader& table) {
        LevelPlacement placement;
        const auto origin = table.place("origin", "of the level: latitude, longitude, height");
        table.needs_one_of({"origin"}, "has no origin; expected origin = [latitude, longitude, height]");
        if (origin) placement.origin = *origin;
        table.degrees("yaw_deg", placement.yaw, {-360, 360}, "azimuth of the level's X axis, clockwise from north");
        table.quantity("unit_m", placement.unit, {1e-6, 1e6}, "length of one level unit; 0.01 for centimetres");
        table.boolean("left_handed", placement.left_handed, "true: Y points to the right of X");
        table.quantity("reach_m", placement.reach, NumberRange::positive(),
                       "a warning names points further from the origin, where a plane leaves the curved Earth");
        frame.emplace(placement);
    });
    return frame;
}

std::optional<TrajectorySettings> read_trajectory_keys(TableReader& parent, KeyText text,
                                                       const TrajectoryContext& context,
                                                       std::vector<std::string>& warnings) {
    std::optional<TrajectorySettings> trajectory;
    PlaceReader places(context.level, warnings);
    parent.table("trajectory", text, [&](TableReader& table) {
        trajectory.emplace();
        const std::size_t before = table.mistake_count();
        read_kind({table, places, context.folder, *trajectory});
        // What is left of a way with mistakes may be none: other mistakes are looked for at a place.
        if (table.mistake_count() > before) trajectory.reset();
    });
    return trajectory;
}

std::optional<Geodetic> PlaceReader::read(TableReader& table, const std::string& key, KeyText text) {
    const std::string level_key = key + "_level";
    const std::string meaning = fmt::format("{}: latitude, longitude, height above the ellipsoid", text.meaning);
    const auto on_earth = table.place(key, {meaning, text.standard});
    const std::string in_frame = fmt::format("the same in the coordinates of [frame], instead of `{}`: x, y, z", key);
    const auto in_level = table.numbers(level_key, 3, {in_frame, "none"});
    table.not_both(key, level_key);
    if (!in_level) return on_earth;
    if (!level_) {
        table.mistake(level_key, "needs a [frame] that says where the level lies");
        return std::nullopt;
    }
    const Position<Level> point((*in_level)[0], (*in_level)[1], (*in_level)[2]);
    const Geodetic place = to_geodetic(level_->to_ecef(point));
    const auto checked =
        place_from_degrees(place.latitude.deg(), place.longitude.deg(), place.height.above_ellipsoid.value());
    if (!checked) {
        table.mistake(level_key, checked.error());
        return std::nullopt;
    }
    if (level_->beyond_reach(point)) warn_beyond_reach(point);
    return place;
}

void PlaceReader::warn_beyond_reach(const Position<Level>& point) {
    const LevelPlacement& placement = level_->placement();
    warnings_.push_back(
        fmt::format("level point ({:g}, {:g}, {:g}) lies {:.0f} m from the frame's origin; beyond {:.0f} m a plane "
                    "leaves the curved "
                    "Earth (by {:.1f} m there): anchor the frame nearer",
                    point.vector().x(), point.vector().y(), point.vector().z(),
                    point.vector().head<2>().norm() * placement.unit.value(), placement.reach.value(),
                    point.vector().head<2>().squaredNorm() * std::pow(placement.unit.value(), 2) / (2 * 6371e3)));
}

std::optional<Geodetic> PlaceReader::read_needed(TableReader& table, const std::string& key, KeyText text) {
    const auto place = read(table, key, text);
    const std::string level_key = key + "_level";
    table.needs_one_of({key, level_key},
                       fmt::format("has no {}; expected {} = [latitude, longitude, height]", text.meaning, key));
    return place;
}

Angle read_heading(TableReader& table) {
    Angle heading;
    table.degrees("heading_deg", heading, {-360, 360},
                  "where the vehicle looks until it moves, clockwise from north; then it looks where it goes");
    return heading;
}

void read_waypoint_motion(TableReader& row, Waypoint& corner) {
    row.quantity("speed_mps", corner.speed, {1e-3, 12000},
                 {"from here to the next corner", "the last one given, at first 10"});
    row.quantity("hold_s", corner.hold, {0, 1e7}, "stop here before leaving");
}

void read_waypoint_tables(TableReader& table, const std::function<void(TableReader&)>& read_corner) {
    constexpr std::size_t fewest_corners = 2;
    std::size_t corners = 0;
    const auto read_and_count = [&](TableReader& row) { ++corners, read_corner(row); };
    table.tables("waypoint", "the corners of the way, at least two", read_and_count, fewest_corners);
    if (corners < fewest_corners)
        table.mistake_here(
            fmt::format("kind \"waypoints\" has {} waypoints; expected two or more [[trajectory.waypoint]]", corners));
}

}  // namespace skyloop::inline run
