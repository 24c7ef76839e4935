// What a physics program answers ArduPilot's SITL (its libraries/SITL/examples/JSON/readme.md; FEEDS.md 3.7).
#include <fmt/format.h>

#include <utility>

#include "detail/dialects.hpp"
#include "detail/json_source.hpp"
#include "detail/line_source.hpp"

namespace skyloop {
namespace {

class ArdupilotJsonDialect : public LineSource {
public:
    using LineSource::LineSource;

private:
    void take(const std::string& line, std::int64_t received_ns, FeedNews& news) override {
        const auto answer = nlohmann::json::parse(line, nullptr, false);
        if (!answer.is_object()) return report_refusal(news, "an answer of the physics that is no JSON object");
        const auto seconds = source_json_number(answer, "timestamp");
        const auto time = seconds ? source_nanoseconds(*seconds) : std::nullopt;
        if (!time) return report_refusal(news, "an answer of the physics without \"timestamp\", a number of seconds");
        if (auto sample = sample_in(answer)) return report_sample(news, std::move(*sample), time, received_ns);
        report_refusal(news,
                       "an answer of the physics without \"position\", metres [north, east, down], or \"latitude\", "
                       "\"longitude\" and \"altitude\"");
    }

    // Nothing where the answer has no place. One on the Earth needs no origin, and is no matter of maps.
    [[nodiscard]] std::optional<SampleOr> sample_in(const nlohmann::json& answer) const {
        const auto latitude = source_json_number(answer, "latitude"),
                   longitude = source_json_number(answer, "longitude"),
                   altitude = source_json_number(answer, "altitude");
        if (latitude && longitude && altitude) {
            SourcePose pose;
            pose.latitude_deg = *latitude;
            pose.longitude_deg = *longitude;
            pose.height_m = *altitude;
            put_ardupilot_motion(pose, answer);
            return sample_of(pose, context());
        }
        const auto position = source_json_triple(answer, "position");
        if (!position) return std::nullopt;
        LocalPose pose;
        pose.ned = *position;
        put_ardupilot_motion(pose, answer);
        return sample_of(pose, LocalMap::ardupilot_flat, context());
    }

    template <class Pose>
    static void put_ardupilot_motion(Pose& pose, const nlohmann::json& answer) {
        pose.velocity_ned = source_json_triple(answer, "velocity");
        pose.attitude = attitude_of(answer);
        if (const auto imu = answer.find("imu"); imu != answer.end() && imu->is_object())
            pose.turn_rate = source_json_triple(*imu, "gyro");
    }

    // Of both the quaternion counts, as for ArduPilot.
    static std::optional<Attitude> attitude_of(const nlohmann::json& answer) {
        if (const auto turned = attitude_of_four(answer)) return turned;
        const auto angles = source_json_triple(answer, "attitude");
        return angles ? attitude_of_radians(angles->x(), angles->y(), angles->z()) : std::nullopt;
    }

    static std::optional<Attitude> attitude_of_four(const nlohmann::json& answer) {
        const auto q = answer.find("quaternion");
        if (q == answer.end() || !q->is_array() || q->size() != 4) return std::nullopt;
        for (const auto& part : *q)
            if (!part.is_number()) return std::nullopt;
        return attitude_of_quaternion((*q)[0].get<double>(), (*q)[1].get<double>(), (*q)[2].get<double>(),
                                      (*q)[3].get<double>());
    }
};

}  // namespace

std::unique_ptr<FeedDialect> make_ardupilot_json_dialect(const FeedContext& context) {
    return std::make_unique<ArdupilotJsonDialect>(context);
}

}  // namespace skyloop
