#include "motion/trajectory/speed_profile.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {
namespace {

constexpr int speed_halvings = 100;  // of an interval: the last bit of a double is reached before

}  // namespace

double speed_change_time(double change, const SpeedLimits& limits) {
    const double size = std::abs(change), a = limits.acceleration, j = limits.jerk;
    return size * j >= a * a ? size / a + a / j : 2 * std::sqrt(size / j);
}

double speed_change_length(double from, double to, const SpeedLimits& limits) {
    return (from + to) / 2 * speed_change_time(to - from, limits);
}

double fastest_after(double from, double length, const SpeedLimits& limits) {
    if (from >= limits.speed) return limits.speed;
    double low = from, high = limits.speed;
    if (speed_change_length(from, high, limits) <= length) return high;
    for (int i = 0; i < speed_halvings; ++i) {
        const double middle = (low + high) / 2;
        (speed_change_length(from, middle, limits) <= length ? low : high) = middle;
    }
    return low;
}

void SpeedProfile::add(double seconds, double acceleration, double jerk) {
    if (!(seconds > 0)) return;
    segments_.push_back({ends_, way_, speed_, acceleration, jerk});
    if (std::isfinite(seconds)) {
        way_ += seconds * (speed_ + seconds * (acceleration / 2 + seconds * jerk / 6));
        speed_ += seconds * (acceleration + seconds * jerk / 2);
    } else if (speed_ > 0) {
        way_ = seconds;
    }
    ends_ += seconds;
}

void SpeedProfile::change(double to, const SpeedLimits& limits) {
    const double size = std::abs(to - speed_), sign = to < speed_ ? -1 : 1;
    if (size == 0) return;
    const bool full = size * limits.jerk >= limits.acceleration * limits.acceleration;
    const double ramp = full ? limits.acceleration / limits.jerk : std::sqrt(size / limits.jerk);
    const double jerk = sign * limits.jerk, peak = jerk * ramp;
    const double way = way_ + speed_change_length(speed_, to, limits);
    add(ramp, 0, jerk);
    if (full) add(size / limits.acceleration - ramp, peak, 0);
    add(ramp, peak, -jerk);
    speed_ = to;  // without the rounding of the sums
    way_ = way;
}

void SpeedProfile::keep(double seconds) { add(seconds, 0, 0); }

void SpeedProfile::run(double length, double to, const SpeedLimits& limits) {
    const double end = way_ + length;
    const auto needed = [&](double top) {
        return speed_change_length(speed_, top, limits) + speed_change_length(top, to, limits);
    };
    double low = std::max(speed_, to), high = std::max(limits.speed, low);
    if (needed(high) <= length) {
        low = high;
    } else {
        for (int i = 0; i < speed_halvings; ++i) {
            const double middle = (low + high) / 2;
            (needed(middle) <= length ? low : high) = middle;
        }
    }
    change(low, limits);
    const double rest = end - way_ - speed_change_length(low, to, limits);
    if (low > 0) keep(std::max(0.0, rest) / low);
    change(to, limits);
    way_ = end;
}

AlongWay SpeedProfile::at(double t) const {
    if (segments_.empty() || t <= 0) return {0, segments_.empty() ? speed_ : segments_.front().speed, 0};
    if (t >= ends_) return {way_, speed_, 0};
    const auto after = std::upper_bound(segments_.begin(), segments_.end(), t,
                                        [](double x, const Segment& s) { return x < s.begins; });
    const Segment& s = *std::prev(after);
    const double u = t - s.begins;
    return {s.way + u * (s.speed + u * (s.acceleration / 2 + u * s.jerk / 6)),
            s.speed + u * (s.acceleration + u * s.jerk / 2), s.acceleration + u * s.jerk};
}

}  // namespace skyloop
