#include "detail/trajectory_kinds.hpp"

#include <array>
#include <string_view>

namespace skyloop {

void read_live(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    static constexpr std::array<std::string_view, 5> maps{"source", "tangent", "ardupilot_flat", "px4_azimuthal",
                                                          "airsim_sphere"};
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
    live.origin = table.place(
        "origin",
        {"where the local metres of a source begin: latitude, longitude, height above the ellipsoid", "none"});
    if (const auto map =
            table
                .choice("local_map", maps,
                        "how a source's local metres lie on the Earth: as it means them, or by another's map", maps[0])
                .value_or(0);
        map > 0)
        live.local_map = local_map_of_name(maps.at(map));
    table.boolean("filtered", live.filtered, "places that a receiver measured (nmea, ubx, gpsd) go through a filter");
    table.number("source_rate_hz", live.rate_hz, {0.1, 1000}, "asked of sources that can be asked");
    table.quantity("delay_s", live.delay, {0, 10}, "the path is this much late, so that slow sources are interpolated");
    table.quantity("lost_after_s", live.lost_after, {0.1, 1e7}, "silence of the source after which it is lost");
    table.word("when_lost",
               {{"hold", LostSource::hold},
                {"outage", LostSource::outage},
                {"pause", LostSource::pause},
                {"stop", LostSource::stop}},
               live.when_lost, "what then becomes of the run");
    if (live.source.starts_with("ardupilot-json:") && !live.origin)
        places.warn(live.source +
                    ": [trajectory] has no origin; places in metres from the physics are refused, and only those with "
                    "latitude, longitude and altitude are taken: expected origin = SITL's --home");
    trajectory = live;
}

}  // namespace skyloop
