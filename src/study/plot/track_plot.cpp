#include "study/plot/track_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/core/std_additions.hpp"
#include "detail/axes_and_labels.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {
namespace {

namespace style = plot_style;

constexpr double earth_radius = 6378137.0;  // WGS-84 semi-major axis, m
constexpr double megametre = 1e6;
constexpr SvgPoint track_centre{track_plot_width / 2, 426};
constexpr double track_half_height = 318;

// Colours that stay apart from each other for the satellites of one system.
constexpr std::array<std::string_view, 10> track_colours{"#1f5fbf", "#c8322f", "#0a8f72", "#d17a00", "#8040b5",
                                                         "#0d8fb3", "#b0306a", "#5c7a12", "#7d5a2a", "#44546a"};

// Megametres to pixels, for a cube of half-width `half_width`.
struct TrackScale {
    double half_width = 0;  ///< Mm
    double pixels = 0;      ///< per Mm of the picture

    explicit TrackScale(double half_width_mm)
        : half_width(half_width_mm),
          pixels(track_half_height / (half_width_mm * 4 / std::numbers::sqrt3 / std::numbers::sqrt2)) {}
    [[nodiscard]] SvgPoint place(const IsometricPoint& p) const {
        return {track_centre.x + p.right / megametre * pixels, track_centre.y - p.up / megametre * pixels};
    }
    [[nodiscard]] SvgPoint place(double x, double y, double z) const {
        return place(isometric(Position<Ecef>(x * megametre, y * megametre, z * megametre)));
    }
};

// How a piece of a track shows.
enum class Depth { front, back, hidden };

Depth depth_of(const IsometricPoint& p) {
    if (hidden_by_earth(p)) return Depth::hidden;
    return p.towards_viewer < 0 ? Depth::back : Depth::front;
}

// The pieces of one track by depth; points closer than a pixel to the last one drawn are left out.
struct TrackPaths {
    std::map<Depth, SvgPath> paths;
    SvgPoint end;
};

// More than one and a half of the usual steps without a point is a gap.
Nanoseconds longest_step(const SatelliteTrack& track) {
    std::vector<Nanoseconds> steps;
    for (std::size_t i = 1; i < track.points.size(); ++i)
        steps.push_back(track.points[i].time - track.points[i - 1].time);
    if (steps.empty()) return Nanoseconds(0);
    return middle_of(steps) * 3 / 2;
}

TrackPaths track_paths(const SatelliteTrack& track, const TrackScale& scale) {
    constexpr double visible_step = 1.0;
    TrackPaths result;
    const Nanoseconds longest = longest_step(track);
    SvgPoint last;
    Depth last_depth = Depth::front;
    for (std::size_t i = 0; i < track.points.size(); ++i) {
        const IsometricPoint iso = isometric(track.points[i].position);
        const SvgPoint p = scale.place(iso);
        const Depth depth = depth_of(iso);
        const bool starts = i == 0 || track.points[i].time - track.points[i - 1].time > longest;
        const bool far = std::hypot(p.x - last.x, p.y - last.y) >= visible_step;
        if (!starts && depth == last_depth && !far && i + 1 < track.points.size()) continue;
        SvgPath& path = result.paths[depth];
        if (starts)
            path.move_to(p);
        else if (depth != last_depth)
            path.move_to(last).line_to(p);
        else
            path.line_to(p);
        last = p;
        last_depth = depth;
    }
    result.end = last;
    return result;
}

double cube_half_width(std::span<const SatelliteTrack> tracks) {
    double largest = 10 * megametre;
    for (const SatelliteTrack& track : tracks)
        for (const TrackPoint& point : track.points)
            largest = std::max(largest, point.position.vector().cwiseAbs().maxCoeff());
    const double step = largest > 100 * megametre ? 50 : 10;
    return step * std::ceil(largest / megametre / step);
}

double track_tick_step(const TrackScale& scale) { return style::round_step(2 * scale.half_width, 8); }

// The three faces of the cube that are away from the viewer, with a grid on each.
void draw_cube(SvgDocument& svg, const TrackScale& scale) {
    const double w = scale.half_width;
    svg.begin_group("axes");
    const std::array<std::array<SvgPoint, 4>, 3> faces{
        {{scale.place(-w, -w, -w), scale.place(-w, w, -w), scale.place(-w, w, w), scale.place(-w, -w, w)},
         {scale.place(-w, -w, -w), scale.place(w, -w, -w), scale.place(w, -w, w), scale.place(-w, -w, w)},
         {scale.place(-w, -w, -w), scale.place(w, -w, -w), scale.place(w, w, -w), scale.place(-w, w, -w)}}};
    constexpr std::array<std::string_view, 3> shades{"#f8fafc", "#f3f6fa", "#edf1f6"};
    for (std::size_t i = 0; i < faces.size(); ++i)
        svg.path(SvgPath().move_to(faces[i][0]).line_to(faces[i][1]).line_to(faces[i][2]).line_to(faces[i][3]).close(),
                 {.fill = shades[i], .stroke = style::grid});
    const double step = track_tick_step(scale);
    SvgPath lines;
    for (double t = -std::floor(w / step) * step; t <= w; t += step) {
        lines.move_to(scale.place(-w, t, -w)).line_to(scale.place(-w, t, w));
        lines.move_to(scale.place(-w, -w, t)).line_to(scale.place(-w, w, t));
        lines.move_to(scale.place(t, -w, -w)).line_to(scale.place(t, -w, w));
        lines.move_to(scale.place(-w, -w, t)).line_to(scale.place(w, -w, t));
        lines.move_to(scale.place(t, -w, -w)).line_to(scale.place(t, w, -w));
        lines.move_to(scale.place(-w, t, -w)).line_to(scale.place(w, t, -w));
    }
    svg.path(lines, {.stroke = "#dbe2ea", .width = 0.8});
    svg.end_group();
}

// Numbers along the three edges that nothing covers.
void draw_tick_labels(SvgDocument& svg, const TrackScale& scale) {
    const double w = scale.half_width;
    const double step = track_tick_step(scale);
    svg.begin_group("ticks");
    const auto number = [&](SvgPoint at, double value, std::string_view anchor) {
        style::note(svg, at, fmt::format("{:.0f}", value), 11, anchor);
    };
    for (double t = -std::floor(w / step) * step; t <= w; t += step) {
        if (std::abs(t) > w - step / 4) continue;  // the corners belong to two axes
        const SvgPoint x = scale.place(t, w, -w);
        const SvgPoint y = scale.place(w, t, -w);
        const SvgPoint z = scale.place(w, -w, t);
        number({x.x + 8, x.y + 9}, t, "start");
        number({y.x - 8, y.y + 9}, t, "end");
        number({z.x - 8, z.y}, t, "end");
    }
    const SvgPoint x = scale.place(0, w, -w);
    const SvgPoint y = scale.place(w, 0, -w);
    const SvgPoint z = scale.place(w, -w, 0);
    const auto name = [&](SvgPoint at, const char* text, double rotation) {
        svg.text({.at = at, .text = text, .size = 12.5, .anchor = "middle", .bold = true, .rotation_deg = rotation});
    };
    name({x.x + 34, x.y + 34}, "X, Mm", -30);
    name({y.x - 34, y.y + 34}, "Y, Mm", 30);
    name({z.x - 42, z.y}, "Z, Mm", -90);
    svg.end_group();
}

// One circle of the graticule, the near half strong and the far half weak.
void draw_graticule_line(std::array<SvgPath, 2>& halves, const TrackScale& scale, bool meridian, double angle_deg) {
    constexpr int steps = 72;
    constexpr double degree = std::numbers::pi / 180;
    std::array<bool, 2> drawing{};
    for (int i = 0; i <= steps; ++i) {
        const double running = 360.0 * i / steps;
        const double latitude = (meridian ? running : angle_deg) * degree;
        const double longitude = (meridian ? angle_deg : running) * degree;
        const IsometricPoint p = isometric(Position<Ecef>(earth_radius * std::cos(latitude) * std::cos(longitude),
                                                          earth_radius * std::cos(latitude) * std::sin(longitude),
                                                          earth_radius * std::sin(latitude)));
        const std::size_t half = p.towards_viewer >= 0 ? 0 : 1;
        if (drawing[half])
            halves[half].line_to(scale.place(p));
        else
            halves[half].move_to(scale.place(p));
        drawing[half] = true;
        drawing[1 - half] = false;
    }
}

void draw_earth(SvgDocument& svg, const TrackScale& scale) {
    const double radius = earth_radius / megametre * scale.pixels;
    svg.begin_group("earth", "Earth");
    svg.circle(track_centre, radius, {.fill = "#c3dcf2", .stroke = "#3f6f9f", .width = 1.4});
    std::array<SvgPath, 2> halves;
    for (int longitude = 0; longitude < 180; longitude += 30)
        draw_graticule_line(halves, scale, true, longitude);
    for (int latitude = -60; latitude <= 60; latitude += 30)
        draw_graticule_line(halves, scale, false, latitude);
    svg.path(halves[1], {.stroke = "#3f6f9f", .width = 0.5, .opacity = 0.25});
    svg.path(halves[0], {.stroke = "#3f6f9f", .width = 0.8, .opacity = 0.8});
    svg.end_group();
}

std::string track_subtitle(std::span<const SatelliteTrack> tracks) {
    std::optional<GpsTime> first;
    std::optional<GpsTime> last;
    std::size_t count = 0;
    for (const SatelliteTrack& track : tracks) {
        if (track.points.empty()) continue;
        ++count;
        if (!first || track.points.front().time < *first) first = track.points.front().time;
        if (!last || track.points.back().time > *last) last = track.points.back().time;
    }
    if (!first) return "no satellites";
    return fmt::format("{} satellite{}   ·   {} UTC and {:.4g} h on   ·   Earth-centred, Earth-fixed", count,
                       count == 1 ? "" : "s", style::utc_words(*first), difference(*last, *first).value() / 3600);
}

void draw_layer(SvgDocument& svg, const std::vector<TrackPaths>& all, const std::vector<std::string_view>& colours,
                Depth depth) {
    constexpr std::array<double, 3> opacities{0.9, 0.42, 0.2};
    constexpr std::array<double, 3> widths{1.5, 1.2, 1.1};
    constexpr std::array<std::string_view, 3> names{"front", "back", "behind-earth"};
    const auto i = static_cast<std::size_t>(depth);
    svg.begin_group(names[i]);
    for (std::size_t k = 0; k < all.size(); ++k)
        if (const auto path = all[k].paths.find(depth); path != all[k].paths.end())
            svg.path(path->second, {.stroke = colours[k], .width = widths[i], .opacity = opacities[i]});
    svg.end_group();
}

void draw_track_ends(SvgDocument& svg, std::span<const SatelliteTrack> tracks, const std::vector<TrackPaths>& all,
                     const std::vector<std::string_view>& colours) {
    constexpr double size = 10.5;
    LabelPlacement labels;
    for (const TrackPaths& t : all)
        labels.block({t.end.x - 3, t.end.y - 3, 6, 6});
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (tracks[k].points.empty()) continue;
        const std::string name = to_string(tracks[k].satellite);
        svg.begin_group("satellite", name);
        svg.circle(all[k].end, 3.4, {.fill = colours[k], .stroke = style::paper});
        const LabelBox box = labels.place(all[k].end, 3.4, {style::text_width(name, size), size});
        svg.text({.at = box.centre(),
                  .text = name,
                  .size = size,
                  .fill = colours[k],
                  .anchor = "middle",
                  .bold = true,
                  .halo = style::paper});
        svg.end_group();
    }
}

// One system: each satellite its own colour. Several: the system's.
std::vector<std::string_view> colours_of(std::span<const SatelliteTrack> tracks) {
    std::set<Constellation> systems;
    for (const SatelliteTrack& track : tracks)
        systems.insert(track.satellite.constellation);
    std::vector<std::string_view> colours;
    for (const SatelliteTrack& track : tracks)
        colours.push_back(systems.size() > 1 ? style::constellation_colour(track.satellite.constellation)
                                             : track_colours[colours.size() % track_colours.size()]);
    return colours;
}

}  // namespace

IsometricPoint isometric(const Position<Ecef>& point) {
    const Eigen::Vector3d& p = point.vector();
    return {(p.y() - p.x()) / std::numbers::sqrt2, (2 * p.z() - p.x() - p.y()) / std::sqrt(6.0),
            (p.x() + p.y() + p.z()) / std::numbers::sqrt3};
}

bool hidden_by_earth(const IsometricPoint& point) {
    return point.towards_viewer < 0 && std::hypot(point.right, point.up) < earth_radius;
}

std::string track_plot_svg(std::span<const SatelliteTrack> tracks, const std::string& title) {
    const TrackScale scale(cube_half_width(tracks));
    const std::vector<std::string_view> colours = colours_of(tracks);
    std::vector<TrackPaths> all;
    for (const SatelliteTrack& track : tracks)
        all.push_back(track_paths(track, scale));

    SvgDocument svg =
        style::titled_sheet({track_plot_width, track_plot_height}, {32, 32}, title, track_subtitle(tracks));
    draw_cube(svg, scale);
    draw_layer(svg, all, colours, Depth::back);
    draw_earth(svg, scale);
    draw_layer(svg, all, colours, Depth::hidden);
    draw_layer(svg, all, colours, Depth::front);
    draw_track_ends(svg, tracks, all, colours);
    draw_tick_labels(svg, scale);
    return svg.str();
}

}  // namespace skyloop::inline study
