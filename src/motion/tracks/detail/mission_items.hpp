// Missions of autopilots: items of MAVLink, whatever file they stand in, and the route that they make.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "track_formats.hpp"

namespace skyloop::inline motion {

// One item (MAVLink common.xml, MISSION_ITEM and MAV_CMD).
struct MissionItem {
    std::size_t number = 0;  // in the file, for messages
    int command = 0;         // MAV_CMD
    int frame = 0;           // MAV_FRAME
    // Of places the fifth is the latitude, the sixth the longitude, degrees, the seventh the height, m. Nothing: the
    // file leaves it open.
    std::array<std::optional<double>, 7> parameters{};
};

// Where the vehicle starts from.
struct MissionHome {
    double latitude_deg = 0, longitude_deg = 0, sea_level_m = 0;
};

// What a file says besides its items.
struct Mission {
    std::string format;  // for people
    std::optional<MissionHome> home{};
    std::optional<VehicleClass> vehicle{};
    std::optional<double> speed_mps{};
    std::vector<MissionItem> items{};
    std::vector<std::string> notes{};
};

// The route of a mission: take-off from home, waypoints, circles, stops, changes of speed, the way home, landings. What
// moves nothing is passed over; commands that are not followed are told. Heights are those of the frames: above the
// sea, or above home, whose height an origin tells where the file does not.
// Fails with `input` for heights above the terrain and places in frames of the vehicle's own, for numbers that cannot
// be, and where no place is left.
Result<Track> track_of_mission(const TrackFile& file, const Mission& mission);

// The vehicle of a MAV_TYPE; nothing for others.
std::optional<VehicleClass> vehicle_of_mav_type(int type);

// One that takes off as a multirotor and cruises as a plane.
bool is_vtol_mav_type(int type);

}  // namespace skyloop::inline motion
