// What the messages of one MAVLink vehicle say of its motion.
// The clock that a vehicle counts from its start, known from some of its messages, read for the others.
#pragma once

#include <cstdint>
#include <optional>

#include "base/time/gps_time.hpp"
#include "dialect_parts.hpp"
#include "motion/trajectory/source_clock.hpp"
#include "motion_filter.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"

namespace skyloop::inline run {

// Runs at its own rate, which need not be ours: simulators hurry and dawdle. State: the last message, and the line
// through them.
class BootClock {
public:
    // Its messages in the order of their arrival.
    void heard(Nanoseconds boot, std::int64_t received_ns);
    // Nothing before the first message.
    [[nodiscard]] std::optional<Nanoseconds> at(std::int64_t received_ns) const;

private:
    std::optional<std::int64_t> boot_ns_;  // on the line, at received_ns_
    std::int64_t received_ns_ = 0;
    std::int64_t said_ns_ = 0;  // by the last message
    double rate_ = 1;
};

// Messages that tell a place, the better ones last: the first three are estimates, the others a simulator's truth.
enum class MavlinkTruthKind { none, global_position, local_position, odometry, sim_state, hil_state };

// One vehicle. Of the kinds of messages that it sends the best one counts; a worse one again when that has been silent
// for two seconds. Attitudes of messages of their own are added to the next place within half a second. SIM_STATE,
// which has no time, is laid on the clock of those that have one; without its integers it is coarse, and smoothed.
class MavlinkVehicleTruth {
public:
    explicit MavlinkVehicleTruth(const FeedContext& context) : context_(context) {}

    // @return a sample, why there is none, or nothing when the message tells no place that counts
    std::optional<SampleOr> take(const MavlinkFrameView& frame, std::int64_t received_ns);
    // HEARTBEAT's: decides how local metres lie on the Earth.
    void set_autopilot(std::uint8_t autopilot) { autopilot_ = autopilot; }
    // The best kind that gave a sample since this was asked.
    MavlinkTruthKind take_heard();
    // Whether a SIM_STATE has told its place by floats alone.
    [[nodiscard]] bool is_coarse() const { return is_coarse_; }

private:
    bool counts(MavlinkTruthKind kind, std::int64_t received_ns) const;
    SampleOr add(MavlinkTruthKind kind, SampleOr sample, std::optional<Nanoseconds> time, std::int64_t received_ns);
    std::optional<SampleOr> take_sim_state(const MavlinkFrameView& frame, std::int64_t received_ns);
    SampleOr of_hil_state(const MavlinkHilStateQuaternion& message) const;
    SampleOr of_sim_state(const MavlinkSimState& message) const;
    SampleOr of_global(const MavlinkGlobalPositionInt& message, std::int64_t received_ns) const;
    SampleOr of_local(const MavlinkLocalPositionNed& message, std::int64_t received_ns) const;
    SampleOr of_odometry(const MavlinkOdometry& message);
    void take_supplement(const MavlinkFrameView& frame, std::int64_t received_ns);
    void take_attitude(const std::optional<Attitude>& attitude, const Eigen::Vector3d& rates, std::int64_t received_ns);
    void take_origin(const MavlinkGpsGlobalOrigin& message);
    template <class Pose>
    void add_attitude(Pose& pose, std::int64_t received_ns) const;
    [[nodiscard]] LocalMap native_map() const;

    FeedContext context_;
    std::uint8_t autopilot_ = 0;
    MavlinkTruthKind kind_ = MavlinkTruthKind::none, heard_ = MavlinkTruthKind::none;
    std::int64_t kind_at_ns_ = 0;
    std::optional<Attitude> attitude_;
    std::optional<Eigen::Vector3d> turn_rate_;
    std::int64_t attitude_at_ns_ = 0;
    std::optional<std::uint8_t> reset_counter_;
    BootClock boot_;
    ArrivalRhythm sim_rhythm_;
    std::optional<TruthSample> sim_state_;  // the last one that had integers
    MotionFilter coarse_filter_{{0.5, 0.05}};
    bool is_coarse_ = false;
};

}  // namespace skyloop::inline run
