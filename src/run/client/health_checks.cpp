#include "run/client/health_checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/time/utc_time.hpp"

namespace skyloop::inline run {
namespace {

// 1e-6 degrees are a decimetre: nobody is there, and receivers that have no place tell exactly this one.
constexpr double nowhere_deg = 1e-6;

std::optional<std::string> doubt_accuracy(const HeardSolution& s, const HealthLimits& limits) {
    if (s.horizontal_accuracy_m && *s.horizontal_accuracy_m > limits.horizontal_accuracy_m)
        return fmt::format("horizontal accuracy {:.1f} m", *s.horizontal_accuracy_m);
    if (s.vertical_accuracy_m && *s.vertical_accuracy_m > limits.vertical_accuracy_m)
        return fmt::format("vertical accuracy {:.1f} m", *s.vertical_accuracy_m);
    if (s.speed_accuracy_mps && *s.speed_accuracy_mps > limits.speed_accuracy_mps)
        return fmt::format("speed accuracy {:.1f} m/s", *s.speed_accuracy_mps);
    if (s.hdop && *s.hdop > limits.hdop) return fmt::format("HDOP {:.1f}", *s.hdop);
    return std::nullopt;
}

}  // namespace

HeardSolution heard_solution(const ObservedEpoch& epoch, GpsTime heard) {
    HeardSolution s;
    s.heard = heard;
    s.valid = epoch.type >= FixType::fix_2d && epoch.type <= FixType::rtk_fixed;
    s.three_dimensional = epoch.type > FixType::fix_2d && epoch.type <= FixType::rtk_fixed;
    s.satellites = epoch.satellites_used.value_or(0);
    const ObservedMotion& motion = epoch.motion;
    s.has_place = epoch.place || motion.latitude;
    if (epoch.place) {
        s.latitude_deg = epoch.place->latitude.deg();
        s.longitude_deg = epoch.place->longitude.deg();
        s.height_m = epoch.place->height.above_ellipsoid.value();
    } else if (motion.latitude) {
        s.latitude_deg = motion.latitude->deg();
        s.longitude_deg = motion.longitude->deg();
    }
    if (motion.altitude) s.height_m = motion.altitude->value();
    if (epoch.horizontal_accuracy) s.horizontal_accuracy_m = epoch.horizontal_accuracy->value();
    if (epoch.vertical_accuracy) s.vertical_accuracy_m = epoch.vertical_accuracy->value();
    if (epoch.speed_accuracy) s.speed_accuracy_mps = epoch.speed_accuracy->value();
    s.hdop = epoch.hdop;
    s.has_vertical_velocity = epoch.velocity.has_value();
    // Receivers leave the course empty when they stand: then the speed has no direction and hardly a size.
    const double course = motion.course ? motion.course->rad() : 0;
    if (epoch.velocity)
        s.velocity_mps = {epoch.velocity->north, epoch.velocity->east, epoch.velocity->down};
    else if (motion.ground_speed)
        s.velocity_mps = {motion.ground_speed->value() * std::cos(course),
                          motion.ground_speed->value() * std::sin(course), 0};
    s.utc_s = epoch.utc_s;
    return s;
}

std::optional<std::string> doubt_fix(const HeardSolution& s, const HealthLimits& limits) {
    if (!s.valid) return "no fix";
    if (!s.has_place) return "a fix without a position";
    if (!s.three_dimensional) return "no 3D fix";
    if (std::abs(s.latitude_deg) < nowhere_deg && std::abs(s.longitude_deg) < nowhere_deg)
        return "a fix at latitude 0, longitude 0";
    if (s.satellites < limits.satellites) return fmt::format("{} satellites used", s.satellites);
    return doubt_accuracy(s, limits);
}

std::optional<std::string> HealthChecks::doubt(const HeardSolution& solution) {
    // Each of them has to see every solution.
    auto fix = doubt_fix(solution, limits_);
    auto time = time_.doubt(solution, limits_);
    auto motion = motion_.doubt(solution, limits_);
    if (fix) return fix;
    return time ? time : motion;
}

namespace {

// Metres of a degree of latitude on a sphere of the mean radius 6371 km: 0.5 % wrong at most, in differences of both
// sides alike.
constexpr double metres_per_degree = 6'371'000 * std::numbers::pi / 180;
constexpr double longest_gap_s = 1.5;  // velocities are not carried over longer gaps
constexpr double accuracies = 5;       // σ of the difference of two positions, √2 · 3.5
constexpr double least_horizontal_m = 1, least_vertical_m = 2;
// Where a protocol tells no accuracy: 2.5 m of range error times HDOP; heights are twice as bad.
constexpr double range_error_m = 2.5;

double horizontal_sigma(const HeardSolution& s) {
    return s.horizontal_accuracy_m.value_or(range_error_m * s.hdop.value_or(1));
}

bool is_same_place(const HeardSolution& a, const HeardSolution& b) {
    return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg && a.height_m == b.height_m;
}

double speed_between(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

void MotionChecks::begin_anew(const HeardSolution& s) {
    window_.clear();
    moved_north_m_ = moved_east_m_ = moved_down_m_ = 0;
    origin_latitude_deg_ = s.latitude_deg;
    origin_longitude_deg_ = s.longitude_deg;
    origin_height_m_ = s.height_m.value_or(0);
    same_since_ = s.heard;
}

std::optional<std::string> MotionChecks::doubt(const HeardSolution& s, const HealthLimits& limits) {
    if (!s.valid || !s.has_place || !s.velocity_mps) {
        last_.reset();
        return std::nullopt;
    }
    if (!last_ || s.heard - last_->heard > to_nanoseconds(Seconds(longest_gap_s))) {
        begin_anew(s);
        last_ = s;
    }
    auto step = doubt_step(s, limits);
    auto window = doubt_window(s, limits);
    last_ = s;
    return step ? step : window;
}

std::optional<std::string> MotionChecks::doubt_step(const HeardSolution& s, const HealthLimits& limits) {
    if (!is_same_place(s, *last_)) same_since_ = s.heard;
    const auto& v = *s.velocity_mps;
    const double speed = std::hypot(v[0], v[1]);
    if (speed > limits.frozen_speed_mps && s.heard - same_since_ > to_nanoseconds(Seconds(limits.frozen_s)))
        return fmt::format("the position stands still at {:.1f} m/s", speed);
    const double passed = difference(s.heard, last_->heard).value();
    const double change = speed_between(v, *last_->velocity_mps);
    // A tenth of a second is the shortest period of these clients' epochs; bursts after a stall come closer.
    if (change > limits.acceleration_mps2 * std::max(passed, 0.1))
        return fmt::format("the velocity changed by {:.0f} m/s in {:.1f} s", change, passed);
    return std::nullopt;
}

std::optional<std::string> MotionChecks::doubt_window(const HeardSolution& s, const HealthLimits& limits) {
    // Velocities belong to the told times, not to those at which messages happened to arrive.
    const double passed = s.seconds && last_->seconds ? wrapped_difference(*s.seconds, *last_->seconds, s.seconds_wrap)
                                                      : difference(s.heard, last_->heard).value();
    const double dt = std::abs(passed) < longest_gap_s ? passed : 0;
    const auto& now = *s.velocity_mps;
    const auto& before = *last_->velocity_mps;
    moved_north_m_ += 0.5 * (now[0] + before[0]) * dt;
    moved_east_m_ += 0.5 * (now[1] + before[1]) * dt;
    moved_down_m_ += 0.5 * (now[2] + before[2]) * dt;
    const double cosine = std::cos(origin_latitude_deg_ * std::numbers::pi / 180);
    const Sample sample{
        s.heard, (s.latitude_deg - origin_latitude_deg_) * metres_per_degree - moved_north_m_,
        wrapped_difference(s.longitude_deg, origin_longitude_deg_, 360) * metres_per_degree * cosine - moved_east_m_,
        origin_height_m_ - s.height_m.value_or(0) - moved_down_m_};
    while (!window_.empty() && s.heard - window_.front().heard > to_nanoseconds(Seconds(limits.consistency_window_s)))
        window_.pop_front();
    double across = 0, down = 0;
    for (const Sample& old : window_) {
        across = std::max(across, std::hypot(sample.north_m - old.north_m, sample.east_m - old.east_m));
        down = std::max(down, std::abs(sample.down_m - old.down_m));
    }
    window_.push_back(sample);
    const double sigma = horizontal_sigma(s);
    if (across > least_horizontal_m + accuracies * sigma)
        return fmt::format("positions moved {:.1f} m that velocities do not tell of", across);
    if (s.has_vertical_velocity && down > least_vertical_m + accuracies * s.vertical_accuracy_m.value_or(2 * sigma))
        return fmt::format("heights moved {:.1f} m that velocities do not tell of", down);
    return std::nullopt;
}

namespace {

constexpr double gps_epoch_in_unix_s = gps_epoch_posix_s;
constexpr double week_s = 604800;
constexpr double same_epoch_s = 1e-4;  // UBX tells time of week in milliseconds
constexpr int repeats_allowed = 2;     // a message that a wire brings twice is no harm
constexpr double learning_s = 3;       // the least lag of so long is the base of later ones
constexpr double longest_lag_s = 30;   // beyond it is not lateness but another time
constexpr double even_s = 0.05;        // a deviation that stays within this is even
constexpr double calendar_slack_s = 0.6;

double clock_seconds(const HeardSolution& s) {
    return to_seconds(s.heard.time_since_epoch() %
                      Nanoseconds(std::chrono::seconds(static_cast<std::int64_t>(s.seconds_wrap))))
        .value();
}

// A solution of before a leap second may be heard after it.
bool has_leap(double told_s, GpsTime heard) {
    const LeapSeconds& announced = LeapSeconds::announced();
    return std::abs(told_s - announced.offset(heard)) <= calendar_slack_s ||
           std::abs(told_s - announced.offset(heard - std::chrono::seconds(1))) <= calendar_slack_s;
}

std::optional<std::string> doubt_calendar(const HeardSolution& s, const HealthLimits& limits) {
    if (!s.utc_s) return std::nullopt;
    const int leap_seconds = LeapSeconds::announced().offset(s.heard);
    if (*s.utc_s < limits.oldest_utc_s) return "a date before this client was made";
    if (s.counts_gps_weeks && s.seconds) {
        const double leap = wrapped_difference(*s.seconds, std::fmod(*s.utc_s - gps_epoch_in_unix_s, week_s), week_s);
        if (!has_leap(leap, s.heard))
            return fmt::format("UTC lies {:.0f} s behind GPS time, not {} s", leap, leap_seconds);
    }
    if (s.gps_s && std::abs(*s.gps_s - (*s.utc_s - gps_epoch_in_unix_s) - leap_seconds) > limits.time_jump_s)
        return "week number and date disagree";
    return std::nullopt;
}

}  // namespace

HealthLimits HealthLimits::made_before(GpsTime switched_on) {
    constexpr double year_s = 365.25 * 86400;
    HealthLimits limits;
    limits.oldest_utc_s = to_seconds(switched_on.time_since_epoch()).value() + gps_epoch_in_unix_s - year_s;
    return limits;
}

double wrapped_difference(double a, double b, double wrap) { return std::remainder(a - b, wrap); }

void TimeChecks::forget() {
    lag_since_.reset();
    off_since_.reset();
}

std::optional<std::string> TimeChecks::doubt(const HeardSolution& solution, const HealthLimits& limits) {
    if (!solution.seconds) return "no time";
    auto order = doubt_order(solution);
    auto lag = doubt_lag(solution, limits);
    auto calendar = doubt_calendar(solution, limits);
    last_ = solution;
    if (order) return order;
    return calendar ? calendar : lag;
}

std::optional<std::string> TimeChecks::doubt_order(const HeardSolution& s) {
    if (!last_ || !last_->seconds) return std::nullopt;
    const double told = wrapped_difference(*s.seconds, *last_->seconds, s.seconds_wrap);
    repeated_ = std::abs(told) < same_epoch_s ? repeated_ + 1 : 0;
    if (repeated_ > repeats_allowed) return "the time stands still";
    if (told < -same_epoch_s) return fmt::format("the time went back by {:.1f} s", -told);
    if (s.gps_s && last_->gps_s && std::abs(*s.gps_s - *last_->gps_s) > week_s / 2)
        return "the week number does not follow the time of week";
    return std::nullopt;
}

std::optional<std::string> TimeChecks::doubt_lag(const HeardSolution& s, const HealthLimits& limits) {
    const double offset = wrapped_difference(clock_seconds(s), *s.seconds, s.seconds_wrap);
    if (!lag_since_) {
        lag_since_ = s.heard;
        base_ = offset;
    }
    const double later = wrapped_difference(offset, base_, s.seconds_wrap);
    if (difference(s.heard, *lag_since_).value() < learning_s) {
        if (later < 0 && later > -limits.time_jump_s) base_ = offset;
        if (std::abs(later) < limits.time_jump_s) return std::nullopt;
    }
    const bool late = later > limits.late_s && later < longest_lag_s;
    const bool off = later < -limits.early_s || later >= longest_lag_s;
    if (!off) off_since_.reset();
    if (late) return fmt::format("solutions come {:.2f} s later than at first", later);
    if (!off) return std::nullopt;
    if (!off_since_ || std::abs(wrapped_difference(offset, off_by_, s.seconds_wrap)) > even_s) {
        off_since_ = s.heard;
        off_by_ = offset;
    }
    if (difference(s.heard, *off_since_).value() > limits.settled_s) {
        forget();
        return std::nullopt;
    }
    return fmt::format("the receiver's time is {:.2f} s off what our clock expects", -later);
}

}  // namespace skyloop::inline run
