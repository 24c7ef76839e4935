#include <fmt/format.h>

#include <cmath>
#include <system_error>
#include <utility>

#include "base/core/number_text.hpp"
#include "detail/dialect_parts.hpp"

namespace skyloop::inline run {
namespace {

constexpr double fastest_mps = 12000;           // FEEDS.md 3.1
constexpr double highest_m = 1e6;               // the same
constexpr double farthest_from_origin_m = 1e6;  // from an origin: no local frame reaches as far
constexpr std::size_t longest_line = 65536;

SampleOr refused_pose(std::string why) { return tl::make_unexpected(std::move(why)); }

std::optional<std::string> wrong_motion(const std::optional<Eigen::Vector3d>& velocity,
                                        const std::optional<Eigen::Vector3d>& turn_rate) {
    if (velocity && !(velocity->norm() <= fastest_mps))
        return fmt::format("a speed of {} m/s; expected at most {}", velocity->norm(), fastest_mps);
    if (turn_rate && !turn_rate->allFinite()) return "turn rates that are no numbers";
    return std::nullopt;
}

double height_above_ellipsoid(const SourcePose& pose, Angle latitude, Angle longitude, const FeedContext& context) {
    const bool as_it_is = pose.above_ellipsoid || context.sea_level == SeaLevel::ellipsoid || context.geoid == nullptr;
    return as_it_is ? pose.height_m : pose.height_m + context.geoid->undulation(latitude, longitude).value();
}

// The motion of a sample, along axes that `to_ecef` turns into ours.
template <class Pose>
void put_motion(TruthSample& sample, const Pose& pose, const Eigen::Matrix3d& to_ecef) {
    if (pose.velocity_ned) sample.velocity = Velocity<Ecef>(to_ecef * *pose.velocity_ned);
    sample.turn_rate = pose.turn_rate;
}

}  // namespace

SampleOr sample_of(const SourcePose& pose, const FeedContext& context) {
    if (!(std::abs(pose.latitude_deg) <= 90 && std::abs(pose.longitude_deg) <= 360))
        return refused_pose(
            fmt::format("latitude {} and longitude {} are no place", pose.latitude_deg, pose.longitude_deg));
    if (!(std::abs(pose.height_m) <= highest_m))
        return refused_pose(
            fmt::format("a height of {} m; expected at most {} from sea level", pose.height_m, highest_m));
    if (pose.latitude_deg == 0 && pose.longitude_deg == 0)
        return refused_pose("latitude and longitude are 0, as of a vehicle that knows no place");
    if (auto wrong = wrong_motion(pose.velocity_ned, pose.turn_rate)) return refused_pose(std::move(*wrong));
    const Angle latitude = Angle::degrees(pose.latitude_deg);
    const Angle longitude = Angle::degrees(std::remainder(pose.longitude_deg, 360));
    const Geodetic place{latitude, longitude, {Metres(height_above_ellipsoid(pose, latitude, longitude, context))}};
    TruthSample sample;
    sample.position = to_ecef(place);
    put_motion(sample, pose, ned_to_ecef(place).toRotationMatrix());
    sample.attitude = pose.attitude;
    return sample;
}

SampleOr sample_of(const LocalPose& pose, LocalMap native, const FeedContext& context) {
    if (!context.origin) return refused_pose("it counts in metres from its origin; expected an origin in the scenario");
    if (!(pose.ned.norm() <= farthest_from_origin_m))
        return refused_pose(
            fmt::format("{} m from the origin; expected at most {}", pose.ned.norm(), farthest_from_origin_m));
    if (auto wrong = wrong_motion(pose.velocity_ned, pose.turn_rate)) return refused_pose(std::move(*wrong));
    const LocalMap map = context.map.value_or(native);
    const Geodetic place = place_on_map(map, *context.origin, pose.ned);
    const Eigen::Matrix3d to_ecef_axes = axes_on_map(map, *context.origin, place);
    TruthSample sample;
    sample.position = to_ecef(place);
    put_motion(sample, pose, to_ecef_axes);
    if (pose.attitude) {
        const Eigen::Matrix3d to_place_axes = ned_to_ecef(place).toRotationMatrix().transpose() * to_ecef_axes;
        sample.attitude = Attitude(Eigen::Quaterniond(to_place_axes) * pose.attitude->body_to_ned());
    }
    return sample;
}

std::optional<Attitude> attitude_of_quaternion(double w, double x, double y, double z) {
    constexpr double tolerance = 0.05;
    const Eigen::Quaterniond body_to_ned(w, x, y, z);
    if (!(std::abs(body_to_ned.norm() - 1) <= tolerance)) return std::nullopt;
    return Attitude(body_to_ned);
}

std::optional<Attitude> attitude_of_degrees(double roll, double pitch, double yaw) {
    return attitude_of_radians(Angle::degrees(roll).rad(), Angle::degrees(pitch).rad(), Angle::degrees(yaw).rad());
}

std::optional<Attitude> attitude_of_radians(double roll, double pitch, double yaw) {
    if (!std::isfinite(roll) || !std::isfinite(pitch) || !std::isfinite(yaw)) return std::nullopt;
    return Attitude::roll_pitch_yaw(Angle::radians(roll), Angle::radians(pitch), Angle::radians(yaw));
}

std::optional<Nanoseconds> source_nanoseconds(double seconds) {
    constexpr double longest = 200.0 * 365.25 * 86400;
    if (!(std::abs(seconds) <= longest)) return std::nullopt;
    return to_nanoseconds(Seconds(seconds));
}

void report_sample(FeedNews& news, SampleOr sample, std::optional<Nanoseconds> source_time, std::int64_t received_ns) {
    if (!sample) return report_refusal(news, std::move(sample.error()));
    sample->source_time = source_time;
    sample->received_ns = received_ns;
    news.samples.push_back(std::move(*sample));
}

void report_refusal(FeedNews& news, std::string why) {
    if (news.refused++ == 0) news.refusal = std::move(why);
}

void report_remark(FeedNews& news, std::string_view sentence) {
    if (!news.remark.empty()) news.remark += "; ";
    news.remark += sentence;
}

std::optional<double> source_number(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return std::nullopt;
    text = text.substr(first, text.find_last_not_of(blanks) - first + 1);
    if (text.front() == '+') text.remove_prefix(1);
    return number_in<double>(text);
}

std::vector<std::string_view> source_cells(std::string_view line) {
    std::vector<std::string_view> cells;
    for (;;) {
        const std::size_t comma = line.find(',');
        cells.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

std::vector<std::string> SourceLines::feed(ByteSpan bytes) {
    std::vector<std::string> lines;
    for (const std::uint8_t byte : bytes) {
        if (byte == '\n' || byte == '\r') {
            if (!line_.empty() && !too_long_) lines.push_back(std::move(line_));
            line_.clear();
            too_long_ = false;
        } else if (line_.size() < longest_line) {
            line_.push_back(static_cast<char>(byte));
        } else if (!too_long_) {
            too_long_ = true;
            ++thrown_away_;
        }
    }
    return lines;
}

void SourceLines::clear() {
    line_.clear();
    too_long_ = false;
}

std::size_t SourceLines::take_thrown_away() { return std::exchange(thrown_away_, 0); }

}  // namespace skyloop::inline run
