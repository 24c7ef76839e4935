#include "trajectory_listing.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace skyloop::host {
namespace {

using Json = nlohmann::ordered_json;

// A number and when it was so.
std::string when_text(const PathExtreme& extreme, std::string_view unit) {
    return fmt::format("{:.2f} {} at {:.2f} s", extreme.value, unit, extreme.at_s);
}

Json when_json(const PathExtreme& extreme) { return {{"value", extreme.value}, {"at_s", extreme.at_s}}; }

std::string limit_text(const ExceededLimit& limit) {
    return fmt::format("{} of {}: {} {} at {:.2f} s, limit {} {}", limit.what, limit.of,
                       fmt::format("{:.2f}", limit.found.value), limit.unit, limit.found.at_s,
                       fmt::format("{:g}", std::round(limit.limit * 100) / 100), limit.unit);
}

constexpr double degrees_per_radian = 57.295779513082321;

}  // namespace

std::string trajectory_text(const TrajectoryListing& listing) {
    const PathSurvey& s = listing.survey;
    std::string text;
    const auto line = [&](std::string_view name, const std::string& value) {
        fmt::format_to(std::back_inserter(text), "{:<13}{}\n", name, value);
    };
    line("path", listing.description.empty() ? fmt::format("{}, {}", listing.name, listing.kind) : listing.description);
    for (const std::string& detail : listing.details)
        line("", detail);
    line("duration", fmt::format("{:.3f} s", s.duration_s));
    line("extent", fmt::format("{:.1f} m east-west, {:.1f} m north-south, {:.1f} m up", s.east_west_m, s.north_south_m,
                               s.highest.value - s.lowest.value));
    const LongitudeSpan longitudes = longitude_span(s);
    line("", fmt::format("latitude {:.7f} to {:.7f}, longitude {:.7f} to {:.7f}", s.south_west.latitude.deg(),
                         s.north_east.latitude.deg(), longitudes.west_deg, longitudes.east_deg));
    line("length", fmt::format("{:.1f} m", s.length_m));
    line("height", fmt::format("{} to {}, above the ellipsoid", when_text(s.lowest, "m"), when_text(s.highest, "m")));
    line("speed", when_text(s.fastest, "m/s"));
    line("", "over ground " + when_text(s.fastest_over_ground, "m/s"));
    line("climb", when_text(s.climb, "m/s"));
    line("descent", when_text(s.descent, "m/s"));
    line("acceleration", when_text(s.acceleration, "m/s²"));
    line("jerk", when_text(s.jerk, "m/s³"));
    if (s.has_orientation)
        line("turn rate", when_text({s.turn_rate.value * degrees_per_radian, s.turn_rate.at_s}, "°/s"));
    if (s.velocity_steps > 0)
        line("steps", fmt::format("{} of the velocity in no time, the largest {}", s.velocity_steps,
                                  when_text(s.largest_step, "m/s")));
    if (s.jumps > 0) line("jumps", fmt::format("{}, the largest {}", s.jumps, when_text(s.largest_jump, "m")));
    line("limits", listing.exceeded.empty()
                       ? fmt::format("kept: receiver (4 g, 50 000 m, 500 m/s), COCOM (18 288 m, 515 m/s){}",
                                     listing.vehicle.empty() ? "" : ", " + listing.vehicle)
                       : fmt::format("{} exceeded", listing.exceeded.size()));
    for (const ExceededLimit& limit : listing.exceeded)
        line("", limit_text(limit));
    for (const std::string& note : listing.notes)
        line("note", note);
    return text;
}

std::string trajectory_json(const TrajectoryListing& listing) {
    const PathSurvey& s = listing.survey;
    Json json{{"file", listing.name}, {"kind", listing.kind}, {"description", listing.description}};
    json["details"] = listing.details;
    json["duration_s"] = s.duration_s;
    const LongitudeSpan longitudes = longitude_span(s);
    json["extent"] = {{"south_deg", s.south_west.latitude.deg()},
                      {"north_deg", s.north_east.latitude.deg()},
                      {"west_deg", longitudes.west_deg},
                      {"east_deg", longitudes.east_deg},
                      {"east_west_m", s.east_west_m},
                      {"north_south_m", s.north_south_m}};
    json["length_m"] = s.length_m;
    for (const auto& [name, extreme] : {std::pair{"lowest_m", &s.lowest},
                                        {"highest_m", &s.highest},
                                        {"speed_mps", &s.fastest},
                                        {"speed_over_ground_mps", &s.fastest_over_ground},
                                        {"climb_mps", &s.climb},
                                        {"descent_mps", &s.descent},
                                        {"acceleration_mps2", &s.acceleration},
                                        {"jerk_mps3", &s.jerk}})
        json[name] = when_json(*extreme);
    if (s.has_orientation)
        json["turn_rate_dps"] = when_json({s.turn_rate.value * degrees_per_radian, s.turn_rate.at_s});
    json["velocity_steps"] = {{"count", s.velocity_steps}, {"largest_mps", when_json(s.largest_step)}};
    json["jumps"] = {{"count", s.jumps}, {"largest_m", when_json(s.largest_jump)}};
    json["exceeded"] = Json::array();
    for (const ExceededLimit& limit : listing.exceeded)
        json["exceeded"].push_back({{"of", limit.of},
                                    {"what", limit.what},
                                    {"unit", limit.unit},
                                    {"limit", limit.limit},
                                    {"value", limit.found.value},
                                    {"at_s", limit.found.at_s}});
    json["notes"] = listing.notes;
    // Names of files may hold what is no UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace skyloop::host
