/// Numbers of a record as the fields of a navigation message.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/core/bytes.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// 2^exponent, the step of a field.
inline double power_of_two(int exponent) { return std::ldexp(1.0, exponent); }

/// A signed field; what does not fit becomes the nearest that does.
inline void put_scaled(BitWriter& bits, double value, int width, double step) {
    const std::int64_t limit = std::int64_t{1} << (width - 1);
    bits.put_signed(quantised(value, step, -limit, limit - 1), width);
}

/// The same without a sign.
inline void put_scaled_unsigned(BitWriter& bits, double value, int width, double step) {
    bits.put_signed(quantised(value, step, 0, (std::int64_t{1} << width) - 1), width);
}

/// A sign, 1 for minus, and a magnitude, as GLONASS has them (ICD L1, L2 GLONASS 5.1, table 4.5, note 1).
inline void put_sign_magnitude(BitWriter& bits, double value, int width, double step) {
    const std::int64_t most = (std::int64_t{1} << (width - 1)) - 1;
    const std::int64_t magnitude = quantised(std::abs(value), step, 0, most);
    // Satellites send −0 too.
    bits.put(std::signbit(value) ? 1 : 0, 1);
    bits.put_signed(magnitude, width - 1);
}

/// An angle in semicircles that wraps around: 32 bits of 2^-31, 24 of 2^-23 and their like cover the whole circle.
inline void put_circle(BitWriter& bits, double radians, int width) {
    const double turns = std::isfinite(radians) ? std::remainder(radians, 2 * std::numbers::pi) : 0;
    const double step = std::numbers::pi * power_of_two(1 - width);
    const std::int64_t limit = std::int64_t{1} << (width - 1);
    // +π is −π: the complement wraps by itself.
    bits.put_signed(quantised(turns, step, -limit, limit), width);
}

/// A rate of an angle, or an angle that stays small: radians in steps of 2^exponent semicircles.
inline void put_semicircles(BitWriter& bits, double radians, int width, int exponent) {
    put_scaled(bits, radians, width, std::numbers::pi * power_of_two(exponent));
}

/// The coefficients alpha, then beta, in the eight fields that BeiDou has taken over from GPS (IS-GPS-200, table 20-X;
/// B1I ICD 3.0, table 5-9).
void put_klobuchar(BitWriter& bits, const KlobucharCoefficients& coefficients);

/// The last or next change of the leap seconds, as GPS (IS-GPS-200, 20.3.3.5.2.4) and Galileo (OS SIS ICD 2.0, 5.1.7)
/// announce it.
struct LeapChange {
    std::uint64_t week = 0;  ///< WN_LSF, of GPS; Galileo's, 1024 fewer, has the same lowest 8 bits
    std::uint64_t day = 1;   ///< DN, at whose end it comes: 1 Sunday … 7
    int offset = 0;          ///< Δt_LSF, after it, s
};
LeapChange leap_change(const LeapSeconds& leap_seconds, GpsTime time);

}  // namespace skyloop::inline world
