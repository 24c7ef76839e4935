/// From a file's coordinates to the frame of a city.
/// What the numbers of a file are, by the name of their reference system.
#pragma once

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "earth_map.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::inline world {

struct CityFileSettings;

/// What a file's numbers are.
enum class CoordinateKind {
    geographic,  ///< longitude, latitude (degrees), height (m)
    projected,   ///< east, north, height of a map projection, m
    local        ///< metres from the frame's origin as they stand
};

/// A reference system and the order of its axes in the file.
struct ReferenceSystem {
    CoordinateKind kind = CoordinateKind::projected;
    bool north_first = false;       ///< latitude or northing come first
    std::string name;               ///< "EPSG:7415", as reference_system() reads it again
    bool named = true;              ///< false where `name` is a word of ours
    std::shared_ptr<EarthMap> map;  ///< absent for degrees of WGS 84, and where PROJ knows no such system
    std::optional<Error> unknown;   ///< why a named system has no map

    [[nodiscard]] bool has_sea_heights() const { return map && !map->vertical_system.empty(); }
    [[nodiscard]] bool lies_on_earth() const { return map || kind == CoordinateKind::geographic; }
};

/// Degrees of WGS 84, longitude first.
inline ReferenceSystem wgs84_degrees(std::string name) {
    return {CoordinateKind::geographic, false, std::move(name), true, {}, {}};
}
/// Numbers of which a file tells nothing.
inline ReferenceSystem unnamed_system(CoordinateKind kind, std::string name = "unnamed") {
    return {kind, false, std::move(name), false, {}, {}};
}

/// Reads "EPSG:4326", "urn:ogc:def:crs:EPSG::25832", "http://www.opengis.net/def/crs/EPSG/0/6697", compounds
/// ("EPSG:4326+5773", "urn:ogc:def:crs,crs:EPSG::4258,crs:EPSG::5783"), in any case, CRS84, the AdV's names of UTM, and
/// what else PROJ reads, such as WKT. Axes are in the registry's order for latitudes and longitudes, and for maps where
/// the name is an OGC URN or URL, as GDAL takes those of GML. Absent for an empty name.
std::optional<ReferenceSystem> reference_system(std::string_view name);

/// That of `file_crs` of the settings, else that which the file names.
std::optional<ReferenceSystem> reference_system_of_file(std::string_view name, const CityFileSettings& settings);

/// Turns longitudes to within 180° of the first, so that what lies on both sides of the 180th meridian lies together.
class LongitudeTurn {
public:
    [[nodiscard]] double operator()(double longitude);

private:
    std::optional<double> first_;
};

/// Numbers farther from 0, 0 are places in a map projection, not metres from an origin.
constexpr double farthest_local = 100'000;

/// The warning of a format that is no mesh.
inline constexpr const char* file_origin_unused =
    "file_origin means nothing for this format; it tells which place of a mesh lies at the origin";

/// Takes coordinates of a file to metres east, north and up.
///
/// Geographic places and those of a map that PROJ knows lie in the tangent frame at `settings.origin`, else at the
/// middle of the extent and the `ground` level (0 m where it is absent). Heights of a vertical system are PROJ's where
/// it has the grid, else they count from the sea and are raised by the geoid's height at the origin. Where neither the
/// system nor `settings.heights` tells what a map's heights count from, the `ground` level lies at the height of the
/// origin. Of an unknown map the middle of the extent lies at the origin, or what `settings.anchor` says: the
/// convergence of the map's north and its scale are neglected.
class PlaceOnEarth {
public:
    /// The box around what a file holds.
    struct Extent {
        Eigen::Vector2d lowest = Eigen::Vector2d::Constant(1e300), highest = Eigen::Vector2d::Constant(-1e300);
        void include(const Eigen::Vector2d& place);
        [[nodiscard]] bool empty() const { return !(lowest.x() <= highest.x()); }
        [[nodiscard]] Eigen::Vector2d middle() const { return (lowest + highest) / 2; }
        [[nodiscard]] double width() const { return (highest - lowest).maxCoeff(); }
        /// True when all of it are longitudes and latitudes, those turned by LongitudeTurn, too.
        [[nodiscard]] bool on_globe() const;
        /// The same within a few degrees.
        [[nodiscard]] bool fits_degrees() const;
        /// The same and so narrow that metres are out of the question.
        [[nodiscard]] bool is_of_degrees() const;
    };

    /// Fails with `input` when geographic coordinates are no degrees, when those of a map lie beyond it or, of an
    /// unknown one, at a guess, and when the file lies more than 100 km from `settings.origin`; with `outside` without
    /// PROJ's database.
    static Result<PlaceOnEarth> make(const ReferenceSystem& system, const Extent& extent, std::optional<double> ground,
                                     const CityFileSettings& settings);
    /// What of the settings means nothing for a file, as warnings.
    static std::vector<std::string> unused_settings(const ReferenceSystem& system, const CityFileSettings& settings);
    /// Whether the coordinates of a map stand in the other order than the system's `north_first` says, by where both
    /// orders would put the middle: near the run, in the map's area of use, or nearly there.
    static bool stands_exchanged(const ReferenceSystem& system, const Eigen::Vector2d& middle,
                                 const CityFileSettings& settings);

    [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& place) const;
    /// The place at the origin's level.
    [[nodiscard]] Eigen::Vector3d on_ground(const Eigen::Vector2d& place) const {
        return (*this)(Eigen::Vector3d(place.x(), place.y(), ground_));
    }
    [[nodiscard]] const Geodetic& origin() const { return origin_; }
    /// Of places of a map, for the files that come after.
    [[nodiscard]] const std::optional<MapAnchor>& anchor() const { return anchor_; }
    /// What of the place is not told by the file, or not as exactly: of the map, and of heights where there are any.
    [[nodiscard]] std::vector<std::string> doubts(const CityFileSettings& settings, bool has_heights) const;

private:
    void settle_map(const ReferenceSystem& system, const Eigen::Vector2d& middle, const CityFileSettings& settings);
    [[nodiscard]] std::string doubt_of_map(const CityFileSettings& settings) const;
    [[nodiscard]] Eigen::Vector2d degrees_of(const Eigen::Vector2d& place) const;
    [[nodiscard]] Result<void> lies_near(const Extent& extent, const CityFileSettings& settings) const;
    void set_origin(const Eigen::Vector2d& middle, std::optional<double> ground, const CityFileSettings& settings);
    Result<void> lay_map(const ReferenceSystem& system, const Extent& extent, std::optional<double> ground,
                         const CityFileSettings& settings);

    Geodetic origin_;
    double ground_ = 0;           ///< of the file's heights, at the level of the origin
    double raise_ = 0;            ///< from the file's heights to those above the ellipsoid
    bool sea_level_ = false;      ///< heights count from there
    bool heights_known_ = false;  ///< and are not fitted to the level of the origin
    bool by_map_ = false;         ///< and PROJ has a grid of them
    double metres_per_unit_ = 1;
    std::optional<MapAnchor> anchor_;
    std::shared_ptr<const EarthMap> map_;
    std::string system_, doubt_of_places_, why_unknown_;
    std::optional<LocalFrame> frame_;
};

}  // namespace skyloop::inline world
