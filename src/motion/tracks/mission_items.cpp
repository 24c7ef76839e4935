#include "detail/mission_items.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace skyloop::inline motion {
namespace {

// What a command does to the way of the vehicle.
enum class MissionMove { waypoint, circles, loiter_time, for_ever, home, land, take_off, delay, speed };

struct MissionCommand {
    int number;
    MissionMove move;
};

// MAV_CMD of MAVLink's common.xml.
constexpr auto mission_commands = std::to_array<MissionCommand>({
    {16, MissionMove::waypoint},     // NAV_WAYPOINT
    {17, MissionMove::for_ever},     // NAV_LOITER_UNLIM
    {18, MissionMove::circles},      // NAV_LOITER_TURNS
    {19, MissionMove::loiter_time},  // NAV_LOITER_TIME
    {20, MissionMove::home},         // NAV_RETURN_TO_LAUNCH
    {21, MissionMove::land},         // NAV_LAND
    {22, MissionMove::take_off},     // NAV_TAKEOFF
    {31, MissionMove::waypoint},     // NAV_LOITER_TO_ALT
    {82, MissionMove::waypoint},     // NAV_SPLINE_WAYPOINT
    {84, MissionMove::take_off},     // NAV_VTOL_TAKEOFF
    {85, MissionMove::land},         // NAV_VTOL_LAND
    {93, MissionMove::delay},        // NAV_DELAY
    {178, MissionMove::speed},       // DO_CHANGE_SPEED
});

// Those that move nothing: 112 and 114 delay only what moves nothing, 181 to 184 are of relays and servos, 189 marks
// where landing begins, 211 is of grippers, 1000 of gimbals, all others of cameras and their mounts.
constexpr std::array commands_without_move{112, 114, 181, 182, 183, 184, 189,  200,  202,  203,  204, 205,
                                           206, 211, 214, 530, 531, 532, 1000, 2000, 2001, 2500, 2501};

// Heights of MAV_FRAME.
enum class MissionHeight { sea_level, home, terrain, elsewhere };

MissionHeight height_of_frame(int frame) {
    switch (frame) {
        case 0:  // GLOBAL
        case 5:  // GLOBAL_INT
            return MissionHeight::sea_level;
        case 3:  // GLOBAL_RELATIVE_ALT
        case 6:  // GLOBAL_RELATIVE_ALT_INT
            return MissionHeight::home;
        case 10:  // GLOBAL_TERRAIN_ALT
        case 11:  // GLOBAL_TERRAIN_ALT_INT
            return MissionHeight::terrain;
        default:
            return MissionHeight::elsewhere;
    }
}

constexpr double usual_radius_m = 60;  // of circles whose radius is left to the autopilot: ArduPilot's WP_LOITER_RAD

class MissionTrack {
public:
    MissionTrack(const TrackFile& file, const Mission& mission) : file_(file), mission_(mission) {}
    Result<Track> make();

private:
    struct Place {
        double latitude_deg = 0, longitude_deg = 0, height_m = 0;  // above the ellipsoid
    };
    [[nodiscard]] tl::unexpected<Error> refusal(const MissionItem& item, const std::string& what) const;
    Result<void> find_home();
    Result<void> follow(const MissionItem& item);
    Result<void> move(MissionMove how, const MissionItem& item);
    Result<Place> place_of(const MissionItem& item) const;
    Result<double> height_of(const MissionItem& item, const Place& there) const;
    Result<double> ellipsoidal(double sea_level_m, double latitude_deg, double longitude_deg) const;
    Result<double> number_of(const MissionItem& item, std::size_t parameter, double most) const;
    Result<void> take_off(const MissionItem& item);
    Result<void> circle(const MissionItem& item, RouteStop stop);
    void fly_home();
    void land(const Place& there);
    void change_speed(double speed_mps);
    void add(const Place& place, const RouteStop& stop = {});
    void add_notes();

    const TrackFile& file_;
    const Mission& mission_;
    Track track_;
    RouteOrder route_;
    std::optional<Place> home_, now_;
    std::optional<double> ground_m_, next_speed_mps_;
    std::map<int, std::size_t> not_followed_;
    std::size_t item_ = 0, without_radius_ = 0, never_reached_ = 0;
    bool for_ever_ = false;
};

tl::unexpected<Error> MissionTrack::refusal(const MissionItem& item, const std::string& what) const {
    return fail(ErrorCode::input,
                fmt::format("{}: item {} (command {}): {}", file_.name, item.number, item.command, what));
}

Result<double> MissionTrack::ellipsoidal(double sea_level_m, double latitude_deg, double longitude_deg) const {
    if (const auto place = place_from_degrees(latitude_deg, longitude_deg, sea_level_m); !place)
        return fail(ErrorCode::input, place.error());
    if (!file_.reading.geoid)
        return fail(ErrorCode::input, "heights above sea level need the geoid, whose grid is not there");
    return sea_level_m +
           file_.reading.geoid->undulation(Angle::degrees(latitude_deg), Angle::degrees(longitude_deg)).value();
}

// An origin stands for a home that the file does not tell.
Result<void> MissionTrack::find_home() {
    if (const auto& origin = file_.reading.origin) ground_m_ = origin->height.above_ellipsoid.value();
    if (!mission_.home) return {};
    const MissionHome& home = *mission_.home;
    const auto height = ellipsoidal(home.sea_level_m, home.latitude_deg, home.longitude_deg);
    if (!height) return fail(ErrorCode::input, fmt::format("{}: home: {}", file_.name, height.error().message));
    ground_m_ = *height;
    home_ = Place{home.latitude_deg, home.longitude_deg, *height};
    return {};
}

Result<double> MissionTrack::height_of(const MissionItem& item, const Place& there) const {
    const MissionHeight frame = height_of_frame(item.frame);
    if (frame == MissionHeight::terrain)
        return refusal(item, fmt::format("its height is above the terrain (frame {}), which is not known; expected "
                                         "heights above home or above the sea",
                                         item.frame));
    if (frame == MissionHeight::elsewhere)
        return refusal(item, fmt::format("its place is in frame {}; expected frame 0 or 5 (above the sea), or 3 or 6 "
                                         "(above home)",
                                         item.frame));
    if (!item.parameters[6] && now_) return now_->height_m;
    const double told = item.parameters[6].value_or(0);
    if (frame == MissionHeight::sea_level) {
        const auto height = ellipsoidal(told, there.latitude_deg, there.longitude_deg);
        if (!height) return refusal(item, height.error().message);
        return height;
    }
    if (!ground_m_)
        return refusal(item,
                       "its height is above home, whose height the file does not tell; expected trajectory.origin "
                       "= [latitude, longitude, height] of home (--origin)");
    return *ground_m_ + told;
}

// Without a latitude and a longitude, or with zeros, it is where the vehicle is.
Result<MissionTrack::Place> MissionTrack::place_of(const MissionItem& item) const {
    const double latitude = item.parameters[4].value_or(0), longitude = item.parameters[5].value_or(0);
    Place there{latitude, longitude, 0};
    if (latitude == 0 && longitude == 0) {
        const auto& known = now_ ? now_ : home_;
        if (!known) return refusal(item, "it has no place; expected a latitude and a longitude");
        there = *known;
    }
    const auto height = height_of(item, there);
    if (!height) return fail(height.error());
    there.height_m = *height;
    if (const auto sound = place_from_degrees(there.latitude_deg, there.longitude_deg, there.height_m); !sound)
        return refusal(item, sound.error());
    return there;
}

// From 0; what the file leaves open is 0.
Result<double> MissionTrack::number_of(const MissionItem& item, std::size_t parameter, double most) const {
    const double value = item.parameters.at(parameter).value_or(0);
    if (value >= 0 && value <= most) return value;
    return refusal(item, fmt::format("parameter {} is {:g}; expected 0 to {:g}", parameter + 1, value, most));
}

void MissionTrack::add(const Place& place, const RouteStop& stop) {
    TrackRow row;
    row.position =
        to_ecef(Geodetic::degrees(place.latitude_deg, std::remainder(place.longitude_deg, 360), place.height_m));
    track_.points.push_back(row);
    route_.stops.push_back(stop);
    route_.stops.back().item = item_;
    if (next_speed_mps_) route_.stops.back().speed = std::exchange(next_speed_mps_, std::nullopt);
    now_ = place;
}

// From the place where the vehicle is.
void MissionTrack::change_speed(double speed_mps) {
    if (speed_mps <= 0) return;  // -1 and 0: as it was
    if (route_.stops.empty())
        next_speed_mps_ = speed_mps;
    else
        route_.stops.back().speed = speed_mps;
}

// Straight up from home, then to the place of the item.
Result<void> MissionTrack::take_off(const MissionItem& item) {
    const auto there = place_of(item);
    if (!there) return fail(there.error());
    if (!now_) {
        Place ground = home_.value_or(*there);
        ground.height_m = std::min(ground_m_.value_or(there->height_m), there->height_m);
        add(ground);
    }
    Place above = *now_;
    above.height_m = there->height_m;
    add(above);
    add(*there);
    return {};
}

Result<void> MissionTrack::circle(const MissionItem& item, RouteStop stop) {
    constexpr double widest_m = 100'000;
    const auto there = place_of(item);
    if (!there) return fail(there.error());
    stop.radius = item.parameters[2].value_or(0);
    if (!(std::abs(stop.radius) <= widest_m))
        return refusal(item, fmt::format("its radius is {:g} m; expected at most {:g}", stop.radius, widest_m));
    constexpr double least_m = 0.1;
    if (std::abs(stop.radius) < least_m) stop.radius = usual_radius_m, ++without_radius_;
    add(*there, stop);
    return {};
}

// At the height that it has, then down.
void MissionTrack::fly_home() {
    if (home_) return land(*home_);
    track_.notes.emplace_back("the way home is not flown: the file tells no home");
}

void MissionTrack::land(const Place& there) {
    Place above = there;
    if (now_) above.height_m = std::max(now_->height_m, there.height_m);
    add(above);
    add(there);
}

Result<void> MissionTrack::move(MissionMove how, const MissionItem& item) {
    constexpr double longest_s = 1e6, most_turns = 1000, fastest_mps = 12000;
    RouteStop stop;
    const bool with_time = how == MissionMove::waypoint || how == MissionMove::loiter_time || how == MissionMove::delay;
    const bool altitude_first = item.command == 31;  // NAV_LOITER_TO_ALT: its first parameter is no time
    if (with_time && !altitude_first) {
        const auto seconds = number_of(item, 0, longest_s);
        if (!seconds) return fail(seconds.error());
        stop.hold = *seconds;
    }
    if (how == MissionMove::circles) {
        const auto turns = number_of(item, 0, most_turns);
        if (!turns) return fail(turns.error());
        stop.turns = *turns;
    }
    if (how == MissionMove::circles || how == MissionMove::loiter_time) return circle(item, stop);
    if (how == MissionMove::take_off) return take_off(item);
    if (how == MissionMove::home) return fly_home(), Result<void>();
    if (how == MissionMove::delay) {
        if (!route_.stops.empty()) route_.stops.back().hold += stop.hold;
        return {};
    }
    if (how == MissionMove::speed) {
        const double speed = item.parameters[1].value_or(-1);
        if (!(speed <= fastest_mps))
            return refusal(item, fmt::format("a speed of {:g} m/s; expected at most {:g}", speed, fastest_mps));
        return change_speed(speed), Result<void>();
    }
    const auto there = place_of(item);
    if (!there) return fail(there.error());
    how == MissionMove::land ? land(*there) : add(*there, stop);
    for_ever_ = how == MissionMove::for_ever;
    return {};
}

Result<void> MissionTrack::follow(const MissionItem& item) {
    item_ = item.number;
    if (for_ever_) return ++never_reached_, Result<void>();
    if (std::find(commands_without_move.begin(), commands_without_move.end(), item.command) !=
        commands_without_move.end())
        return {};
    const auto* const known = std::find_if(mission_commands.begin(), mission_commands.end(),
                                           [&](const MissionCommand& c) { return c.number == item.command; });
    if (known == mission_commands.end()) return ++not_followed_[item.command], Result<void>();
    return move(known->move, item);
}

void MissionTrack::add_notes() {
    constexpr std::size_t most_told = 8;
    std::vector<std::string> commands;
    std::size_t items = 0;
    for (const auto& [command, count] : not_followed_) {
        items += count;
        if (commands.size() < most_told) commands.push_back(fmt::format("{}", command));
    }
    if (items > 0)
        track_.notes.push_back(fmt::format("{} items are not followed: the commands (MAV_CMD) {}{}", items,
                                           fmt::join(commands, ", "), not_followed_.size() > most_told ? ", …" : ""));
    if (without_radius_ > 0)
        track_.notes.push_back(
            fmt::format("{} circles leave their radius to the autopilot: {:g} m", without_radius_, usual_radius_m));
    if (for_ever_)
        track_.notes.push_back(fmt::format(
            "it loiters for ever at its last place, where the path ends; {} items come after it", never_reached_));
}

Result<Track> MissionTrack::make() {
    track_.name = file_.name;
    track_.format = mission_.format;
    track_.notes = mission_.notes;
    if (const auto found = find_home(); !found) return fail(found.error());
    for (const MissionItem& item : mission_.items)
        if (const auto followed = follow(item); !followed) return fail(followed.error());
    if (track_.points.empty())
        return fail(ErrorCode::input, fmt::format("{}: {} items, and no place among them; expected waypoints",
                                                  file_.name, mission_.items.size()));
    add_notes();
    route_.why = "a mission";
    route_.vehicle = mission_.vehicle;
    route_.speed = mission_.speed_mps;
    track_.route = std::move(route_);
    return std::move(track_);
}

}  // namespace

Result<Track> track_of_mission(const TrackFile& file, const Mission& mission) {
    return MissionTrack(file, mission).make();
}

std::optional<VehicleClass> vehicle_of_mav_type(int type) {
    switch (type) {
        case 1:  // FIXED_WING
            return VehicleClass::plane;
        case 2:   // QUADROTOR
        case 3:   // COAXIAL
        case 4:   // HELICOPTER
        case 13:  // HEXAROTOR
        case 14:  // OCTOROTOR
        case 15:  // TRICOPTER
        // VTOLs, which go straight up and down; the plane between cannot.
        case 19:  // VTOL_TAILSITTER_DUOROTOR
        case 20:  // VTOL_TAILSITTER_QUADROTOR
        case 21:  // VTOL_TILTROTOR
        case 22:  // VTOL_FIXEDROTOR
        case 23:  // VTOL_TAILSITTER
        case 24:  // VTOL_TILTWING
        case 25:  // VTOL_RESERVED5
            return VehicleClass::multirotor;
        case 10:  // GROUND_ROVER
            return VehicleClass::rover;
        case 11:  // SURFACE_BOAT
            return VehicleClass::boat;
        default:
            return std::nullopt;
    }
}

bool is_vtol_mav_type(int type) {
    constexpr int first = 19, last = 25;
    return type >= first && type <= last;
}

}  // namespace skyloop::inline motion
