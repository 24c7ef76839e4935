#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "detail/plan_view.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {

PlanView::PlanView(const Eigen::AlignedBox2d& area, SvgPoint corner, SvgPoint size)
    : area_(area),
      corner_(corner),
      scale_(std::min(size.x / std::max(area.sizes().x(), 1e-3), size.y / std::max(area.sizes().y(), 1e-3))) {}

SvgPoint PlanView::at(const Eigen::Vector2d& place) const {
    return {corner_.x + (place.x() - area_.min().x()) * scale_, corner_.y + (area_.max().y() - place.y()) * scale_};
}

std::vector<Eigen::Vector2d> clipped_polygon(std::vector<Eigen::Vector2d> polygon, const Eigen::AlignedBox2d& box) {
    for (int side = 0; side < 4 && !polygon.empty(); ++side) {
        const int axis = side / 2;
        const double sign = side % 2 == 0 ? 1 : -1;
        const double edge = side % 2 == 0 ? box.max()[axis] : box.min()[axis];
        const auto beyond = [&](const Eigen::Vector2d& p) { return sign * (p[axis] - edge); };
        std::vector<Eigen::Vector2d> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Eigen::Vector2d& a = polygon[i];
            const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
            if (beyond(a) <= 0) kept.push_back(a);
            if ((beyond(a) < 0 && beyond(b) > 0) || (beyond(a) > 0 && beyond(b) < 0))
                kept.emplace_back(a + (b - a) * (beyond(a) / (beyond(a) - beyond(b))));
        }
        polygon = std::move(kept);
    }
    return polygon;
}

bool clip_line(Eigen::Vector2d& from, Eigen::Vector2d& to, const Eigen::AlignedBox2d& box) {
    const Eigen::Vector2d along = to - from;
    double first = 0, last = 1;
    for (int axis = 0; axis < 2; ++axis) {
        const double low = box.min()[axis] - from[axis];
        const double high = box.max()[axis] - from[axis];
        if (along[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        first = std::max(first, std::min(low / along[axis], high / along[axis]));
        last = std::min(last, std::max(low / along[axis], high / along[axis]));
    }
    if (!(first <= last)) return false;
    const Eigen::Vector2d start = from;
    from = start + first * along;
    to = start + last * along;
    return true;
}

Eigen::AlignedBox2d ground_box(const UrbanScene& scene) {
    const SceneStatistics& s = scene.statistics();
    Eigen::AlignedBox2d box(Eigen::Vector2d(s.lowest.head<2>()), Eigen::Vector2d(s.highest.head<2>()));
    // A margin, so that outlines are seen whole and a single wall has a picture too.
    const double margin = std::max(1.0, 0.02 * box.sizes().maxCoeff());
    box.min().array() -= margin;
    box.max().array() += margin;
    // Very long and narrow scenes become a little wider: a picture has two directions.
    const double narrowest = 0.25 * box.sizes().maxCoeff();
    for (int axis = 0; axis < 2; ++axis) {
        const double missing = std::max(0.0, narrowest - box.sizes()[axis]) / 2;
        box.min()[axis] -= missing;
        box.max()[axis] += missing;
    }
    return box;
}

void draw_scale_and_north(SvgDocument& svg, const PlanView& view) {
    namespace style = plot_style;
    constexpr double widest_bar = 160;
    const double metres = style::round_step(widest_bar / view.pixels_per_metre(), 2);
    const double length = metres * view.pixels_per_metre();
    const SvgPoint low{view.corner().x + 14, view.corner().y + view.size().y - 14};
    const std::string text = metres >= 1000 ? fmt::format("{:g} km", metres / 1000) : fmt::format("{:g} m", metres);
    svg.begin_group("scale");
    svg.line({low.x, low.y}, {low.x + length, low.y}, {.stroke = style::paper, .width = 6, .opacity = 0.8});
    svg.line({low.x, low.y}, {low.x + length, low.y}, {.stroke = style::ink, .width = 2.5});
    for (const double x : {low.x, low.x + length})
        svg.line({x, low.y - 5}, {x, low.y + 5}, {.stroke = style::ink, .width = 1.5});
    svg.text(
        {.at = {low.x + length / 2, low.y - 11}, .text = text, .size = 11.5, .anchor = "middle", .halo = style::paper});
    svg.end_group();
    const SvgPoint top{view.corner().x + view.size().x - 22, view.corner().y + 14};
    svg.begin_group("north");
    svg.path(SvgPath()
                 .move_to({top.x, top.y})
                 .line_to({top.x + 7, top.y + 22})
                 .line_to({top.x, top.y + 17})
                 .line_to({top.x - 7, top.y + 22})
                 .close(),
             {.fill = style::ink, .stroke = style::paper, .width = 1.5});
    svg.text(
        {.at = {top.x, top.y + 32}, .text = "N", .size = 12, .anchor = "middle", .bold = true, .halo = style::paper});
    svg.end_group();
}

namespace {

namespace style = plot_style;

constexpr int height_levels = 16;
constexpr double lowest_building = 0.5;  // m above ground: less is a kerb
constexpr std::size_t most_drawn_triangles = 30'000;
constexpr double sampled_pixels = 1.5;

using Triangle3 = std::array<Eigen::Vector3d, 3>;

// Shapes of one picture, by the height that decides their shade.
struct CityShapes {
    std::vector<std::pair<double, std::vector<Eigen::Vector2d>>> roofs;  // height above ground, outline
    std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> walls;
    double highest = 0;  // m above ground
};

double ground_height(const UrbanScene& scene, double east, double north) {
    return scene.ground_at(east, north).value_or(scene.statistics().lowest.z());
}

bool vertical(const Triangle3& t) {
    const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    return std::abs(normal.z()) < 0.02 * normal.norm();
}

// The longest side as seen from above.
std::pair<Eigen::Vector2d, Eigen::Vector2d> seen_edge_on(const Triangle3& t) {
    std::pair<Eigen::Vector2d, Eigen::Vector2d> longest{t[0].head<2>(), t[1].head<2>()};
    for (std::size_t i = 1; i < 3; ++i) {
        const Eigen::Vector2d a = t[i].head<2>(), b = t[(i + 1) % 3].head<2>();
        if ((b - a).squaredNorm() > (longest.second - longest.first).squaredNorm()) longest = {a, b};
    }
    return longest;
}

// Adds a triangle; false when the picture would hold too many.
bool add_triangle(CityShapes& shapes, const UrbanScene& scene, std::uint32_t index, const Eigen::AlignedBox2d& area) {
    if (scene.planes()[scene.plane_of(index)].kind == SurfaceKind::ground) return true;
    const Triangle3 t = scene.triangle(index);
    if (vertical(t)) {
        auto [from, to] = seen_edge_on(t);
        if (clip_line(from, to, area)) shapes.walls.emplace_back(from, to);
    } else {
        auto outline = clipped_polygon({t[0].head<2>(), t[1].head<2>(), t[2].head<2>()}, area);
        const Eigen::Vector3d middle = (t[0] + t[1] + t[2]) / 3;
        if (outline.size() >= 3)
            shapes.roofs.emplace_back(middle.z() - ground_height(scene, middle.x(), middle.y()), std::move(outline));
    }
    return shapes.roofs.size() + shapes.walls.size() <= most_drawn_triangles;
}

std::optional<CityShapes> shapes_of(const UrbanScene& scene, const Eigen::AlignedBox2d& area) {
    CityShapes shapes;
    for (std::uint32_t i = 0; i < scene.statistics().triangles; ++i)
        if (!add_triangle(shapes, scene, i, area)) return std::nullopt;
    for (const auto& roof : shapes.roofs)
        shapes.highest = std::max(shapes.highest, roof.first);
    return shapes;
}

int height_level(double height, double highest) {
    if (height < lowest_building || !(highest > 0)) return -1;
    return std::clamp(static_cast<int>(height / highest * height_levels), 0, height_levels - 1);
}

std::string level_colour(int level) {
    return style::ramp_colour(style::height_ramp, static_cast<double>(level) / (height_levels - 1));
}

void draw_outline(SvgPath& path, const std::vector<Eigen::Vector2d>& outline, const PlanView& view) {
    path.move_to(view.at(outline.front()));
    for (std::size_t i = 1; i < outline.size(); ++i)
        path.line_to(view.at(outline[i]));
    path.close();
}

// One path a shade, from low to high: what is higher hides what is lower.
void draw_roofs(SvgDocument& svg, const CityShapes& shapes, const PlanView& view) {
    std::array<SvgPath, height_levels> paths;
    for (const auto& [height, outline] : shapes.roofs)
        if (const int level = height_level(height, shapes.highest); level >= 0)
            draw_outline(paths[static_cast<std::size_t>(level)], outline, view);
    for (int level = 0; level < height_levels; ++level) {
        const std::string colour = level_colour(level);
        // The stroke closes the hairlines between triangles of one roof.
        if (const SvgPath& path = paths[static_cast<std::size_t>(level)]; !path.empty())
            svg.path(path, {.fill = colour, .stroke = colour, .width = 0.6});
    }
}

void draw_walls(SvgDocument& svg, const CityShapes& shapes, const PlanView& view) {
    // The triangles and windows of one wall lie on one line: each line of the picture once.
    std::set<std::tuple<long, long, long, long>> drawn;
    SvgPath path;
    for (const auto& [from, to] : shapes.walls) {
        SvgPoint a = view.at(from), b = view.at(to);
        if (std::pair(b.x, b.y) < std::pair(a.x, a.y)) std::swap(a, b);
        const auto rounded = [](double pixels) { return std::lround(pixels * 4); };
        const std::tuple key(rounded(a.x), rounded(a.y), rounded(b.x), rounded(b.y));
        if (std::hypot(b.x - a.x, b.y - a.y) < 0.5 || !drawn.insert(key).second) continue;
        path.move_to(a).line_to(b);
    }
    if (!path.empty()) svg.path(path, {.stroke = style::faint_ink, .width = 0.8});
}

// Heights above ground on a grid of squares of the picture; rows from north to south.
struct HeightSamples {
    int columns = 0, rows = 0;
    std::vector<float> heights;
    double highest = 0;
};

HeightSamples sampled_heights(const UrbanScene& scene, const PlanView& view) {
    HeightSamples samples;
    samples.columns = std::max(1, static_cast<int>(view.size().x / sampled_pixels));
    samples.rows = std::max(1, static_cast<int>(view.size().y / sampled_pixels));
    const Eigen::Vector2d step(view.area().sizes().x() / samples.columns, view.area().sizes().y() / samples.rows);
    for (int row = 0; row < samples.rows; ++row)
        for (int column = 0; column < samples.columns; ++column) {
            const double east = view.area().min().x() + (column + 0.5) * step.x();
            const double north = view.area().max().y() - (row + 0.5) * step.y();
            const std::optional<double> top = scene.top_at(east, north);
            const double height = top ? *top - ground_height(scene, east, north) : 0;
            samples.heights.push_back(static_cast<float>(height));
            samples.highest = std::max(samples.highest, height);
        }
    return samples;
}

// Runs of one shade in each row, one path a shade.
void draw_samples(SvgDocument& svg, const HeightSamples& samples, const PlanView& view) {
    const double width = view.size().x / samples.columns;
    const double height = view.size().y / samples.rows;
    std::array<SvgPath, height_levels> paths;
    for (int row = 0; row < samples.rows; ++row) {
        const auto level_at = [&](int column) {
            return height_level(
                samples.heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(samples.columns) +
                                static_cast<std::size_t>(column)],
                samples.highest);
        };
        for (int begin = 0, end = 0; begin < samples.columns; begin = end) {
            const int level = level_at(begin);
            while (end < samples.columns && level_at(end) == level)
                ++end;
            const double y = view.corner().y + (row + 0.5) * height;
            if (level >= 0)
                paths[static_cast<std::size_t>(level)]
                    .move_to({view.corner().x + begin * width, y})
                    .line_to({view.corner().x + end * width, y});
        }
    }
    for (int level = 0; level < height_levels; ++level)
        if (const SvgPath& path = paths[static_cast<std::size_t>(level)]; !path.empty())
            svg.runs(path, level_colour(level), height + 0.05);
}

void draw_trees(SvgDocument& svg, const UrbanScene& scene, const PlanView& view) {
    SvgPath path;
    for (const FoliageVolume& trees : scene.foliage())
        if (const auto ring = clipped_polygon(trees.ring, view.area()); ring.size() >= 3)
            draw_outline(path, ring, view);
    if (!path.empty())
        svg.path(path, {.fill = style::foliage, .stroke = style::foliage_edge, .width = 0.8, .opacity = 0.75});
}

}  // namespace

double draw_city(SvgDocument& svg, const UrbanScene& scene, const PlanView& view, bool blank_ground) {
    svg.begin_group("city");
    if (blank_ground) svg.rectangle(view.corner(), view.size(), 0, {.fill = style::paper});
    double highest = 0;
    if (const auto shapes = shapes_of(scene, view.area())) {
        draw_roofs(svg, *shapes, view);
        draw_walls(svg, *shapes, view);
        highest = shapes->highest;
    } else {
        const HeightSamples samples = sampled_heights(scene, view);
        draw_samples(svg, samples, view);
        highest = samples.highest;
    }
    draw_trees(svg, scene, view);
    svg.rectangle(view.corner(), view.size(), 0, {.stroke = style::grid});
    svg.end_group();
    return highest;
}

}  // namespace skyloop::inline study
