#include "place_on_earth.hpp"

#include <fmt/format.h>

#include <cmath>

namespace skyloop {

namespace {

/// Wider files of numbers that fit degrees are metres: no city is 500 km wide.
constexpr double most_degrees = 5;

/// Degrees that no file in metres is as narrow as.
constexpr double least_metres = 0.5;

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
    if (settings.metres_per_unit != 1 && system.kind == CoordinateKind::geographic)
        warnings.emplace_back("the length of a unit means nothing for degrees and heights in metres");
    return warnings;
}

Result<PlaceOnEarth> PlaceOnEarth::make(const ReferenceSystem& system, const Extent& extent, double ground,
                                        const CityFileSettings& settings) {
    PlaceOnEarth place;
    place.kind_ = system.kind;
    if (system.kind == CoordinateKind::geographic) {
        if (!extent.fits_degrees())
            return fail(ErrorCode::input,
                        fmt::format("expected longitudes and latitudes within {} degrees of each other, found {:.6g} … "
                                    "{:.6g} and {:.6g} … {:.6g}",
                                    most_degrees, extent.lowest.x(), extent.highest.x(), extent.lowest.y(),
                                    extent.highest.y()));
        const Eigen::Vector2d middle = extent.middle();
        place.origin_ =
            settings.origin.value_or(Geodetic::degrees(middle.y(), std::remainder(middle.x(), 360), ground));
        place.ground_ = place.origin_.height.above_ellipsoid.value();
        place.frame_.emplace(place.origin_);
        return place;
    }
    place.origin_ = settings.origin.value_or(Geodetic{});
    place.metres_per_unit_ = settings.metres_per_unit;
    if (system.kind == CoordinateKind::projected) {
        place.middle_ = extent.middle();
        place.ground_ = ground;
    }
    return place;
}

Eigen::Vector3d PlaceOnEarth::operator()(const Eigen::Vector3d& place) const {
    if (kind_ == CoordinateKind::geographic)
        return frame_->to_enu(to_ecef(Geodetic::degrees(place.y(), place.x(), place.z()))).vector();
    const Eigen::Vector2d flat = (place.head<2>() - middle_) * metres_per_unit_;
    return {flat.x(), flat.y(), (place.z() - ground_) * metres_per_unit_};
}

}  // namespace skyloop
