#include "detail/trajectory_kinds.hpp"

#include <array>

namespace skyloop {
namespace {

void read_vehicle_class(TableReader& table, FileSettings& file) {
    if (const auto index = table.choice("vehicle", track_vehicle_names(),
                                        {"how it stands where the rows tell no attitude", "upright"}))
        file.vehicle = static_cast<VehicleClass>(*index);
}

}  // namespace

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

}  // namespace skyloop
