/// Numbers that cross a function border carry their unit. There is no unit algebra: formulas take `.value()`, always
/// SI.
#pragma once

#include <compare>
#include <numbers>

namespace skyloop::inline base {

/// A number with a unit. Quantities of one unit add, subtract, compare and scale; different units refuse each other.
template <class Unit>
class Quantity {
public:
    constexpr Quantity() = default;
    constexpr explicit Quantity(double value) : value_(value) {}
    [[nodiscard]] constexpr double value() const { return value_; }

    constexpr auto operator<=>(const Quantity&) const = default;
    constexpr Quantity operator-() const { return Quantity(-value_); }
    constexpr Quantity& operator+=(Quantity other) { return value_ += other.value_, *this; }
    constexpr Quantity& operator-=(Quantity other) { return value_ -= other.value_, *this; }
    friend constexpr Quantity operator+(Quantity a, Quantity b) { return Quantity(a.value_ + b.value_); }
    friend constexpr Quantity operator-(Quantity a, Quantity b) { return Quantity(a.value_ - b.value_); }
    friend constexpr Quantity operator*(Quantity a, double factor) { return Quantity(a.value_ * factor); }
    friend constexpr Quantity operator*(double factor, Quantity a) { return Quantity(a.value_ * factor); }
    friend constexpr Quantity operator/(Quantity a, double divisor) { return Quantity(a.value_ / divisor); }

private:
    double value_ = 0;
};

using Metres = Quantity<struct MetresUnit>;
using Seconds = Quantity<struct SecondsUnit>;
using MetresPerSecond = Quantity<struct MetresPerSecondUnit>;
using Hertz = Quantity<struct HertzUnit>;
using Kelvin = Quantity<struct KelvinUnit>;
/// A ratio of powers, dB.
using Decibels = Quantity<struct DecibelsUnit>;
/// A power, dBW.
using DecibelWatts = Quantity<struct DecibelWattsUnit>;
/// Carrier-to-noise-density ratio C/N0, dB-Hz.
using DbHz = Quantity<struct DbHzUnit>;
/// Total electron content, TECU (1e16 electrons per square metre).
using Tecu = Quantity<struct TecuUnit>;

/// A plane angle. It has no bare value: say which unit you mean.
class Angle {
public:
    constexpr Angle() = default;
    static constexpr Angle radians(double value) { return Angle(value); }
    static constexpr Angle degrees(double value) { return Angle(value * (std::numbers::pi / 180.0)); }
    [[nodiscard]] constexpr double rad() const { return radians_; }
    [[nodiscard]] constexpr double deg() const { return radians_ * (180.0 / std::numbers::pi); }

    constexpr auto operator<=>(const Angle&) const = default;
    constexpr Angle operator-() const { return Angle(-radians_); }
    friend constexpr Angle operator+(Angle a, Angle b) { return Angle(a.radians_ + b.radians_); }
    friend constexpr Angle operator-(Angle a, Angle b) { return Angle(a.radians_ - b.radians_); }
    friend constexpr Angle operator*(Angle a, double factor) { return Angle(a.radians_ * factor); }

private:
    constexpr explicit Angle(double value) : radians_(value) {}
    double radians_ = 0;
};

}  // namespace skyloop::inline base
