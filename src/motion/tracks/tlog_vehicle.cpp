#include "detail/tlog_vehicle.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "receiver/protocol/mavlink.hpp"

namespace skyloop::inline motion {
namespace {

constexpr double degree_of_1e7 = 1e-7;

std::optional<Eigen::Quaterniond> message_turn(const std::array<float, 4>& q) {
    return logged_quaternion(q[0], q[1], q[2], q[3]);
}

// UTC less the clock of the autopilot. By SYSTEM_TIME the middle one; by the stamps the least, for those have waited
// least, of what is within an hour of the middle one (FEEDS.md 1.9, 3.2).
std::optional<std::int64_t> stamp_offset(std::vector<std::int64_t> offsets) {
    constexpr std::int64_t hour_ns = 3'600'000'000'000;
    const auto middle = middle_offset(offsets);
    if (!middle) return std::nullopt;
    std::int64_t least = *middle;
    for (const std::int64_t offset : offsets)
        if (offset > *middle - hour_ns) least = std::min(least, offset);
    return least;
}

struct StartOffset {
    std::optional<std::int64_t> ns;
    bool by_stamps = false;
};

StartOffset offset_of_start(const TlogStart& start) {
    auto told = start.clock_offsets;
    if (const auto middle = middle_offset(told)) return {middle, false};
    if (const auto stamps = stamp_offset(start.stamp_offsets)) return {stamps, true};
    // Nothing but rows by the stamps: GPS time is the clock.
    const auto dated = [](const TlogStart::Dated& row) { return row.by_gps; };
    const bool any = std::any_of(start.simulated.begin(), start.simulated.end(), dated) ||
                     std::any_of(start.hil.begin(), start.hil.end(), dated) ||
                     std::any_of(start.receiver.begin(), start.receiver.end(), dated);
    return any ? StartOffset{0, true} : StartOffset{};
}

std::vector<FlightRow> by_autopilot_clock(const std::vector<TlogStart::Dated>& dated, const TlogStart& start) {
    const auto offset = offset_of_start(start).ns;
    std::vector<FlightRow> rows;
    for (const auto& [told, by_gps] : dated) {
        FlightRow row = told;
        if (by_gps && (!offset || row.ns < *offset || row.ns - *offset > longest_flight_clock_ns)) continue;
        if (by_gps) row.ns -= *offset;
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

void TlogVehicle::take(const TlogFrame& frame) {
    const std::size_t refusals = refusals_;
    dispatch(frame);
    if (refusals_ > refusals)
        refused_ = frame;
    else if (refused_ && boots_.confirmed())
        dispatch(*std::exchange(refused_, std::nullopt));
}

void TlogVehicle::dispatch(const TlogFrame& frame) {
    switch (frame.frame.message) {
        case MavlinkHeartbeat::message_id: {
            constexpr std::uint8_t ground_station = 6;
            const auto message = decode_mavlink<MavlinkHeartbeat>(frame.frame.payload);
            if (message.autopilot == mavlink_autopilot_none || message.type == ground_station) return;
            is_autopilot_ = true;
            is_ardupilot_ = message.autopilot == mavlink_autopilot_ardupilot;
            return;
        }
        case MavlinkSystemTime::message_id:
            return take_clock(frame);
        case MavlinkAttitude::message_id:
        case MavlinkAttitudeQuaternion::message_id:
            return take_attitude(frame);
        case MavlinkGlobalPositionInt::message_id:
            return take_global(frame);
        case MavlinkLocalPositionNed::message_id:
        case MavlinkGpsGlobalOrigin::message_id:
            return take_local(frame);
        case MavlinkGpsRawInt::message_id:
            return take_receiver(frame);
        case MavlinkSimState::message_id:
            return take_truth(frame);
        case MavlinkHilStateQuaternion::message_id:
            return take_hil(frame);
        default:
            return;
    }
}

TlogStart& TlogVehicle::latest_start() {
    if (starts_.size() <= now_start_) starts_.resize(now_start_ + 1);
    return starts_[now_start_];
}

// The 32 bits end after 49.7 days.
TlogStart* TlogVehicle::start_at(std::uint32_t boot_ms, std::int64_t stamp_us) {
    constexpr std::uint32_t near_ms = 600'000;
    constexpr std::int64_t most_wraps = 500;  // 68 years
    if (last_ms_ && *last_ms_ > ~near_ms && boot_ms < near_ms && wraps_ < most_wraps) ++wraps_;
    last_ms_ = boot_ms;
    constexpr std::int64_t wrap_ms = std::int64_t{1} << 32;
    return start_at((wraps_ * wrap_ms + boot_ms) * 1'000'000, stamp_us);
}

TlogStart* TlogVehicle::start_at(std::int64_t ns, std::int64_t stamp_us) {
    const auto start = ns <= longest_flight_clock_ns ? boots_.of(ns) : std::nullopt;
    if (!start) return ++refusals_, nullptr;
    now_start_ = *start;
    now_ns_ = ns;
    TlogStart& here = latest_start();
    if (const auto gps = gps_ns_of_posix_us(static_cast<double>(stamp_us))) here.stamp_offsets.push_back(*gps - ns);
    return &here;
}

void TlogVehicle::take_clock(const TlogFrame& frame) {
    const auto message = decode_mavlink<MavlinkSystemTime>(frame.frame.payload);
    TlogStart* start = start_at(message.time_boot_ms, frame.stamp_us);
    const auto gps = gps_ns_of_posix_us(static_cast<double>(message.time_unix_usec));
    if (start && gps) start->clock_offsets.push_back(*gps - now_ns_);
}

void TlogVehicle::take_attitude(const TlogFrame& frame) {
    if (frame.frame.message == MavlinkAttitudeQuaternion::message_id) {
        const auto message = decode_mavlink<MavlinkAttitudeQuaternion>(frame.frame.payload);
        TlogStart* start = start_at(message.time_boot_ms, frame.stamp_us);
        const auto turn = message_turn(message.q);
        if (start && turn) start->quaternions.add(now_ns_, *turn);
        return;
    }
    const auto message = decode_mavlink<MavlinkAttitude>(frame.frame.payload);
    TlogStart* start = start_at(message.time_boot_ms, frame.stamp_us);
    const auto degrees = [](float radians) { return Angle::radians(static_cast<double>(radians)).deg(); };
    const auto turn = logged_angles(degrees(message.roll), degrees(message.pitch), degrees(message.yaw));
    if (start && turn) start->angles.add(now_ns_, *turn);
}

void TlogVehicle::take_global(const TlogFrame& frame) {
    const auto message = decode_mavlink<MavlinkGlobalPositionInt>(frame.frame.payload);
    TlogStart* start = start_at(message.time_boot_ms, frame.stamp_us);
    auto row = flight_row(now_ns_, message.lat.value(), message.lon.value(), message.alt.value());
    if (!start || !row) return;
    row->velocity_ned = logged_velocity(message.vx.value(), message.vy.value(), message.vz.value());
    start->global.push_back(*row);
    ++places_;
}

void TlogVehicle::take_local(const TlogFrame& frame) {
    if (frame.frame.message == MavlinkGpsGlobalOrigin::message_id) {
        const auto message = decode_mavlink<MavlinkGpsGlobalOrigin>(frame.frame.payload);
        const GlobalSample told{0, message.latitude.value(), message.longitude.value(), message.altitude.value()};
        if (flight_row(0, told.latitude_deg, told.longitude_deg, told.height_m)) origin_ = told;
        return;
    }
    const auto message = decode_mavlink<MavlinkLocalPositionNed>(frame.frame.payload);
    constexpr double farthest_m = 1e6;
    TlogStart* start = start_at(message.time_boot_ms, frame.stamp_us);
    const Eigen::Vector3d ned(message.x, message.y, message.z);
    if (!start || !ned.allFinite() || ned.cwiseAbs().maxCoeff() > farthest_m) return;
    start->local.push_back({now_ns_, ned, logged_velocity(message.vx, message.vy, message.vz), origin_});
    ++places_;
}

// The receiver's own solution; its vertical velocity is not in it.
void TlogVehicle::take_receiver(const TlogFrame& frame) {
    const auto message = decode_mavlink<MavlinkGpsRawInt>(frame.frame.payload);
    constexpr std::uint8_t fix_2d = 2;
    if (message.fix_type < fix_2d) return;
    const bool above = message.alt_ellipsoid != 0;
    auto row = flight_row(0, message.lat.value(), message.lon.value(),
                          above ? message.alt_ellipsoid.value() : message.alt.value());
    if (!row) return;
    row->above_sea = !above;
    const auto gps = gps_ns_of_posix_us(static_cast<double>(message.time_usec));
    const auto ns = gps ? gps : flight_clock_ns(static_cast<double>(message.time_usec));
    if (!ns || *ns == 0) return;
    row->ns = *ns;
    TlogStart* start = gps ? &latest_start() : start_at(*ns, frame.stamp_us);
    if (!start) return;
    start->receiver.push_back({*row, gps.has_value()});
    ++places_;
}

// ArduPilot puts 1e7 times the degrees into the floats (FEEDS.md 3.6). The message has no time.
void TlogVehicle::take_truth(const TlogFrame& frame) {
    const auto message = decode_mavlink<MavlinkSimState>(frame.frame.payload);
    const auto gps = gps_ns_of_posix_us(static_cast<double>(frame.stamp_us));
    double latitude = message.lat, longitude = message.lon;
    if (std::abs(latitude) > 90 || std::abs(longitude) > 360) latitude *= degree_of_1e7, longitude *= degree_of_1e7;
    if (message.lat_int != 0 || message.lon_int != 0)
        latitude = message.lat_int.value().value_or(0), longitude = message.lon_int.value().value_or(0);
    auto row = flight_row(gps.value_or(0), latitude, longitude, message.alt);
    if (!gps || !row) return;
    row->velocity_ned = logged_velocity(message.vn, message.ve, message.vd);
    row->turn = message_turn(message.q);
    latest_start().simulated.push_back({*row, true});
    ++places_;
}

// PX4 leaves the time at 0.
void TlogVehicle::take_hil(const TlogFrame& frame) {
    const auto message = decode_mavlink<MavlinkHilStateQuaternion>(frame.frame.payload);
    const auto told = static_cast<double>(message.time_usec == 0 ? static_cast<std::uint64_t>(frame.stamp_us)
                                                                 : message.time_usec.raw);
    const auto gps = gps_ns_of_posix_us(told);
    const auto ns = gps ? gps : flight_clock_ns(told);
    auto row = flight_row(ns.value_or(0), message.lat.value(), message.lon.value(), message.alt.value());
    if (!ns || !row) return;
    TlogStart* start = gps ? &latest_start() : start_at(*ns, frame.stamp_us);
    if (!start) return;
    row->velocity_ned = logged_velocity(message.vx.value(), message.vy.value(), message.vz.value());
    row->turn = message_turn(message.q);
    start->hil.push_back({*row, gps.has_value()});
    ++places_;
}

// Rows before the first origin take that one.
std::vector<FlightRow> TlogVehicle::local_rows(const TlogStart& start) const {
    std::vector<FlightRow> rows;
    const auto first = std::find_if(start.local.begin(), start.local.end(),
                                    [](const TlogStart::LocalPlace& place) { return place.origin.has_value(); });
    std::optional<GlobalSample> origin = first == start.local.end() ? origin_ : first->origin;
    if (!origin) return rows;
    for (const TlogStart::LocalPlace& place : start.local) {
        const GlobalSample from = place.origin.value_or(*origin);
        const bool moved = from.latitude_deg != origin->latitude_deg || from.longitude_deg != origin->longitude_deg ||
                           from.height_m != origin->height_m;
        const GlobalSample there = is_ardupilot_ ? on_ardupilot_map(from, place.ned) : on_px4_map(from, place.ned);
        auto row = flight_row(place.ns, there.latitude_deg, there.longitude_deg, there.height_m);
        if (!row) continue;
        row->velocity_ned = place.velocity;
        row->jump = moved;
        rows.push_back(*row);
        origin = from;
    }
    return rows;
}

std::vector<FlightOffer> TlogVehicle::offers() const {
    std::vector<FlightOffer> all{{"GLOBAL_POSITION_INT", {}},
                                 {"LOCAL_POSITION_NED", {}},
                                 {"HIL_STATE_QUATERNION", {}},
                                 {"SIM_STATE", {}},
                                 {"GPS_RAW_INT", {}}};
    for (const TlogStart& start : starts_) {
        all[0].starts.push_back(start.global);
        all[1].starts.push_back(local_rows(start));
        all[2].starts.push_back(by_autopilot_clock(start.hil, start));
        all[3].starts.push_back(by_autopilot_clock(start.simulated, start));
        all[4].starts.push_back(by_autopilot_clock(start.receiver, start));
    }
    std::erase_if(all, [](const FlightOffer& offer) {
        return std::all_of(offer.starts.begin(), offer.starts.end(), [](const auto& rows) { return rows.empty(); });
    });
    return all;
}

std::vector<FlightClock> TlogVehicle::clocks(std::string& note) const {
    std::vector<FlightClock> clocks;
    bool by_stamps = false, by_system_time = false;
    for (const TlogStart& start : starts_) {
        const StartOffset offset = offset_of_start(start);
        (offset.by_stamps ? by_stamps : by_system_time) |= offset.ns.has_value();
        clocks.push_back({offset.ns, start.quaternions.size() > 0 ? start.quaternions : start.angles});
    }
    if (by_stamps) note = "the ground station's stamps give UTC, as late as the link";
    if (by_system_time) note = "SYSTEM_TIME gives UTC";
    return clocks;
}

}  // namespace skyloop::inline motion
