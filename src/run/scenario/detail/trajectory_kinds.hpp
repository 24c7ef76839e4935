// The parts of [trajectory]: one function for each group of kinds.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "motion/trajectory/shaped_path.hpp"
#include "scenario_keys.hpp"

namespace skyloop::inline run {

// Reads places that may be given on the Earth or in the coordinates of a game level.
class PlaceReader {
public:
    PlaceReader(const std::optional<LevelFrame>& level, std::vector<std::string>& warnings)
        : level_(level), warnings_(warnings) {}

    // `key` = [lat, lon, height], or `key`_level = [x, y, z].
    std::optional<Geodetic> read(TableReader& table, const std::string& key, KeyText text);
    // The same; neither is a mistake. @param text "place": what the table then has not
    std::optional<Geodetic> read_needed(TableReader& table, const std::string& key, KeyText text);
    void warn(std::string sentence) { warnings_.push_back(std::move(sentence)); }

private:
    void warn_beyond_reach(const Position<Level>& point);

    const std::optional<LevelFrame>& level_;
    std::vector<std::string>& warnings_;
};

// heading_deg: of the vehicle until it moves.
Angle read_heading(TableReader& table);

// East and north of the plane's origin and height, m; nothing, and a mistake of the key, when that is too far away.
std::optional<Eigen::Vector3d> on_plane(TableReader& table, const GeodesicPlane& plane, std::string_view key,
                                        const Geodetic& place);

// Reads the places of a generated path onto one plane, whose origin is the first of them.
class PlaneReader {
public:
    explicit PlaneReader(PlaceReader& places) : places_(places) {}
    // As PlaceReader::read_needed(); east and north of the origin and height, m.
    std::optional<Eigen::Vector3d> read(TableReader& table, const std::string& key, std::string_view meaning);
    // Nothing before the first place.
    [[nodiscard]] const std::optional<GeodesicPlane>& plane() const { return plane_; }

private:
    PlaceReader& places_;
    std::optional<GeodesicPlane> plane_;
};

// A group of keys of one generated path.
struct ShapeReading {
    TableReader& table;
    PlaneReader& places;
    VehicleLimits& vehicle;  // in: the one that stands for an absent key
    Angle heading;
    bool whole = true;  // no place is missing
};

// The words of `kind` of generated paths, those that can be steps of another.
std::span<const std::string_view> path_shape_names();
// Reads the keys of one of them. Nothing when a place is missing.
std::optional<PathWish> read_path_shape(std::size_t kind, ShapeReading reading);
// Whether its path has dice, and so a seed.
bool has_dice(std::size_t kind);

// speed_mps; vehicle, and what it can do: only the keys of moving along a way
void read_speed_and_vehicle(TableReader& table, VehicleLimits& vehicle);

// A whole path of one kind, and "sequence".
void read_generated(TableReader& table, PlaceReader& places, std::size_t kind, TrajectorySettings& trajectory);
void read_sequence(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory);

// loop and start_delay_s; then plans the path, and a path that there is not is a mistake of the table.
void finish_generated(TableReader& table, GeneratedPath path, Angle heading, TrajectorySettings& trajectory);

// speed_mps and hold_s of a corner whose place has been read
void read_waypoint_motion(TableReader& row, Waypoint& corner);
// Every [[waypoint]], two at least.
void read_waypoint_tables(TableReader& table, const std::function<void(TableReader&)>& read_corner);
void read_waypoints(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory);

}  // namespace skyloop::inline run
