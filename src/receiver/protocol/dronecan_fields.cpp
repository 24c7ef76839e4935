#include "receiver/protocol/dronecan_fields.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop::inline receiver {
namespace {

constexpr int half_fraction = 10, half_bias = 15, half_most_exponent = 31;
constexpr std::uint16_t half_infinity = 0x7C00, half_nan = 0x7E00, half_sign = 0x8000;

}  // namespace

std::uint16_t half_bits(float value) {
    const std::uint16_t sign = std::signbit(value) ? half_sign : 0;
    if (std::isnan(value)) return static_cast<std::uint16_t>(sign | half_nan);
    const double size = std::fabs(static_cast<double>(value));
    if (size == 0) return sign;
    // The exponent of the smallest normal number holds for all below it.
    const int exponent = std::max(std::ilogb(size), 1 - half_bias);
    if (exponent > half_bias) return static_cast<std::uint16_t>(sign | half_infinity);
    // In steps of its last bit, to the nearest and, between two, to the even one; a carry goes on into the exponent.
    const double steps = std::nearbyint(std::ldexp(size, half_fraction - exponent));
    const auto biased = static_cast<std::uint32_t>(exponent + half_bias - 1);
    const std::uint32_t bits = (biased << half_fraction) + static_cast<std::uint32_t>(steps);
    return static_cast<std::uint16_t>(sign | std::min<std::uint32_t>(bits, half_infinity));
}

float half_value(std::uint16_t bits) {
    const int exponent = bits >> half_fraction & half_most_exponent;
    const int fraction = bits & ((1 << half_fraction) - 1);
    const double sign = (bits & half_sign) != 0 ? -1 : 1;
    if (exponent == half_most_exponent)
        return fraction != 0 ? std::numeric_limits<float>::quiet_NaN()
                             : static_cast<float>(sign) * std::numeric_limits<float>::infinity();
    const int whole = exponent == 0 ? fraction : fraction + (1 << half_fraction);
    return static_cast<float>(sign * std::ldexp(whole, std::max(exponent, 1) - half_bias - half_fraction));
}

}  // namespace skyloop::inline receiver
