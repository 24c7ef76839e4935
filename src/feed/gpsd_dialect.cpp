// gpsd's JSON (gpsd_json(5); FEEDS.md 3.13).
#include <fmt/format.h>

#include <cmath>

#include "dialects.hpp"
#include "json_source.hpp"
#include "motion_filter.hpp"
#include "skyloop/time/utc_time.hpp"
#include "source_pose.hpp"

namespace skyloop {
namespace {

class GpsdDialect : public FeedDialect {
public:
    explicit GpsdDialect(const FeedContext& context) : context_(context) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        for (const std::string& line : lines_.feed(bytes))
            take(line, received_ns, news);
        if (lines_.take_thrown_away() > 0) report_refusal(news, "a line of more than 65536 bytes");
        return news;
    }

    // Until it reports.
    std::vector<Bytes> say() override {
        if (watches_) return {};
        return {to_bytes("?WATCH={\"enable\":true,\"json\":true};\n")};
    }

    void reconnected() override {
        lines_.clear();
        watches_ = false;
        told_.reset();
        filter_.forget();
    }

private:
    void take(const std::string& line, std::int64_t received_ns, FeedNews& news) {
        const auto report = nlohmann::json::parse(line, nullptr, false);
        if (!report.is_object()) return report_refusal(news, "a line of gpsd that is no JSON object");
        const std::string kind = source_json_text(report, "class");
        if (kind == "WATCH") watches_ = true;
        if (kind == "ERROR") report_refusal(news, "gpsd says: " + source_json_text(report, "message"));
        const bool wanted = context_.vehicle.empty() || context_.vehicle == source_json_text(report, "device");
        if (kind == "ATT" && wanted) take_attitude(report, received_ns);
        if (kind == "TPV" && wanted) take_position(report, received_ns, news);
    }

    void take_attitude(const nlohmann::json& report, std::int64_t received_ns) {
        const auto roll = source_json_number(report, "roll"), pitch = source_json_number(report, "pitch");
        const auto yaw = source_json_number(report, "heading");
        attitude_.reset();
        if (roll && pitch && yaw) attitude_ = attitude_of_degrees(*roll, *pitch, *yaw);
        attitude_at_ns_ = received_ns;
    }

    // Several reports of one epoch may come; the first that is whole counts. Without a fix there is nothing to tell.
    void take_position(const nlohmann::json& report, std::int64_t received_ns, FeedNews& news) {
        constexpr double least_mode = 2;
        const double mode = source_json_number(report, "mode").value_or(0);
        const auto latitude = source_json_number(report, "lat"), longitude = source_json_number(report, "lon");
        if (mode < least_mode || !latitude || !longitude) return report_refusal(news, "gpsd has no fix");
        SourcePose pose;
        pose.latitude_deg = *latitude;
        pose.longitude_deg = *longitude;
        if (!put_height(report, pose)) return report_refusal(news, "gpsd's fix has no height");
        const auto time = time_of(report);
        if (time && told_ && *time == *told_) return;
        told_ = time;
        put_velocity(report, pose);
        constexpr std::int64_t attitude_patience = 1'000'000'000;
        if (attitude_ && received_ns - attitude_at_ns_ <= attitude_patience) pose.attitude = attitude_;
        SampleOr sample = sample_of(pose, context_);
        if (sample && !context_.vehicle.empty()) sample->vehicle = context_.vehicle;
        if (sample && context_.smooth) filter_.smooth(*sample, time ? time->count() : received_ns);
        report_sample(news, std::move(sample), time, received_ns);
    }

    // gpsd's own separation of the geoid is coarse: the height above the ellipsoid first (FEEDS.md 1.15). A fix in two
    // dimensions keeps the last height.
    bool put_height(const nlohmann::json& report, SourcePose& pose) {
        if (const auto ellipsoidal = source_json_number(report, "altHAE")) {
            height_ = {*ellipsoidal, true};
        } else if (auto sea = source_json_number(report, "altMSL"); sea || (sea = source_json_number(report, "alt"))) {
            height_ = {*sea, false};
        }
        if (!height_) return false;
        pose.height_m = height_->metres;
        pose.above_ellipsoid = height_->above_ellipsoid;
        return true;
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

    struct Height {
        double metres;
        bool above_ellipsoid;
    };
    FeedContext context_;
    SourceLines lines_;
    bool watches_ = false;
    std::optional<Nanoseconds> told_;
    std::optional<Height> height_;
    std::optional<Attitude> attitude_;
    std::int64_t attitude_at_ns_ = 0;
    MotionFilter filter_{receiver_noise};
};

}  // namespace

std::unique_ptr<FeedDialect> make_gpsd_dialect(const FeedContext& context) {
    return std::make_unique<GpsdDialect>(context);
}

}  // namespace skyloop
