/// How a satellite's signal comes to the antenna in a city.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "base/core/std_additions.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline world {

class UrbanScene;

/// Reflections that the article's sensor follows (MODELS.md R-23).
constexpr int most_reflections = 16;

/// A satellite in the scene's frame.
struct SceneSatellite {
    SatelliteId id;
    Eigen::Vector3d position;  ///< m; where the signal left, turned to the instant of reception
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
};

/// One specular path: a fixed point of launching and tracing.
struct ScenePath {
    /// Planes from the antenna to the satellite, as UrbanScene::planes() numbers them.
    InplaceVector<std::uint32_t, most_reflections> planes;
    Eigen::Vector3d arrival;  ///< unit, from the antenna to where the signal comes from
    double excess = 0;        ///< over the straight line, m
    double excess_rate = 0;   ///< m/s
    [[nodiscard]] int reflections() const { return static_cast<int>(planes.size()); }
};

/// What one satellite's signal finds.
struct SatellitePaths {
    SatelliteId id;
    bool line_of_sight = true;
    std::vector<ScenePath> paths;  ///< reflected ones, by number of reflections, then by excess
};

/// A direction after a mirror of that normal, unit both.
inline Eigen::Vector3d mirrored(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction) {
    return direction - normal * (2 * normal.dot(direction));
}

/// |satellite − a| − |satellite − b|, m, by the difference of the squares: that of two lengths of 20,000 km would lose
/// nine digits.
double nearer_by(const Eigen::Vector3d& b, const Eigen::Vector3d& a, const Eigen::Vector3d& satellite);

/// A way between satellite and antenna that is not the straight one: unit vectors, all towards the satellite's end.
struct WayDirections {
    Eigen::Vector3d arrival;    ///< from the antenna to where the signal comes from
    Eigen::Vector3d departure;  ///< of the last stretch
    Eigen::Vector3d direct;     ///< of the straight line
};
/// How fast the excess of a way grows, m/s: the way's gradient is −arrival at the antenna and +departure at the
/// satellite, that of the straight line −direct and +direct (CITY.md section 2).
double excess_growth(const WayDirections& way, const Eigen::Vector3d& antenna_velocity,
                     const Eigen::Vector3d& satellite_velocity);

/// Launch direction and excess length of a sequence of planes by image points, in closed form for the spherical wave:
/// the image P' of the antenna, u = unit(S − P'), arrival = R1…Rk u, excess = (P − P')·(2S − P − P') ∕ (|S − P'| + |S −
/// P|) (CITY.md section 1). Whether facets lie there is not asked.
struct UnfoldedPath {
    Eigen::Vector3d arrival;    ///< unit
    Eigen::Vector3d departure;  ///< u, unit: towards the satellite after the last reflection
    double excess = 0;          ///< m
};
UnfoldedPath unfold(const UrbanScene& scene, std::span<const std::uint32_t> planes, const Eigen::Vector3d& antenna,
                    const Eigen::Vector3d& satellite);

/// Points of reflection from the antenna outwards, by exact planes.
std::vector<Eigen::Vector3d> reflection_points(const UrbanScene& scene, const ScenePath& path,
                                               const Eigen::Vector3d& antenna);

}  // namespace skyloop::inline world
