// Keys of generated paths.
#include "detail/key_meanings.hpp"

namespace skyloop {
namespace {

constexpr KeyMeaning path_meanings[] = {
    {"trajectory", "vehicle",
     "who goes: rounds corners, speeds up, leans (docs/paths.md); waypoints without any key of a vehicle run at "
     "constant "
     "speed from corner to corner; on a track, how it stands where the rows tell no attitude",
     "car for drive, none for file, else multirotor"},
    {"trajectory", "route_tolerance_m",
     "of a file without times: places this near to the way between the others are left out, and the others passed as "
     "near"},
    {"trajectory", "acceleration_mps2", "along the way", "the vehicle's"},
    {"trajectory", "jerk_mps3", "change of the acceleration along the way", "the vehicle's"},
    {"trajectory", "lateral_mps2", "acceleration in turns", "the vehicle's"},
    {"trajectory", "bank_deg", "bank in turns, which gives lateral_mps2", "none"},
    {"trajectory", "turn_time_s", "until a turn has its full acceleration: rolling in, steering", "the vehicle's"},
    {"trajectory", "turn_radius_m", "smallest", "the vehicle's"},
    {"trajectory", "corner_m", "how far before a waypoint the turn there may begin", "the vehicle's"},
    {"trajectory", "slowest_mps", "speed on the way; what has one cannot stop there", "the vehicle's"},
    {"trajectory", "climb_mps", "largest", "the vehicle's"},
    {"trajectory", "sink_mps", "largest", "the vehicle's"},
    {"trajectory", "steepest_deg", "slope of the way", "the vehicle's"},
    {"trajectory", "loop", "the path begins anew when it has ended"},
    {"trajectory", "start_delay_s", "the vehicle stands at its beginning for so long"},
    {"trajectory", "seed", "of the path's dice", "the run's"},
    {"trajectory", "laps", "after which it comes to rest; 0: it never does"},
    {"trajectory", "anticlockwise", "seen from above"},
    {"trajectory", "climb_m", "change of height over all laps"},
    {"trajectory", "length_m", "of the straights, of the whole eight, of the lines"},
    {"trajectory", "spacing_m", "from line to line, each to the right of the one before"},
    {"trajectory", "lines", "how many"},
    {"trajectory", "sway_m", "root mean square on each horizontal axis, half of it upward"},
    {"trajectory", "wind_mps", "wind that it leans into"},
    {"trajectory", "wind_from_deg", "where the wind comes from, clockwise from north"},
    {"trajectory", "wave_height_m", "significant: four times the root mean square of the surface"},
    {"trajectory", "wave_period_s", "of the main wave"},
    {"trajectory", "wave_from_deg", "where the waves come from, clockwise from north"},
    {"trajectory", "current_mps", "that sets the boat"},
    {"trajectory", "current_to_deg", "where the current goes, clockwise from north"},
    {"trajectory", "area_m", "how far it drives from the centre, along the streets"},
    {"trajectory", "block_m", "from crossing to crossing"},
    {"trajectory", "duration_s", "about how long it drives; of another step: when the next one takes over",
     "until its end"},
    {"trajectory", "stops", "share of the crossings at which it waits 5 to 40 s"},
    {"trajectory", "preset", "a known flight, whose values the other keys change", "none"},
    {"trajectory", "boost_mps2", "thrust by mass"},
    {"trajectory", "burn_s", "of the motor"},
    {"trajectory", "drag_per_m", "at sea level: density · drag coefficient · area / (2 · mass)"},
    {"trajectory", "drogue_mps", "falling speed at sea level under the first parachute, from the top on"},
    {"trajectory", "main_mps", "the same under the second one"},
    {"trajectory", "main_below_m", "height above the pad at which the second one opens"},
    {"trajectory", "ascent_mps", "until it bursts"},
    {"trajectory", "burst_m", "height above the ellipsoid"},
    {"trajectory", "descent_mps", "falling speed at sea level under the parachute"},
    {"trajectory", "wind", "layers of wind by ascending height", "a jet of 25 m/s eastward at 11 km"},
    {"trajectory.wind", "height_m", "above the ellipsoid"},
    {"trajectory.wind", "speed_mps", "of the wind there"},
    {"trajectory.wind", "to_deg", "where it goes, clockwise from north"},
    {"trajectory", "step", "paths one after the other, joined smoothly"},
};

}  // namespace

std::span<const KeyMeaning> path_key_meanings() { return path_meanings; }

}  // namespace skyloop
