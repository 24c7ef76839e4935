#include "base/geo/map_projection.hpp"

#include <GeographicLib/Constants.hpp>
#include <GeographicLib/LambertConformalConic.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <array>
#include <cmath>

namespace skyloop {
namespace {

constexpr double utm_false_east = 500e3, utm_false_north_of_the_south = 10e6;
/// m from the central meridian and from the equator. Maps of whole countries in one zone reach some 700 km from it.
constexpr double utm_reach_east = 2000e3, utm_reach_north = 10e6;
/// m, by which the zone stands before eastings of Germany's surveys: 32691603 is 691603 in zone 32 (EPSG:4647).
constexpr double utm_zone_unit = 1e6;

/// Universal Transverse Mercator. WGS 84's ellipsoid differs from GRS 80 by 0.1 mm.
class UtmInverse final : public MapProjection::Inverse {
public:
    UtmInverse(int zone, bool south)
        : central_meridian_(6.0 * zone - 183),
          zone_in_front_(utm_zone_unit * zone),
          false_north_(south ? utm_false_north_of_the_south : 0) {}
    [[nodiscard]] EarthPlace on_earth(const MapPlace& place) const override {
        double latitude = 0, longitude = 0;
        GeographicLib::TransverseMercator::UTM().Reverse(central_meridian_, from_meridian(place.east),
                                                         place.north - false_north_, latitude, longitude);
        return {Angle::degrees(latitude), Angle::degrees(longitude)};
    }
    [[nodiscard]] bool reaches(const MapPlace& place) const override {
        return std::abs(from_meridian(place.east)) <= utm_reach_east &&
               std::abs(place.north - false_north_) <= utm_reach_north;
    }

private:
    /// The zone is taken off where it tells what would lie beyond the map otherwise.
    [[nodiscard]] double from_meridian(double east) const {
        const double behind_zone = east - zone_in_front_, away = east - utm_false_east;
        const bool zone_told = away > utm_reach_east && behind_zone >= 0 && behind_zone < utm_zone_unit;
        return zone_told ? behind_zone - utm_false_east : away;
    }

    double central_meridian_, zone_in_front_, false_north_;
};

/// Lambert-93 of France: EPSG:2154, method 9802, standard parallels 44° and 49°, false origin 46.5° N 3° E.
class Lambert93Inverse final : public MapProjection::Inverse {
public:
    Lambert93Inverse()
        : cone_(GeographicLib::Constants::WGS84_a(), GeographicLib::Constants::WGS84_f(), 44.0, 49.0, 1.0) {
        cone_.Forward(central_meridian, 46.5, central_meridian, origin_east_, origin_north_);
    }
    [[nodiscard]] EarthPlace on_earth(const MapPlace& place) const override {
        double latitude = 0, longitude = 0;
        cone_.Reverse(central_meridian, place.east - 700e3 + origin_east_, place.north - 6600e3 + origin_north_,
                      latitude, longitude);
        return {Angle::degrees(latitude), Angle::degrees(longitude)};
    }

private:
    static constexpr double central_meridian = 3;
    GeographicLib::LambertConformalConic cone_;
    double origin_east_ = 0, origin_north_ = 0;
};

/// Mercator of the sphere with the ellipsoid's coordinates: EPSG:3857, method 1024.
class WebMercatorInverse final : public MapProjection::Inverse {
public:
    [[nodiscard]] EarthPlace on_earth(const MapPlace& place) const override {
        const double radius = GeographicLib::Constants::WGS84_a();
        return {Angle::radians(std::atan(std::sinh(place.north / radius))), Angle::radians(place.east / radius)};
    }
};

/// Consecutive codes of UTM's zones.
struct UtmCodes {
    int first_code, last_code, first_zone;
    bool south = false;
};
constexpr std::array<UtmCodes, 20> utm_codes{{
    {32601, 32660, 1, false},  {32701, 32760, 1, true},   // WGS 84
    {25828, 25838, 28, false}, {26901, 26923, 1, false},  // ETRS89, NAD83
    {6328, 6329, 59, false},   {6330, 6348, 1, false},    // NAD83(2011)
    {31965, 31976, 11, false}, {31977, 31985, 17, true},  // SIRGAS 2000
    {28348, 28358, 48, true},  {7846, 7859, 46, true},    // GDA94 and GDA2020, MGA
    {3067, 3067, 35, false},   {3154, 3157, 7, false},    // TM35FIN, NAD83(CSRS)
    {2955, 2957, 11, false},   {3158, 3160, 14, false},   // NAD83(CSRS)
    {2958, 2962, 17, false},   {5554, 5556, 31, false},   // NAD83(CSRS), ETRS89 with DHHN92 heights
    {5971, 5976, 31, false},                              // ETRS89 with NN2000 heights
    {5649, 5649, 31, false},   {4647, 4647, 32, false},   // ETRS89 with the zone before eastings (zE-N)
    {5650, 5650, 33, false},
}};

}  // namespace

std::optional<MapProjection> MapProjection::of_epsg(int code) {
    for (const UtmCodes& known : utm_codes)
        if (code >= known.first_code && code <= known.last_code)
            return MapProjection(std::make_shared<UtmInverse>(known.first_zone + code - known.first_code, known.south));
    for (const int french : {2154, 9793, 9794, 5698, 5699})
        if (code == french) return MapProjection(std::make_shared<Lambert93Inverse>());
    if (code == 3857) return MapProjection(std::make_shared<WebMercatorInverse>());
    return std::nullopt;
}

EarthPlace MapProjection::on_earth(const MapPlace& place) const { return inverse_->on_earth(place); }

bool MapProjection::reaches(const MapPlace& place) const { return inverse_->reaches(place); }

}  // namespace skyloop
