#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "detail/knot_curve.hpp"
#include "detail/smooth_step.hpp"
#include "motion/trajectory/generated_path.hpp"
#include "motion/trajectory/shaped_path.hpp"

namespace skyloop::inline motion {
namespace {

constexpr double rocket_g = 9.80665;          // m/s²
constexpr double rocket_scale_height = 8500;  // m
constexpr double longest_flight_s = 2 * 3600, highest_m = 1e6;

// The motion up and down, by Runge and Kutta's method of the fourth order in steps of 1 ms, of 10 ms in calm flight.
class RocketFlight {
public:
    explicit RocketFlight(const RocketWish& wish) : wish_(wish), height_(wish.pad.z()) {}
    PathPlanResult fly();

private:
    struct Slope {
        double height, speed;
    };
    [[nodiscard]] double thrust(double t) const;
    [[nodiscard]] double drag(double t, double speed) const;
    [[nodiscard]] double acceleration(double t, double height, double speed) const;
    [[nodiscard]] bool calm() const;
    void step(double h);
    void open_parachutes();
    [[nodiscard]] LocalMotion motion() const;

    RocketWish wish_;
    double t_ = 0, height_, speed_ = 0;
    std::optional<double> drogue_at_, main_at_;  // s
};

constexpr double ignition_s = 0.1, opening_s = 1;

double RocketFlight::thrust(double t) const {
    return wish_.boost * (smooth_step(t / ignition_s).value - smooth_step((t - wish_.burn) / ignition_s).value);
}

// By speed², at sea level, 1/m.
double RocketFlight::drag(double t, double speed) const {
    const double drogue = rocket_g / (wish_.drogue * wish_.drogue), main = rocket_g / (wish_.main * wish_.main);
    double whole = wish_.drag;
    if (drogue_at_) whole += smooth_step((t - *drogue_at_) / opening_s).value * (drogue - wish_.drag);
    if (main_at_) whole += smooth_step((t - *main_at_) / opening_s).value * (main - drogue);
    return whole * speed * std::abs(speed);
}

double RocketFlight::acceleration(double t, double height, double speed) const {
    const double free = thrust(t) - rocket_g - drag(t, speed) * std::exp(-height / rocket_scale_height);
    // The pad carries it until the thrust does.
    return height <= wish_.pad.z() && speed <= 0 && !drogue_at_ ? std::max(0.0, free) : free;
}

// Neither motor nor parachute is about to change, and the air changes slowly.
bool RocketFlight::calm() const {
    constexpr double thin_air_m = 60000;
    if (!drogue_at_) return t_ > wish_.burn + 1 && height_ > thin_air_m && speed_ > 10;
    if (t_ < *drogue_at_ + 3 * opening_s) return false;
    if (main_at_) return t_ > *main_at_ + 3 * opening_s;
    return height_ - wish_.pad.z() > wish_.main_below + 2 * std::abs(speed_);
}

void RocketFlight::step(double h) {
    const auto slope = [&](double after, const Slope& s) {
        const double speed = speed_ + after * s.speed;
        return Slope{speed, acceleration(t_ + after, height_ + after * s.height, speed)};
    };
    const Slope k1 = slope(0, {}), k2 = slope(h / 2, k1), k3 = slope(h / 2, k2), k4 = slope(h, k3);
    height_ += h / 6 * (k1.height + 2 * k2.height + 2 * k3.height + k4.height);
    speed_ += h / 6 * (k1.speed + 2 * k2.speed + 2 * k3.speed + k4.speed);
    t_ += h;
}

void RocketFlight::open_parachutes() {
    if (!drogue_at_ && t_ > wish_.burn && speed_ <= 0) drogue_at_ = t_;
    if (drogue_at_ && !main_at_ && t_ > *drogue_at_ + opening_s && height_ - wish_.pad.z() < wish_.main_below)
        main_at_ = t_;
}

LocalMotion RocketFlight::motion() const {
    LocalMotion m;
    m.position = {wish_.pad.x(), wish_.pad.y(), height_};
    m.velocity.z() = speed_;
    m.acceleration.z() = acceleration(t_, height_, speed_);
    m.heading = wish_.heading;
    return m;
}

PathPlanResult RocketFlight::fly() {
    constexpr long steps_between_knots = 20;
    constexpr double touchdown_s = 2;
    const auto curve = std::make_shared<KnotCurve>(motion());
    double top = height_, fastest = 0;
    // A smooth end: from its speed to rest within 2 s, which takes half the way that it would go at that speed.
    const auto lands = [&] { return drogue_at_ && height_ - wish_.pad.z() <= touchdown_s / 2 * std::abs(speed_); };
    for (long steps = 1; !lands(); ++steps) {
        if (t_ > longest_flight_s || height_ > highest_m)
            return tl::unexpected(
                fmt::format("the rocket flies longer than {:.0f} s or higher than {:.0f} m; expected "
                            "less thrust, a shorter burn or faster parachutes",
                            longest_flight_s, highest_m));
        step(calm() ? 1e-2 : 1e-3);
        open_parachutes();
        if (steps % steps_between_knots == 0) curve->add(t_, motion());
        top = std::max(top, height_);
        fastest = std::max(fastest, std::abs(speed_));
    }
    if (curve->duration() < t_) curve->add(t_, motion());
    LocalMotion rest;
    rest.position = wish_.pad;
    rest.heading = wish_.heading;
    curve->add(t_ + touchdown_s, rest);
    if (top - wish_.pad.z() < 1)
        return tl::unexpected(
            fmt::format("a thrust of {:g} m/s² for {:g} s does not lift the rocket; expected boost_mps2 "
                        "above {:.3g}",
                        wish_.boost, wish_.burn, rocket_g));
    return PathPlan{
        curve, {}, fmt::format("rocket, {:.0f} m above its pad, {:.0f} m/s at most", top - wish_.pad.z(), fastest)};
}

}  // namespace

PathPlanResult plan_rocket(const RocketWish& wish) { return RocketFlight(wish).fly(); }

bool choose_rocket(RocketWish& wish, std::string_view preset) {
    if (preset == "rocket_1km") {
        wish.boost = 70, wish.burn = 2.5, wish.drag = 4e-4;
    } else if (preset == "rocket_30km_M3") {
        wish.boost = 150, wish.burn = 10.8, wish.drag = 1.5e-4;
    } else {
        return false;
    }
    return true;
}

namespace {

constexpr double balloon_scale_height = 7500;  // m
constexpr double east_wind = std::numbers::pi / 2;
constexpr std::array<WindLayer, 6> winds_by_height{{{0, 3, east_wind},
                                                    {5000, 12, east_wind},
                                                    {11000, 25, east_wind},
                                                    {18000, 10, east_wind},
                                                    {25000, 8, east_wind},
                                                    {35000, 15, east_wind}}};

// East and north as cubic functions of the height, with the slopes of the layers around.
class WindColumn {
public:
    explicit WindColumn(std::span<const WindLayer> layers) {
        for (const WindLayer& layer : layers)
            knots_.push_back({layer.height, layer.speed * Eigen::Vector2d(std::sin(layer.to), std::cos(layer.to)),
                              Eigen::Vector2d::Zero()});
        for (std::size_t i = 1; i + 1 < knots_.size(); ++i)
            knots_[i].slope = (knots_[i + 1].wind - knots_[i - 1].wind) / (knots_[i + 1].height - knots_[i - 1].height);
    }
    [[nodiscard]] Eigen::Vector2d at(double height) const {
        const auto above = std::upper_bound(knots_.begin(), knots_.end(), height,
                                            [](double value, const Knot& knot) { return value < knot.height; });
        if (above == knots_.begin()) return knots_.front().wind;
        if (above == knots_.end()) return knots_.back().wind;
        const Knot &a = *std::prev(above), &b = *above;
        const double h = b.height - a.height, u = (height - a.height) / h;
        return (1 + 2 * u) * (1 - u) * (1 - u) * a.wind + u * (1 - u) * (1 - u) * h * a.slope +
               u * u * (3 - 2 * u) * b.wind - u * u * (1 - u) * h * b.slope;
    }

private:
    struct Knot {
        double height;
        Eigen::Vector2d wind, slope;
    };
    std::vector<Knot> knots_;
};

class BalloonFlight {
public:
    explicit BalloonFlight(const BalloonWish& wish)
        : wish_(wish),
          winds_(wish.winds.empty() ? usual_winds() : std::span<const WindLayer>(wish.winds)),
          position_(wish.place) {}
    PathPlanResult fly();

private:
    static constexpr double start_s = 5, burst_s = 3, landing_s = 2;
    [[nodiscard]] Eigen::Vector3d velocity(double t, const Eigen::Vector3d& position) const;
    [[nodiscard]] LocalMotion motion() const;
    void step(double h);

    BalloonWish wish_;
    WindColumn winds_;
    double t_ = 0, burst_at_ = std::numeric_limits<double>::infinity();
    Eigen::Vector3d position_;
};

// It goes with the wind as soon as it has left the ground; before that it stands.
Eigen::Vector3d BalloonFlight::velocity(double t, const Eigen::Vector3d& position) const {
    const double begun = smooth_step(t / start_s).value, fallen = smooth_step((t - burst_at_) / burst_s).value;
    Eigen::Vector3d v;
    v << begun * winds_.at(position.z()),
        begun * ((1 - fallen) * wish_.ascent -
                 fallen * wish_.descent * std::exp(position.z() / (2 * balloon_scale_height)));
    return v;
}

LocalMotion BalloonFlight::motion() const {
    constexpr double step_s = 1e-3;
    LocalMotion m;
    m.position = position_;
    m.velocity = velocity(t_, position_);
    m.acceleration = (velocity(t_ + step_s, position_ + step_s * m.velocity) -
                      velocity(t_ - step_s, position_ - step_s * m.velocity)) /
                     (2 * step_s);
    m.heading = wish_.heading;
    return m;
}

void BalloonFlight::step(double h) {
    const Eigen::Vector3d k1 = velocity(t_, position_), k2 = velocity(t_ + h / 2, position_ + h / 2 * k1),
                          k3 = velocity(t_ + h / 2, position_ + h / 2 * k2), k4 = velocity(t_ + h, position_ + h * k3);
    position_ += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    t_ += h;
}

PathPlanResult BalloonFlight::fly() {
    const double ground = wish_.place.z();
    if (wish_.burst < ground + 2 * start_s * wish_.ascent)
        return tl::unexpected(fmt::format("bursts at {:g} m, and starts at {:.0f} m; expected at least {:.0f}",
                                          wish_.burst, ground, ground + 2 * start_s * wish_.ascent));
    LocalMotion rest;
    rest.position = wish_.place;
    rest.heading = wish_.heading;
    const auto curve = std::make_shared<KnotCurve>(rest);
    for (;;) {
        const double since_burst = t_ - burst_at_;
        const bool busy = t_ < start_s || (since_burst >= -1 && since_burst < burst_s + 1);
        step(busy ? 0.05 : 0.5);
        if (position_.z() >= wish_.burst && std::isinf(burst_at_)) burst_at_ = t_;
        const LocalMotion now = motion();
        curve->add(t_, now);
        // From the origin of its plane, the first place of the path, as places are.
        if (position_.head<2>().norm() > GeodesicPlane::farthest_m)
            return tl::unexpected(
                fmt::format("the wind takes the balloon {:.0f} km away, farther than which no path leads, after {:.0f} "
                            "s at {:.0f} m; "
                            "expected less wind, a lower burst, or a faster ascent or descent",
                            GeodesicPlane::farthest_m / 1000, t_, position_.z()));
        if (t_ > burst_at_ + burst_s && position_.z() - ground <= landing_s / 2 * std::abs(now.velocity.z())) break;
    }
    const LocalMotion last = curve->end();
    rest.position = last.position + landing_s / 2 * last.velocity;
    rest.position.z() = ground;
    curve->add(t_ + landing_s, rest);
    const double drift = (rest.position - wish_.place).head<2>().norm();
    return PathPlan{curve,
                    {},
                    fmt::format("balloon, bursts at {:.0f} m after {:.0f} s, lands {:.1f} km away", wish_.burst,
                                burst_at_, drift / 1000)};
}

}  // namespace

std::span<const WindLayer> usual_winds() { return winds_by_height; }

PathPlanResult plan_balloon(const BalloonWish& wish) { return BalloonFlight(wish).fly(); }

bool choose_balloon(BalloonWish& wish, std::string_view preset) {
    if (preset != "balloon_32km") return false;
    wish.ascent = 5, wish.burst = 32000, wish.descent = 6;
    return true;
}

}  // namespace skyloop::inline motion
