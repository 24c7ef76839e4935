/// Colours for numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>

namespace skyloop::plot_style {

struct Rgb {
    double red = 0, green = 0, blue = 0;  ///< 0 … 255
};

/// From low to high, even in lightness, readable with any kind of colour vision.
inline constexpr std::array<Rgb, 6> value_ramp{
    {{68, 20, 90}, {62, 74, 137}, {38, 130, 142}, {53, 183, 121}, {157, 217, 59}, {253, 231, 37}}};
/// Heights of buildings: pale to dark.
inline constexpr std::array<Rgb, 3> height_ramp{{{221, 226, 232}, {139, 151, 166}, {46, 58, 74}}};

/// The colour of `share`, 0 … 1, as SVG writes it.
inline std::string ramp_colour(std::span<const Rgb> ramp, double share) {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(ramp.size() - 1);
    const std::size_t low = std::min(static_cast<std::size_t>(at), ramp.size() - 2);
    const double part = at - static_cast<double>(low);
    const auto mixed = [&](double Rgb::*channel) {
        return static_cast<unsigned>(std::lround(ramp[low].*channel * (1 - part) + ramp[low + 1].*channel * part));
    };
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", mixed(&Rgb::red) & 0xffU, mixed(&Rgb::green) & 0xffU,
                  mixed(&Rgb::blue) & 0xffU);
    return text.data();
}

}  // namespace skyloop::plot_style
