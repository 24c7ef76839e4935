#include "place_on_earth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "city_text.hpp"

namespace skyloop {

namespace {

/// Wider files of numbers that fit degrees are metres: no city is 500 km wide.
constexpr double most_degrees = 5;

/// Geographic systems whose difference from WGS-84 is no more than a metre; axes latitude, longitude [height].
constexpr std::array geographic_codes{4258, 4269, 4283, 4326, 4612, 4937, 4939, 4979, 6318, 6319,
                                      6667, 6668, 6697, 7842, 7843, 7844, 9057, 9755, 9782};

std::optional<int> epsg_code(std::string_view name) {
    std::string capitals(
        name.substr(0, name.find(',', name.find("EPSG") == std::string_view::npos ? 0 : name.find("EPSG"))));
    const auto found = capitals.find("EPSG");
    if (found == std::string::npos) return std::nullopt;
    const auto end = capitals.find_last_of("0123456789");
    if (end == std::string::npos || end < found) return std::nullopt;
    auto start = end;
    while (start > found && capitals[start - 1] >= '0' && capitals[start - 1] <= '9')
        --start;
    int code = 0;
    const auto [rest, error] = std::from_chars(capitals.data() + start, capitals.data() + end + 1, code);
    if (error != std::errc()) return std::nullopt;
    return code;
}

}  // namespace

std::optional<ReferenceSystem> reference_system(std::string_view name) {
    if (name.empty()) return std::nullopt;
    if (name.find("CRS84") != std::string_view::npos)
        return ReferenceSystem{CoordinateKind::geographic, false, "OGC:CRS84"};
    const std::optional<int> code = epsg_code(name);
    if (!code) return ReferenceSystem{CoordinateKind::projected, false, shown(name)};
    const bool geographic =
        std::find(geographic_codes.begin(), geographic_codes.end(), *code) != geographic_codes.end();
    return ReferenceSystem{geographic ? CoordinateKind::geographic : CoordinateKind::projected, geographic,
                           fmt::format("EPSG:{}", *code)};
}

void PlaceOnEarth::Extent::include(const Eigen::Vector2d& place) {
    if (!place.allFinite()) return;
    lowest = lowest.cwiseMin(place);
    highest = highest.cwiseMax(place);
}

bool PlaceOnEarth::Extent::fits_degrees() const {
    return !empty() && lowest.x() >= -180 && highest.x() <= 180 && lowest.y() >= -90 && highest.y() <= 90 &&
           (highest - lowest).maxCoeff() <= most_degrees;
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
        place.origin_ = settings.origin.value_or(Geodetic::degrees(middle.y(), middle.x(), ground));
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
