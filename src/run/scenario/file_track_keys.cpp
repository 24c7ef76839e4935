#include "detail/trajectory_kinds.hpp"

#include <array>

namespace skyloop {
namespace {

constexpr std::array<Word<GapPolicy>, 4> gap_words{{{"bridge", GapPolicy::bridge},
                                                    {"hold", GapPolicy::hold},
                                                    {"compress", GapPolicy::compress},
                                                    {"outage", GapPolicy::outage}}};
constexpr std::array<Word<EndOfPath>, 3> end_words{
    {{"hold", EndOfPath::hold}, {"stop", EndOfPath::stop}, {"loop", EndOfPath::loop}}};
constexpr std::array<Word<Smoothing>, 3> smooth_words{
    {{"none", Smoothing::none}, {"noise", Smoothing::noise}, {"sensor", Smoothing::sensor}}};

void read_vehicle_class(TableReader& table, FileSettings& file) {
    if (const auto index = table.choice("vehicle", track_vehicle_names()))
        file.vehicle = static_cast<VehicleClass>(*index);
}

}  // namespace

void read_file_track(TableReader& table, PlaceReader& places, const std::filesystem::path& folder,
                     TrajectorySettings& trajectory) {
    static constexpr std::array<std::string_view, 2> clocks{"run", "recorded"};
    FileSettings file;
    file.heading_given = table.has("heading_deg");
    file.heading = read_heading(table);
    table.file_path("path", folder, file.path);
    file.path_told_at = table.told_at("path");
    table.needs_one_of({"path"}, "kind \"file\" has no path; expected path = \"track.csv\"");
    file.keeps_time = table.choice("time", clocks, clocks[0]).value_or(0) == 1;
    table.quantity("gap_s", file.gap, {1e-3, 1e7});
    file.origin = places.read(table, "origin");
    table.word("gap", gap_words, file.gap_policy);
    table.quantity("start_delay_s", file.playback.delay, {0, 1e7});
    table.quantity("skip_s", file.playback.skip, {0, 1e9});
    table.number("time_scale", file.playback.time_scale, {1e-3, 1e3});
    table.word("end", end_words, file.playback.end);
    read_vehicle_class(table, file);
    table.word("smooth", smooth_words, file.smoothing);
    MetresPerSecond speed(12);
    table.quantity("speed_mps", speed, {1e-2, 12000});
    if (table.has("speed_mps")) file.route_speed = speed;
    file.route_told = table.has("speed_mps") || table.has("route_tolerance_m");
    table.quantity("route_tolerance_m", file.route_tolerance, {0, 1e5});
    trajectory = file;
}

}  // namespace skyloop
