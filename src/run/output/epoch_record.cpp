#include "run/output/epoch_record.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "firmware/messages/reported_fix.hpp"

namespace skyloop {
namespace {

using Json = nlohmann::ordered_json;

// A tenth of a millimetre of place and way, and what is finer than any receiver's own of the rest: more digits would
// only make the lines longer.
constexpr double per_degree_of_place = 1e9, per_metre = 1e4, per_degree = 1e4, per_decibel = 1e2, per_dop = 1e3;

// JSON has no number for what is not finite.
Json rounded(double value, double parts) {
    // Zero is added for the sign of a zero.
    return std::isfinite(value) ? Json(std::round(value * parts) / parts + 0.0) : Json(nullptr);
}

// Divided, unlike multiplied, gives the number whose shortest text is the one that is meant: 18.4.
double decimal_seconds(Nanoseconds span) { return static_cast<double>(span.count()) / 1e9; }

template <class T, class Make>
Json if_known(const std::optional<T>& value, Make make) {
    return value ? Json(make(*value)) : Json(nullptr);
}

Json utc_text(GpsTime time, const LeapSeconds& leap_seconds) { return format_utc(to_utc(time, leap_seconds), 3); }

void add_place(Json& to, const Geodetic& place) {
    to["lat_deg"] = rounded(place.latitude.deg(), per_degree_of_place);
    to["lon_deg"] = rounded(place.longitude.deg(), per_degree_of_place);
    to["height_m"] = rounded(place.height.above_ellipsoid.value(), per_metre);
}

Json velocity_json(const VelocityNed& velocity) {
    return {{"north", rounded(velocity.north, per_metre)},
            {"east", rounded(velocity.east, per_metre)},
            {"down", rounded(velocity.down, per_metre)}};
}

Json attitude_json(const Orientation& orientation) {
    const Attitude& attitude = orientation.attitude;
    const Eigen::Quaterniond& q = attitude.body_to_ned();
    constexpr double parts = 1e7;
    return {{"roll_deg", rounded(attitude.roll().deg(), per_degree)},
            {"pitch_deg", rounded(attitude.pitch().deg(), per_degree)},
            {"yaw_deg", rounded(attitude.yaw().deg(), per_degree)},
            {"q", {rounded(q.w(), parts), rounded(q.x(), parts), rounded(q.y(), parts), rounded(q.z(), parts)}}};
}

Json truth_json(const TruthState& truth) {
    const Eigen::Vector3d enu = LocalFrame(truth.geodetic).to_enu(truth.velocity).vector();
    Json json;
    add_place(json, truth.geodetic);
    json["velocity_mps"] = velocity_json({enu.y(), enu.x(), -enu.z()});
    json["attitude"] = if_known(truth.orientation, attitude_json);
    return json;
}

// What only a position gives; without one the keys are there and null.
void add_solution(Json& json, const EpochRecord::Report& report) {
    const Fix& fix = report.fix;
    add_place(json, fix.position);
    json["msl_m"] =
        rounded(above_sea_level(fix.position.height, fix.geoid_undulation).above_sea_level.value(), per_metre);
    json["velocity_mps"] = velocity_json(fix.velocity);
    json["speed_mps"] = rounded(fix.speed.value(), per_metre);
    json["course_deg"] = if_known(report.course, [](Angle course) { return rounded(course.deg(), per_degree); });
    json["h_acc_m"] = rounded(fix.horizontal_accuracy.value(), per_metre);
    json["v_acc_m"] = rounded(fix.vertical_accuracy.value(), per_metre);
    json["speed_acc_mps"] = rounded(fix.speed_accuracy.value(), per_metre);
    json["dop"] = {{"g", rounded(fix.dop.gdop, per_dop)},
                   {"p", rounded(fix.dop.pdop, per_dop)},
                   {"h", rounded(fix.dop.hdop, per_dop)},
                   {"v", rounded(fix.dop.vdop, per_dop)},
                   {"t", rounded(fix.dop.tdop, per_dop)}};
}

Json fix_json(const EpochRecord::Report& report) {
    const Fix& fix = report.fix;
    Json json{{"type", fix_type_name(fix.type)},
              {"ok", report.fix_ok},
              {"time_utc", utc_text(fix.time, report.leap_seconds)},
              {"leap_seconds", fix.leap_seconds},
              {"satellites_used", report.satellites_used},
              {"jamming_state", report.jamming_state},
              {"spoofing", report.spoofing}};
    if (fix.has_position())
        add_solution(json, report);
    else
        for (const char* key : {"lat_deg", "lon_deg", "height_m", "msl_m", "velocity_mps", "speed_mps", "course_deg",
                                "h_acc_m", "v_acc_m", "speed_acc_mps", "dop"})
            json[key] = nullptr;
    return json;
}

Json fix_error_json(const EpochRecord& record) {
    if (!record.report || !record.report->fix.has_position()) return nullptr;
    const EnuError error = enu_error(record.truth, record.report->fix);
    return {{"east_m", rounded(error.east.value(), per_metre)},
            {"north_m", rounded(error.north.value(), per_metre)},
            {"up_m", rounded(error.up.value(), per_metre)}};
}

Json satellite_line(const SatelliteSeen& satellite) {
    Json cn0 = Json::object();
    for (const auto& [signal, value] : satellite.signals)
        cn0[std::string(rinex_signal_code(satellite.id.constellation, signal).value_or("?"))] =
            rounded(value.value(), per_decibel);
    return {{"id", to_string(satellite.id)},
            {"az_deg", rounded(satellite.azimuth.deg(), per_degree)},
            {"el_deg", rounded(satellite.elevation.deg(), per_degree)},
            {"cn0_dbhz", std::move(cn0)},
            {"used", satellite.used},
            {"healthy", satellite.healthy},
            {"line_of_sight", satellite.line_of_sight},
            {"paths", satellite.paths}};
}

}  // namespace

EpochRecord record_epoch(const EpochSeen& seen, std::string receiver, std::uint64_t number) {
    EpochRecord record;
    record.receiver = std::move(receiver);
    record.number = number;
    record.truth = seen.trace.truth;
    record.leaves = seen.leaves;
    record.satellites = satellites_seen(seen);
    if (!seen.leaves) {
        for (SatelliteSeen& satellite : record.satellites)
            satellite.used = false;  // in a solution that nobody is told
        return record;
    }
    const firmware::NavigationState& state = seen.reported;
    record.report = EpochRecord::Report{};
    EpochRecord::Report& report = *record.report;
    report.fix = state.epoch.fix;
    report.satellites_used = report.fix.satellites_used();
    report.fix.satellites.clear();
    report.fix_ok = state.fix_ok;
    report.course = state.course;
    report.leap_seconds = firmware::reported_leap_seconds(state);
    report.jamming_state = state.monitors.told_jamming_state();
    report.spoofing = static_cast<int>(state.monitors.spoofing);
    return record;
}

std::string epoch_line(const EpochRecord& record) {
    const GpsTime time = record.truth.time;
    const WeekAndTow stamp = week_and_tow(time);
    Json json{{"schema", "skyloop-epoch/1"},
              {"receiver", record.receiver},
              {"epoch", record.number},
              {"time_utc", utc_text(time, LeapSeconds::announced())},
              {"gps_week", stamp.week},
              {"tow_s", decimal_seconds(stamp.tow)},
              {"truth", truth_json(record.truth)},
              {"latency_s", if_known(record.leaves, [&](GpsTime at) { return decimal_seconds(at - time); })},
              {"fix", if_known(record.report, fix_json)},
              {"error", fix_error_json(record)}};
    Json satellites = Json::array();
    for (const SatelliteSeen& satellite : record.satellites)
        satellites.push_back(satellite_line(satellite));
    json["satellites"] = std::move(satellites);
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace skyloop
