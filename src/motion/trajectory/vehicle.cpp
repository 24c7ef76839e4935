#include "motion/trajectory/vehicle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace skyloop::inline motion {

const std::array<VehicleTraits, vehicle_class_count>& vehicle_classes() {
    using Speed = MetresPerSecond;
    constexpr double g = 9.80665;
    const auto deg = [](double value) { return Angle::degrees(value); };
    static const std::array<VehicleTraits, vehicle_class_count> classes{{
        {"fixed", 0.1, Speed(0.5), Speed(0.5), 0.1 * g, Speed(0.5), deg(0), deg(0)},
        {"pedestrian", 1, Speed(10), Speed(3), 0.8 * g, Speed(0.5), deg(180), deg(0)},
        {"car", 3, Speed(70), Speed(15), 1.2 * g, Speed(0.5), deg(90), deg(10)},
        {"rover", 3, Speed(15), Speed(5), 1.0 * g, Speed(0.5), deg(90), deg(10)},
        {"boat", 0.7, Speed(30), Speed(2), 0.6 * g, Speed(0.5), deg(45), deg(30)},
        {"plane", 5, Speed(320), Speed(60), 4 * g, Speed(3), deg(90), deg(60)},
        {"multirotor", 10, Speed(50), Speed(20), 3 * g, Speed(3), deg(90), deg(60)},
        {"balloon", 1, Speed(100), Speed(100), 3 * g, Speed(3), deg(90), deg(0)},
        {"rocket", 100, Speed(3000), Speed(3000), 20 * g, Speed(3), deg(90), deg(90)},
    }};
    return classes;
}

std::array<std::string_view, track_vehicle_count> track_vehicle_names() {
    std::array<std::string_view, track_vehicle_count> names;
    for (std::size_t i = 0; i < names.size(); ++i)
        names[i] = vehicle_classes()[i].name;
    return names;
}

const VehicleTraits& traits_of(VehicleClass vehicle) { return vehicle_classes()[static_cast<std::size_t>(vehicle)]; }

std::optional<VehicleClass> vehicle_class_named(std::string_view name) {
    const auto& classes = vehicle_classes();
    const auto found =
        std::find_if(classes.begin(), classes.end(), [&](const VehicleTraits& traits) { return traits.name == name; });
    if (found == classes.end()) return std::nullopt;
    return static_cast<VehicleClass>(found - classes.begin());
}

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

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double everywhere = 1e9;  // a corner may begin as early as it needs to

// In the order of VehicleClass: along the way, in turns, up and down. A plane's turn is one of 45° bank, rolled into at
// 60° a second; a boat's radius is four lengths of 6 m.
constexpr std::array<VehicleLimits, vehicle_class_count> usual_values{{
    {VehicleClass::fixed, {0.1, 0.1, 0.1}, 0.1, 0, 0, 0, 0, 0.1, 0.1, 90 * degree},
    {VehicleClass::pedestrian, {1.4, 1, 2}, 1, 0, 0, 1, 0, 0.7, 0.7, 45 * degree},
    {VehicleClass::car, {14, 2, 2}, 2.5, 1.5, 6, 25, 0, 3, 3, 15 * degree},
    {VehicleClass::rover, {5, 1.5, 2}, 1.5, 0, 0, 2, 0, 3, 3, 30 * degree},
    {VehicleClass::boat, {6, 0.5, 0.4}, 0.8, 3, 24, everywhere, 0, 0.5, 0.5, 5 * degree},
    {VehicleClass::plane, {20, 2, 1}, 9.81, 0.75, 0, everywhere, 12, 4, 4, 20 * degree},
    {VehicleClass::multirotor, {12, 4, 8}, 4, 0, 0, 10, 0, 5, 3, 90 * degree},
    {VehicleClass::balloon, {30, 1, 1}, 1, 0, 0, 0, 0, 10, 300, 90 * degree},
    {VehicleClass::rocket, {3000, 200, 4000}, 100, 0, 0, 0, 0, 3000, 3000, 90 * degree},
}};

}  // namespace

VehicleLimits usual_limits(VehicleClass kind) { return usual_values.at(static_cast<std::size_t>(kind)); }

}  // namespace skyloop::inline motion
