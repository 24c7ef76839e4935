#include "study/plot/city_run_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "detail/plan_view.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {
namespace {

namespace style = plot_style;

constexpr double strip_left = 70, strip_width = 850;
constexpr std::size_t most_bins = 850;

// One column of the strips: several epochs where there are more than pixels.
struct StripBin {
    double begin = 0, end = 0;  // s since the start
    std::array<double, reception_names.size()> received{};
    std::optional<double> error;  // m, the largest
    std::size_t epochs = 0;
    void add(const CityRunEpoch& epoch) {
        for (std::size_t i = 0; i < received.size(); ++i)
            received.at(i) += epoch.received.at(i);
        if (epoch.error) error = std::max(error.value_or(0), epoch.error->value());
        ++epochs;
    }
    // Of the first so many kinds of reception together, a mean.
    [[nodiscard]] double up_to(std::size_t kinds) const {
        const double sum =
            std::accumulate(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(kinds), 0.0);
        return sum / static_cast<double>(std::max<std::size_t>(epochs, 1));
    }
};

std::vector<StripBin> strip_bins(const CityRun& run) {
    const std::size_t count = std::min(run.epochs.size(), most_bins);
    std::vector<StripBin> bins(count);
    for (std::size_t i = 0; i < run.epochs.size(); ++i) {
        StripBin& bin = bins[i * count / run.epochs.size()];
        if (bin.epochs == 0) bin.begin = run.epochs[i].since_start.value();
        bin.add(run.epochs[i]);
    }
    for (std::size_t k = 0; k + 1 < count; ++k)
        bins[k].end = bins[k + 1].begin;
    bins.back().end = std::max(run.epochs.back().since_start.value(), bins.back().begin + 1e-9);
    return bins;
}

// A panel of the picture with time to the right and a quantity upwards.
struct Strip {
    double top = 0, height = 0;
    double duration = 1, highest = 1;
    [[nodiscard]] SvgPoint at(double time, double value) const {
        return {strip_left + strip_width * time / duration, top + height * (1 - std::min(value, highest) / highest)};
    }
};

void draw_strip_frame(SvgDocument& svg, const Strip& strip, const std::string& name, bool with_times) {
    svg.rectangle({strip_left, strip.top}, {strip_width, strip.height}, 0, {.fill = style::panel});
    const double step = style::round_step(strip.highest, 4);
    for (double value = 0; value <= strip.highest * (1 + 1e-9); value += step) {
        svg.line(strip.at(0, value), strip.at(strip.duration, value), {.stroke = style::faint_grid});
        style::note(svg, {strip_left - 6, strip.at(0, value).y}, fmt::format("{:g}", value), 10.5, "end");
    }
    svg.text({.at = {strip_left, strip.top - 11}, .text = name, .size = 12.5, .bold = true});
    if (!with_times) return;
    const double time_step = style::round_step(strip.duration, 10);
    for (double time = 0; time <= strip.duration * (1 + 1e-9); time += time_step)
        style::note(svg, {strip.at(time, 0).x, strip.top + strip.height + 13}, fmt::format("{:g} s", time), 10.5,
                    "middle");
}

double opacity_of(Reception kind) { return kind == Reception::blocked ? 0.25 : 0.85; }

// The area between two stacked counts.
void draw_stack(SvgDocument& svg, const Strip& strip, const std::vector<StripBin>& bins, std::size_t layer) {
    SvgPath path;
    path.move_to(strip.at(bins.front().begin, bins.front().up_to(layer)));
    for (const StripBin& bin : bins)
        path.line_to(strip.at(bin.begin, bin.up_to(layer + 1))).line_to(strip.at(bin.end, bin.up_to(layer + 1)));
    for (auto bin = bins.rbegin(); bin != bins.rend(); ++bin)
        path.line_to(strip.at(bin->end, bin->up_to(layer))).line_to(strip.at(bin->begin, bin->up_to(layer)));
    const auto kind = static_cast<Reception>(layer);
    svg.path(path.close(), {.fill = style::reception_colour(kind), .opacity = opacity_of(kind)});
}

void draw_counts(SvgDocument& svg, const std::vector<StripBin>& bins, double top) {
    Strip strip{top, 130, bins.back().end, 1};
    for (const StripBin& bin : bins)
        strip.highest = std::max(strip.highest, bin.up_to(reception_names.size()));
    svg.begin_group("counts");
    draw_strip_frame(svg, strip, "Satellites", false);
    for (std::size_t layer = 0; layer < reception_names.size(); ++layer)
        draw_stack(svg, strip, bins, layer);
    double x = strip_left + 110;
    for (const Reception kind :
         {Reception::line_of_sight, Reception::shadowed, Reception::reflected, Reception::blocked}) {
        const std::string word(style::reception_word(kind));
        svg.rectangle({x, top - 17}, {12, 12}, 2, {.fill = style::reception_colour(kind), .opacity = opacity_of(kind)});
        style::note(svg, {x + 18, top - 11}, word, 11.5);
        x += 18 + style::text_width(word, 11.5) + 18;
    }
    svg.end_group();
}

void draw_errors(SvgDocument& svg, const std::vector<StripBin>& bins, double top) {
    Strip strip{top, 130, bins.back().end, 1};
    for (const StripBin& bin : bins)
        strip.highest = std::max(strip.highest, bin.error.value_or(0));
    SvgPath path;
    bool down = true;  // without a fix the line is lifted
    for (const StripBin& bin : bins) {
        if (bin.error) {
            const SvgPoint p = strip.at(bin.begin, *bin.error);
            down ? path.move_to(p) : path.line_to(p);
            path.line_to(strip.at(bin.end, *bin.error));
        }
        down = !bin.error;
    }
    svg.begin_group("errors");
    draw_strip_frame(svg, strip, "Horizontal error, m", true);
    if (!path.empty()) svg.path(path, {.stroke = style::accent, .width = 1.4});
    svg.end_group();
}

std::vector<Eigen::Vector2d> track_points(const CityRun& run, const LocalFrame& frame) {
    std::vector<Eigen::Vector2d> points;
    for (const CityRunEpoch& epoch : run.epochs)
        points.emplace_back(frame.to_enu(to_ecef(epoch.truth)).vector().head<2>());
    return points;
}

// The track with its surroundings; as wide as the panel is, whatever the track's shape.
Eigen::AlignedBox2d track_area(const std::vector<Eigen::Vector2d>& points, SvgPoint panel) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& point : points)
        box.extend(point);
    constexpr double least_margin = 60;  // m
    const double margin = std::max(least_margin, 0.1 * box.sizes().maxCoeff());
    Eigen::Vector2d half = (box.sizes() / 2).array() + margin;
    half.x() = std::max(half.x(), half.y() * panel.x / panel.y);
    half.y() = std::max(half.y(), half.x() * panel.y / panel.x);
    return {Eigen::Vector2d(box.center() - half), Eigen::Vector2d(box.center() + half)};
}

std::string count_colour(int count, int most) {
    return style::ramp_colour(style::value_ramp, most > 0 ? static_cast<double>(count) / most : 0);
}

// Pieces of one colour; points closer than a third of a pixel are left out.
void draw_track(SvgDocument& svg, const CityRun& run, const std::vector<Eigen::Vector2d>& points, const PlanView& view,
                int most) {
    svg.begin_group("track");
    SvgPath whole;
    std::vector<std::pair<int, SvgPath>> pieces;
    SvgPoint last = view.at(points.front());
    whole.move_to(last);
    for (std::size_t i = 1; i < points.size(); ++i) {
        const SvgPoint p = view.at(points[i]);
        const int count = run.epochs[i].received.front();
        const bool changes = pieces.empty() || pieces.back().first != count;
        if (!changes && std::hypot(p.x - last.x, p.y - last.y) < 0.33) continue;
        if (changes) pieces.emplace_back(count, SvgPath().move_to(last));
        pieces.back().second.line_to(p);
        whole.line_to(p);
        last = p;
    }
    svg.path(whole, {.stroke = style::ink, .width = 7});
    for (const auto& [count, path] : pieces)
        svg.path(path, {.stroke = count_colour(count, most), .width = 4.5});
    for (const auto& [index, name] : {std::pair{std::size_t{0}, "start"}, {points.size() - 1, "end"}}) {
        const SvgPoint p = view.at(points[index]);
        svg.circle(p, 5, {.fill = style::paper, .stroke = style::ink, .width = 2});
        svg.text({.at = {p.x + 9, p.y + (index == 0 ? -9.0 : 9.0)},
                  .text = name,
                  .size = 11.5,
                  .bold = true,
                  .halo = style::paper});
    }
    svg.end_group();
}

void draw_count_legend(SvgDocument& svg, SvgPoint at, int most) {
    constexpr double width = 20;
    constexpr int widest = 24;
    const int shown = std::min(most, widest);
    for (int k = 0; k <= shown; ++k) {
        const int count = shown > 0 ? k * most / shown : 0;
        svg.rectangle({at.x + k * width, at.y}, {width, 12}, 0, {.fill = count_colour(count, most)});
        style::note(svg, {at.x + (k + 0.5) * width, at.y + 21}, std::to_string(count), 10, "middle");
    }
    style::note(svg, {at.x + (shown + 1) * width + 10, at.y + 6}, "satellites in line of sight", 11.5);
}

}  // namespace

std::string city_run_plot_svg(const CityRun& run, const UrbanScene* scene, const std::string& title) {
    SvgDocument svg = style::titled_sheet({city_run_plot_width, city_run_plot_height}, {40, 30}, title,
                                          fmt::format("from {}   ·   {} epochs   ·   satellites above {:g}°", run.start,
                                                      run.epochs.size(), run.lowest.deg()));
    if (run.epochs.empty()) return svg.str();
    const LocalFrame frame = scene ? scene->frame() : LocalFrame(run.epochs.front().truth);
    const std::vector<Eigen::Vector2d> points = track_points(run, frame);
    constexpr SvgPoint panel{880, 620};
    const PlanView view(track_area(points, panel), {40, 74}, panel);
    if (scene)
        draw_city(svg, *scene, view);
    else
        svg.rectangle(view.corner(), view.size(), 0, {.fill = style::panel, .stroke = style::grid});
    int most = 0;
    for (const CityRunEpoch& epoch : run.epochs)
        most = std::max(most, epoch.received.front());
    draw_track(svg, run, points, view, most);
    draw_scale_and_north(svg, view);
    draw_count_legend(svg, {40, 706}, most);
    const std::vector<StripBin> bins = strip_bins(run);
    draw_counts(svg, bins, 776);
    draw_errors(svg, bins, 946);
    return svg.str();
}

}  // namespace skyloop::inline study
