// What the sources have in common: their statements, put into our frames and heights.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "run/feed/feed_dialect.hpp"

namespace skyloop {

// A pose in latitude and longitude, as most sources tell it.
struct SourcePose {
    double latitude_deg = 0, longitude_deg = 0;
    double height_m = 0;
    bool above_ellipsoid = false;                   // the height; else above the sea, which FeedContext explains
    std::optional<Eigen::Vector3d> velocity_ned{};  // m/s
    std::optional<Attitude> attitude{};
    std::optional<Eigen::Vector3d> turn_rate{};  // body axes, rad/s
};

// A pose in metres from FeedContext::origin.
struct LocalPose {
    Eigen::Vector3d ned = Eigen::Vector3d::Zero();
    std::optional<Eigen::Vector3d> velocity_ned{};  // m/s, along the axes of LocalMap
    std::optional<Attitude> attitude{};             // against the same axes
    std::optional<Eigen::Vector3d> turn_rate{};     // body axes, rad/s
};

// A sample, or a sentence that says why the pose cannot be one.
using SampleOr = tl::expected<TruthSample, std::string>;

// Refuses what is not finite, no place near the Earth, faster than 12 km/s, or 0° N 0° E, which is what vehicles say
// that know no place (FEEDS.md 3.1).
SampleOr sample_of(const SourcePose& pose, const FeedContext& context);
// The same, `native` being the map that the source is known for; refuses without an origin.
SampleOr sample_of(const LocalPose& pose, LocalMap native, const FeedContext& context);

// An attitude of a quaternion body (forward, right, down) to north, east, down; nothing unless its length is 1 ± 0.05.
std::optional<Attitude> attitude_of_quaternion(double w, double x, double y, double z);
// Nothing unless all are finite. Yaw clockwise from true north.
std::optional<Attitude> attitude_of_degrees(double roll, double pitch, double yaw);
std::optional<Attitude> attitude_of_radians(double roll, double pitch, double yaw);

// Nanoseconds of a time in seconds; nothing when it is not finite or beyond 200 years.
std::optional<Nanoseconds> source_nanoseconds(double seconds);

// Adds a sample that came at `received_ns`, or counts why it is none.
void report_sample(FeedNews& news, SampleOr sample, std::optional<Nanoseconds> source_time, std::int64_t received_ns);
void report_refusal(FeedNews& news, std::string why);
// Adds what the user should be told.
void report_remark(FeedNews& news, std::string_view sentence);

// A number of a text, blanks around it left out; nothing when anything else is there or it is not finite.
std::optional<double> source_number(std::string_view text);
// The cells between commas.
std::vector<std::string_view> source_cells(std::string_view line);

// Cuts a stream into lines; a datagram that ends without a line end goes on in the next. A line that grows beyond 64
// KiB is thrown away, up to its end.
class SourceLines {
public:
    // The lines that `bytes` completes, without their ends; empty ones are left out.
    std::vector<std::string> feed(ByteSpan bytes);
    void clear();
    // Lines thrown away since this was asked.
    std::size_t take_thrown_away();

private:
    std::string line_;
    bool too_long_ = false;
    std::size_t thrown_away_ = 0;
};

}  // namespace skyloop
