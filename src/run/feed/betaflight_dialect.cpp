// The packets that a simulator sends to Betaflight's SITL (fdm_packet of its sitl.c; FEEDS.md 3.7).
#include <fmt/format.h>

#include <array>

#include "detail/dialects.hpp"
#include "detail/source_pose.hpp"
#include "receiver/protocol/field_list.hpp"

namespace skyloop {
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

}  // namespace skyloop
