/// Colours and measures that all pictures share.
/// Colours for numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/time/utc_time.hpp"
#include "study/analysis/scene_sky.hpp"
#include "study/plot/svg_document.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline study::plot_style {

inline constexpr std::string_view ink = "#1f2933";
inline constexpr std::string_view faint_ink = "#5f6b7a";
inline constexpr std::string_view grid = "#cbd3dd";
inline constexpr std::string_view faint_grid = "#e3e8ef";
inline constexpr std::string_view paper = "#ffffff";
inline constexpr std::string_view panel = "#f6f8fb";
inline constexpr std::string_view series = "#1f5fbf";
inline constexpr std::string_view accent = "#b4540a";
inline constexpr std::string_view unhealthy = "#8b95a1";
inline constexpr std::string_view foliage = "#a9cf9d";
inline constexpr std::string_view foliage_edge = "#6fa563";
inline constexpr std::string_view line_of_sight = "#0a8f72";
inline constexpr std::string_view shadowed = "#86b32d";
inline constexpr std::string_view reflected = "#e08a00";
inline constexpr std::string_view blocked = "#b3403a";
inline constexpr std::string_view skyline = "#c3cad3";

/// One colour for each system, told apart by people with any kind of colour vision in pairs that meet in practice.
constexpr std::string_view constellation_colour(Constellation constellation) {
    constexpr std::array<std::string_view, 7> colours{"#1f5fbf", "#7d5a2a", "#0a8f72", "#d17a00",
                                                      "#8040b5", "#c8322f", "#0d8fb3"};
    return colours[static_cast<std::size_t>(constellation)];
}

/// How a satellite is received: by colour, and by word.
constexpr std::string_view reception_colour(Reception reception) {
    return std::array{line_of_sight, shadowed, reflected, blocked}[static_cast<std::size_t>(reception)];
}
constexpr std::string_view reception_word(Reception reception) {
    return std::array<std::string_view, 4>{"line of sight", "shadowed", "reflected",
                                           "blocked"}[static_cast<std::size_t>(reception)];
}

/// A line of small grey text: a figure at an axis, an entry of a legend.
inline void note(SvgDocument& svg, SvgPoint at, std::string text, double size = 11, std::string_view anchor = "start") {
    svg.text({.at = at, .text = std::move(text), .size = size, .fill = faint_ink, .anchor = anchor});
}

/// The name of an axis about its middle; `rotation_deg` is clockwise.
inline void axis_name(SvgDocument& svg, SvgPoint at, std::string text, double rotation_deg = 0) {
    svg.text({.at = at, .text = std::move(text), .size = 12, .anchor = "middle", .rotation_deg = rotation_deg});
}

/// A picture of `size` with a sheet of paper of its own, so that it reads on a white page and on a dark one.
inline SvgDocument blank_sheet(SvgPoint size, std::string_view title) {
    SvgDocument svg(size.x, size.y, title);
    svg.rectangle({0.5, 0.5}, {size.x - 1, size.y - 1}, 10, {.fill = paper, .stroke = grid});
    return svg;
}

/// The same with its title written at `at` and a line of grey text below.
inline SvgDocument titled_sheet(SvgPoint size, SvgPoint at, const std::string& title, std::string subtitle) {
    SvgDocument svg = blank_sheet(size, title);
    svg.text({.at = at, .text = title, .size = 17, .bold = true});
    note(svg, {at.x, at.y + 24}, std::move(subtitle), 12);
    return svg;
}

/// "2026-03-01 12:00:00", of UTC.
inline std::string utc_words(GpsTime time) {
    std::string text = utc_text(time);
    text.replace(text.find('T'), 1, " ").pop_back();
    return text;
}

/// Width of a line of text, pixels, on the safe side for common sans-serif fonts.
inline double text_width(std::string_view text, double size) {
    const auto characters = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
    return 0.62 * size * static_cast<double>(characters);
}

/// The round number 1, 2 or 5 times a power of ten that divides `span` into at most `most` steps. @param least spans
/// below it count as this one
inline double round_step(double span, int most, double least = 1e-9) {
    const double raw = std::max(span, least) / most;
    const double power = std::pow(10, std::floor(std::log10(raw)));
    constexpr double slack = 1 + 1e-9;
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power * slack >= raw) return factor * power;
    return 10 * power;
}

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

}  // namespace skyloop::inline study::plot_style
