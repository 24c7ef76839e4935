#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <tuple>

#include "base/core/words.hpp"
#include "base/geo/geodetic.hpp"
#include "detail/city_text.hpp"
#include "detail/place_on_earth.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::inline world {
namespace {

bool is_decimal(char c) { return c >= '0' && c <= '9'; }

/// The last number of a text.
std::optional<int> last_number(std::string_view text) {
    while (!text.empty() && !is_decimal(text.back()))
        text.remove_suffix(1);
    std::size_t first = text.size();
    while (first > 0 && is_decimal(text[first - 1]))
        --first;
    int number = 0;
    const auto [rest, error] = std::from_chars(text.data() + first, text.data() + text.size(), number);
    return error == std::errc() ? std::optional<int>(number) : std::nullopt;
}

/// Of the first system that a name holds, before which may stand a version, and of the heights behind it.
std::string epsg_definition(std::string_view lower) {
    const std::size_t start = lower.find("epsg");
    if (start == std::string_view::npos) return {};
    const std::size_t end = std::min(lower.find_first_of(",&+; ", start), lower.size());
    const auto code = last_number(lower.substr(start, end - start)), heights = last_number(lower.substr(end));
    if (!code) return {};
    return heights ? fmt::format("EPSG:{}+{}", *code, *heights) : fmt::format("EPSG:{}", *code);
}

/// Names of Germany's surveying authorities (AdV, GeoInfoDok): "urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH" is UTM,
/// "DE_DHDN_3GK4" Gauss and Krueger's fourth zone, and behind the asterisk stand heights.
std::string adv_definition(std::string_view lower) {
    for (const auto& [map, digits, code, first, last] :
         {std::tuple("etrs89_utm", 2, 25800, 28, 38), std::tuple("de_dhdn_3gk", 1, 31464, 2, 5)}) {
        const std::size_t start = lower.find(map);
        if (start == std::string_view::npos) continue;
        const std::size_t end = start + std::string_view(map).size() + static_cast<std::size_t>(digits);
        const std::optional<int> zone = last_number(lower.substr(start, end - start));
        if (!zone || *zone < first || *zone > last) continue;
        const std::string_view heights = lower.substr(std::min(lower.find('*', start), lower.size()));
        const bool old = heights.find("dhhn92") != std::string_view::npos;
        return fmt::format("EPSG:{}{}", code + *zone, heights.empty() ? "" : old ? "+5783" : "+7837");
    }
    return {};
}

}  // namespace

std::optional<ReferenceSystem> reference_system(std::string_view name) {
    if (name.empty()) return std::nullopt;
    const std::string lower = lower_case(name);
    const bool wkt = name.find_first_of("[{") != std::string_view::npos;  // or JSON: names other systems inside
    if (!wkt && lower.find("crs84") != std::string::npos) return wgs84_degrees("OGC:CRS84");
    std::string definition = wkt ? "" : adv_definition(lower);
    if (!wkt && definition.empty()) definition = epsg_definition(lower);
    ReferenceSystem system;
    system.name = definition.empty() ? std::string(name) : definition;
    if (system.name == "EPSG:4326" || system.name == "EPSG:4979") {
        system.kind = CoordinateKind::geographic;
        system.north_first = true;
        return system;
    }
    auto map = EarthMap::open(system.name);
    if (!map) {
        system.unknown = map.error();
        return system;
    }
    system.map = std::move(*map);
    if (system.map->geographic) system.kind = CoordinateKind::geographic;
    const bool strict = lower.starts_with("urn:ogc") || lower.find("/def/crs") != std::string::npos;
    system.north_first = system.map->north_first && (strict || system.map->geographic);
    return system;
}

std::optional<ReferenceSystem> reference_system_of_file(std::string_view name, const CityFileSettings& settings) {
    if (settings.file_crs.empty()) return reference_system(name);
    if (settings.file_crs == "local") return unnamed_system(CoordinateKind::projected, "local");
    return reference_system(settings.file_crs);
}

Result<void> check_file_crs(std::string_view name) {
    if (name == "local") return {};
    const auto system = reference_system(name);
    if (!system) return fail(ErrorCode::usage, "is empty; expected a reference system, such as EPSG:25832");
    if (!system->unknown) return {};
    if (system->unknown->code == ErrorCode::outside) return fail(*system->unknown);
    return fail(ErrorCode::usage,
                fmt::format("'{}' {}; expected one such as EPSG:25832, EPSG:7415 or EPSG:25832+7837, or local", name,
                            system->unknown->message));
}

namespace {

/// No city is 500 km wide.
constexpr double most_degrees = 5;

/// Degrees that no file in metres is as narrow as.
constexpr double least_metres = 0.5;

/// From the run, m, at which no model says anything to it.
constexpr double farthest_from_run = 100'000;

Metres distance(const Geodetic& from, const Eigen::Vector2d& degrees) {
    return geodesic_between(from, Geodetic::degrees(degrees.y(), std::remainder(degrees.x(), 360), 0)).length;
}

}  // namespace

double LongitudeTurn::operator()(double longitude) {
    if (!std::isfinite(longitude)) return longitude;
    if (!first_) first_ = longitude;
    return std::abs(longitude - *first_) <= 180 ? longitude : *first_ + std::remainder(longitude - *first_, 360);
}

void PlaceOnEarth::Extent::include(const Eigen::Vector2d& place) {
    if (!place.allFinite()) return;
    lowest = lowest.cwiseMin(place);
    highest = highest.cwiseMax(place);
}

bool PlaceOnEarth::Extent::on_globe() const {
    return !empty() && lowest.x() >= -360 && highest.x() <= 360 && lowest.y() >= -90 && highest.y() <= 90;
}

bool PlaceOnEarth::Extent::fits_degrees() const { return on_globe() && width() <= most_degrees; }

bool PlaceOnEarth::Extent::is_of_degrees() const { return on_globe() && width() < least_metres; }

std::vector<std::string> PlaceOnEarth::unused_settings(const ReferenceSystem& system,
                                                       const CityFileSettings& settings) {
    std::vector<std::string> warnings;
    if (settings.axes) warnings.emplace_back("axes mean nothing for this format, east and north are told by it");
    if (settings.file_origin != Eigen::Vector3d::Zero()) warnings.emplace_back(file_origin_unused);
    if (settings.metres_per_unit != 1 && system.lies_on_earth())
        warnings.emplace_back("the length of a unit means nothing for places on the Earth and heights in metres");
    return warnings;
}

bool PlaceOnEarth::stands_exchanged(const ReferenceSystem& system, const Eigen::Vector2d& middle,
                                    const CityFileSettings& settings) {
    const EarthMap& map = *system.map;
    const auto near_run = [&](const Eigen::Vector2d& place) {
        const Eigen::Vector2d degrees = map.on_earth(place);
        return settings.origin && map.fit(place) != EarthMap::Fit::none &&
               distance(*settings.origin, degrees).value() <= farthest_from_run;
    };
    const Eigen::Vector2d other(middle.y(), middle.x());
    const EarthMap::Fit fits = map.fit(middle), other_fits = map.fit(other);
    if (const bool near = near_run(middle); near || near_run(other)) return !near;
    return other_fits > fits;
}

Result<PlaceOnEarth> PlaceOnEarth::make(const ReferenceSystem& system, const Extent& extent,
                                        std::optional<double> ground, const CityFileSettings& settings) {
    PlaceOnEarth place;
    if (system.kind == CoordinateKind::geographic) {
        if (!extent.on_globe())
            return fail(ErrorCode::input,
                        fmt::format("expected degrees on the globe, found longitudes {:.6g} … {:.6g} and latitudes "
                                    "{:.6g} … {:.6g}",
                                    extent.lowest.x(), extent.highest.x(), extent.lowest.y(), extent.highest.y()));
        if (!extent.fits_degrees())
            return fail(ErrorCode::input,
                        fmt::format("expected longitudes and latitudes within {} degrees of each other, found {:.6g} … "
                                    "{:.6g} and {:.6g} … {:.6g}",
                                    most_degrees, extent.lowest.x(), extent.highest.x(), extent.lowest.y(),
                                    extent.highest.y()));
        place.settle_map(system, extent.middle(), settings);
        place.heights_known_ = true;
        place.set_origin(extent.middle(), ground, settings);
    } else {
        place.origin_ = settings.origin.value_or(Geodetic{});
        place.metres_per_unit_ = settings.metres_per_unit;
        if (system.kind == CoordinateKind::projected)
            if (const auto laid = place.lay_map(system, extent, ground, settings); !laid) return fail(laid.error());
    }
    if (const auto near = place.lies_near(extent, settings); !near) return fail(near.error());
    return place;
}

void PlaceOnEarth::settle_map(const ReferenceSystem& system, const Eigen::Vector2d& middle,
                              const CityFileSettings& settings) {
    system_ = system.name;
    map_ = system.map;
    if (map_) doubt_of_places_ = system.map->settle(middle);
    const bool told = settings.heights == CityHeights::as_told && system.has_sea_heights();
    by_map_ = told && map_->knows_heights;
    sea_level_ = settings.heights == CityHeights::sea_level || (told && !by_map_);
    heights_known_ = told || settings.heights != CityHeights::as_told;
}

Eigen::Vector2d PlaceOnEarth::degrees_of(const Eigen::Vector2d& place) const {
    return map_ ? map_->on_earth(place) : place;
}

void PlaceOnEarth::set_origin(const Eigen::Vector2d& middle, std::optional<double> ground,
                              const CityFileSettings& settings) {
    const double level = ground.value_or(0);
    const Eigen::Vector2d degrees = degrees_of(middle);
    origin_ = settings.origin.value_or(Geodetic::degrees(degrees.y(), std::remainder(degrees.x(), 360), level));
    double raise = 0;
    if (by_map_)
        raise = map_->ellipsoidal_height({middle.x(), middle.y(), level}) - level;
    else if (sea_level_ && settings.geoid)
        raise = settings.geoid->undulation(origin_.latitude, origin_.longitude).value();
    if (!settings.origin) origin_.height.above_ellipsoid += Metres(raise);
    raise_ = heights_known_ ? raise : origin_.height.above_ellipsoid.value() - level;
    ground_ = origin_.height.above_ellipsoid.value() - raise_;
    frame_.emplace(origin_);
}

Result<void> PlaceOnEarth::lay_map(const ReferenceSystem& system, const Extent& extent, std::optional<double> ground,
                                   const CityFileSettings& settings) {
    const Eigen::Vector2d middle = extent.middle();
    anchor_ = MapAnchor{system.name, system.named, middle.x(), middle.y(), ground};
    // Files that name no map are taken to be of that of the others.
    const auto& before = settings.anchor;
    if (before && (!system.named || !before->named || before->system == system.name)) {
        anchor_ = before;
        if (!anchor_->level) anchor_->level = ground;
    }
    ground_ = anchor_->level.value_or(0);
    ReferenceSystem known = system;
    if (!known.map && anchor_->named && anchor_->system != system.name)
        known = reference_system(anchor_->system).value_or(system);
    if (!known.map || known.kind != CoordinateKind::projected) {
        const Error why = known.unknown.value_or(Error{ErrorCode::input, "names no reference system"});
        const bool guessed = settings.origin && settings.origin_is_guess && !before && settings.file_crs != "local";
        if (guessed || why.code == ErrorCode::outside)
            return fail(why.code,
                        fmt::format("{}; set scene.file_crs to the file's reference system, or scene.origin to "
                                    "where the middle of the file lies",
                                    why.message));
        if (known.unknown) why_unknown_ = fmt::format(", which {}", why.message);
        return {};
    }
    const std::array places{middle, extent.lowest, extent.highest};
    if (std::any_of(places.begin(), places.end(),
                    [&](const auto& place) { return known.map->fit(place) == EarthMap::Fit::none; }))
        return fail(ErrorCode::input,
                    fmt::format("no place of this map lies {:.0f} m east and {:.0f} m north, where the middle of the "
                                "file is; set scene.file_crs to the system of its coordinates, or to \"local\"",
                                middle.x(), middle.y()));
    settle_map(known, middle, settings);
    metres_per_unit_ = 1;
    set_origin(middle, ground_, settings);
    return {};
}

Result<void> PlaceOnEarth::lies_near(const Extent& extent, const CityFileSettings& settings) const {
    if (!frame_ || !settings.origin) return {};
    const Geodetic& run = *settings.origin;
    const Eigen::Vector2d middle = degrees_of(extent.middle()), corner = degrees_of(extent.lowest);
    const Geodetic there = Geodetic::degrees(middle.y(), std::remainder(middle.x(), 360), 0);
    const double away = distance(run, middle).value() - distance(there, corner).value();
    if (away <= farthest_from_run) return {};
    return fail(
        ErrorCode::input,
        fmt::format("lies at {:.4f}, {:.4f} (latitude, longitude), {:.0f} km from the {} at {:.4f}, {:.4f}; set "
                    "scene.file_crs to the file's reference system, or scene.origin and the trajectory to its "
                    "place",
                    middle.y(), std::remainder(middle.x(), 360), away / 1000,
                    settings.origin_is_guess ? "start of the run" : "origin", run.latitude.deg(), run.longitude.deg()));
}

std::string PlaceOnEarth::doubt_of_map(const CityFileSettings& settings) const {
    if (!anchor_ || (frame_ && heights_known_)) return "";
    if (frame_)
        return settings.origin
                   ? fmt::format(
                         "heights ({}) count from the ground, which is at {:.3f} of the file and taken to be at "
                         "the height of the origin",
                         shown(anchor_->system), ground_)
                   : "";
    const std::string_view origin =
        settings.origin ? settings.origin_is_guess ? ", which is a guess," : " as given" : "";
    const bool told = settings.origin && !settings.origin_is_guess;
    const bool beside = settings.anchor && settings.anchor->system == anchor_->system;
    return fmt::format(
        "coordinates are projected ({}{}): the frame's origin{} is at {:.3f}, {:.3f}, {:.3f} of the {}{}",
        shown(anchor_->system), why_unknown_, origin, anchor_->east, anchor_->north, ground_,
        beside ? "map, as for the file before" : "file",
        told ? "" : "; its place on Earth is not known: give an origin");
}

std::vector<std::string> PlaceOnEarth::doubts(const CityFileSettings& settings, bool has_heights) const {
    std::vector<std::string> lines;
    if (!doubt_of_places_.empty()) lines.push_back(fmt::format("{} ({})", doubt_of_places_, shown(system_)));
    if (std::string doubt = doubt_of_map(settings); !doubt.empty() && (has_heights || !frame_))
        lines.push_back(std::move(doubt));
    if (!has_heights || !frame_ || !sea_level_) return lines;
    const bool by_name = settings.heights == CityHeights::as_told;
    const std::string what = by_name ? fmt::format("{} of {}", map_->vertical_system, shown(system_)) : system_;
    if (!settings.geoid)
        lines.push_back(fmt::format(
            "heights ({}) count from the sea, and the geoid's grid is not there: they are taken as above the ellipsoid",
            what));
    else if (by_name)
        lines.push_back(fmt::format("heights ({}) are taken as above mean sea level, the geoid EGM96: {}", what,
                                    map_->why_no_heights));
    return lines;
}

Eigen::Vector3d PlaceOnEarth::operator()(const Eigen::Vector3d& place) const {
    if (frame_) {
        const Eigen::Vector2d degrees = degrees_of(place.head<2>());
        double height = by_map_ ? map_->ellipsoidal_height(place) : place.z() + raise_;
        if (!std::isfinite(height)) height = place.z() + raise_;  // beyond the grid
        return frame_->to_enu(to_ecef(Geodetic::degrees(degrees.y(), degrees.x(), height))).vector();
    }
    const Eigen::Vector2d middle = anchor_ ? Eigen::Vector2d(anchor_->east, anchor_->north) : Eigen::Vector2d::Zero();
    const Eigen::Vector2d flat = (place.head<2>() - middle) * metres_per_unit_;
    return {flat.x(), flat.y(), (place.z() - ground_) * metres_per_unit_};
}

}  // namespace skyloop::inline world
