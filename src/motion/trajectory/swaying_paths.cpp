#include "motion/trajectory/generated_path.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "base/core/random.hpp"
#include "detail/smooth_step.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop::inline motion {
namespace {

constexpr double swing_g = 9.80665;  // m/s²
constexpr double fade_in_s = 5;      // from rest to the whole motion

// A sum of sines; value and two derivatives.
struct Swing {
    double value = 0, slope = 0, bend = 0;
};

struct Tone {
    double amplitude = 0, rate = 0, phase = 0;  // rad/s, rad
    void add_to(Swing& swing, double t, double lead = 0) const {
        const double angle = rate * t + phase + lead;
        swing.value += amplitude * std::sin(angle);
        swing.slope += amplitude * rate * std::cos(angle);
        swing.bend -= amplitude * rate * rate * std::sin(angle);
    }
};

// The swing as it grows from nothing.
Swing faded_in(const Swing& s, double t) {
    const SmoothStep f = smooth_step(t / fade_in_s);
    const double slope = f.slope / fade_in_s, bend = f.bend / (fade_in_s * fade_in_s);
    return {f.value * s.value, f.value * s.slope + slope * s.value,
            f.value * s.bend + 2 * slope * s.slope + bend * s.value};
}

template <std::size_t count>
Swing sum_of(const std::array<Tone, count>& tones, double t, double lead = 0) {
    Swing swing;
    for (const Tone& tone : tones)
        tone.add_to(swing, t, lead);
    return swing;
}

template <std::size_t count>
void scale_to_rms(std::array<Tone, count>& tones, double rms) {
    double power = 0;
    for (const Tone& tone : tones)
        power += tone.amplitude * tone.amplitude / 2;
    for (Tone& tone : tones)
        tone.amplitude *= rms / std::sqrt(power);
}

double random_phase(RandomStream& stream) { return stream.uniform() * 2 * std::numbers::pi; }

class HoverShape : public LocalShape {
public:
    explicit HoverShape(const HoverWish& wish) : wish_(wish) {
        constexpr double slowest_hz = 0.05, fastest_hz = 0.8, fall = -5.0 / 6;
        RandomStream stream(wish.seed, "path.hover");
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < tones_[axis].size(); ++i) {
                const double part = static_cast<double>(i) / (static_cast<double>(tones_[axis].size()) - 1);
                const double frequency = slowest_hz * std::pow(fastest_hz / slowest_hz, part);
                tones_[axis][i] = {std::pow(frequency, fall), 2 * std::numbers::pi * frequency, random_phase(stream)};
            }
            scale_to_rms(tones_[axis], axis == 2 ? wish.sway / 2 : wish.sway);
        }
    }
    [[nodiscard]] double duration() const override { return endless; }
    [[nodiscard]] LocalMotion at(double t) const override {
        // Drag against weight: the lean of a small multirotor, 5.7° at 10 m/s, grows with the square of the wind.
        constexpr double lean_per_wind2 = 0.001;
        LocalMotion m;
        t = std::max(t, 0.0);
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            const Swing swing = faded_in(sum_of(tones_[static_cast<std::size_t>(axis)], t), t);
            m.position(axis) = wish_.place(axis) + swing.value;
            m.velocity(axis) = swing.slope;
            m.acceleration(axis) = swing.bend;
        }
        m.heading = wish_.heading;
        const double lean = std::atan(lean_per_wind2 * wish_.wind * wish_.wind);
        const double from = wish_.wind_from - wish_.heading;
        m.pitch = -lean * std::cos(from);
        m.roll = lean * std::sin(from);
        return m;
    }

private:
    HoverWish wish_;
    std::array<std::array<Tone, 6>, 3> tones_;
};

class FloatShape : public LocalShape {
public:
    explicit FloatShape(const FloatWish& wish) : wish_(wish) {
        RandomStream stream(wish.seed, "path.float");
        for (std::size_t i = 0; i < waves_.size(); ++i) {
            constexpr double spread = 0.15;  // between two tones, of the main frequency
            const double step = static_cast<double>(i) - 2;
            const double rate = 2 * std::numbers::pi / wish.wave_period * (1 + spread * step);
            waves_[i] = {std::exp(-step * step / 2), rate, random_phase(stream)};
        }
        scale_to_rms(waves_, wish.wave_height / 4);
        yaw_ = {2 * std::numbers::pi / 180, 2 * std::numbers::pi / (7 * wish.wave_period), random_phase(stream)};
        constexpr SpeedLimits gently{0, 0.3, 0.2};
        headway_.change(wish.speed, gently);
        drift_.change(wish.current, gently);
        headway_.keep(endless);
        drift_.keep(endless);
    }
    [[nodiscard]] double duration() const override { return endless; }
    [[nodiscard]] LocalMotion at(double t) const override;

private:
    FloatWish wish_;
    std::array<Tone, 5> waves_;
    Tone yaw_;
    SpeedProfile headway_, drift_;
};

LocalMotion FloatShape::at(double t) const {
    t = std::max(t, 0.0);
    LocalMotion m;
    m.position = wish_.place;
    const auto add = [&](const Eigen::Vector3d& direction, const AlongWay& along) {
        m.position += along.way * direction;
        m.velocity += along.speed * direction;
        m.acceleration += along.acceleration * direction;
    };
    const auto toward = [](double azimuth) { return Eigen::Vector3d(std::sin(azimuth), std::cos(azimuth), 0); };
    add(toward(wish_.heading), headway_.at(t));
    add(toward(wish_.current_to), drift_.at(t));
    const Swing heave = faded_in(sum_of(waves_, t), t);
    const Swing surge = faded_in(sum_of(waves_, t, std::numbers::pi / 2), t);
    add(Eigen::Vector3d::UnitZ(), {heave.value, heave.slope, heave.bend});
    add(toward(wish_.wave_from), {surge.value, surge.slope, surge.bend});
    Swing slope, yaw;
    for (const Tone& wave : waves_) {
        // The wave number on deep water: ω² / g.
        const Tone steep{wave.amplitude * wave.rate * wave.rate / swing_g, wave.rate, wave.phase};
        steep.add_to(slope, t, std::numbers::pi / 2);
    }
    yaw_.add_to(yaw, t);
    const double tilt = faded_in(slope, t).value, from = wish_.wave_from - wish_.heading;
    m.heading = wish_.heading + faded_in(yaw, t).value;
    m.pitch = tilt * std::cos(from);
    m.roll = -tilt * std::sin(from);
    return m;
}

}  // namespace

std::shared_ptr<const LocalShape> hover_shape(const HoverWish& wish) { return std::make_shared<HoverShape>(wish); }

std::shared_ptr<const LocalShape> float_shape(const FloatWish& wish) { return std::make_shared<FloatShape>(wish); }

}  // namespace skyloop::inline motion
