// Values of JSON objects that come from others.
// What a physics program answers ArduPilot's SITL (its libraries/SITL/examples/JSON/readme.md; FEEDS.md 3.7).
// gpsd's JSON (gpsd_json(5); FEEDS.md 3.13).

#include <fmt/format.h>
#include <Eigen/Core>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/core/json.hpp"
#include "base/time/utc_time.hpp"
#include "detail/dialect_parts.hpp"
#include "detail/motion_filter.hpp"

namespace skyloop::inline run {
namespace {

// A finite number; nothing when it is not there or anything else.
std::optional<double> source_json_number(const JsonData& object, std::string_view key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number()) return std::nullopt;
    const double value = found->get<double>();
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// Three finite numbers.
std::optional<Eigen::Vector3d> source_json_triple(const JsonData& object, std::string_view key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_array() || found->size() != 3) return std::nullopt;
    Eigen::Vector3d triple;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(*found)[i].is_number()) return std::nullopt;
        triple(static_cast<Eigen::Index>(i)) = (*found)[i].get<double>();
    }
    return triple.allFinite() ? std::optional(triple) : std::nullopt;
}

// Empty when it is not there or no text.
std::string source_json_text(const JsonData& object, std::string_view key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

class ArdupilotJsonDialect : public LineSource {
public:
    using LineSource::LineSource;

private:
    void take(const std::string& line, std::int64_t received_ns, FeedNews& news) override {
        const auto answer = JsonData::parse(line, nullptr, false);
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
    [[nodiscard]] std::optional<SampleOr> sample_in(const JsonData& answer) const {
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
    static void put_ardupilot_motion(Pose& pose, const JsonData& answer) {
        pose.velocity_ned = source_json_triple(answer, "velocity");
        pose.attitude = attitude_of(answer);
        if (const auto imu = answer.find("imu"); imu != answer.end() && imu->is_object())
            pose.turn_rate = source_json_triple(*imu, "gyro");
    }

    // Of both the quaternion counts, as for ArduPilot.
    static std::optional<Attitude> attitude_of(const JsonData& answer) {
        if (const auto turned = attitude_of_four(answer)) return turned;
        const auto angles = source_json_triple(answer, "attitude");
        return angles ? attitude_of_radians(angles->x(), angles->y(), angles->z()) : std::nullopt;
    }

    static std::optional<Attitude> attitude_of_four(const JsonData& answer) {
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

namespace {

class GpsdDialect : public LineSource {
public:
    using LineSource::LineSource;

    // Until it reports.
    std::vector<Bytes> say() override {
        if (watches_) return {};
        return {to_bytes("?WATCH={\"enable\":true,\"json\":true};\n")};
    }

    void reconnected() override {
        LineSource::reconnected();
        watches_ = false;
        devices_.clear();
    }

private:
    struct Height {
        double metres;
        bool above_ellipsoid;
    };
    // What the reports of an epoch may have beside the place.
    enum Part : unsigned { has_place = 1, has_height = 2, has_speed = 4, has_climb = 8 };
    // What one of gpsd's devices has said.
    struct Device {
        std::string vehicle;
        std::optional<Nanoseconds> time;  // of the epoch
        JsonData epoch;                   // all of its reports, merged
        std::int64_t epoch_at_ns = 0;     // when the last of them came
        EpochGate gate{has_place | has_height};
        std::optional<Height> height;
        std::optional<Attitude> attitude;
        std::int64_t attitude_at_ns = 0;
        MotionFilter filter{receiver_noise};
    };

    void take(const std::string& line, std::int64_t received_ns, FeedNews& news) override {
        const auto report = JsonData::parse(line, nullptr, false);
        if (!report.is_object()) return report_refusal(news, "a line of gpsd that is no JSON object");
        const std::string kind = source_json_text(report, "class");
        if (kind == "WATCH") watches_ = true;
        if (kind == "ERROR") report_refusal(news, "gpsd says: " + source_json_text(report, "message"));
        if (kind != "ATT" && kind != "TPV") return;
        const std::string name = source_json_text(report, "device");
        constexpr std::size_t most_devices = 64;
        if (devices_.size() >= most_devices && !devices_.contains(name))
            return report_refusal(news, "more than 64 devices of gpsd");
        Device& device = devices_[name];
        device.vehicle = name.empty() ? "0" : name;
        if (kind == "ATT") return take_attitude(report, device, received_ns);
        take_position(report, device, received_ns, news);
    }

    static void take_attitude(const JsonData& report, Device& device, std::int64_t received_ns) {
        const auto roll = source_json_number(report, "roll"), pitch = source_json_number(report, "pitch");
        const auto yaw = source_json_number(report, "heading");
        device.attitude.reset();
        if (roll && pitch && yaw) device.attitude = attitude_of_degrees(*roll, *pitch, *yaw);
        device.attitude_at_ns = received_ns;
    }

    // Several reports of one epoch may come, the first of them without a height or a velocity (FEEDS.md 3.13).
    void take_position(const JsonData& report, Device& device, std::int64_t received_ns, FeedNews& news) const {
        constexpr double least_mode = 2;
        const double mode = source_json_number(report, "mode").value_or(0);
        if (mode < least_mode || !source_json_number(report, "lat") || !source_json_number(report, "lon"))
            return report_refusal(news, "gpsd has no fix");
        const auto time = time_of(report);
        if (!time || time != device.time) {
            if (device.gate.next()) tell(device, news);
            device.time = time;
            device.epoch = JsonData::object();
        }
        const bool whole = device.gate.take(merge(report, device.epoch));
        device.epoch_at_ns = received_ns;
        if (whole) return tell(device, news);
        // Nothing else can belong to it.
        if (!time && device.gate.next()) tell(device, news);
    }

    // @return the parts that the report has
    static unsigned merge(const JsonData& report, JsonData& epoch) {
        struct Key {
            const char* name;
            unsigned part;
        };
        constexpr std::array<Key, 11> keys{{{"lat", has_place},
                                            {"lon", has_place},
                                            {"altHAE", has_height},
                                            {"altMSL", has_height},
                                            {"alt", has_height},
                                            {"speed", has_speed},
                                            {"track", 0},
                                            {"climb", has_climb},
                                            {"velN", has_speed},
                                            {"velE", has_speed},
                                            {"velD", has_climb}}};
        unsigned parts = 0;
        for (const Key& key : keys) {
            const auto value = source_json_number(report, key.name);
            if (!value) continue;
            epoch[key.name] = *value;
            parts |= key.part;
        }
        return parts;
    }

    void tell(Device& device, FeedNews& news) const {
        SampleOr sample = sample_of_epoch(device);
        if (sample && context().smooth)
            device.filter.smooth(*sample, device.time ? device.time->count() : device.epoch_at_ns);
        if (sample) sample->vehicle = device.vehicle;
        report_sample(news, std::move(sample), device.time, device.epoch_at_ns);
    }

    SampleOr sample_of_epoch(Device& device) const {
        take_height(device.epoch, device);
        if (!device.height) return tl::make_unexpected("gpsd's fix has no height");
        SourcePose pose;
        pose.latitude_deg = *source_json_number(device.epoch, "lat");
        pose.longitude_deg = *source_json_number(device.epoch, "lon");
        pose.height_m = device.height->metres;
        pose.above_ellipsoid = device.height->above_ellipsoid;
        put_velocity(device.epoch, pose);
        constexpr std::int64_t attitude_patience = 1'000'000'000;
        if (device.epoch_at_ns - device.attitude_at_ns <= attitude_patience) pose.attitude = device.attitude;
        return sample_of(pose, context());
    }

    // gpsd's own separation of the geoid is coarse: the height above the ellipsoid first (FEEDS.md 1.15). A fix in two
    // dimensions keeps the last height.
    static void take_height(const JsonData& report, Device& device) {
        if (const auto ellipsoidal = source_json_number(report, "altHAE"))
            device.height = Height{*ellipsoidal, true};
        else if (const auto sea = source_json_number(report, "altMSL"))
            device.height = Height{*sea, false};
        else if (const auto old_name = source_json_number(report, "alt"))
            device.height = Height{*old_name, false};
    }

    static void put_velocity(const JsonData& report, SourcePose& pose) {
        const auto north = source_json_number(report, "velN"), east = source_json_number(report, "velE");
        const auto down = source_json_number(report, "velD");
        if (north && east && down) {
            pose.velocity_ned = Eigen::Vector3d(*north, *east, *down);
            return;
        }
        const auto speed = source_json_number(report, "speed"), climb = source_json_number(report, "climb");
        // A vehicle at rest has no course.
        const auto track = speed && *speed == 0 ? std::optional(0.0) : source_json_number(report, "track");
        if (!speed || !climb || !track) return;
        const double course = Angle::degrees(*track).rad();
        pose.velocity_ned = Eigen::Vector3d(*speed * std::cos(course), *speed * std::sin(course), -*climb);
    }

    static std::optional<Nanoseconds> time_of(const JsonData& report) {
        const auto utc = parse_utc(source_json_text(report, "time"));
        if (!utc) return std::nullopt;
        return to_gps_time(*utc, LeapSeconds::announced()).time_since_epoch();
    }

    bool watches_ = false;
    std::map<std::string, Device> devices_;
};

}  // namespace

std::unique_ptr<FeedDialect> make_gpsd_dialect(const FeedContext& context) {
    return std::make_unique<GpsdDialect>(context);
}

}  // namespace skyloop::inline run
