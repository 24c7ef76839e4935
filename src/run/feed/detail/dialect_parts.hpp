// The dialects, one maker each; listed by name in feed_dialect.cpp.
// What the sources have in common: their statements, put into our frames and heights.
// What dialects of lines have in common: bytes into lines, and what is bad among them.
// When what a receiver says of one epoch is whole.
#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "run/feed/feed_dialect.hpp"

namespace skyloop::inline run {

std::unique_ptr<FeedDialect> make_ardupilot_json_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_betaflight_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_flightgear_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_flightgear_generic_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_gpsd_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_jsbsim_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_json_dialect(const FeedContext& context);  // skyloop-truth/1
std::unique_ptr<FeedDialect> make_mavlink_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_nmea_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_px4_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_ubx_dialect(const FeedContext& context);
std::unique_ptr<FeedDialect> make_xplane_dialect(const FeedContext& context);

inline constexpr double metres_per_foot = 0.3048;

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

inline constexpr std::array<std::uint8_t, 1> line_end{'\n'};

// A source that speaks in lines of text.
class LineSource : public FeedDialect {
public:
    explicit LineSource(const FeedContext& context) : context_(context) {}

    FeedNews hear(ByteSpan bytes, std::int64_t received_ns) override {
        FeedNews news;
        for (const std::string& line : lines_.feed(bytes))
            take(line, received_ns, news);
        if (context_.datagrams)
            for (const std::string& line : lines_.feed(line_end))
                take(line, received_ns, news);
        if (lines_.take_thrown_away() > 0) report_refusal(news, "a line of more than 65536 bytes");
        return news;
    }
    void reconnected() override { lines_.clear(); }

protected:
    virtual void take(const std::string& line, std::int64_t received_ns, FeedNews& news) = 0;
    [[nodiscard]] const FeedContext& context() const { return context_; }

private:
    FeedContext context_;
    SourceLines lines_;
};

// An epoch's messages come one after the other and none says that it is the last. An epoch is whole when every kind of
// message has come that the one before had, so that nobody waits for the next; the first is whole when the second
// begins. Kinds are bits.
class EpochGate {
public:
    EpochGate() = default;
    // @param expected of the first epoch, which then is whole by it
    explicit EpochGate(unsigned expected) : expected_(expected) {}
    // Another message of the epoch. @return the epoch has become whole by it
    bool take(unsigned kind) {
        seen_ |= kind;
        const bool whole = expected_ != 0 && (seen_ & expected_) == expected_;
        return whole && !std::exchange(done_, true);
    }
    // The next epoch begins. @return the one before had messages and never became whole
    bool next() {
        const bool left = seen_ != 0 && !done_;
        if (seen_ != 0) expected_ = seen_;
        seen_ = 0;
        done_ = false;
        return left;
    }

private:
    unsigned seen_ = 0, expected_ = 0;
    bool done_ = false;
};

}  // namespace skyloop::inline run
