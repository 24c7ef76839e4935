#include "run/control/status_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/time/utc_time.hpp"
#include "detail/control_json.hpp"
#include "receiver/protocol/decoded_message.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::size_t longest_dialogue_text = 400, most_hex_bytes = 48;
constexpr std::uint64_t recent_dialogue_lines = 64;

Json utc_json(GpsTime time) { return utc_text(time, 3); }

template <class T, class Make>
Json or_null(const std::optional<T>& value, Make make) {
    return value ? Json(make(*value)) : Json(nullptr);
}

Json since(const std::optional<GpsTime>& time, GpsTime start) {
    return or_null(time, [&](GpsTime t) { return difference(t, start).value(); });
}

Json place_json(const Geodetic& place) {
    return {{"lat_deg", place.latitude.deg()},
            {"lon_deg", place.longitude.deg()},
            {"height_m", place.height.above_ellipsoid.value()}};
}

std::string signal_code(SatelliteId id, Signal signal) {
    return std::string(rinex_signal_code(id.constellation, signal).value_or("?"));
}

Json satellite_json(const SatelliteSeen& satellite) {
    Json cn0 = Json::object();
    for (const auto& [signal, value] : satellite.signals)
        cn0[signal_code(satellite.id, signal)] = value.value();
    return {{"id", to_string(satellite.id)},
            {"constellation", constellation_name(satellite.id.constellation)},
            {"az_deg", satellite.azimuth.deg()},
            {"el_deg", satellite.elevation.deg()},
            {"cn0_dbhz", std::move(cn0)},
            {"state", reception_names.at(static_cast<std::size_t>(satellite.state))},
            {"used", satellite.used},
            {"healthy", satellite.healthy},
            {"paths", satellite.paths}};
}

Json wire_json(const WireStatus& wire) {
    return {{"port", wire.port},
            {"description", wire.description},
            {"other_end", wire.other_end},
            {"baud", or_null(wire.baud, [](std::uint32_t baud) { return baud; })},
            {"connected", wire.connected},
            {"bytes_out", wire.bytes_out},
            {"bytes_in", wire.bytes_in},
            {"bytes_lost", wire.bytes_lost},
            {"bytes_unheard", wire.bytes_unheard},
            {"bytes_garbled", wire.bytes_garbled},
            {"messages_sent", wire.messages_sent},
            {"messages_dropped", wire.messages_dropped},
            {"trusted", wire.belief.empty() ? Json(nullptr) : Json(wire.trusted)},
            {"belief", wire.belief}};
}

Json fix_json(const ReceiverStatus& receiver) {
    const Fix& fix = receiver.fix;
    Json json{{"type", fix_type_name(fix.type)},
              {"ok", receiver.fix_ok},
              {"time_utc", utc_json(fix.time)},
              {"leap_seconds", fix.leap_seconds},
              {"satellites_used", receiver.satellites_used}};
    if (!fix.has_position()) return json;
    json["place"] = place_json(fix.position);
    json["speed_mps"] = fix.speed.value();
    json["course_deg"] = fix.course.deg();
    json["velocity_mps"] = {{"north", fix.velocity.north}, {"east", fix.velocity.east}, {"down", fix.velocity.down}};
    json["dop"] = {{"g", fix.dop.gdop}, {"p", fix.dop.pdop}, {"h", fix.dop.hdop}, {"v", fix.dop.vdop}};
    json["h_acc_m"] = fix.horizontal_accuracy.value();
    json["v_acc_m"] = fix.vertical_accuracy.value();
    json["speed_acc_mps"] = fix.speed_accuracy.value();
    return json;
}

Json error_json(const EnuError& error) {
    return {{"east_m", error.east.value()}, {"north_m", error.north.value()}, {"up_m", error.up.value()}};
}

Json baseline_json(const RelativePosition& vector) {
    return {{"length_m", std::hypot(vector.north_m, vector.east_m, vector.down_m)},
            {"north_m", vector.north_m},
            {"east_m", vector.east_m},
            {"down_m", vector.down_m},
            {"base_moves", vector.base_moves},
            {"ratio", vector.ratio > 0 ? Json(vector.ratio) : Json(nullptr)}};
}

Json corrections_json(const CorrectionsStatus& corrections) {
    return {{"solution", correction_words.at(static_cast<std::size_t>(corrections.solution))},
            {"age_s", corrections.age.value()},
            {"station", corrections.station},
            {"base", or_null(corrections.base, place_json)},
            {"baseline", or_null(corrections.baseline, baseline_json)}};
}

Json receiver_json(const ReceiverStatus& receiver, GpsTime start) {
    Json json{{"name", receiver.name},
              {"board", receiver.board},
              {"rate_hz", receiver.rate_hz},
              {"epochs", receiver.epochs},
              {"epoch_s", difference(receiver.epoch, start).value()},
              {"truth", place_json(receiver.truth)},
              {"true_speed_mps", receiver.true_speed.value()},
              {"fix", fix_json(receiver)},
              {"error", or_null(receiver.error, error_json)},
              {"jamming_state", receiver.jamming_state},
              {"spoofing", receiver.spoofing},
              {"interference_db", receiver.interference.value()},
              {"lateness_ms", static_cast<double>(receiver.lateness.count()) * 1e-6},
              {"satellites", json_list(receiver.satellites, satellite_json)},
              {"wires", json_list(receiver.wires, wire_json)}};
    if (receiver.corrections) json["corrections"] = corrections_json(*receiver.corrections);
    return json;
}

Json bar_json(const TimelineBar& bar, GpsTime start) {
    return {{"name", bar.name},
            {"kind", bar.kind},
            {"what", bar.command ? "command" : "fault"},
            {"receiver", bar.receiver},
            {"live", bar.live},
            {"occurrence", bar.occurrence},
            {"begins_s", since(bar.begins, start)},
            {"ends_s", since(bar.ends, start)},
            {"active", bar.active},
            {"strength", bar.strength},
            {"words", bar.words}};
}

std::string hex_text(ByteSpan bytes) {
    std::string text;
    for (const std::uint8_t byte : bytes.first(std::min(bytes.size(), most_hex_bytes)))
        text += fmt::format("{:02x}", byte);
    return bytes.size() > most_hex_bytes ? text + "…" : text;
}

// Decoded where all of it is there; long ones are cut, for the page shows a line.
std::string message_text(const DialogueLine& line) {
    if (line.kind == StreamKind::noise || line.bytes.size() < line.size) return hex_text(line.bytes);
    std::string text = text_line(decode_piece({line.kind, line.bytes}));
    if (text.size() <= longest_dialogue_text) return text;
    text.resize(longest_dialogue_text);
    return text + "…";
}

const char* speaker(bool client) { return client ? "client" : "receiver"; }

Json dialogue_json(const DialogueLine& line, GpsTime start) {
    return {{"seq", line.sequence},
            {"t_s", difference(line.time, start).value()},
            {"receiver", line.receiver},
            {"wire", line.wire},
            {"from", speaker(line.from_client)},
            {"protocol", stream_kind_name(line.kind)},
            {"name", line.name},
            {"bytes", line.size},
            {"hex", hex_text(line.bytes)},
            {"text", message_text(line)}};
}

Json message_json(const MessageCount& message) {
    return {{"receiver", message.receiver},
            {"wire", message.wire},
            {"from", speaker(message.from_client)},
            {"protocol", stream_kind_name(message.kind)},
            {"name", message.name},
            {"count", message.count}};
}

Json caster_status_json(const CasterStatus& caster) {
    return {{"address", caster.address},
            {"clients", caster.clients},
            {"served", caster.served},
            {"refused", caster.refused},
            {"dropped", caster.dropped}};
}

Json bars_json(const StatusSnapshot& snapshot) {
    return json_list(snapshot.timeline, [&](const TimelineBar& bar) { return bar_json(bar, snapshot.start); });
}

Json verdict_status_json(const VerdictStatus& verdict) {
    return {{"name", verdict.name}, {"what", verdict.what}, {"state", verdict.state}, {"detail", verdict.detail}};
}

template <class Line>
std::uint64_t last_sequence(const std::vector<std::shared_ptr<const Line>>& lines) {
    return lines.empty() ? 0 : lines.back()->sequence;
}

}  // namespace

std::string status_json(const StatusSnapshot& snapshot, const SeenLines& seen) {
    const WeekAndTow gps = week_and_tow(snapshot.time);
    Json json{{"sequence", snapshot.sequence},
              {"time_utc", utc_json(snapshot.time)},
              {"gps_week", gps.week},
              {"gps_tow_s", gps.tow_seconds()},
              {"elapsed_s", difference(snapshot.time, snapshot.start).value()},
              {"start_utc", utc_json(snapshot.start)},
              {"span_s", since(snapshot.end, snapshot.start)},
              {"title", snapshot.title},
              {"paused", snapshot.pace.paused},
              {"speed", snapshot.pace.speed},
              {"virtual_time", snapshot.pace.virtual_time}};
    Json dialogue = Json::array(), events = Json::array();
    for (const auto& line : snapshot.dialogue)
        if (line->sequence > seen.dialogue) dialogue.push_back(dialogue_json(*line, snapshot.start));
    for (const auto& line : snapshot.events)
        if (line->sequence > seen.events)
            events.push_back({{"seq", line->sequence},
                              {"t_s", difference(line->time, snapshot.start).value()},
                              {"what", line->what},
                              {"text", line->text}});
    json["receivers"] = json_list(
        snapshot.receivers, [&](const ReceiverStatus& receiver) { return receiver_json(receiver, snapshot.start); });
    json["timeline"] = bars_json(snapshot);
    json["verdicts"] = json_list(snapshot.verdicts, verdict_status_json);
    json["caster"] = or_null(snapshot.caster, caster_status_json);
    json["events"] = std::move(events);
    json["dialogue"] = std::move(dialogue);
    json["messages"] = json_list(snapshot.messages, message_json);
    return json_text(json);
}

SeenLines last_lines(const StatusSnapshot& snapshot) {
    return {last_sequence(snapshot.dialogue), last_sequence(snapshot.events)};
}

std::string recent_status_json(const StatusSnapshot& snapshot) {
    const std::uint64_t last = last_lines(snapshot).dialogue;
    return status_json(snapshot, {last > recent_dialogue_lines ? last - recent_dialogue_lines : 0, 0});
}

std::string timeline_json(const StatusSnapshot& snapshot) {
    return json_text({{"now_s", difference(snapshot.time, snapshot.start).value()},
                      {"span_s", since(snapshot.end, snapshot.start)},
                      {"entries", bars_json(snapshot)}});
}

namespace {

// Decimetres are enough for a picture, and keep the text short.
double decimetres(double metres) { return std::round(metres * 10) / 10; }

double area_from_above(const std::array<Eigen::Vector3d, 3>& corners) {
    const Eigen::Vector3d a = corners[1] - corners[0], b = corners[2] - corners[0];
    return std::abs(a.x() * b.y() - a.y() * b.x()) / 2;
}

// The largest roofs first.
std::vector<std::uint32_t> roofs_of(const UrbanScene& scene, std::size_t most) {
    std::vector<std::pair<double, std::uint32_t>> roofs;
    for (std::uint32_t i = 0; i < scene.statistics().triangles; ++i) {
        if (scene.planes()[scene.plane_of(i)].kind != SurfaceKind::roof) continue;
        const double area = area_from_above(scene.triangle(i));
        if (area > 0.01) roofs.emplace_back(-area, i);
    }
    std::sort(roofs.begin(), roofs.end());
    if (roofs.size() > most) roofs.resize(most);
    std::vector<std::uint32_t> indices;
    for (const auto& [area, index] : roofs)
        indices.push_back(index);
    return indices;
}

}  // namespace

std::string scene_json(const UrbanScene& scene, std::size_t most) {
    const Geodetic& origin = scene.frame().origin();
    Json roofs = Json::array(), trees = Json::array();
    for (const std::uint32_t index : roofs_of(scene, most)) {
        Json flat = Json::array();
        double top = -1e9;
        for (const Eigen::Vector3d& corner : scene.triangle(index)) {
            flat.push_back(decimetres(corner.x()));
            flat.push_back(decimetres(corner.y()));
            top = std::max(top, corner.z());
        }
        flat.push_back(decimetres(top));
        roofs.push_back(std::move(flat));
    }
    for (std::size_t i = 0; i < std::min(scene.foliage().size(), most); ++i) {
        Json ring = Json::array();
        for (const Eigen::Vector2d& corner : scene.foliage()[i].ring)
            ring.push_back({decimetres(corner.x()), decimetres(corner.y())});
        trees.push_back(std::move(ring));
    }
    return json_text({{"origin",
                       {{"lat_deg", origin.latitude.deg()},
                        {"lon_deg", origin.longitude.deg()},
                        {"height_m", origin.height.above_ellipsoid.value()}}},
                      {"roofs", std::move(roofs)},
                      {"trees", std::move(trees)}});
}

}  // namespace skyloop::inline run
