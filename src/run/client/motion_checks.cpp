#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "run/client/health_checks.hpp"

namespace skyloop {
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

}  // namespace skyloop
