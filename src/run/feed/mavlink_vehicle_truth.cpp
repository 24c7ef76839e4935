#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "detail/mavlink_vehicle_truth.hpp"

namespace skyloop::inline run {
namespace {

constexpr double boot_gain = 0.1, boot_step_ns = 100e6;
constexpr double least_boot_rate = 0, most_boot_rate = 100;
constexpr std::int64_t least_measured_ns = 10'000'000, longest_measured_ns = 5'000'000'000;

}  // namespace

// A loop of second order, as that of arrivals; beyond a tenth of a second it is set, with the rate of the last two.
void BootClock::heard(Nanoseconds boot, std::int64_t received_ns) {
    const auto predicted = at(received_ns);
    const std::int64_t since_ns = received_ns - received_ns_, told_ns = boot.count() - said_ns_;
    said_ns_ = boot.count();
    received_ns_ = received_ns;
    const double error_ns = predicted ? static_cast<double>((boot - *predicted).count()) : 0;
    if (predicted && std::abs(error_ns) < boot_step_ns) {
        boot_ns_ = predicted->count() + std::llround(boot_gain * error_ns);
        if (since_ns >= least_measured_ns)
            rate_ = std::clamp(rate_ + boot_gain * boot_gain / 4 * error_ns / static_cast<double>(since_ns),
                               least_boot_rate, most_boot_rate);
        return;
    }
    boot_ns_ = boot.count();
    if (!predicted || told_ns < 0 || since_ns > longest_measured_ns)
        rate_ = 1;
    else if (since_ns >= least_measured_ns)
        rate_ = std::min(static_cast<double>(told_ns) / static_cast<double>(since_ns), most_boot_rate);
}

std::optional<Nanoseconds> BootClock::at(std::int64_t received_ns) const {
    constexpr double longest_ns = 1e15;
    if (!boot_ns_) return std::nullopt;
    const double since = std::clamp(static_cast<double>(received_ns - received_ns_), -longest_ns, longest_ns);
    return Nanoseconds(*boot_ns_ + std::llround(rate_ * since));
}

namespace {

constexpr std::int64_t kind_patience_ns = 2'000'000'000, attitude_patience_ns = 500'000'000;
constexpr std::uint8_t autopilot_ardupilot = 3, autopilot_px4 = 12;                         // MAV_AUTOPILOT
constexpr std::uint8_t frame_local_ned = 1, frame_local_enu = 4;                            // MAV_FRAME
constexpr std::uint8_t frame_body_ned = 8, frame_body_offset_ned = 9, frame_body_frd = 12;  // the first two: old names

// Microseconds of 1970 or of the start; 0: PX4's stream of HIL_STATE_QUATERNION tells none (FEEDS.md 3.6).
std::optional<Nanoseconds> time_of_microseconds(std::uint64_t count) {
    constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max() / 1000;
    if (count == 0 || count > most) return std::nullopt;
    return Nanoseconds(static_cast<std::int64_t>(count) * 1000);
}

Nanoseconds time_of_boot(std::uint32_t milliseconds) { return Nanoseconds(std::int64_t{milliseconds} * 1'000'000); }

// At the end of 16 bits the vehicle may be faster, and the message tells nothing.
template <class Message>
std::optional<Eigen::Vector3d> velocity_of_integers(const Message& message) {
    constexpr int most = std::numeric_limits<std::int16_t>::max();
    for (const int speed : {+message.vx, +message.vy, +message.vz})
        if (std::abs(speed) >= most) return std::nullopt;
    return Eigen::Vector3d(message.vx.value(), message.vy.value(), message.vz.value());
}

template <class Message>
SourcePose pose_of_integers(const Message& message) {
    SourcePose pose;
    pose.latitude_deg = message.lat.value();
    pose.longitude_deg = message.lon.value();
    pose.height_m = message.alt.value();
    pose.velocity_ned = velocity_of_integers(message);
    return pose;
}

bool has_integers(const MavlinkSimState& message) { return message.lat_int != 0 || message.lon_int != 0; }

std::optional<Attitude> attitude_of_floats(const std::array<float, 4>& q) {
    return attitude_of_quaternion(q[0], q[1], q[2], q[3]);
}

SampleOr no_sample(std::string why) { return tl::make_unexpected(std::move(why)); }

}  // namespace

MavlinkTruthKind MavlinkVehicleTruth::take_heard() { return std::exchange(heard_, MavlinkTruthKind::none); }

bool MavlinkVehicleTruth::counts(MavlinkTruthKind kind, std::int64_t received_ns) const {
    return kind >= kind_ || received_ns - kind_at_ns_ > kind_patience_ns;
}

SampleOr MavlinkVehicleTruth::add(MavlinkTruthKind kind, SampleOr sample, std::optional<Nanoseconds> time,
                                  std::int64_t received_ns) {
    if (!sample) return sample;
    kind_ = kind;
    kind_at_ns_ = received_ns;
    heard_ = std::max(heard_, kind);
    sample->source_time = time;
    sample->received_ns = received_ns;
    return sample;
}

std::optional<SampleOr> MavlinkVehicleTruth::take(const MavlinkFrameView& frame, std::int64_t received_ns) {
    using Kind = MavlinkTruthKind;
    switch (frame.message) {
        case MavlinkHilStateQuaternion::message_id: {
            const auto message = decode_mavlink<MavlinkHilStateQuaternion>(frame.payload);
            return add(Kind::hil_state, of_hil_state(message), time_of_microseconds(message.time_usec), received_ns);
        }
        case MavlinkSimState::message_id:
            if (!counts(Kind::sim_state, received_ns)) return std::nullopt;
            return take_sim_state(frame, received_ns);
        case MavlinkOdometry::message_id: {
            if (!counts(Kind::odometry, received_ns)) return std::nullopt;
            const auto message = decode_mavlink<MavlinkOdometry>(frame.payload);
            return add(Kind::odometry, of_odometry(message), time_of_microseconds(message.time_usec), received_ns);
        }
        case MavlinkLocalPositionNed::message_id: {
            const auto message = decode_mavlink<MavlinkLocalPositionNed>(frame.payload);
            boot_.heard(time_of_boot(message.time_boot_ms), received_ns);
            // Without an origin it tells no place; GLOBAL_POSITION_INT may.
            if (!counts(Kind::local_position, received_ns) || !context_.origin) return std::nullopt;
            return add(Kind::local_position, of_local(message, received_ns), time_of_boot(message.time_boot_ms),
                       received_ns);
        }
        case MavlinkGlobalPositionInt::message_id: {
            const auto message = decode_mavlink<MavlinkGlobalPositionInt>(frame.payload);
            boot_.heard(time_of_boot(message.time_boot_ms), received_ns);
            if (!counts(Kind::global_position, received_ns)) return std::nullopt;
            return add(Kind::global_position, of_global(message, received_ns), time_of_boot(message.time_boot_ms),
                       received_ns);
        }
        default:
            take_supplement(frame, received_ns);
            return std::nullopt;
    }
}

// It has no time of its own. Its arrivals, evened out, are laid on the clock of the vehicle's other messages. Steps on
// the grid of its floats, of up to 1.4 m, tell nothing of time; they are smoothed.
std::optional<SampleOr> MavlinkVehicleTruth::take_sim_state(const MavlinkFrameView& frame, std::int64_t received_ns) {
    const auto message = decode_mavlink<MavlinkSimState>(frame.payload);
    SampleOr sample = of_sim_state(message);
    if (!sample) return sample;
    const bool coarse = !has_integers(message);
    const auto step = sim_state_ && !coarse ? own_step(*sim_state_, *sample) : std::nullopt;
    const std::int64_t evened_ns = sim_rhythm_.evened(received_ns, step);
    const auto time = boot_.at(evened_ns);
    if (coarse) {
        is_coarse_ = true;
        sim_state_.reset();
        coarse_filter_.smooth(*sample, time ? time->count() : evened_ns);
    } else {
        sim_state_ = *sample;
    }
    return add(MavlinkTruthKind::sim_state, std::move(sample), time, received_ns);
}

void MavlinkVehicleTruth::take_supplement(const MavlinkFrameView& frame, std::int64_t received_ns) {
    if (frame.message == MavlinkAttitude::message_id) {
        const auto m = decode_mavlink<MavlinkAttitude>(frame.payload);
        boot_.heard(time_of_boot(m.time_boot_ms), received_ns);
        take_attitude(attitude_of_radians(m.roll, m.pitch, m.yaw), {m.rollspeed, m.pitchspeed, m.yawspeed},
                      received_ns);
    } else if (frame.message == MavlinkAttitudeQuaternion::message_id) {
        const auto m = decode_mavlink<MavlinkAttitudeQuaternion>(frame.payload);
        boot_.heard(time_of_boot(m.time_boot_ms), received_ns);
        take_attitude(attitude_of_floats(m.q), {m.rollspeed, m.pitchspeed, m.yawspeed}, received_ns);
    } else if (frame.message == MavlinkGpsGlobalOrigin::message_id) {
        take_origin(decode_mavlink<MavlinkGpsGlobalOrigin>(frame.payload));
    }
}

// Its accelerations are not read: some senders mean specific force, PX4 whole m/s² (FEEDS.md 3.6).
SampleOr MavlinkVehicleTruth::of_hil_state(const MavlinkHilStateQuaternion& message) const {
    SourcePose pose = pose_of_integers(message);
    pose.attitude = attitude_of_floats(message.q);
    pose.turn_rate = Eigen::Vector3d(message.rollspeed, message.pitchspeed, message.yawspeed);
    return sample_of(pose, context_);
}

// ArduPilot puts 1e7 times the degrees into the floats; the integers, where they are, are better anyway.
SampleOr MavlinkVehicleTruth::of_sim_state(const MavlinkSimState& message) const {
    SourcePose pose;
    const bool integers = has_integers(message);
    const bool scaled = std::abs(message.lat) > 90 || std::abs(message.lon) > 360;
    const double unit = scaled ? 1e-7 : 1;
    pose.latitude_deg = integers ? message.lat_int.value().value_or(0) : double{message.lat} * unit;
    pose.longitude_deg = integers ? message.lon_int.value().value_or(0) : double{message.lon} * unit;
    pose.height_m = message.alt;
    pose.velocity_ned = Eigen::Vector3d(message.vn, message.ve, message.vd);
    pose.attitude = attitude_of_floats(message.q);
    if (!pose.attitude) pose.attitude = attitude_of_radians(message.roll, message.pitch, message.yaw);
    pose.turn_rate = Eigen::Vector3d(message.xgyro, message.ygyro, message.zgyro);
    return sample_of(pose, context_);
}

SampleOr MavlinkVehicleTruth::of_global(const MavlinkGlobalPositionInt& message, std::int64_t received_ns) const {
    SourcePose pose = pose_of_integers(message);
    add_attitude(pose, received_ns);
    return sample_of(pose, context_);
}

SampleOr MavlinkVehicleTruth::of_local(const MavlinkLocalPositionNed& message, std::int64_t received_ns) const {
    LocalPose pose;
    pose.ned = Eigen::Vector3d(message.x, message.y, message.z);
    pose.velocity_ned = Eigen::Vector3d(message.vx, message.vy, message.vz);
    add_attitude(pose, received_ns);
    return sample_of(pose, native_map(), context_);
}

SampleOr MavlinkVehicleTruth::of_odometry(const MavlinkOdometry& message) {
    const bool enu = message.frame_id == frame_local_enu;
    if (!enu && message.frame_id != frame_local_ned)
        return no_sample(
            fmt::format("ODOMETRY in frame {}; expected 1 (north, east, down) or 4 (east, north, up): "
                        "others do not say where north is",
                        message.frame_id));
    const bool of_body = message.child_frame_id == frame_body_frd || message.child_frame_id == frame_body_ned ||
                         message.child_frame_id == frame_body_offset_ned;
    if (!of_body && message.child_frame_id != message.frame_id)
        return no_sample(fmt::format("ODOMETRY with child frame {}; expected 12 (the body) or that of the place",
                                     message.child_frame_id));
    if (message.quality < 0) return no_sample("ODOMETRY of an estimator that has failed");
    // East, north, up to north, east, down: half a turn about the axis between north and east (FEEDS.md 3.8).
    const double half = std::sqrt(0.5);
    const Eigen::Quaterniond to_ned = enu ? Eigen::Quaterniond(0, half, half, 0) : Eigen::Quaterniond::Identity();
    const Eigen::Vector3d velocity(message.vx, message.vy, message.vz);
    const auto turn = attitude_of_floats(message.q);
    LocalPose pose;
    pose.ned = to_ned * Eigen::Vector3d(message.x, message.y, message.z);
    if (!of_body) pose.velocity_ned = to_ned * velocity;
    if (of_body && turn) pose.velocity_ned = to_ned * (turn->body_to_ned() * velocity);
    if (turn) pose.attitude = Attitude(to_ned * turn->body_to_ned());
    if (of_body && turn) pose.turn_rate = Eigen::Vector3d(message.rollspeed, message.pitchspeed, message.yawspeed);
    SampleOr sample = sample_of(pose, native_map(), context_);
    if (sample) {
        sample->jump = reset_counter_ && *reset_counter_ != message.reset_counter;
        reset_counter_ = message.reset_counter;
    }
    return sample;
}

void MavlinkVehicleTruth::take_attitude(const std::optional<Attitude>& attitude, const Eigen::Vector3d& rates,
                                        std::int64_t received_ns) {
    attitude_ = attitude;
    turn_rate_.reset();
    if (rates.allFinite()) turn_rate_ = rates;
    attitude_at_ns_ = received_ns;
}

void MavlinkVehicleTruth::take_origin(const MavlinkGpsGlobalOrigin& message) {
    SourcePose pose;
    pose.latitude_deg = message.latitude.value();
    pose.longitude_deg = message.longitude.value();
    pose.height_m = message.altitude.value();
    if (const SampleOr place = sample_of(pose, context_)) context_.origin = to_geodetic(place->position);
}

template <class Pose>
void MavlinkVehicleTruth::add_attitude(Pose& pose, std::int64_t received_ns) const {
    if (!attitude_ || received_ns - attitude_at_ns_ > attitude_patience_ns) return;
    pose.attitude = attitude_;
    pose.turn_rate = turn_rate_;
}

LocalMap MavlinkVehicleTruth::native_map() const {
    if (autopilot_ == autopilot_px4) return LocalMap::px4_azimuthal;
    return autopilot_ == autopilot_ardupilot ? LocalMap::ardupilot_flat : LocalMap::tangent;
}

}  // namespace skyloop::inline run
