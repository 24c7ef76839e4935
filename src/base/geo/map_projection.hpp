/// Map projections by their number in the EPSG registry.
#pragma once

#include <memory>
#include <optional>

#include "base/core/units.hpp"

namespace skyloop {

/// A place on a map, and on the Earth.
struct MapPlace {
    double east = 0, north = 0;  ///< m
};
struct EarthPlace {
    Angle latitude, longitude;
};

/// From east and north to latitude and longitude of WGS-84 (GeographicLib). Systems whose datum differs from it by
/// more than a metre or two are none: without the shift of the datum they would lie a hundred metres aside.
class MapProjection {
public:
    /// UTM on WGS 84 (326xx, 327xx), ETRS89 (258xx; 4647, 5649 and 5650 with the zone before eastings), NAD83 (269xx,
    /// 63xx), SIRGAS 2000 (319xx), GDA94 and GDA2020 (MGA), TM35FIN (3067), Lambert-93 (2154, 9793, 9794) and Web
    /// Mercator (3857), and compounds of these with heights. Absent for any other code.
    static std::optional<MapProjection> of_epsg(int code);

    /// Eastings of UTM may have the zone before them: 32691603 is 691603 in zone 32.
    [[nodiscard]] EarthPlace on_earth(const MapPlace& place) const;
    /// False for numbers that no such map has: of UTM more than 2000 km from the central meridian, or 10000 km from the
    /// equator. What on_earth() tells of them means nothing.
    [[nodiscard]] bool reaches(const MapPlace& place) const;

    /// The inverse of one kind of projection.
    class Inverse {
    public:
        Inverse() = default;
        Inverse(const Inverse&) = delete;
        Inverse& operator=(const Inverse&) = delete;
        virtual ~Inverse() = default;
        [[nodiscard]] virtual EarthPlace on_earth(const MapPlace& place) const = 0;
        [[nodiscard]] virtual bool reaches(const MapPlace& /*place*/) const { return true; }
    };

private:
    explicit MapProjection(std::shared_ptr<const Inverse> inverse) : inverse_(std::move(inverse)) {}
    std::shared_ptr<const Inverse> inverse_;
};

}  // namespace skyloop
