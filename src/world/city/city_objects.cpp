#include "detail/city_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/core/std_additions.hpp"
#include "detail/city_text.hpp"
#include "world/city/footprint.hpp"

namespace skyloop::inline world {

namespace {

/// Bytes that a triangle takes in a CityModel and in a scene with its tree, planes and tables.
constexpr double bytes_per_triangle = 300;
/// Metres above its lowest point within which a level surface is the floor of a construction.
constexpr double floor_thickness = 0.2;
/// Metres from which a plant cover hides what is behind.
constexpr double least_plants = 2;
/// Area over that of its hull below which a plant cover is too ragged for one prism.
constexpr double least_filling = 0.5;

bool one_of(std::string_view word, std::initializer_list<std::string_view> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Calls with(point) for each corner of all rings.
template <class Surfaces, class With>
void for_each_point(Surfaces& surfaces, With with) {
    for (auto& surface : surfaces)
        for (auto& ring : surface.rings)
            for (auto& point : ring)
                with(point);
}

struct Heights {
    double lowest = std::numeric_limits<double>::infinity(), highest = -std::numeric_limits<double>::infinity();
};

Heights heights_of(const std::vector<ObjectSurface>& surfaces) {
    Heights heights;
    for_each_point(surfaces, [&](const Eigen::Vector3d& point) {
        heights.lowest = std::min(heights.lowest, point.z());
        heights.highest = std::max(heights.highest, point.z());
    });
    return heights;
}

/// Level 0 alone tells no heights of a construction.
const std::vector<ObjectSurface>* best_surfaces(const CityObject& object) {
    if (object.levels.empty() || object.object_class == ObjectClass::ignored) return nullptr;
    const auto& [level, surfaces] = *object.levels.rbegin();
    const bool useful = level >= 10 || object.object_class != ObjectClass::construction;
    return useful ? &surfaces : nullptr;
}

int best_level(const CityObject& object) { return best_surfaces(object) ? object.levels.rbegin()->first : -1; }

/// Median height of the feet of buildings, else of everything: what stands for the ground.
double ground_level(const std::vector<CityObject>& objects) {
    std::vector<double> feet, all;
    for (const CityObject& object : objects) {
        const auto* surfaces = best_surfaces(object);
        if (!surfaces) continue;
        const double lowest = heights_of(*surfaces).lowest;
        if (!std::isfinite(lowest)) continue;
        all.push_back(lowest);
        if (object.building) feet.push_back(lowest);
    }
    std::vector<double>& heights = feet.empty() ? all : feet;
    if (heights.empty()) return 0;
    return middle_of(heights);
}

/// Makes triangles and trees of objects.
class ObjectBuilder {
public:
    ObjectBuilder(CityFile& file, const CityFileSettings& settings) : file_(file) {
        CityModel& model = file.model;
        if (settings.material != model.materials.front()) model.materials.front() = settings.material;
    }

    void add(const CityObject& object, const PlaceOnEarth& place);
    std::size_t ragged = 0;

private:
    void add_construction(const std::vector<ObjectSurface>& surfaces);
    bool add_plants(const std::vector<ObjectSurface>& surfaces, bool tree);
    void add_surface(const ObjectSurface& surface, SurfaceKind kind);

    CityFile& file_;
};

void ObjectBuilder::add(const CityObject& object, const PlaceOnEarth& place) {
    std::vector<ObjectSurface> surfaces = *best_surfaces(object);
    for_each_point(surfaces, [&](Eigen::Vector3d& point) { point = place(point); });
    if (object.object_class == ObjectClass::construction) {
        add_construction(surfaces);
    } else if (object.object_class == ObjectClass::terrain ||
               !add_plants(surfaces, object.object_class == ObjectClass::tree)) {
        for (const ObjectSurface& surface : surfaces)
            add_surface(surface, SurfaceKind::ground);
    }
}

void ObjectBuilder::add_surface(const ObjectSurface& surface, SurfaceKind kind) {
    const std::uint8_t material =
        surface.use == SurfaceUse::window ? file_.model.material_index("glass") : std::uint8_t{0};
    if (!add_polygon(file_.model, surface.rings, kind, material)) ++file_.dropped;
}

void ObjectBuilder::add_construction(const std::vector<ObjectSurface>& surfaces) {
    // What is thin as a whole, such as the deck of a bridge, has no floor of its own.
    const auto [lowest, highest] = heights_of(surfaces);
    const double floor = highest > lowest + floor_thickness ? lowest + floor_thickness : lowest - 1;
    const bool told = std::any_of(surfaces.begin(), surfaces.end(), [](const ObjectSurface& surface) {
        return surface.use == SurfaceUse::wall || surface.use == SurfaceUse::roof;
    });
    for (const ObjectSurface& surface : surfaces) {
        if (surface.use == SurfaceUse::floor || surface.use == SurfaceUse::hidden) continue;
        if (told && surface.use == SurfaceUse::unknown) continue;  // a solid beside its own told surfaces
        if (surface.use != SurfaceUse::unknown && surface.use != SurfaceUse::by_slope) {
            add_surface(surface, surface.use == SurfaceUse::roof ? SurfaceKind::roof : SurfaceKind::wall);
            continue;
        }
        const Eigen::Vector3d normal = area_vector(surface.rings.front());
        const bool level = normal.z() != 0 && std::abs(normal.z()) >= 0.5 * normal.norm();
        const auto& ring = surface.rings.front();
        const bool low = std::all_of(ring.begin(), ring.end(), [&](const auto& point) { return point.z() <= floor; });
        if (!(level && low)) add_surface(surface, level ? SurfaceKind::roof : SurfaceKind::wall);
    }
}

bool ObjectBuilder::add_plants(const std::vector<ObjectSurface>& surfaces, bool tree) {
    std::vector<Eigen::Vector2d> points;
    double area = 0, volume = 0, highest = -1e300;
    const double lowest = heights_of(surfaces).lowest;
    for (const ObjectSurface& surface : surfaces) {
        double mean = 0;
        for (const Eigen::Vector3d& point : surface.rings.front()) {
            points.emplace_back(point.head<2>());
            mean += point.z() / static_cast<double>(surface.rings.front().size());
            highest = std::max(highest, point.z());
        }
        const double flat = std::abs(area_vector(surface.rings.front()).z()) / 2;
        area += flat;
        volume += flat * (mean - lowest);
    }
    // A tree's surfaces lie around it: its top is the highest; a cover's mean height is that of its surface.
    const double top = tree ? highest : lowest + (area > 0 ? volume / area : 0);
    if (!(top - lowest >= least_plants)) return false;
    const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(points));
    if (hull.size() < 3 || (!tree && area < least_filling * hull_area(hull))) {
        ++ragged;
        return true;
    }
    FoliageVolume& foliage = file_.model.foliage.emplace_back();
    foliage.ring = hull;
    foliage.base = crown_base(lowest, top);
    foliage.top = top;
    return true;
}

/// True for each object that is not shown: what parts tell better, and parts that tell less than their whole. Of the
/// same level a whole tells its main part (OGC 12-019, 10.3), beside which the others stand; where it repeats them,
/// facets lie in each other, which blocks and reflects as one of them does.
std::vector<bool> replaced_objects(const std::vector<CityObject>& objects) {
    std::vector<int> parts(objects.size(), -1);
    for (const CityObject& object : objects)
        if (object.parent) parts[*object.parent] = std::max(parts[*object.parent], best_level(object));
    std::vector<bool> replaced(objects.size());
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const int own = best_level(objects[i]);
        replaced[i] = own < 0 || parts[i] > own;
        if (objects[i].parent && best_level(objects[*objects[i].parent]) > parts[*objects[i].parent])
            replaced[i] = true;
    }
    return replaced;
}

/// The warning of constructions that are told by level 0 alone, as wholes and parts; empty without any.
std::string told_by_outlines(const std::vector<CityObject>& objects) {
    std::vector<bool> outline(objects.size()), told(objects.size());
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::size_t whole = objects[i].parent.value_or(i);
        if (best_surfaces(objects[i])) told[whole] = true;
        if (objects[i].object_class == ObjectClass::construction && !objects[i].levels.empty()) outline[whole] = true;
    }
    std::size_t alone = 0;
    for (std::size_t i = 0; i < objects.size(); ++i)
        if (outline[i] && !told[i]) ++alone;
    if (alone == 0) return {};
    return fmt::format(
        "{} buildings or other constructions are told by their outlines alone (level 0) and were left out", alone);
}

PlaceOnEarth::Extent extent_of(const std::vector<CityObject>& objects) {
    PlaceOnEarth::Extent extent;
    for (const CityObject& object : objects)
        if (const auto* surfaces = best_surfaces(object))
            for (const ObjectSurface& surface : *surfaces)
                for (const Eigen::Vector3d& point : surface.rings.front())
                    extent.include(surface.reference_point.value_or(point).head<2>());
    return extent;
}

/// Changes coordinates of the file; shapes go where their reference points go.
template <class Change>
void change_points(std::vector<CityObject>& objects, Change change) {
    for (CityObject& object : objects)
        for (auto& [level, surfaces] : object.levels)
            for (ObjectSurface& surface : surfaces) {
                if (surface.reference_point) {
                    change(*surface.reference_point);
                    continue;
                }
                for (auto& ring : surface.rings)
                    std::for_each(ring.begin(), ring.end(), change);
            }
}

void exchange_axes(std::vector<CityObject>& objects) {
    change_points(objects, [](Eigen::Vector3d& point) { std::swap(point.x(), point.y()); });
}

PlaceOnEarth::Extent exchanged(PlaceOnEarth::Extent extent) {
    std::swap(extent.lowest.x(), extent.lowest.y());
    std::swap(extent.highest.x(), extent.highest.y());
    return extent;
}

/// Whether numbers are degrees though their system is none that is known, by themselves. Those of EPSG stand in its
/// order, latitude first, others with the longitude first unless that is too great for a latitude.
bool turn_out_to_be_degrees(std::vector<CityObject>& objects, bool latitude_first) {
    const PlaceOnEarth::Extent extent = extent_of(objects);
    const bool exchange = latitude_first || (std::abs(extent.middle().y()) > 90 && std::abs(extent.middle().x()) <= 90);
    if (!(exchange ? exchanged(extent) : extent).is_of_degrees()) return false;
    if (exchange) exchange_axes(objects);
    return true;
}

/// Degrees that stand against the order of their system, where it shows: a longitude that is no latitude.
bool turn_out_to_be_exchanged(std::vector<CityObject>& objects) {
    const PlaceOnEarth::Extent extent = extent_of(objects);
    if (extent.on_globe() || !exchanged(extent).fits_degrees()) return false;
    exchange_axes(objects);
    return true;
}

/// The system of what was read; east stands first and longitudes lie together afterwards.
ReferenceSystem settle_system(CityObjects& read, std::vector<std::string>& warnings, const CityFileSettings& settings) {
    ReferenceSystem system = read.system.value_or(unnamed_system(CoordinateKind::projected));
    const bool of_epsg = system.name.starts_with("EPSG:");
    if (system.kind == CoordinateKind::projected && turn_out_to_be_degrees(read.objects, of_epsg)) {
        warnings.push_back(fmt::format("coordinates ({}) are taken as degrees of WGS-84, {} first", shown(system.name),
                                       of_epsg ? "latitude" : "longitude"));
        return wgs84_degrees(system.name);
    }
    if (system.north_first) exchange_axes(read.objects);
    if (system.map && system.kind == CoordinateKind::projected &&
        PlaceOnEarth::stands_exchanged(system, extent_of(read.objects).middle(), settings)) {
        exchange_axes(read.objects);
        warnings.push_back(fmt::format("coordinates ({}) stand {} first, by where they lie", shown(system.name),
                                       system.north_first ? "east" : "north"));
    }
    if (system.kind == CoordinateKind::geographic) {
        if (turn_out_to_be_exchanged(read.objects))
            warnings.push_back(fmt::format("coordinates ({}) stand {} first, against their system", shown(system.name),
                                           system.north_first ? "longitude" : "latitude"));
        LongitudeTurn turn;
        change_points(read.objects, [&](Eigen::Vector3d& point) { point.x() = turn(point.x()); });
    }
    return system;
}

/// From metres east, north and up of a place to the file's coordinates.
Eigen::Vector3d place_beside(const Eigen::Vector3d& place, const Eigen::Vector3d& way, CoordinateKind kind) {
    if (kind != CoordinateKind::geographic) return place + way;
    const Angle latitude = Angle::degrees(place.y());
    const CurvatureRadii radii = curvature_radii(latitude);
    const double parallel = radii.prime_vertical * std::cos(latitude.rad());
    return place + Eigen::Vector3d(Angle::radians(way.x() / parallel).deg(),
                                   Angle::radians(way.y() / radii.meridian).deg(), way.z());
}

/// Lays the shapes of implicit geometries about their reference points.
void lay_shapes(std::vector<CityObject>& objects, CoordinateKind kind) {
    for (CityObject& object : objects)
        for (auto& [level, surfaces] : object.levels)
            for (ObjectSurface& surface : surfaces) {
                if (!surface.reference_point) continue;
                for (auto& ring : surface.rings)
                    for (Eigen::Vector3d& point : ring)
                        point = place_beside(*surface.reference_point, point, kind);
                surface.reference_point.reset();
            }
}

}  // namespace

ObjectClass object_class(std::string_view type) {
    if (one_of(type,
               {"BuildingRoom", "BuildingFurniture", "BuildingUnit", "BuildingStorey", "BridgeRoom",
                "TunnelHollowSpace", "BridgeFurniture", "TunnelFurniture", "CityObjectGroup", "Room", "CityModel"}))
        return ObjectClass::ignored;
    if (one_of(type, {"TINRelief", "ReliefFeature", "LandUse", "Road", "Railway", "Track", "Square", "TransportSquare",
                      "Waterway", "WaterBody", "TransportationComplex"}))
        return ObjectClass::terrain;
    if (type == "PlantCover") return ObjectClass::plants;
    if (type == "SolitaryVegetationObject") return ObjectClass::tree;
    return ObjectClass::construction;
}

SurfaceUse surface_use(std::string_view type) {
    if (one_of(type, {"WallSurface", "Door", "DoorSurface"})) return SurfaceUse::wall;
    if (one_of(type, {"RoofSurface", "OuterCeilingSurface", "OuterFloorSurface"})) return SurfaceUse::roof;
    if (one_of(type, {"Window", "WindowSurface"})) return SurfaceUse::window;
    if (type == "GroundSurface") return SurfaceUse::floor;
    if (one_of(type, {"ClosureSurface", "InteriorWallSurface", "CeilingSurface", "FloorSurface", "interiorRoom"}))
        return SurfaceUse::hidden;
    return SurfaceUse::unknown;
}

tl::unexpected<Error> too_many_triangles(std::string_view name, const CityFileSettings& settings) {
    const auto most = static_cast<double>(settings.most_triangles);
    return fail(ErrorCode::input, fmt::format("{}: more than {} triangles, which would take some {:.1f} GB of memory; "
                                              "raise the limit or cut the city smaller",
                                              name, settings.most_triangles, most * bytes_per_triangle / 1e9));
}

Result<CityFile> city_of_objects(CityObjects read, std::string_view format, std::string_view name,
                                 const CityFileSettings& settings) {
    CityFile file;
    file.format = format;
    file.dropped = read.dropped;
    file.warnings = std::move(read.warnings);
    const ReferenceSystem system = settle_system(read, file.warnings, settings);
    lay_shapes(read.objects, system.kind);
    const auto extent = extent_of(read.objects);
    const std::string outlines = told_by_outlines(read.objects);
    if (extent.empty())
        return fail(ErrorCode::input,
                    fmt::format("{}: {}", name, outlines.empty() ? "no surface that could be used" : outlines));
    if (!outlines.empty()) file.warnings.push_back(outlines);
    const double ground = ground_level(read.objects);
    const auto place = PlaceOnEarth::make(system, extent, ground, settings);
    if (!place)
        return fail(place.error().code, fmt::format("{}: {}: {}", name, shown(system.name), place.error().message));
    file.model.origin = place->origin();
    for (std::string& warning : PlaceOnEarth::unused_settings(system, settings))
        file.warnings.push_back(std::move(warning));
    file.anchor = place->anchor();
    for (std::string& doubt : place->doubts(settings, true))
        file.warnings.push_back(std::move(doubt));
    const std::vector<bool> replaced = replaced_objects(read.objects);
    ObjectBuilder builder(file, settings);
    std::set<std::size_t> buildings;
    for (std::size_t i = 0; i < read.objects.size(); ++i) {
        if (replaced[i]) continue;
        builder.add(read.objects[i], *place);
        if (read.objects[i].building) buildings.insert(read.objects[i].parent.value_or(i));
        if (file.model.triangles.size() > settings.most_triangles) return too_many_triangles(name, settings);
    }
    file.buildings = buildings.size();
    if (file.dropped > 0)
        file.warnings.push_back(
            fmt::format("{} surfaces without area or with wrong corners were left out", file.dropped));
    if (builder.ragged > 0)
        file.warnings.push_back(fmt::format("{} plant covers of ragged outline were left out", builder.ragged));
    if (file.model.triangles.empty() && file.model.foliage.empty())
        return fail(ErrorCode::input, fmt::format("{}: no surface that could be used", name));
    return file;
}

}  // namespace skyloop::inline world
