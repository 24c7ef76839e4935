// Generated paths as a whole, and sequences of them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "detail/trajectory_kinds.hpp"

namespace skyloop::inline run {
namespace {

void read_seed(TableReader& table, GeneratedPath& path) {
    table.integer("seed", path.seed, {0, 9e18}, {"of the path's dice", "the run's"});
}

void read_beginning_and_end(TableReader& table, GeneratedPath& path) {
    table.boolean("loop", path.loop, "the path repeats when it has ended");
    table.quantity("start_delay_s", path.start_delay, {0, 1e7}, "the vehicle stands at its beginning for so long");
}

// The same corners for a vehicle; nothing, and a mistake, when one is too far away.
std::optional<WaypointWish> driven(TableReader& table, const WaypointSettings& corners, const GeneratedPath& path) {
    const GeodesicPlane plane(path.origin);
    WaypointWish wish;
    wish.vehicle = path.vehicle;
    wish.heading = corners.heading.rad();
    for (const Waypoint& corner : corners.corners) {
        const auto place = on_plane(table, plane, "waypoint", corner.place);
        if (!place) return std::nullopt;
        wish.waypoints.push_back({*place, corner.speed.value(), corner.hold.value()});
    }
    return wish;
}

// One [[trajectory.step]].
class StepReader {
public:
    StepReader(PlaneReader& places, GeneratedPath& path) : places_(places), path_(path) {}
    void read(TableReader& table);
    [[nodiscard]] bool whole() const { return whole_; }

private:
    PlaneReader& places_;
    GeneratedPath& path_;
    bool whole_ = true;
};

void StepReader::read(TableReader& table) {
    const auto names = path_shape_names();
    const auto kind = table.choice("kind", names, "the shape of the way");
    table.needs_one_of({"kind"}, fmt::format("has no kind; expected kind = \"{}\"", fmt::join(names, "\", \"")));
    const Angle heading = read_heading(table);
    VehicleLimits vehicle = path_.vehicle;
    GeneratedPath::Step step;
    const auto wish = kind ? read_path_shape(*kind, {table, places_, vehicle, heading}) : std::nullopt;
    constexpr std::string_view lasts_by_itself = "drive";
    if (kind && names[*kind] != lasts_by_itself)
        table.number("duration_s", step.seconds, {1e-2, 1e7}, {"when the next step takes over", "until its end"});
    whole_ = whole_ && wish;
    if (wish) step.wish = *wish;
    step.vehicle = vehicle;
    path_.steps.push_back(std::move(step));
}

}  // namespace

void finish_generated(TableReader& table, GeneratedPath path, Angle heading, TrajectorySettings& trajectory) {
    auto plan = plan_generated(path, 1);
    if (!plan) return table.mistake_here(plan.error());
    GeneratedSettings settings;
    settings.heading = heading;
    settings.shape = plan->shape;
    settings.path = std::move(path);
    trajectory = std::move(settings);
}

void read_generated(TableReader& table, PlaceReader& places, std::size_t kind, TrajectorySettings& trajectory) {
    PlaneReader plane(places);
    GeneratedPath path;
    const Angle heading = read_heading(table);
    auto wish = read_path_shape(kind, {table, plane, path.vehicle, heading});
    read_beginning_and_end(table, path);
    if (has_dice(kind)) read_seed(table, path);
    if (!wish || table.recording()) return;
    path.origin = plane.plane()->origin();
    path.steps.push_back({std::move(*wish), LocalShape::endless});
    finish_generated(table, std::move(path), heading, trajectory);
}

void read_waypoints(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    WaypointSettings way;
    way.heading = read_heading(table);
    GeneratedPath path;
    const bool has_vehicle = table.reads_any([&] { read_speed_and_vehicle(table, path.vehicle); });
    read_beginning_and_end(table, path);
    const bool moves_as_a_vehicle = has_vehicle || path.loop || path.start_delay > Seconds(0);
    bool whole = true;
    read_waypoint_tables(table, [&](TableReader& row) {
        Waypoint corner;
        if (moves_as_a_vehicle) corner.speed = MetresPerSecond(path.vehicle.along.speed);
        if (!way.corners.empty()) corner.speed = way.corners.back().speed;
        const auto at = places.read_needed(row, "at", {"place", "none"});
        whole = whole && at;
        if (at) corner.place = *at;
        read_waypoint_motion(row, corner);
        way.corners.push_back(corner);
    });
    trajectory = way;
    if (!moves_as_a_vehicle || !whole || way.corners.size() < 2 || table.recording()) return;
    path.origin = way.corners.front().place;
    auto wish = driven(table, way, path);
    if (!wish) return;
    path.steps.push_back({std::move(*wish), LocalShape::endless});
    finish_generated(table, std::move(path), way.heading, trajectory);
}

void read_sequence(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    PlaneReader plane(places);
    GeneratedPath path;
    const Angle heading = read_heading(table);
    read_speed_and_vehicle(table, path.vehicle);
    read_beginning_and_end(table, path);
    read_seed(table, path);
    StepReader steps(plane, path);
    table.tables(
        "step", "paths one after the other, joined smoothly", [&](TableReader& row) { steps.read(row); }, 1);
    if (path.steps.empty())
        table.mistake_here("kind \"sequence\" has no steps; expected one or more [[trajectory.step]]");
    if (!steps.whole() || path.steps.empty() || table.recording()) return;
    path.origin = plane.plane()->origin();
    finish_generated(table, std::move(path), heading, trajectory);
}

}  // namespace skyloop::inline run
