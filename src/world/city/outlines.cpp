#include "detail/outlines.hpp"

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>

#include "detail/city_objects.hpp"
#include "detail/city_text.hpp"
#include "detail/ear_clipper.hpp"
#include "world/scene/city_model.hpp"

namespace skyloop::inline world {

namespace {

using Kind = OutlineUse::Kind;

constexpr double tree_height = 12;      ///< m, of woods without a height
constexpr double wood_width = 500;      ///< m, of one prism: 10 km from the origin the ground falls 0.8 m across it
constexpr double canopy_thickness = 1;  ///< m, of roofs without walls
constexpr double cell_width = 100;      ///< m, of the grid in which parts look for their building

/// What a part is to the outline it lies in.
struct Inner {
    Eigen::Vector2d point = Eigen::Vector2d::Zero();
    double area = 0;
};

Inner inner_of(const Footprint& footprint) {
    Inner inner;
    double largest = 0;
    std::vector<Eigen::Vector2d> points = footprint.outer;
    for (const auto& hole : footprint.holes)
        points.insert(points.end(), hole.begin(), hole.end());
    for (const auto& [a, b, c] : triangulated(footprint)) {
        const Eigen::Vector2d u = points[b] - points[a], v = points[c] - points[a];
        const double area = std::abs(u.x() * v.y() - u.y() * v.x()) / 2;
        inner.area += area;
        if (area > largest) inner.point = points[a] + (u + v) / 3;
        largest = std::max(largest, area);
    }
    return inner;
}

/// Buildings by the cells that their boxes touch; those that touch very many stand in a list of their own.
class BuildingGrid {
public:
    explicit BuildingGrid(const std::vector<Outline>& outlines) : outlines_(outlines) {
        for (std::size_t i = 0; i < outlines.size(); ++i)
            if (outlines[i].use.kind == Kind::building) insert(i);
    }
    /// The building around a place, and whether there is one.
    [[nodiscard]] std::optional<std::size_t> around(const Eigen::Vector2d& place) const {
        const auto [x, y] = cell(place);
        if (const auto found = cells_.find(key(x, y)); found != cells_.end())
            for (const std::size_t i : found->second)
                if (inside_ring(outlines_[i].footprint.outer, place)) return i;
        for (const std::size_t i : wide_)
            if (inside_ring(outlines_[i].footprint.outer, place)) return i;
        return std::nullopt;
    }

private:
    static std::pair<std::int64_t, std::int64_t> cell(const Eigen::Vector2d& place) {
        return {std::llround(place.x() / cell_width), std::llround(place.y() / cell_width)};
    }
    static std::int64_t key(std::int64_t x, std::int64_t y) { return x * 4'000'000 + y; }
    void insert(std::size_t i) {
        PlaceOnEarth::Extent box;
        for (const Eigen::Vector2d& point : outlines_[i].footprint.outer)
            box.include(point);
        if (box.empty() || std::max(box.lowest.cwiseAbs().maxCoeff(), box.highest.cwiseAbs().maxCoeff()) > 1e8) return;
        const auto [x0, y0] = cell(box.lowest);
        const auto [x1, y1] = cell(box.highest);
        if ((x1 - x0) * (y1 - y0) > 400 || x1 - x0 > 400 || y1 - y0 > 400) {
            wide_.push_back(i);
            return;
        }
        for (auto x = x0; x <= x1; ++x)
            for (auto y = y0; y <= y1; ++y)
                cells_[key(x, y)].push_back(i);
    }

    const std::vector<Outline>& outlines_;
    std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
    std::vector<std::size_t> wide_;
};

/// Lets parts inherit. @returns true for each outline whose parts cover at least half of it
std::vector<bool> outlines_of_parts(std::vector<Outline>& outlines) {
    std::vector<double> covered(outlines.size());
    const BuildingGrid grid(outlines);
    for (Outline& outline : outlines) {
        if (outline.use.kind != Kind::part) continue;
        const Inner inner = inner_of(outline.footprint);
        if (inner.area <= 0 || inner.point.cwiseAbs().maxCoeff() > 1e8) continue;
        const auto whole = grid.around(inner.point);
        if (!whole) continue;
        covered[*whole] += inner.area;
        inherit(outline.use, outlines[*whole].use);
    }
    std::vector<bool> replaced(outlines.size());
    for (std::size_t i = 0; i < outlines.size(); ++i)
        replaced[i] = covered[i] > 0 && covered[i] >= 0.5 * inner_of(outlines[i].footprint).area;
    return replaced;
}

/// The ground level with the origin, below the plane that touches the Earth there; flat where a file's metres are.
class LevelGround {
public:
    LevelGround(const PlaceOnEarth& place, const PlaceOnEarth::Extent& extent) {
        for (const Eigen::Vector2d& corner : {extent.lowest, extent.highest}) {
            const Eigen::Vector3d placed = place.on_ground(corner);
            const double square = placed.head<2>().squaredNorm();
            if (square > farthest_) fall_ = placed.z() / square;
            farthest_ = std::max(farthest_, square);
        }
    }
    [[nodiscard]] double below(const std::vector<Eigen::Vector2d>& ring) const {
        double sum = 0;
        for (const Eigen::Vector2d& corner : ring)
            sum += fall_ * corner.squaredNorm();
        return sum / static_cast<double>(ring.size());
    }

private:
    double farthest_ = 1, fall_ = 0;  ///< m², m
};

/// Raises what stands on outlines.
class OutlineBuilder {
public:
    OutlineBuilder(CityFile& file, const CityFileSettings& settings, const LevelGround& level)
        : file_(file), settings_(settings), level_(level) {
        file.model.materials.front() = settings.material;
    }
    void add(const Outline& outline, double ground);
    std::size_t without_height = 0;

private:
    void add_trees(const Outline& outline);

    CityFile& file_;
    const CityFileSettings& settings_;
    const LevelGround& level_;
};

void OutlineBuilder::add_trees(const Outline& outline) {
    const double height = outline.use.top.value_or(tree_height);
    const double base = outline.use.base > 0 ? outline.use.base : crown_base(0, height);
    const auto pieces = ring_pieces(EarClipper(outline.footprint).bridged_ring(), wood_width);
    if (pieces.empty() || height <= base) {
        ++file_.dropped;
        return;
    }
    for (const std::vector<Eigen::Vector2d>& ring : pieces) {
        const double ground = level_.below(ring);
        if (!(ground + base < ground + height)) continue;  // so low that rounding leaves nothing
        file_.model.foliage.push_back({ring, ground + base, ground + height, ground});
    }
}

void OutlineBuilder::add(const Outline& outline, double ground) {
    if (outline.use.kind == Kind::trees) {
        add_trees(outline);
        return;
    }
    double top = outline.use.top.value_or(settings_.default_height), base = outline.use.base;
    if (outline.use.canopy) base = std::max(0.0, top - canopy_thickness);
    // A base above an unknown top tells at least where the house begins.
    if (!outline.use.top && top <= base) top = base + settings_.metres_per_level;
    const std::uint8_t material =
        outline.use.material.empty() ? std::uint8_t{0} : file_.model.material_index(outline.use.material);
    const auto first = static_cast<std::uint32_t>(file_.model.vertices.size());
    if (!add_extruded(file_.model, outline.footprint, ground + base, ground + top, material)) {
        ++file_.dropped;
        return;
    }
    file_.model.grounded.push_back({first, static_cast<std::uint32_t>(file_.model.vertices.size()) - first, ground});
    ++file_.buildings;
    if (!outline.use.top) ++without_height;
}

/// Places the rings. @returns the height of the ground there
double place_footprint(Footprint& footprint, const PlaceOnEarth& place) {
    double sum = 0;
    const auto count = static_cast<double>(footprint.outer.size());
    for (Eigen::Vector2d& point : footprint.outer) {
        const Eigen::Vector3d placed = place.on_ground(point);
        sum += placed.z();
        point = placed.head<2>();
    }
    for (auto& hole : footprint.holes)
        for (Eigen::Vector2d& point : hole)
            point = place.on_ground(point).head<2>();
    return count > 0 ? sum / count : 0;
}

PlaceOnEarth::Extent extent_of(std::vector<Outline>& outlines, const ReferenceSystem& system) {
    PlaceOnEarth::Extent extent;
    LongitudeTurn turn;
    for (Outline& outline : outlines) {
        if (system.kind == CoordinateKind::geographic) turn_longitudes(outline.footprint, turn);
        for (const Eigen::Vector2d& point : outline.footprint.outer)
            extent.include(point);
    }
    return extent;
}

void add_outline_warnings(CityFile& file, std::size_t without_height, const CityFileSettings& settings) {
    if (without_height > 0)
        file.warnings.push_back(fmt::format("{} of {} buildings have no height or levels: taken as {:g} m tall",
                                            without_height, file.buildings, settings.default_height));
    if (file.dropped > 0)
        file.warnings.push_back(
            fmt::format("{} outlines without area or with wrong or missing corners were left out", file.dropped));
}

}  // namespace

void inherit(OutlineUse& use, const OutlineUse& from) {
    if (!use.top && from.top && *from.top > use.base) use.top = from.top;
    if (use.material.empty()) use.material = from.material;
}

void turn_longitudes(Footprint& footprint, LongitudeTurn& turn) {
    for (Eigen::Vector2d& point : footprint.outer)
        point.x() = turn(point.x());
    for (auto& hole : footprint.holes)
        for (Eigen::Vector2d& point : hole)
            point.x() = turn(point.x());
}

Result<CityFile> city_of_outlines(Outlines read, std::string_view format, std::string_view name,
                                  const CityFileSettings& settings) {
    CityFile file;
    file.format = format;
    file.dropped = read.dropped;
    file.warnings = std::move(read.warnings);
    const PlaceOnEarth::Extent extent = extent_of(read.outlines, read.system);
    if (extent.empty())
        return fail(ErrorCode::input,
                    read.dropped == 0 ? fmt::format("{}: no outline of a building or wood", name)
                                      : fmt::format("{}: the corners of all {} outlines are wrong or not in the file",
                                                    name, read.dropped));
    const auto place = PlaceOnEarth::make(read.system, extent, std::nullopt, settings);
    if (!place)
        return fail(place.error().code,
                    fmt::format("{}: {}: {}", name, shown(read.system.name), place.error().message));
    file.model.origin = place->origin();
    file.anchor = place->anchor();
    constexpr bool has_heights = false;
    for (std::string& doubt : place->doubts(settings, has_heights))
        file.warnings.push_back(std::move(doubt));
    for (std::string& warning : PlaceOnEarth::unused_settings(read.system, settings))
        file.warnings.push_back(std::move(warning));
    std::vector<double> grounds;
    for (Outline& outline : read.outlines)
        grounds.push_back(place_footprint(outline.footprint, *place));
    const std::vector<bool> replaced = outlines_of_parts(read.outlines);
    const LevelGround level(*place, extent);
    OutlineBuilder builder(file, settings, level);
    for (std::size_t i = 0; i < read.outlines.size(); ++i) {
        if (!replaced[i]) builder.add(read.outlines[i], grounds[i]);
        if (file.model.triangles.size() > settings.most_triangles) return too_many_triangles(name, settings);
    }
    add_outline_warnings(file, builder.without_height, settings);
    if (file.model.triangles.empty() && file.model.foliage.empty())
        return fail(ErrorCode::input,
                    fmt::format("{}: none of its {} outlines could be used", name, read.outlines.size()));
    return file;
}

}  // namespace skyloop::inline world
