#include "detail/trajectory_kinds.hpp"

#include <array>
#include <string_view>

namespace skyloop {

void read_live(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    static constexpr std::array<std::string_view, 3> clocks{"realtime", "follow", "lock_step"};
    static constexpr std::array<std::string_view, 2> seas{"geoid", "ellipsoid"};
    static constexpr std::array<std::string_view, 4> ends{"hold", "outage", "pause", "stop"};
    static constexpr std::array<std::string_view, 5> maps{"source", "tangent", "ardupilot_flat", "px4_azimuthal",
                                                          "airsim_sphere"};
    LiveSettings live;
    live.heading = read_heading(table);
    table.text("source", live.source);
    live.source_told_at = table.told_at("source");
    table.needs_one_of({"source"}, "kind \"live\" has no source; expected source = \"udp-json:29990\" or another");
    table.text("vehicle_id", live.vehicle);
    live.at = table.place("at");
    live.clock = static_cast<ClockMode>(table.choice("clock", clocks, clocks[0]).value_or(0));
    live.sea_is_ellipsoid = table.choice("sea_level", seas, seas[0]).value_or(0) == 1;
    live.origin = table.place("origin");
    if (const auto map = table.choice("local_map", maps, maps[0]).value_or(0); map > 0)
        live.local_map = local_map_of_name(maps.at(map));
    table.boolean("filtered", live.filtered);
    table.number("source_rate_hz", live.rate_hz, {0.1, 1000});
    table.quantity("delay_s", live.delay, {0, 10});
    table.quantity("lost_after_s", live.lost_after, {0.1, 1e7});
    live.when_lost = static_cast<LostSource>(table.choice("when_lost", ends, ends[0]).value_or(0));
    if (live.source.starts_with("ardupilot-json:") && !live.origin)
        places.warn(live.source +
                    ": [trajectory] has no origin; places in metres from the physics are refused, and only those with "
                    "latitude, longitude and altitude are taken: expected origin = SITL's --home");
    trajectory = live;
}

}  // namespace skyloop
