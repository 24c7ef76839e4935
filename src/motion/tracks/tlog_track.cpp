#include <fmt/format.h>

#include <map>

#include "detail/tlog_vehicle.hpp"

namespace skyloop::inline motion {
namespace {

// Ground stations (QGroundControl, Mission Planner, MAVProxy) put the time before each frame: microseconds of UTC since
// 1970, the most significant byte first (FEEDS.md 1.9).
constexpr std::size_t tlog_stamp_size = 8;

std::uint64_t tlog_stamp(ByteSpan bytes) {
    std::uint64_t stamp = 0;
    for (std::size_t i = 0; i < tlog_stamp_size; ++i)
        stamp = stamp << 8 | bytes[i];
    return stamp;
}

// Whether a stamp before the year 2100 and the start of a frame may stand here.
bool begins_tlog_record(ByteSpan bytes) {
    constexpr std::uint64_t until_2100_us = 4'102'444'800'000'000;
    return bytes.size() > tlog_stamp_size && tlog_stamp(bytes) < until_2100_us &&
           (bytes[tlog_stamp_size] == mavlink_v1_start || bytes[tlog_stamp_size] == mavlink_v2_start);
}

// Gives the frames whose checksum holds. Frames of messages that are not known here are passed over by their length.
class TlogReader {
public:
    explicit TlogReader(ByteSpan bytes) : bytes_(bytes) {}
    std::optional<TlogFrame> next();
    [[nodiscard]] std::size_t skipped() const { return skipped_; }
    [[nodiscard]] std::size_t damaged() const { return damaged_; }
    [[nodiscard]] bool is_cut() const { return cut_; }

private:
    ByteSpan bytes_;
    std::size_t at_ = 0, skipped_ = 0, damaged_ = 0;
    bool cut_ = false;
};

std::optional<TlogFrame> TlogReader::next() {
    while (at_ + tlog_stamp_size < bytes_.size()) {
        const ByteSpan rest = bytes_.subspan(at_), frame_bytes = rest.subspan(tlog_stamp_size);
        const auto size = begins_tlog_record(rest) ? mavlink_frame_size(frame_bytes) : std::nullopt;
        const bool whole = size && *size <= frame_bytes.size();
        if (whole)
            if (const auto frame = parse_mavlink(frame_bytes.first(*size))) {
                at_ += tlog_stamp_size + *size;
                return TlogFrame{static_cast<std::int64_t>(tlog_stamp(rest)), *frame};
            }
        const ByteSpan behind = whole ? frame_bytes.subspan(*size) : ByteSpan();
        if (whole && (behind.empty() || begins_tlog_record(behind))) {
            const auto message = mavlink_message_id(frame_bytes);
            if (message && mavlink_crc_extra(*message)) ++damaged_;
            at_ += tlog_stamp_size + *size;
            continue;
        }
        cut_ = cut_ || (size && !whole);
        ++at_;
        ++skipped_;
    }
    return std::nullopt;
}

using TlogSender = std::pair<int, int>;  // system and component

std::string told_senders(const std::map<TlogSender, TlogVehicle>& all, TlogSender chosen) {
    std::string others;
    for (const auto& [sender, vehicle] : all)
        if (sender != chosen && vehicle.has_places())
            others += fmt::format("{}{}/{}", others.empty() ? "" : ", ", sender.first, sender.second);
    return others;
}

// The first one to speak that is an autopilot and says where it is, else the first one that says where it is.
std::optional<TlogSender> chosen_sender(const std::map<TlogSender, TlogVehicle>& all,
                                        const std::vector<TlogSender>& order) {
    for (const bool autopilots : {true, false})
        for (const TlogSender& sender : order)
            if (const TlogVehicle& vehicle = all.at(sender);
                vehicle.has_places() && (vehicle.is_autopilot() || !autopilots))
                return sender;
    return std::nullopt;
}

}  // namespace

bool is_tlog(const TrackFile& file) {
    if (!begins_tlog_record(file.bytes)) return false;
    const ByteSpan frame = file.bytes.subspan(tlog_stamp_size);
    const auto size = mavlink_frame_size(frame);
    return !size || *size >= frame.size() || begins_tlog_record(frame.subspan(*size));
}

Result<Track> read_tlog(const TrackFile& file) {
    TlogReader reader(file.bytes);
    std::map<TlogSender, TlogVehicle> vehicles;
    std::vector<TlogSender> order;
    while (const auto frame = reader.next()) {
        const TlogSender sender{frame->frame.source.system, frame->frame.source.component};
        if (!vehicles.contains(sender)) order.push_back(sender);
        vehicles[sender].take(*frame);
    }
    FlightLog flight;
    flight.name = file.name;
    const auto sender = chosen_sender(vehicles, order);
    const auto offers = sender ? vehicles.at(*sender).offers() : std::vector<FlightOffer>();
    const auto chosen = chosen_offer(offers);
    if (!chosen)
        return fail(ErrorCode::input,
                    fmt::format("{}: a MAVLink log of {} senders without two places of a vehicle; expected "
                                "GLOBAL_POSITION_INT, LOCAL_POSITION_NED with GPS_GLOBAL_ORIGIN, HIL_STATE_QUATERNION, "
                                "SIM_STATE or GPS_RAW_INT",
                                file.name, vehicles.size()));
    flight.places = offers[*chosen];
    flight.format = "MAVLink tlog, " + flight.places.name;
    std::string utc;
    flight.clocks = vehicles.at(*sender).clocks(utc);
    flight.notes.push_back(told_choice(flight.places, *chosen) +
                           fmt::format(" by system {}, component {}", sender->first, sender->second));
    if (!utc.empty()) flight.notes.push_back(utc);
    if (const std::string others = told_senders(vehicles, *sender); !others.empty())
        flight.notes.push_back(fmt::format("other senders say where they are, too, and were left out: {}", others));
    add_count_note(flight.notes, reader.damaged(), "frames with a wrong checksum were left out");
    add_count_note(flight.notes, reader.skipped(), "bytes that begin no record were passed over");
    if (reader.is_cut()) flight.notes.emplace_back("a record is cut by the end of the file");
    return track_of_flight(std::move(flight), file.reading.geoid);
}

}  // namespace skyloop::inline motion
