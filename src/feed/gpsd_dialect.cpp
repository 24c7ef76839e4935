// gpsd's JSON (gpsd_json(5); FEEDS.md 3.13).
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "dialects.hpp"
#include "heard_pieces.hpp"
#include "json_source.hpp"
#include "motion_filter.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop {
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
    // What one of gpsd's devices has said.
    struct Device {
        std::optional<Nanoseconds> told;
        std::optional<Height> height;
        std::optional<Attitude> attitude;
        std::int64_t attitude_at_ns = 0;
        MotionFilter filter{receiver_noise};
    };

    void take(const std::string& line, std::int64_t received_ns, FeedNews& news) override {
        const auto report = nlohmann::json::parse(line, nullptr, false);
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
        if (kind == "ATT") return take_attitude(report, device, received_ns);
        if (SampleOr sample = take_position(report, device, received_ns); !sample) {
            report_refusal(news, std::move(sample.error()));
        } else if (!sample->source_time || device.told != sample->source_time) {
            // Several reports of one epoch may come: the first that is whole counts.
            device.told = sample->source_time;
            sample->vehicle = name.empty() ? "0" : name;
            news.samples.push_back(std::move(*sample));
        }
    }

    static void take_attitude(const nlohmann::json& report, Device& device, std::int64_t received_ns) {
        const auto roll = source_json_number(report, "roll"), pitch = source_json_number(report, "pitch");
        const auto yaw = source_json_number(report, "heading");
        device.attitude.reset();
        if (roll && pitch && yaw) device.attitude = attitude_of_degrees(*roll, *pitch, *yaw);
        device.attitude_at_ns = received_ns;
    }

    SampleOr take_position(const nlohmann::json& report, Device& device, std::int64_t received_ns) const {
        constexpr double least_mode = 2;
        const double mode = source_json_number(report, "mode").value_or(0);
        const auto latitude = source_json_number(report, "lat"), longitude = source_json_number(report, "lon");
        if (mode < least_mode || !latitude || !longitude) return tl::make_unexpected("gpsd has no fix");
        take_height(report, device);
        if (!device.height) return tl::make_unexpected("gpsd's fix has no height");
        SourcePose pose;
        pose.latitude_deg = *latitude;
        pose.longitude_deg = *longitude;
        pose.height_m = device.height->metres;
        pose.above_ellipsoid = device.height->above_ellipsoid;
        put_velocity(report, pose);
        constexpr std::int64_t attitude_patience = 1'000'000'000;
        if (received_ns - device.attitude_at_ns <= attitude_patience) pose.attitude = device.attitude;
        SampleOr sample = sample_of(pose, context());
        if (!sample) return sample;
        sample->source_time = time_of(report);
        sample->received_ns = received_ns;
        const bool again = sample->source_time && sample->source_time == device.told;
        if (context().smooth && !again)
            device.filter.smooth(*sample, sample->source_time ? sample->source_time->count() : received_ns);
        return sample;
    }

    // gpsd's own separation of the geoid is coarse: the height above the ellipsoid first (FEEDS.md 1.15). A fix in two
    // dimensions keeps the last height.
    static void take_height(const nlohmann::json& report, Device& device) {
        if (const auto ellipsoidal = source_json_number(report, "altHAE"))
            device.height = Height{*ellipsoidal, true};
        else if (const auto sea = source_json_number(report, "altMSL"))
            device.height = Height{*sea, false};
        else if (const auto old_name = source_json_number(report, "alt"))
            device.height = Height{*old_name, false};
    }

    static void put_velocity(const nlohmann::json& report, SourcePose& pose) {
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

    static std::optional<Nanoseconds> time_of(const nlohmann::json& report) {
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

}  // namespace skyloop
