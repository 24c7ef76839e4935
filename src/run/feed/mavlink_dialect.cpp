// MAVLink as a source: an autopilot's or a simulator's own messages (FEEDS.md 3.6), and the link between PX4 and its
// simulator (3.7).
//
// MAVLink frames out of datagrams and streams alike.

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "detail/dialect_parts.hpp"
#include "detail/mavlink_vehicle_truth.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "run/feed/mavlink_component.hpp"

namespace skyloop::inline run {
namespace {

// Cuts bytes into frames. Frames of messages that are not known are passed over by their length where another frame or
// nothing follows them; anything else is searched byte by byte. State: at most the beginning of one frame.
class MavlinkStream {
public:
    // Calls take(const MavlinkFrameView&) for every whole frame of a known message; the view lives during the call.
    template <class Take>
    void feed(ByteSpan bytes, Take&& take) {
        pending_.insert(pending_.end(), bytes.begin(), bytes.end());
        std::size_t at = 0;
        while (at < pending_.size()) {
            const ByteSpan rest = ByteSpan(pending_).subspan(at);
            if (rest[0] != mavlink_v1_start && rest[0] != mavlink_v2_start) {
                ++at;
                continue;
            }
            const auto size = mavlink_frame_size(rest);
            if (!size || *size > rest.size()) break;
            const auto frame = parse_mavlink(rest.first(*size));
            const bool whole = frame || is_passed_over(rest, *size);
            if (whole) ++frames_;
            if (frame) take(*frame);
            at += whole ? *size : 1;
        }
        pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    void clear() { pending_.clear(); }
    // Whole frames so far, of messages that are not known, too.
    [[nodiscard]] std::uint64_t frames() const { return frames_; }
    // Frames of known messages with a wrong checksum or flags that are not known, since this was asked.
    std::size_t take_broken() { return std::exchange(broken_, 0); }

private:
    bool is_passed_over(ByteSpan rest, std::size_t size) {
        if (mavlink_crc_extra(*mavlink_message_id(rest))) {
            ++broken_;
            return false;
        }
        return rest.size() == size || rest[size] == mavlink_v1_start || rest[size] == mavlink_v2_start;
    }

    Bytes pending_;
    std::uint64_t frames_ = 0;
    std::size_t broken_ = 0;
};

constexpr std::uint8_t no_autopilot = 8;             // MAV_AUTOPILOT_INVALID: ground stations, gimbals
constexpr std::uint8_t onboard_controller = 18;      // MAV_TYPE_ONBOARD_CONTROLLER
constexpr std::uint16_t set_message_interval = 511;  // MAV_CMD_SET_MESSAGE_INTERVAL

void report_broken_frames(MavlinkStream& stream, FeedNews& news) {
    for (std::size_t left = stream.take_broken(); left > 0; --left)
        report_refusal(news, "a MAVLink frame with a wrong checksum or unknown flags");
}

// Looks whether a link that is busy tells places: what has never told one is waited for, and the user must know why. An
// autopilot is asked for its estimate after three seconds.
class PlaceWatch {
public:
    // @param places the messages that would tell one
    explicit PlaceWatch(std::string_view places) : places_(places) {}

    void heard_place() { over_ = true; }
    // After what came at once. @param frames all so far
    void look(std::uint64_t frames, std::int64_t received_ns, FeedNews& news) {
        constexpr std::int64_t patience_ns = 5'000'000'000;
        if (over_ || frames == 0) return;
        if (!first_ns_) first_ns_ = received_ns;
        if (received_ns - *first_ns_ < patience_ns) return;
        over_ = true;
        report_remark(news, fmt::format("{} messages, and none of them tells a place ({})", frames, places_));
    }

private:
    std::string_view places_;
    std::optional<std::int64_t> first_ns_;  // when messages began
    bool over_ = false;
};

// Vehicles count from their own starts or from 1970, the run has one clock for all of a source: the later ones are
// moved, by when their first message came, onto the clock of the first. Those that count from 1970, as it does, are on
// it.
class FleetClock {
public:
    std::optional<Nanoseconds> common(std::uint8_t system, std::optional<Nanoseconds> time, std::int64_t received_ns) {
        constexpr std::int64_t longest_ns = 4'000'000'000'000'000'000;  // beyond it times are taken as none
        if (!time || time->count() > longest_ns) return time;
        const std::int64_t time_ns = time->count();
        if (!leader_) {
            leader_ = system;
            lead_ns_ = time_ns;
        }
        if (*leader_ == system) {
            if (begins_anew(lead_ns_, time_ns)) followers_.clear();
            lead_ns_ = time_ns;
            lead_received_ns_ = received_ns;
            return time;
        }
        if (of_1970(time_ns) && of_1970(lead_ns_)) return time;
        Follower& follower = followers_[system];
        if (!follower.known || begins_anew(follower.last_ns, time_ns))
            follower.offset_ns = lead_ns_ + (received_ns - lead_received_ns_) - time_ns;
        follower.known = true;
        follower.last_ns = time_ns;
        return Nanoseconds(time_ns + follower.offset_ns);
    }

private:
    static bool of_1970(std::int64_t time_ns) { return time_ns > 1'000'000'000'000'000'000; }
    // As SourceClock has it for runs that follow; from a boot's time to one of 1970, too.
    static bool begins_anew(std::int64_t last_ns, std::int64_t time_ns) {
        constexpr std::int64_t back_ns = 1'000'000'000, ahead_ns = 60'000'000'000;
        return time_ns + back_ns < last_ns || time_ns > last_ns + ahead_ns;
    }
    struct Follower {
        bool known = false;
        std::int64_t offset_ns = 0, last_ns = 0;
    };
    std::optional<std::uint8_t> leader_;
    std::int64_t lead_ns_ = 0, lead_received_ns_ = 0;
    std::map<std::uint8_t, Follower> followers_;
};

class MavlinkDialect : public FeedDialect {
public:
    explicit MavlinkDialect(const FeedContext& context) : context_(context) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        stream_.feed(bytes, [&](const MavlinkFrameView& frame) { take(frame, received_ns, news); });
        report_broken_frames(stream_, news);
        places_.look(stream_.frames(), received_ns, news);
        return news;
    }

    std::vector<Bytes> say() override {
        MavlinkHeartbeat alive;
        alive.type = onboard_controller;
        std::vector<Bytes> words{encode_mavlink(next_source(), alive)};
        for (auto& [system, vehicle] : vehicles_)
            ask(system, vehicle, words);
        return words;
    }

    void reconnected() override {
        stream_.clear();
        for (auto& [system, vehicle] : vehicles_)
            vehicle.asked = 0;
    }

private:
    struct Vehicle {
        MavlinkVehicleTruth truth;
        std::uint8_t component = 1;
        bool is_autopilot = false;
        int asked = 0;
    };

    void take(const MavlinkFrameView& frame, std::int64_t received_ns, FeedNews& news) {
        const std::uint8_t system = frame.source.system;
        if (system == 0 || system == mavlink_own_system) return;
        Vehicle& vehicle = vehicles_.try_emplace(system, Vehicle{MavlinkVehicleTruth(context_)}).first->second;
        if (frame.message == MavlinkHeartbeat::message_id) return meet(frame, vehicle, news);
        auto sample = vehicle.truth.take(frame, received_ns);
        if (!sample) return;
        places_.heard_place();
        if (vehicle.truth.is_coarse() && !std::exchange(coarse_told_, true))
            report_remark(news,
                          "SIM_STATE without lat_int and lon_int: its places lie on a grid of up to 1.4 m and are "
                          "smoothed; MAVLink 2 of newer senders has them");
        if (!*sample) return report_refusal(news, fmt::format("vehicle {}: {}", system, sample->error()));
        (*sample)->vehicle = std::to_string(system);
        (*sample)->source_time = clock_.common(system, (*sample)->source_time, received_ns);
        news.samples.push_back(std::move(**sample));
    }

    void meet(const MavlinkFrameView& frame, Vehicle& vehicle, FeedNews& news) {
        const auto alive = decode_mavlink<MavlinkHeartbeat>(frame.payload);
        if (alive.autopilot == no_autopilot) return;
        vehicle.truth.set_autopilot(alive.autopilot);
        vehicle.component = frame.source.component;
        if (std::exchange(vehicle.is_autopilot, true)) return;
        ask(frame.source.system, vehicle, news.answers);
    }

    // The truth of a simulator three times; what every autopilot has, when there is none.
    void ask(std::uint8_t system, Vehicle& vehicle, std::vector<Bytes>& words) {
        constexpr int patience = 3, most = 6;
        const MavlinkTruthKind heard = vehicle.truth.take_heard();
        if (!vehicle.is_autopilot || heard >= MavlinkTruthKind::sim_state) return;
        if (vehicle.asked >= most && heard != MavlinkTruthKind::none) return;
        const double rate = context_.rate_hz;
        words.push_back(request(system, vehicle, MavlinkHilStateQuaternion::message_id, rate));
        words.push_back(request(system, vehicle, MavlinkSimState::message_id, rate));
        if (vehicle.asked++ < patience) return;
        vehicle.asked = std::min(vehicle.asked, most);
        words.push_back(request(system, vehicle, MavlinkGpsGlobalOrigin::message_id, 1));
        words.push_back(request(system, vehicle, MavlinkAttitudeQuaternion::message_id, rate));
        words.push_back(request(system, vehicle, MavlinkLocalPositionNed::message_id, rate));
        words.push_back(request(system, vehicle, MavlinkGlobalPositionInt::message_id, rate));
    }

    Bytes request(std::uint8_t system, const Vehicle& vehicle, std::uint32_t message, double rate_hz) {
        constexpr double second_us = 1e6;
        MavlinkCommandLong command;
        command.command = set_message_interval;
        command.param1 = static_cast<float>(message);
        command.param2 = static_cast<float>(second_us / rate_hz);
        command.target_system = system;
        command.target_component = vehicle.component;
        return encode_mavlink(next_source(), command);
    }

    MavlinkSource next_source() { return {mavlink_own_system, mavlink_own_component, sequence_++}; }

    FeedContext context_;
    MavlinkStream stream_;
    PlaceWatch places_{
        "HIL_STATE_QUATERNION, SIM_STATE, ODOMETRY, GLOBAL_POSITION_INT; LOCAL_POSITION_NED with an origin"};
    FleetClock clock_;
    std::map<std::uint8_t, Vehicle> vehicles_;  // by system: at most 254
    std::uint8_t sequence_ = 0;
    bool coarse_told_ = false;
};

// Between PX4 and its simulator nobody else may speak: the simulator's HIL_STATE_QUATERNION is read, its clock is
// PX4's.
class Px4Dialect : public FeedDialect {
public:
    explicit Px4Dialect(const FeedContext& context) : truth_(context) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        stream_.feed(bytes, [&](const MavlinkFrameView& frame) {
            if (frame.message != MavlinkHilStateQuaternion::message_id) return;
            places_.heard_place();
            if (auto sample = truth_.take(frame, received_ns)) {
                if (*sample)
                    news.samples.push_back(std::move(**sample));
                else
                    report_refusal(news, std::move(sample->error()));
            }
        });
        report_broken_frames(stream_, news);
        places_.look(stream_.frames(), received_ns, news);
        return news;
    }
    void reconnected() override { stream_.clear(); }

private:
    MavlinkVehicleTruth truth_;
    MavlinkStream stream_;
    PlaceWatch places_{"HIL_STATE_QUATERNION"};
};

}  // namespace

std::unique_ptr<FeedDialect> make_mavlink_dialect(const FeedContext& context) {
    return std::make_unique<MavlinkDialect>(context);
}

std::unique_ptr<FeedDialect> make_px4_dialect(const FeedContext& context) {
    return std::make_unique<Px4Dialect>(context);
}

}  // namespace skyloop::inline run
