#include "detail/mesh_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/core/words.hpp"
#include "detail/city_text.hpp"
#include "detail/place_on_earth.hpp"
#include "world/city/footprint.hpp"

namespace skyloop::inline world {
namespace {

// Farther than any city from its origin: such a coordinate is as good as none.
constexpr double farthest_coordinate = 1e9;
// Twice the area below which a triangle has no plane worth the name, m².
constexpr double least_doubled_area = 1e-9;
// Corners of a polygon that is not convex beyond which cutting it takes too long.
constexpr std::size_t most_concave_corners = 20'000;

// Twice the area along the normal (Newell's sum), which a polygon that is not quite plane has, too.
template <class At>
Eigen::Vector3d doubled_area(std::span<const std::uint32_t> corners, const At& at) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const Eigen::Vector3d& start = at(corners[0]);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum += (at(corners[i]) - start).cross(at(corners[i + 1]) - start);
    return sum;
}

// A fan from the first corner covers it: all of its triangles turn the same way.
template <class At>
bool fan_covers(std::span<const std::uint32_t> corners, const Eigen::Vector3d& normal, const At& at) {
    const Eigen::Vector3d& start = at(corners[0]);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        if ((at(corners[i]) - start).cross(at(corners[i + 1]) - start).dot(normal) < 0) return false;
    return true;
}

}  // namespace

MeshBuilder::MeshBuilder(const CityFileSettings& settings, std::string_view name, std::string_view usual_axes)
    : name_(name),
      settings_(settings),
      of_a_map_(!settings.file_crs.empty() && settings.file_crs != "local"),
      most_triangles_(std::min<std::size_t>(settings.most_triangles, std::numeric_limits<std::uint32_t>::max() / 3)),
      most_vertices_(std::max<std::size_t>(1000, 3 * most_triangles_)),
      to_city_(Eigen::Affine3d::Identity()),
      placement_(Eigen::Affine3d::Identity()) {
    const FileAxes axes = settings.axes ? *settings.axes : FileAxes::parse(usual_axes).value_or(FileAxes{});
    Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) {
        const auto which = static_cast<std::size_t>(i);
        turn(i, axes.axis[which]) = axes.sign[which] * settings.metres_per_unit;
    }
    to_city_.linear() = turn;
    if (!of_a_map_) to_city_.translate(-settings.file_origin);
    placement_ = to_city_;
    model_.origin = settings.origin.value_or(Geodetic{});
    model_.materials = {settings.material};
}

void MeshBuilder::begin_mesh(const Eigen::Affine3d& placement) {
    first_vertex_ = model_.vertices.size();
    placement_ = to_city_ * placement;
}

MeshPart MeshBuilder::part(std::string_view material, std::span<const std::string_view> names) {
    MeshPart part;
    const std::string meant = material_of_name(material);
    if (!meant.empty()) part.material = model_.material_index(meant);
    // A material may be called "terrain", too, but Blender's "Plane" is a name of objects.
    part.ground = lower_case(material).find("plane") == std::string::npos && names_ground(material);
    for (const std::string_view name : names)
        part.ground = part.ground || names_ground(name);
    return part;
}

bool MeshBuilder::may_add(std::size_t vertices, std::size_t triangles) const {
    return triangles <= most_triangles_ - model_.triangles.size() &&
           vertices <= most_vertices_ - model_.vertices.size();
}

tl::unexpected<Error> MeshBuilder::too_many() const {
    const double each = sizeof(CityTriangle) + 3 * sizeof(Eigen::Vector3d);
    return fail(
        ErrorCode::input,
        fmt::format("{}: holds more than {} triangles or {} vertices, the most that is read ({:.3g} GB of memory "
                    "before the scene is built)",
                    name_, most_triangles_, most_vertices_, each * static_cast<double>(most_triangles_) / 1e9));
}

void MeshBuilder::reserve(std::size_t vertices, std::size_t triangles) {
    model_.vertices.reserve(model_.vertices.size() + vertices);
    model_.triangles.reserve(model_.triangles.size() + triangles);
}

bool MeshBuilder::add_vertex(const Eigen::Vector3d& as_in_file) {
    if (model_.vertices.size() >= most_vertices_) return false;
    Eigen::Vector3d place = placement_ * as_in_file;
    // Stays to keep the count; finish() takes it out. Infinity times zero of the turn is no number either.
    if (!(place.cwiseAbs().maxCoeff() <= farthest_coordinate)) place.setConstant(std::nan(""));
    model_.vertices.push_back(place);
    return true;
}

bool MeshBuilder::add_polygon(std::span<const std::uint32_t> corners, MeshPart part) {
    if (corners.size() < 3) {
        ++without_area_;
        return true;
    }
    if (corners.size() == 3) return add_triangle({corners[0], corners[1], corners[2]}, part);
    const auto place = [this](std::uint32_t corner) -> const Eigen::Vector3d& { return at(corner); };
    const Eigen::Vector3d normal = doubled_area(corners, place);
    if (!normal.allFinite()) {
        ++not_finite_;
        return true;
    }
    if (normal.norm() <= least_doubled_area) {
        ++without_area_;
        return true;
    }
    if (!fan_covers(corners, normal, place)) return add_concave(corners, normal, part);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        if (!add_triangle({corners[0], corners[i], corners[i + 1]}, part)) return false;
    return true;
}

// Cut in the plane that it faces most.
bool MeshBuilder::add_concave(std::span<const std::uint32_t> corners, const Eigen::Vector3d& normal, MeshPart part) {
    if (corners.size() > most_concave_corners) {
        warn(fmt::format("{}: a polygon with {} corners that is not convex was dropped; at most {} can be cut", name_,
                         corners.size(), most_concave_corners));
        ++without_area_;
        return true;
    }
    Eigen::Index away = 0;
    normal.cwiseAbs().maxCoeff(&away);
    Footprint flat;
    for (const std::uint32_t corner : corners)
        flat.outer.emplace_back(at(corner)[(away + 1) % 3], at(corner)[(away + 2) % 3]);
    const auto pieces = triangulated(flat);
    if (pieces.empty()) ++without_area_;
    for (const auto& piece : pieces)
        if (!add_triangle({corners[piece[0]], corners[piece[1]], corners[piece[2]]}, part)) return false;
    return true;
}

bool MeshBuilder::add_triangle(const std::array<std::uint32_t, 3>& corners, MeshPart part) {
    const Eigen::Vector3d& a = at(corners[0]);
    const Eigen::Vector3d normal = (at(corners[1]) - a).cross(at(corners[2]) - a);
    const double area = normal.norm();
    if (!std::isfinite(area)) {
        ++not_finite_;
        return true;
    }
    if (area <= least_doubled_area) {
        ++without_area_;
        return true;
    }
    if (model_.triangles.size() >= most_triangles_) return false;
    const bool level = std::abs(normal.z()) > 0.5 * area;
    const SurfaceKind kind = !level ? SurfaceKind::wall : part.ground ? SurfaceKind::ground : SurfaceKind::roof;
    const auto first = static_cast<std::uint32_t>(first_vertex_);
    model_.triangles.push_back({{first + corners[0], first + corners[1], first + corners[2]}, kind, part.material});
    return true;
}

void MeshBuilder::drop_unused_vertices() {
    constexpr std::uint32_t unused = ~0U;
    std::vector<std::uint32_t> renumbered(model_.vertices.size(), unused);
    for (const CityTriangle& triangle : model_.triangles)
        for (const std::uint32_t corner : triangle.corners)
            renumbered[corner] = 0;
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < renumbered.size(); ++i) {
        if (renumbered[i] == unused) continue;
        model_.vertices[kept] = model_.vertices[i];
        renumbered[i] = kept++;
    }
    if (kept == renumbered.size()) return;
    model_.vertices.resize(kept);
    for (CityTriangle& triangle : model_.triangles)
        for (std::uint32_t& corner : triangle.corners)
            corner = renumbered[corner];
}

void MeshBuilder::find_ground() {
    Eigen::Vector3d lowest = model_.vertices.front(), highest = lowest;
    for (const Eigen::Vector3d& vertex : model_.vertices) {
        lowest = lowest.cwiseMin(vertex);
        highest = highest.cwiseMax(vertex);
    }
    const double level = lowest.z() + 0.5;
    if (highest.z() < level + 2) return;
    double covered = 0;
    std::vector<CityTriangle*> at_the_bottom;
    for (CityTriangle& triangle : model_.triangles) {
        const auto& [i, j, k] = triangle.corners;
        const Eigen::Vector3d &a = model_.vertices[i], &b = model_.vertices[j], &c = model_.vertices[k];
        if (triangle.kind != SurfaceKind::roof || std::max({a.z(), b.z(), c.z()}) > level) continue;
        covered += 0.5 * std::abs((b - a).cross(c - a).z());
        at_the_bottom.push_back(&triangle);
    }
    const Eigen::Vector3d extent = highest - lowest;
    if (covered < 0.25 * extent.x() * extent.y()) return;
    for (CityTriangle* triangle : at_the_bottom)
        triangle->kind = SurfaceKind::ground;
}

void MeshBuilder::tell_dropped() {
    if (not_finite_ + without_area_ == 0) return;
    warn(fmt::format("{}: dropped {} facets with a corner that is no number or beyond any city, and {} without area",
                     name_, not_finite_, without_area_));
}

Result<CityFile> MeshBuilder::finish(std::string format) {
    tell_dropped();
    if (model_.triangles.empty())
        return fail(ErrorCode::input,
                    not_finite_ + without_area_ == 0
                        ? fmt::format("{}: holds no triangle", name_)
                        : fmt::format("{}: holds no triangle that can be used; {}", name_, warnings_.back()));
    drop_unused_vertices();
    find_ground();
    CityFile file;
    file.format = std::move(format);
    // Height grids of the same map lie beside the mesh.
    const Eigen::Vector3d at_origin = -to_city_.translation();
    if (at_origin.head<2>().cwiseAbs().maxCoeff() > farthest_local)
        file.anchor = MapAnchor{"unnamed", false, at_origin.x(), at_origin.y(), at_origin.z()};
    file.dropped = not_finite_ + without_area_ + shapes_;
    file.warnings = std::move(warnings_);
    file.model = std::move(model_);
    if (of_a_map_)
        if (auto laid = lay_on_map(file); !laid) return fail(std::move(laid.error()));
    return file;
}

// From the coordinates of the map to the frame; what is lowest is the ground.
Result<void> MeshBuilder::lay_on_map(CityFile& file) {
    const ReferenceSystem system = reference_system_of_file("", settings_).value_or(ReferenceSystem{});
    PlaceOnEarth::Extent extent;
    double lowest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& vertex : file.model.vertices) {
        extent.include(vertex.head<2>());
        lowest = std::min(lowest, vertex.z());
    }
    CityFileSettings in_metres = settings_;
    in_metres.metres_per_unit = 1;  // has been applied
    const auto place = PlaceOnEarth::make(system, extent, lowest, in_metres);
    if (!place) return fail(place.error().code, fmt::format("{}: {}: {}", name_, system.name, place.error().message));
    for (Eigen::Vector3d& vertex : file.model.vertices)
        vertex = (*place)(vertex);
    file.model.origin = place->origin();
    file.anchor = place->anchor();
    for (const std::string& doubt : place->doubts(settings_, true))
        file.warnings.push_back(fmt::format("{}: {}", name_, doubt));
    if (settings_.file_origin != Eigen::Vector3d::Zero())
        file.warnings.push_back(fmt::format("{}: file_origin means nothing beside file_crs", name_));
    return {};
}

}  // namespace skyloop::inline world
