// The packets that a simulator sends to Betaflight's SITL (fdm_packet of its sitl.c; FEEDS.md 3.7).
//
// FlightGear's native-fdm packets (simgear's net_fdm.hxx; offsets and traps: FEEDS.md 3.4), which JSBSim and ArduPilot
// send too.

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "detail/dialect_parts.hpp"
#include "detail/motion_filter.hpp"
#include "motion/trajectory/source_clock.hpp"
#include "receiver/protocol/field_list.hpp"

namespace skyloop::inline run {
namespace {

// Eighteen little-endian doubles. The frames of gyros, accelerations and quaternion differ between simulators: they are
// not read.
struct BetaflightPacket {
    double timestamp_s = 0;
    std::array<double, 3> gyro{}, acceleration{};
    std::array<double, 4> quaternion{};
    std::array<double, 3> velocity{};  // m/s east, north, up
    std::array<double, 3> position{};  // longitude and latitude, deg; m above the sea
    double pressure = 0;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.timestamp_s, m.gyro, m.acceleration, m.quaternion, m.velocity, m.position, m.pressure);
    }
};

class BetaflightDialect : public FeedDialect {
public:
    explicit BetaflightDialect(const FeedContext& context) : context_(context) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        const auto packet = decode_payload<BetaflightPacket>(bytes);
        if (!packet) {
            report_refusal(news, fmt::format("{} bytes are no fdm_packet; expected 144", bytes.size()));
            return news;
        }
        const auto time = source_nanoseconds(packet->timestamp_s);
        if (!time) {
            report_refusal(news, fmt::format("a time of {} s", packet->timestamp_s));
            return news;
        }
        SourcePose pose;
        pose.longitude_deg = packet->position[0];
        pose.latitude_deg = packet->position[1];
        pose.height_m = packet->position[2];
        pose.velocity_ned = Eigen::Vector3d(packet->velocity[1], packet->velocity[0], -packet->velocity[2]);
        report_sample(news, sample_of(pose, context_), time, received_ns);
        return news;
    }

private:
    FeedContext context_;
};

}  // namespace

std::unique_ptr<FeedDialect> make_betaflight_dialect(const FeedContext& context) {
    return std::make_unique<BetaflightDialect>(context);
}

namespace {

constexpr std::size_t fdm_size_v24 = 408, fdm_size_v25 = 552;
constexpr std::size_t fdm_time_v24 = 356, fdm_time_v25 = 500;

template <class T>
T big_endian(ByteSpan bytes, std::size_t offset) {
    std::array<std::uint8_t, sizeof(T)> little{};
    for (std::size_t i = 0; i < sizeof(T); ++i)
        little[sizeof(T) - 1 - i] = bytes[offset + i];
    return std::bit_cast<T>(little);
}

Eigen::Vector3d three_floats(ByteSpan bytes, std::size_t offset) {
    return {big_endian<float>(bytes, offset), big_endian<float>(bytes, offset + 4),
            big_endian<float>(bytes, offset + 8)};
}

// Body rates of the rates of roll, pitch and yaw (Stevens and Lewis, Aircraft Control and Simulation, table 1.4-1).
Eigen::Vector3d body_rates(const Eigen::Vector3d& angles, const Eigen::Vector3d& rates) {
    const double sin_roll = std::sin(angles.x()), cos_roll = std::cos(angles.x());
    const double sin_pitch = std::sin(angles.y()), cos_pitch = std::cos(angles.y());
    return {rates.x() - rates.z() * sin_pitch,                        //
            rates.y() * cos_roll + rates.z() * cos_pitch * sin_roll,  //
            -rates.y() * sin_roll + rates.z() * cos_pitch * cos_roll};
}

// JSBSim's simulation time in microseconds, where its output asks for it. FlightGear has whole seconds of a calendar
// there and JSBSim by itself a constant: neither is a clock. What advances by more than 100 and less than 2 s of
// microseconds in a packet is taken for microseconds.
class MicrosecondClock {
public:
    std::optional<Nanoseconds> read(std::uint32_t count) {
        constexpr std::uint32_t least_step = 100, most_step = 2'000'000;
        constexpr int enough = 3;
        const std::uint32_t step = count - last_;  // past the 32 bits it goes on
        const bool advances = first_seen_ && step >= least_step && step <= most_step;
        if (first_seen_ && step != 0) fitting_ = advances ? std::min(fitting_ + 1, enough) : 0;
        // A step back is a run begun anew.
        elapsed_us_ = advances || step == 0 ? elapsed_us_ + step : count;
        last_ = count;
        first_seen_ = true;
        if (fitting_ < enough) return std::nullopt;
        return Nanoseconds(static_cast<std::int64_t>(elapsed_us_) * 1000);
    }

private:
    bool first_seen_ = false;
    int fitting_ = 0;
    std::uint32_t last_ = 0;
    std::uint64_t elapsed_us_ = 0;
};

// The clock of a sender without one, whose packets come at the rate of its physics from the same machine: their number.
// Arrivals are no clock at 400 Hz and more, as each stall of the machine bunches them; and an ArrivalRhythm takes what
// stands in a bunch for lost.
class PacketClock {
public:
    // @return when the packet has been sent, but for a delay that is the same for all, ns of the clock of arrivals
    std::int64_t sent(std::int64_t received_ns) {
        constexpr std::int64_t learned_ns = 1'000'000'000, silence_ns = 2'000'000'000;
        if (count_ > 0 && std::abs(received_ns - last_ns_) > silence_ns) *this = PacketClock();
        last_ns_ = received_ns;
        if (count_++ == 0) first_ns_ = received_ns;
        if (!clock_) {
            if (received_ns - first_ns_ < learned_ns) return received_ns;
            period_ns_ = (received_ns - first_ns_) / (count_ - 1);
            clock_.emplace(ClockMode::realtime, GpsTime(), 0);
        }
        return (clock_->stamp(Nanoseconds(count_ * period_ns_), received_ns).time - GpsTime()).count();
    }

private:
    std::optional<SourceClock> clock_;  // corrects the period, which the first second tells roughly
    std::int64_t count_ = 0, first_ns_ = 0, last_ns_ = 0, period_ns_ = 0;
};

class FlightgearDialect : public FeedDialect {
public:
    explicit FlightgearDialect(const FeedContext& context) : context_(context) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        const std::uint32_t version = bytes.size() >= 4 ? big_endian<std::uint32_t>(bytes, 0) : 0;
        const bool v24 = bytes.size() == fdm_size_v24 && version == 24;
        const bool v25 = bytes.size() == fdm_size_v25 && version == 25;
        if (!v24 && !v25) {
            report_refusal(news,
                           fmt::format("{} bytes of version {} are no native-fdm packet; expected {} bytes of 24 or "
                                       "{} of 25",
                                       bytes.size(), version, fdm_size_v24, fdm_size_v25));
            return news;
        }
        SourcePose pose = pose_of(bytes);
        const auto time = clock_.read(big_endian<std::uint32_t>(bytes, v24 ? fdm_time_v24 : fdm_time_v25));
        const std::int64_t sent_ns = packets_.sent(received_ns);
        const bool derive = derives_velocity(pose);
        if (derive) pose.velocity_ned.reset();
        SampleOr sample = sample_of(pose, context_);
        if (derive && sample) filter_.smooth(*sample, time ? time->count() : sent_ns);
        report_sample(news, std::move(sample), time, received_ns);
        return news;
    }

    void reconnected() override {
        clock_ = {};
        packets_ = {};
        filter_.forget();
        still_ = false;
    }

private:
    static SourcePose pose_of(ByteSpan bytes) {
        SourcePose pose;
        pose.longitude_deg = Angle::radians(big_endian<double>(bytes, 8)).deg();
        pose.latitude_deg = Angle::radians(big_endian<double>(bytes, 16)).deg();
        pose.height_m = big_endian<double>(bytes, 24);
        const Eigen::Vector3d angles = three_floats(bytes, 36), rates = three_floats(bytes, 56);
        pose.attitude = attitude_of_radians(angles.x(), angles.y(), angles.z());
        // Rates that are all zero are those of a sender that has none.
        if (pose.attitude && !rates.isZero(0)) pose.turn_rate = body_rates(angles, rates);
        pose.velocity_ned = three_floats(bytes, 76) * metres_per_foot;
        return pose;
    }

    // ArduPilot's packets for views have no velocities: zeros while the vehicle moves are not believed any more.
    bool derives_velocity(const SourcePose& pose) {
        const Eigen::Vector3d place(pose.latitude_deg, pose.longitude_deg, pose.height_m);
        const bool zero = pose.velocity_ned->isZero(0);
        if (!zero) still_ = false;
        if (zero && last_place_ && place != *last_place_) still_ = true;
        last_place_ = place;
        return still_;
    }

    FeedContext context_;
    MicrosecondClock clock_;
    PacketClock packets_;
    MotionFilter filter_{{0.01, 0.2}};  // ArduPilot's latitudes have a grid of 1 cm
    std::optional<Eigen::Vector3d> last_place_;
    bool still_ = false;  // the velocities say so, and are wrong
};

}  // namespace

std::unique_ptr<FeedDialect> make_flightgear_dialect(const FeedContext& context) {
    return std::make_unique<FlightgearDialect>(context);
}

}  // namespace skyloop::inline run
