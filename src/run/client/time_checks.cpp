#include <fmt/format.h>

#include <cmath>

#include "base/time/utc_time.hpp"
#include "run/client/health_checks.hpp"

namespace skyloop {
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

}  // namespace skyloop
