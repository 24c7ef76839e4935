#include "run/output/epoch_messages.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/core/json.hpp"
#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/output_only/other_protocols.hpp"
#include "run/output/rtcm_writer.hpp"

namespace skyloop::inline run {
namespace {

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

// As the receiver believes.
std::string believed_utc_text(GpsTime time, const LeapSeconds& leap_seconds) {
    return format_utc(to_utc(time, leap_seconds), 3);
}

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
              {"time_utc", believed_utc_text(fix.time, report.leap_seconds)},
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
            {"line_of_sight", satellite.in_sight()},
            {"state", reception_names.at(static_cast<std::size_t>(satellite.state))},
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
              {"time_utc", utc_text(time, 3)},
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
    return json_text(json) + "\n";
}

namespace {

constexpr std::uint8_t fix_type_3d = 3;

void put_accuracy(const Fix& fix, HilGpsAccuracy accuracy, MavlinkHilGps& to) {
    if (accuracy == HilGpsAccuracy::px4_cm) {
        to.eph.set(fix.horizontal_accuracy.value());
        to.epv.set(fix.vertical_accuracy.value());
        return;
    }
    if (fix.dop.hdop > 0) to.eph.set(fix.dop.hdop);
    if (fix.dop.vdop > 0) to.epv.set(fix.dop.vdop);
}

}  // namespace

MavlinkHilGps mavlink_hil_gps(const firmware::NavigationState& state, HilGpsAccuracy accuracy) {
    const MavlinkGpsInput known = firmware::mavlink_gps_input(state);
    const Fix& fix = state.epoch.fix;
    MavlinkHilGps message;
    message.time_usec = known.time_usec;
    message.fix_type = std::min(known.fix_type.raw, fix_type_3d);
    message.satellites_visible = known.satellites_visible;
    message.lat = known.lat;
    message.lon = known.lon;
    if (firmware::has_place(state)) message.alt.set(firmware::msl_height(fix));
    if (!firmware::has_solution(state)) return message;
    put_accuracy(fix, accuracy, message);
    message.vel.set(fix.speed.value());
    message.vn.set(fix.velocity.north);
    message.ve.set(fix.velocity.east);
    message.vd.set(fix.velocity.down);
    constexpr std::uint16_t full_turn = 36000;
    if (state.course) {
        message.cog.set(state.course->deg());
        message.cog = message.cog % full_turn;
    }
    message.yaw = known.yaw;
    return message;
}

namespace {

constexpr Nanoseconds heartbeat_every = std::chrono::seconds(1);

EpochJob json_job(const EpochSeen& seen, const std::string& receiver, std::uint64_t number) {
    return [record = record_epoch(seen, receiver, number)] { return std::vector<Bytes>{to_bytes(epoch_line(record))}; };
}

EpochJob msp_job(const EpochSeen& seen, std::uint8_t instance) {
    if (!seen.leaves) return [] { return std::vector<Bytes>{}; };
    MspSensorGps message = firmware::msp_sensor_gps(seen.reported);
    message.instance = instance;
    return [message] { return std::vector<Bytes>{encode_msp(message)}; };
}

// A component of MAVLink: its messages are numbered in the order of sending, and each second begins with a heartbeat.
class MavlinkWriter {
public:
    explicit MavlinkWriter(const OutputSettings& settings) : settings_(settings) {
        source_.system = settings.system;
        source_.component = settings.component;
    }

    EpochJob note(const EpochSeen& seen) {
        if (!seen.leaves) return [this, now = seen.now] { return beat(now); };
        if (settings_.format == OutputFormat::gps_input) {
            MavlinkGpsInput message = firmware::mavlink_gps_input(seen.reported);
            message.gps_id = settings_.id;
            return [this, now = seen.now, message] { return told(now, message); };
        }
        MavlinkHilGps message = mavlink_hil_gps(seen.reported, settings_.eph);
        message.id = settings_.id;
        return [this, now = seen.now, message] { return told(now, message); };
    }

private:
    std::vector<Bytes> beat(GpsTime now) {
        if (beat_at_ && now < *beat_at_ + heartbeat_every) return {};
        beat_at_ = now;
        return {numbered(MavlinkHeartbeat{})};
    }
    template <class Message>
    std::vector<Bytes> told(GpsTime now, const Message& message) {
        std::vector<Bytes> frames = beat(now);
        frames.push_back(numbered(message));
        return frames;
    }
    template <class Message>
    Bytes numbered(const Message& message) {
        Bytes frame = encode_mavlink(source_, message);
        ++source_.sequence;
        return frame;
    }

    OutputSettings settings_;
    MavlinkSource source_;
    std::optional<GpsTime> beat_at_;
};

}  // namespace

EpochWriter make_epoch_writer(const OutputSettings& settings, const WriterSources& sources) {
    switch (settings.format) {
        case OutputFormat::json:
            return json_job;
        case OutputFormat::msp:
            return [id = settings.id](const EpochSeen& seen, const std::string&, std::uint64_t) {
                return msp_job(seen, id);
            };
        case OutputFormat::rtcm:
            return make_rtcm_writer(settings, sources);
        default:
            break;
    }
    return [writer = std::make_shared<MavlinkWriter>(settings)](const EpochSeen& seen, const std::string&,
                                                                std::uint64_t) { return writer->note(seen); };
}

}  // namespace skyloop::inline run
