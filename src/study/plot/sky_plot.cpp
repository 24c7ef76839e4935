#include "study/plot/sky_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "detail/axes_and_labels.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {
namespace {

namespace style = plot_style;

constexpr SvgPoint sky_centre{sky_plot_centre_x, sky_plot_centre_y};
constexpr double sky_label_size = 11.5;

double sky_ring_radius(double elevation_deg) { return sky_plot_radius * (90 - elevation_deg) / 90; }

SvgPoint sky_point(Angle azimuth, Angle elevation) {
    const double r = sky_ring_radius(elevation.deg());
    return {sky_centre.x + r * std::sin(azimuth.rad()), sky_centre.y - r * std::cos(azimuth.rad())};
}

bool tells_cn0(const std::vector<SkyPlotSatellite>& satellites) {
    return std::any_of(satellites.begin(), satellites.end(),
                       [](const SkyPlotSatellite& s) { return s.cn0.has_value(); });
}

// Radius of a mark: 20 dB-Hz and less is small, 50 and more is large. Of a satellite without a C/N0 nothing arrives
// where others have one; where none has, all are in between.
double mark_radius(const std::optional<DbHz>& cn0, bool with_cn0) {
    constexpr double smallest = 4.5;
    constexpr double largest = 9.5;
    if (!cn0) return with_cn0 ? smallest : 7;
    return smallest + (largest - smallest) * std::clamp((cn0->value() - 20) / 30, 0.0, 1.0);
}

std::string coordinate_text(Angle angle, char positive, char negative) {
    return fmt::format("{:.5f}° {}", std::abs(angle.deg()), angle.deg() < 0 ? negative : positive);
}

std::string sky_place(const SkyPlot& plot) {
    return fmt::format("Sky at {}, {}, {:.0f} m", coordinate_text(plot.place.latitude, 'N', 'S'),
                       coordinate_text(plot.place.longitude, 'E', 'W'), plot.place.height.above_ellipsoid.value());
}

std::string sky_title(const SkyPlot& plot) { return plot.title.empty() ? sky_place(plot) : plot.title; }

// A picture of buildings alone: no satellite was asked for, at no time.
bool shows_buildings_alone(const SkyPlot& plot) { return plot.obstruction && plot.satellites.empty(); }

std::string sky_subtitle(const SkyPlot& plot, std::size_t seen) {
    if (shows_buildings_alone(plot)) {
        const std::string place = plot.title.empty() ? "" : sky_place(plot) + "   ·   ";
        return fmt::format("{}{:.0f} % of the sky is open", place, 100 * plot.obstruction->open_share());
    }
    const auto used =
        std::count_if(plot.satellites.begin(), plot.satellites.end(), [](const SkyPlotSatellite& s) { return s.used; });
    std::string text =
        fmt::format("{} UTC   ·   {} above the horizon, {} used", style::utc_words(plot.time), seen, used);
    if (plot.dop)
        text +=
            fmt::format("   ·   PDOP {:.2f}, HDOP {:.2f}, VDOP {:.2f}", plot.dop->pdop, plot.dop->hdop, plot.dop->vdop);
    return text;
}

// Blocked cells, those on top of each other as one piece. A piece is wide enough to close the gap to its neighbour.
void draw_obstruction(SvgDocument& svg, const SkyMask& mask) {
    constexpr double overlap = 0.08;  // degrees
    SvgPath path;
    for (int azimuth = 0; azimuth < SkyMask::azimuths; ++azimuth)
        for (int low = 0, high = 0; low < SkyMask::elevations; low = high) {
            high = low + 1;
            if (!mask.at(azimuth, low)) continue;
            while (high < SkyMask::elevations && mask.at(azimuth, high))
                ++high;
            const Angle left = Angle::degrees(azimuth - overlap), right = Angle::degrees(azimuth + 1 + overlap);
            path.move_to(sky_point(left, Angle::degrees(low)))
                .line_to(sky_point(right, Angle::degrees(low)))
                .line_to(sky_point(right, Angle::degrees(high)))
                .line_to(sky_point(left, Angle::degrees(high)))
                .close();
        }
    svg.begin_group("buildings", fmt::format("{:.0f} % of the sky is open", 100 * mask.open_share()));
    if (!path.empty()) svg.path(path, {.fill = style::skyline});
    svg.end_group();
}

void draw_sky_grid(SvgDocument& svg, const SkyPlot& plot) {
    svg.begin_group("grid");
    svg.circle(sky_centre, sky_plot_radius, {.fill = style::panel, .stroke = style::faint_ink, .width = 1.2});
    if (plot.obstruction) draw_obstruction(svg, *plot.obstruction);
    for (int azimuth = 0; azimuth < 360; azimuth += 30) {
        const Angle a = Angle::degrees(azimuth);
        svg.line(sky_centre, sky_point(a, Angle()), {.stroke = azimuth % 90 == 0 ? style::grid : style::faint_grid});
        const SvgPoint edge = sky_point(a, Angle::degrees(-90 * 17 / sky_plot_radius));
        const bool cardinal = azimuth % 90 == 0;
        const std::string name = cardinal ? std::string(1, "NESW"[azimuth / 90]) : fmt::format("{}°", azimuth);
        svg.text({.at = edge,
                  .text = name,
                  .size = cardinal ? 15.0 : 11.0,
                  .fill = cardinal ? style::ink : style::faint_ink,
                  .anchor = "middle",
                  .bold = cardinal});
    }
    for (const double elevation : {30.0, 60.0})
        svg.circle(sky_centre, sky_ring_radius(elevation), {.stroke = style::grid});
    if (plot.mask && plot.mask->deg() > 0 && plot.mask->deg() < 90)
        svg.circle(sky_centre, sky_ring_radius(plot.mask->deg()),
                   {.stroke = style::accent, .width = 1.1, .dash = "5 4"});
    for (const double elevation : {30.0, 60.0})
        svg.text({.at = {sky_centre.x + 4, sky_centre.y - sky_ring_radius(elevation) - 7},
                  .text = fmt::format("{:.0f}°", elevation),
                  .size = 10,
                  .fill = style::faint_ink,
                  .halo = style::panel});
    svg.end_group();
}

std::string_view satellite_colour(const SkyPlotSatellite& satellite) {
    if (!satellite.healthy) return style::unhealthy;
    if (!satellite.reception) return style::constellation_colour(satellite.id.constellation);
    return style::reception_colour(*satellite.reception);
}

void draw_trail(SvgDocument& svg, const SkyPlotSatellite& satellite) {
    SvgPath path;
    bool down = true;  // below the horizon the line is lifted
    for (const SkyDirection& d : satellite.trail) {
        const bool below = d.elevation < Angle();
        if (!below) {
            const SvgPoint p = sky_point(d.azimuth, d.elevation);
            down ? path.move_to(p) : path.line_to(p);
        }
        down = below;
    }
    if (!down) path.line_to(sky_point(satellite.azimuth, satellite.elevation));
    const std::string_view colour = satellite_colour(satellite);
    svg.path(path, {.stroke = colour, .width = 1.3, .opacity = 0.4});
}

void draw_mark(SvgDocument& svg, SvgPoint p, double radius, const SkyPlotSatellite& satellite) {
    const std::string_view colour = satellite_colour(satellite);
    if (satellite.used && satellite.healthy)
        svg.circle(p, radius, {.fill = colour, .stroke = style::paper, .width = 1.2});
    else
        svg.circle(p, radius, {.fill = style::paper, .stroke = colour, .width = 2});
    if (satellite.healthy) return;
    const double arm = 0.7 * radius;
    svg.path(SvgPath().move_to({p.x - arm, p.y - arm}).line_to({p.x + arm, p.y + arm}), {.stroke = colour, .width = 2});
    svg.path(SvgPath().move_to({p.x - arm, p.y + arm}).line_to({p.x + arm, p.y - arm}), {.stroke = colour, .width = 2});
}

std::string satellite_tooltip(const SkyPlotSatellite& s) {
    std::string text =
        fmt::format("{}: azimuth {:.1f}°, elevation {:.1f}°", to_string(s.id), s.azimuth.deg(), s.elevation.deg());
    if (s.cn0) text += fmt::format(", {:.1f} dB-Hz", s.cn0->value());
    if (s.reception) text += fmt::format(", {}", style::reception_word(*s.reception));
    return text + (!s.healthy ? ", unhealthy" : s.used ? ", used" : ", not used");
}

void draw_satellites(SvgDocument& svg, const std::vector<SkyPlotSatellite>& satellites) {
    const bool with_cn0 = tells_cn0(satellites);
    LabelPlacement labels;
    labels.keep_inside(sky_centre, sky_plot_radius + 4);
    for (const SkyPlotSatellite& s : satellites) {
        const double r = mark_radius(s.cn0, with_cn0);
        const SvgPoint p = sky_point(s.azimuth, s.elevation);
        labels.block({p.x - r, p.y - r, 2 * r, 2 * r});
        draw_trail(svg, s);
    }
    for (const SkyPlotSatellite& s : satellites) {
        const double r = mark_radius(s.cn0, with_cn0);
        const SvgPoint p = sky_point(s.azimuth, s.elevation);
        const std::string name = to_string(s.id);
        svg.begin_group("satellite", satellite_tooltip(s));
        draw_mark(svg, p, r, s);
        const LabelBox box = labels.place(p, r, {style::text_width(name, sky_label_size), sky_label_size});
        svg.text({.at = box.centre(),
                  .text = name,
                  .size = sky_label_size,
                  .fill = s.healthy ? style::ink : style::unhealthy,
                  .anchor = "middle",
                  .bold = s.used && s.healthy,
                  .halo = style::panel});
        svg.end_group();
    }
}

// Entries one after the other; its state is where the next one goes.
class LegendRow {
public:
    LegendRow(SvgDocument& svg, double y) : svg_(svg), y_(y) {}
    SvgPoint mark_place(double radius) const { return {x_ + radius, y_}; }
    void label(const std::string& text, double mark_width) {
        constexpr double size = 11.5;
        style::note(svg_, {x_ + mark_width + 6, y_}, text, size);
        x_ += mark_width + 6 + style::text_width(text, size) + 16;
    }

private:
    SvgDocument& svg_;
    double x_ = 32;
    double y_;
};

void draw_system_legend(SvgDocument& svg, const SkyPlot& plot, const std::vector<SkyPlotSatellite>& satellites) {
    LegendRow row(svg, 672);
    std::set<Constellation> present;
    for (const SkyPlotSatellite& s : satellites)
        if (!s.reception) present.insert(s.id.constellation);
    if (plot.obstruction)
        for (const Reception kind : {Reception::line_of_sight, Reception::reflected, Reception::blocked}) {
            svg.circle(row.mark_place(6), 6, {.fill = style::reception_colour(kind)});
            row.label(std::string(style::reception_word(kind)), 12);
        }
    for (const Constellation c : present) {
        svg.circle(row.mark_place(6), 6, {.fill = style::constellation_colour(c)});
        row.label(std::string(constellation_title(c)), 12);
    }
    if (plot.mask && plot.mask->deg() > 0) {
        const SvgPoint p = row.mark_place(0);
        svg.line(p, {p.x + 26, p.y}, {.stroke = style::accent, .width = 1.3, .dash = "5 4"});
        row.label(fmt::format("mask {:.3g}°", plot.mask->deg()), 26);
    }
}

void draw_state_legend(SvgDocument& svg, bool with_cn0) {
    constexpr double radius = 6;
    LegendRow row(svg, 700);
    SkyPlotSatellite sample;
    draw_mark(svg, row.mark_place(radius), radius, sample);
    row.label("used", 2 * radius);
    sample.used = false;
    draw_mark(svg, row.mark_place(radius), radius, sample);
    row.label("not used", 2 * radius);
    sample.healthy = false;
    draw_mark(svg, row.mark_place(radius), radius, sample);
    row.label("unhealthy", 2 * radius);
    if (!with_cn0) return;
    for (const double cn0 : {20.0, 35.0, 50.0}) {
        const double r = mark_radius(DbHz(cn0), with_cn0);
        svg.circle(row.mark_place(r), r, {.fill = style::unhealthy});
        row.label(cn0 < 50 ? fmt::format("{:.0f}", cn0) : fmt::format("{:.0f} dB-Hz", cn0), 2 * r);
    }
}

void draw_legend(SvgDocument& svg, const SkyPlot& plot, const std::vector<SkyPlotSatellite>& satellites) {
    if (shows_buildings_alone(plot)) return;
    svg.begin_group("legend");
    draw_system_legend(svg, plot, satellites);
    draw_state_legend(svg, tells_cn0(satellites));
    svg.end_group();
}

}  // namespace

SkyPlot sky_plot(const SkyListing& listing) {
    SkyPlot plot{listing.place, listing.time, listing.mask, listing.dop, {}, {}, {}};
    for (const SkyRow& row : listing.rows)
        plot.satellites.push_back({row.view.id,
                                   row.view.azimuth,
                                   row.view.elevation,
                                   row.cn0,
                                   row.used,
                                   row.view.healthy,
                                   row.scene ? std::optional(row.scene->reception()) : std::nullopt,
                                   {}});
    return plot;
}

std::string sky_plot_svg(const SkyPlot& plot) {
    std::vector<SkyPlotSatellite> seen;
    for (const SkyPlotSatellite& s : plot.satellites)
        if (s.elevation >= Angle() && std::isfinite(s.azimuth.rad())) seen.push_back(s);
    // The uncertain ones first, so that what matters lies on top.
    std::stable_sort(seen.begin(), seen.end(),
                     [](const SkyPlotSatellite& a, const SkyPlotSatellite& b) { return a.used < b.used; });

    const std::string title = sky_title(plot);
    SvgDocument svg =
        style::titled_sheet({sky_plot_width, sky_plot_height}, {32, 32}, title, sky_subtitle(plot, seen.size()));
    draw_sky_grid(svg, plot);
    draw_satellites(svg, seen);
    draw_legend(svg, plot, seen);
    return svg.str();
}

}  // namespace skyloop::inline study
