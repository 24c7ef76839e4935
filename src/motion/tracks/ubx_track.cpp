#include <array>

#include "base/geo/local_frame.hpp"
#include "detail/flight_log.hpp"
#include "receiver/logs/receiver_log.hpp"
#include "receiver/protocol/ubx_inertial.hpp"
#include "receiver/protocol/ubx_nav.hpp"

namespace skyloop {
namespace {

constexpr std::array ubx_place_messages{NavPvt::message_id, NavPvat::message_id, NavPosllh::message_id,
                                        NavSol::message_id, NavHpposllh::message_id};

}  // namespace

// A whole message with a place in the first part of the file, after whatever else a receiver sends.
bool is_ubx_track(const TrackFile& file) {
    constexpr std::size_t searched = 262'144, length_at = 4;
    const std::size_t end = std::min(file.bytes.size(), searched);
    for (std::size_t at = 0; at + ubx_head_size + ubx_tail_size <= end; ++at) {
        if (file.bytes[at] != ubx_sync_1 || file.bytes[at + 1] != ubx_sync_2) continue;
        const UbxMessageId id{file.bytes[at + 2], file.bytes[at + 3]};
        if (std::find(ubx_place_messages.begin(), ubx_place_messages.end(), id) == ubx_place_messages.end()) continue;
        const std::size_t payload = file.bytes[at + length_at] | std::size_t{file.bytes[at + length_at + 1]} << 8;
        const std::size_t size = ubx_head_size + payload + ubx_tail_size;
        if (at + size <= file.bytes.size() && parse_frame(file.bytes.subspan(at, size))) return true;
    }
    return false;
}

Result<Track> read_ubx_track(const TrackFile& file) {
    auto log = read_receiver_log(file.bytes, file.name, {file.reading.geoid, 0, true});
    if (!log) return fail(log.error());
    if (log->format == "NMEA") return read_nmea_track(file);  // a few polled messages among its sentences
    Track track;
    track.name = file.name;
    track.format = log->format;
    track.notes = std::move(log->notes);
    if (log->dated)
        track.origin = GpsTime{};
    else
        track.notes.emplace_back("no week in it (no NAV-PVT, NAV-SOL or NAV-TIMEGPS); times count from its first week");
    std::size_t placeless = 0, standing = 0, reckoned = 0, flat = 0;
    for (const LogEpoch& epoch : log->epochs) {
        if (!epoch.place) {
            ++placeless;
            continue;
        }
        TrackRow row;
        row.time = epoch.time.time_since_epoch();
        row.position = to_ecef(*epoch.place);
        if (epoch.velocity)
            row.velocity =
                LocalFrame(*epoch.place)
                    .to_ecef(Velocity<Enu>(epoch.velocity->east, epoch.velocity->north, -epoch.velocity->down));
        row.attitude = epoch.attitude;
        if (epoch.attitude) ++standing;
        if (epoch.type == FixType::dead_reckoning) ++reckoned;
        if (epoch.type == FixType::fix_2d) ++flat;
        track.points.push_back(row);
    }
    add_count_note(track.notes, placeless, "epochs without a fix were left out");
    add_count_note(track.notes, flat, "rows are fixes in two dimensions: their heights are not measured");
    add_count_note(track.notes, reckoned, "rows were reckoned without satellites");
    add_count_note(track.notes, standing, "rows have an attitude");
    return track;
}

}  // namespace skyloop
