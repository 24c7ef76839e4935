#include "detail/earth_map.hpp"

#include <fmt/format.h>
#include <proj.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>

#include "base/core/bytes.hpp"
#include "base/core/words.hpp"
#include "detail/city_text.hpp"

namespace skyloop::inline world {
namespace {

constexpr double margin_longitude = 15, margin_latitude = 10;  // °; countries with one zone reach some 700 km beyond it
constexpr double utm_zone_unit = 1e6;
constexpr double good_accuracy = 1;  // m, of an operation
constexpr double same_place = 1000;  // units of a map: there and back by other operations of the same datum

/// Of the name "ETRS89 / UTM zone 32N"; 0 for other maps.
int utm_zone(std::string_view name) {
    constexpr std::string_view words = "UTM zone ";
    const std::size_t at = name.find(words);
    return at == std::string_view::npos ? 0 : std::atoi(std::string(name.substr(at + words.size(), 2)).c_str());
}

/// PROJ looks for systems whose names are like a text that is none.
bool is_a_likeness(const std::string& definition, const PJ* found) {
    if (definition.find_first_of("[{=") != std::string::npos || definition.starts_with("EPSG:")) return false;
    const char* code = proj_get_id_code(found, 0);
    return !(code && definition.ends_with(code)) && lower_case(proj_get_name(found)) != lower_case(definition);
}

PJ_COORD coordinate(double x, double y, double z = 0) { return proj_coord(x, y, z, HUGE_VAL); }

}  // namespace

EarthMap::EarthMap() : context_(proj_context_create(), proj_context_destroy) {
    proj_log_level(context_.get(), PJ_LOG_NONE);
    proj_context_set_enable_network(context_.get(), 0);
}

Result<std::shared_ptr<EarthMap>> EarthMap::open(const std::string& definition) {
    const std::shared_ptr<EarthMap> map(new EarthMap);
    if (const auto read = map->read(definition); !read) return fail(read.error());
    return map;
}

EarthMap::Object EarthMap::object(PJconsts* made) const {
    return {made, [context = context_](PJ* old) { proj_destroy(old); }};
}

Result<void> EarthMap::read(const std::string& definition) {
    PJ_CONTEXT* const c = context_.get();
    if (!proj_context_get_database_path(c))
        return fail(ErrorCode::outside, "PROJ's database proj.db is missing: install the package proj-data");
    system_ = object(proj_create(c, definition.c_str()));
    if (!system_ || !proj_is_crs(system_.get()) || is_a_likeness(definition, system_.get()))
        return fail(ErrorCode::input, fmt::format("is no reference system that PROJ {} knows", proj_info().version));
    flat_system_ = system_;
    if (proj_get_type(system_.get()) == PJ_TYPE_COMPOUND_CRS) {
        flat_system_ = object(proj_crs_get_sub_crs(c, system_.get(), 0));
        vertical_system = shown(proj_get_name(object(proj_crs_get_sub_crs(c, system_.get(), 1)).get()));
    }
    const bool bound = proj_get_type(flat_system_.get()) == PJ_TYPE_BOUND_CRS;
    const Object plain = bound ? object(proj_get_source_crs(c, flat_system_.get())) : flat_system_;
    const PJ_TYPE type = proj_get_type(plain.get());
    geographic = type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
    if (!geographic && type != PJ_TYPE_PROJECTED_CRS)
        return fail(ErrorCode::input, "is of another kind; expected a system of a map, or of latitudes and longitudes");
    zone_ = utm_zone(proj_get_name(plain.get()));
    const Object axes = object(proj_crs_get_coordinate_system(c, plain.get()));
    const char *axis = "", *way = "";
    proj_cs_get_axis_info(c, axes.get(), 0, &axis, nullptr, &way, nullptr, nullptr, nullptr, nullptr);
    north_first = std::string_view(way) == "north" || std::string_view(axis) == "Northing";  // at the pole: south
    wgs84_ = object(proj_create(c, "EPSG:4326"));
    wgs84_heights_ = object(proj_create(c, "EPSG:4979"));
    flat_ = operation(flat_system_, wgs84_);
    if (!flat_) return fail(ErrorCode::input, "has no way to WGS 84 in PROJ");
    if (!vertical_system.empty()) heights_ = operation(system_, wgs84_heights_);
    if (!proj_get_area_of_use(c, flat_system_.get(), &west_, &south_, &east_, &north_, nullptr) || west_ < -180)
        west_ = -180, south_ = -90, east_ = 180, north_ = 90;
    return {};
}

EarthMap::Object EarthMap::operation(const Object& from, const Object& to) const {
    PJ_CONTEXT* const c = context_.get();
    const Object registered = object(proj_create_crs_to_crs_from_pj(c, from.get(), to.get(), nullptr, nullptr));
    return registered ? object(proj_normalize_for_visualization(c, registered.get())) : nullptr;
}

EarthMap::Object EarthMap::used_at(const Object& operations, const Eigen::Vector2d& place) const {
    if (!operations) return nullptr;
    const PJ_COORD there = proj_trans(operations.get(), PJ_FWD, coordinate(place.x(), place.y()));
    const bool possible = std::isfinite(there.xyz.x) && std::isfinite(there.xyz.z);
    return possible ? object(proj_trans_get_last_used_operation(operations.get())) : nullptr;
}

// Of the operation that would be best if all grids were there.
std::string EarthMap::missing_grid(const Object& from, const Object& to, const Eigen::Vector2d& degrees) const {
    PJ_CONTEXT* const c = context_.get();
    const std::shared_ptr<PJ_OPERATION_FACTORY_CONTEXT> factory(proj_create_operation_factory_context(c, nullptr),
                                                                proj_operation_factory_context_destroy);
    const double x = std::remainder(degrees.x(), 360), y = degrees.y(), aside = 1e-3;
    proj_operation_factory_context_set_area_of_interest(c, factory.get(), x - aside, y - aside, x + aside, y + aside);
    proj_operation_factory_context_set_spatial_criterion(c, factory.get(), PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
    proj_operation_factory_context_set_grid_availability_use(c, factory.get(), PROJ_GRID_AVAILABILITY_IGNORED);
    const std::shared_ptr<PJ_OBJ_LIST> list(proj_create_operations(c, from.get(), to.get(), factory.get()),
                                            proj_list_destroy);
    const Object best = object(list && proj_list_get_count(list.get()) > 0 ? proj_list_get(c, list.get(), 0) : nullptr);
    for (int i = 0; best && i < proj_coordoperation_get_grid_used_count(c, best.get()); ++i) {
        const char* name = "";
        int there = 1;
        proj_coordoperation_get_grid_used(c, best.get(), i, &name, nullptr, nullptr, nullptr, nullptr, nullptr, &there);
        if (!there) return name;
    }
    return {};
}

std::string EarthMap::settle(const Eigen::Vector2d& place) {
    PJ_CONTEXT* const c = context_.get();
    const Eigen::Vector2d degrees = on_earth(place);
    const auto guessed = [&](const Object& used) {
        return !used || proj_coordoperation_has_ballpark_transformation(c, used.get()) != 0;
    };
    if (const Object used = used_at(heights_, bare(place)); !guessed(used)) {
        heights_ = used;
        knows_heights = true;
    } else if (!vertical_system.empty()) {
        const std::string grid = missing_grid(system_, wgs84_heights_, degrees);
        why_no_heights =
            grid.empty() ? "PROJ knows no grid of them" : fmt::format("the grid {} is not installed", shown(grid));
    }
    const Object used = used_at(flat_, bare(place));
    if (!used) return {};
    flat_ = used;
    const double accuracy = proj_coordoperation_get_accuracy(c, used.get());
    const bool unknown = guessed(used) || accuracy < 0;
    if (!unknown && accuracy <= good_accuracy) return {};
    const std::string grid = missing_grid(flat_system_, wgs84_, degrees);
    if (grid.empty()) return {};
    return fmt::format("places are right to {}: the grid {} is not installed",
                       unknown ? "some 100 m alone" : fmt::format("{:g} m", accuracy), shown(grid));
}

Eigen::Vector2d EarthMap::transformed(const Eigen::Vector2d& place) const {
    const PJ_COORD there = proj_trans(flat_.get(), PJ_FWD, coordinate(place.x(), place.y()));
    return {there.lp.lam, there.lp.phi};
}

double EarthMap::ellipsoidal_height(const Eigen::Vector3d& place) const {
    const Eigen::Vector2d flat = bare(place.head<2>());
    return proj_trans(heights_.get(), PJ_FWD, coordinate(flat.x(), flat.y(), place.z())).xyz.z;
}

EarthMap::Fit EarthMap::fit_of(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d there = transformed(place);
    if (!there.allFinite()) return Fit::none;
    const double half_width = (east_ >= west_ ? east_ - west_ : east_ - west_ + 360) / 2;
    const double beyond_x = std::abs(std::remainder(there.x() - (west_ + half_width), 360)) - half_width;
    const double beyond_y = std::max(south_ - there.y(), there.y() - north_);
    if (beyond_x > margin_longitude || beyond_y > margin_latitude) return Fit::none;
    // Far from its middle a projection may lead to places that lead elsewhere.
    const PJ_COORD back = proj_trans(flat_.get(), PJ_INV, coordinate(there.x(), there.y()));
    if (!geographic && !((Eigen::Vector2d(back.xy.x, back.xy.y) - place).norm() < same_place)) return Fit::none;
    return beyond_x <= 0 && beyond_y <= 0 ? Fit::inside : Fit::near;
}

// Without the zone before the easting, where there is one that is not the map's own.
Eigen::Vector2d EarthMap::bare(const Eigen::Vector2d& place) const {
    const double behind_zone = place.x() - utm_zone_unit * zone_;
    const bool in_front = zone_ > 0 && behind_zone >= 0 && behind_zone < utm_zone_unit;
    return in_front && fit_of(place) == Fit::none ? Eigen::Vector2d(behind_zone, place.y()) : place;
}

std::uint64_t proj_data_digest() {
    const PJ_INFO info = proj_info();
    std::set<std::string> files;
    std::istringstream folders(info.searchpath);
    for (std::string folder; std::getline(folders, folder, ':');) {
        std::error_code ignored;
        for (std::filesystem::directory_iterator file(folder, ignored), end; !ignored && file != end;
             file.increment(ignored))
            files.insert(file->path().string());
    }
    std::uint64_t digest = fnv1a_64(info.version);
    for (const std::string& file : files)
        digest = fnv1a_64(file, digest);
    return digest;
}

}  // namespace skyloop::inline world
