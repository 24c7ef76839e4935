#include "detail/place_on_earth.hpp"

#include <fmt/format.h>

#include <cmath>

namespace skyloop {

namespace {

/// No city is 500 km wide.
constexpr double most_degrees = 5;

/// Degrees that no file in metres is as narrow as.
constexpr double least_metres = 0.5;

bool counts_from_the_sea(const ReferenceSystem& system, const CityFileSettings& settings) {
    if (settings.heights != CityHeights::as_told) return settings.heights == CityHeights::sea_level;
    return system.sea_level;
}

bool lies_on_earth(const ReferenceSystem& system) {
    return system.kind == CoordinateKind::geographic ||
           (system.kind == CoordinateKind::projected && system.code && MapProjection::of_epsg(*system.code));
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
    if (settings.metres_per_unit != 1 && lies_on_earth(system))
        warnings.emplace_back("the length of a unit means nothing for places on the Earth and heights in metres");
    return warnings;
}

std::string PlaceOnEarth::doubt_of_heights(const ReferenceSystem& system, const CityFileSettings& settings) {
    if (settings.geoid || !lies_on_earth(system) || !counts_from_the_sea(system, settings)) return "";
    return fmt::format(
        "heights ({}) count from the sea, and the geoid's grid is not there: they are taken as above the "
        "ellipsoid",
        system.name);
}

Result<PlaceOnEarth> PlaceOnEarth::make(const ReferenceSystem& system, const Extent& extent,
                                        std::optional<double> ground, const CityFileSettings& settings) {
    PlaceOnEarth place;
    place.count_heights(system, settings);
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
        const Eigen::Vector2d middle = extent.middle();
        place.heights_known_ = true;
        place.set_origin(middle.y(), middle.x(), ground, settings);
        return place;
    }
    place.origin_ = settings.origin.value_or(Geodetic{});
    place.metres_per_unit_ = settings.metres_per_unit;
    if (system.kind == CoordinateKind::projected)
        if (const auto laid = place.lay_map(system, extent, ground, settings); !laid) return fail(laid.error());
    return place;
}

void PlaceOnEarth::count_heights(const ReferenceSystem& system, const CityFileSettings& settings) {
    sea_level_ = counts_from_the_sea(system, settings);
    heights_known_ = sea_level_ || settings.heights != CityHeights::as_told;
}

void PlaceOnEarth::set_origin(double latitude_deg, double longitude_deg, std::optional<double> ground,
                              const CityFileSettings& settings) {
    const double level = ground.value_or(0);
    origin_ = settings.origin.value_or(Geodetic::degrees(latitude_deg, std::remainder(longitude_deg, 360), level));
    const double geoid =
        sea_level_ && settings.geoid ? settings.geoid->undulation(origin_.latitude, origin_.longitude).value() : 0;
    if (!settings.origin) origin_.height.above_ellipsoid += Metres(geoid);
    raise_ = heights_known_ ? geoid : origin_.height.above_ellipsoid.value() - level;
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
    const auto known = reference_system(anchor_->system);
    if (known && known->code) projection_ = MapProjection::of_epsg(*known->code);
    if (!projection_) return {};
    if (!projection_->reaches({middle.x(), middle.y()}))
        return fail(ErrorCode::input,
                    fmt::format("no place of this map lies {:.0f} m east and {:.0f} m north, where the "
                                "middle of the file is; are its coordinates of another?",
                                middle.x(), middle.y()));
    count_heights(*known, settings);
    metres_per_unit_ = 1;
    const EarthPlace place = projection_->on_earth({middle.x(), middle.y()});
    set_origin(place.latitude.deg(), place.longitude.deg(), ground_, settings);
    return {};
}

std::string PlaceOnEarth::doubt_of_map(const CityFileSettings& settings) const {
    if (!anchor_ || (projection_ && heights_known_)) return "";
    if (projection_)
        return settings.origin
                   ? fmt::format(
                         "heights ({}) count from the ground, which is at {:.3f} of the file and taken to be at "
                         "the height of the origin",
                         anchor_->system, ground_)
                   : "";
    const std::string_view origin =
        settings.origin ? settings.origin_is_guess ? ", which is a guess," : " as given" : "";
    const bool told = settings.origin && !settings.origin_is_guess;
    const bool beside = settings.anchor && settings.anchor->system == anchor_->system;
    return fmt::format("coordinates are projected ({}): the frame's origin{} is at {:.3f}, {:.3f}, {:.3f} of the {}{}",
                       anchor_->system, origin, anchor_->east, anchor_->north, ground_,
                       beside ? "map, as for the file before" : "file",
                       told ? "" : "; its place on Earth is not known: give an origin");
}

Eigen::Vector3d PlaceOnEarth::operator()(const Eigen::Vector3d& place) const {
    if (frame_) {
        const EarthPlace on_earth = projection_ ? projection_->on_earth({place.x(), place.y()})
                                                : EarthPlace{Angle::degrees(place.y()), Angle::degrees(place.x())};
        return frame_->to_enu(to_ecef({on_earth.latitude, on_earth.longitude, {Metres(place.z() + raise_)}})).vector();
    }
    const Eigen::Vector2d middle = anchor_ ? Eigen::Vector2d(anchor_->east, anchor_->north) : Eigen::Vector2d::Zero();
    const Eigen::Vector2d flat = (place.head<2>() - middle) * metres_per_unit_;
    return {flat.x(), flat.y(), (place.z() - ground_) * metres_per_unit_};
}

}  // namespace skyloop
