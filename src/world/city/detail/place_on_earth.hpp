/// From a file's coordinates to the frame of a city.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "base/geo/map_projection.hpp"
#include "reference_system.hpp"
#include "world/city/city_file.hpp"

namespace skyloop {

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
/// Geographic places lie in the tangent frame at `settings.origin`, else at the middle of the extent and the `ground`
/// level (0 m where it is absent). Heights above the sea are raised by the geoid's at the origin. So do places of a
/// projection that geo/map_projection knows; where neither it nor `settings.heights` tells what heights count from, the
/// `ground` level lies at the height of the origin. Of another projection the middle of the extent lies there, or what
/// `settings.anchor` says: the convergence of the map's north and its scale are neglected.
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

    /// Fails with `input` when geographic coordinates are no degrees, and those of a map lie beyond it.
    static Result<PlaceOnEarth> make(const ReferenceSystem& system, const Extent& extent, std::optional<double> ground,
                                     const CityFileSettings& settings);
    /// What of the settings means nothing for a file, as warnings.
    static std::vector<std::string> unused_settings(const ReferenceSystem& system, const CityFileSettings& settings);
    /// Of a geoid that would be needed and is not there; else nothing.
    static std::string doubt_of_heights(const ReferenceSystem& system, const CityFileSettings& settings);

    [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& place) const;
    /// The place at the origin's level.
    [[nodiscard]] Eigen::Vector3d on_ground(const Eigen::Vector2d& place) const {
        return (*this)(Eigen::Vector3d(place.x(), place.y(), ground_));
    }
    [[nodiscard]] const Geodetic& origin() const { return origin_; }
    /// Whether the file tells where on the Earth it lies.
    [[nodiscard]] bool on_earth() const { return frame_.has_value(); }
    /// Of places of a map, for the files that come after.
    [[nodiscard]] const std::optional<MapAnchor>& anchor() const { return anchor_; }
    /// How a map lies on the Earth as far as that is not told by the file; nothing where it is.
    [[nodiscard]] std::string doubt_of_map(const CityFileSettings& settings) const;

private:
    void count_heights(const ReferenceSystem& system, const CityFileSettings& settings);
    void set_origin(double latitude_deg, double longitude_deg, std::optional<double> ground,
                    const CityFileSettings& settings);
    Result<void> lay_map(const ReferenceSystem& system, const Extent& extent, std::optional<double> ground,
                         const CityFileSettings& settings);

    Geodetic origin_;
    double ground_ = 0;           ///< of the file's heights, at the level of the origin
    double raise_ = 0;            ///< from the file's heights to those above the ellipsoid
    bool sea_level_ = false;      ///< heights count from there
    bool heights_known_ = false;  ///< and are not fitted to the level of the origin
    double metres_per_unit_ = 1;
    std::optional<MapAnchor> anchor_;
    std::optional<MapProjection> projection_;
    std::optional<LocalFrame> frame_;
};

}  // namespace skyloop
