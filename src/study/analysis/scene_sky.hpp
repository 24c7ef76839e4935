/// What a city leaves of the sky above a place, for people and programs that ask.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/sky_view.hpp"
#include "world/gnss/dop.hpp"
#include "world/scene/scene_path.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline study {

/// One reflected path with its geometry; lists go from the antenna outwards.
struct ReflectedPath {
    std::vector<SurfaceKind> surfaces;
    std::vector<Eigen::Vector3d> points;  ///< of reflection, in the scene's frame, m
    std::vector<Geodetic> places;         ///< the same
    SkyDirection arrival;                 ///< where the antenna hears it, in the scene's frame; elevations below 0 too
    Metres excess;                        ///< over the straight line
    MetresPerSecond excess_rate;
    Decibels loss;  ///< half of the power at each reflection, whatever the material (MODELS.md R-22)
};

/// What one satellite's signal finds in the city.
struct SceneReception {
    bool line_of_sight = true;
    std::vector<ReflectedPath> paths;  ///< by number of reflections, then by excess: the first one counts
    [[nodiscard]] Reception reception() const;
};

/// A satellite of the sky in the scene's frame: where its signal left, turned by the Earth's rotation on the way
/// (MODELS.md 3.4).
SceneSatellite scene_satellite(const LocalFrame& frame, const SatelliteInView& satellite);
/// All of them, in their order.
std::vector<SceneSatellite> scene_satellites(const LocalFrame& frame, const SkyView& sky);

/// The paths of one satellite with their geometry. @param antenna in the scene's frame, m
SceneReception scene_reception(const UrbanScene& scene, const SatellitePaths& found, const Eigen::Vector3d& antenna);

/// What is blocked above a place, by cells of one degree.
struct SkyMask {
    static constexpr int azimuths = 360, elevations = 90;
    std::vector<std::uint8_t> blocked = std::vector<std::uint8_t>(std::size_t{azimuths} * elevations);

    /// The cell from `azimuth` to `azimuth` + 1° and from `elevation` to `elevation` + 1°; decided at its middle.
    [[nodiscard]] bool at(int azimuth, int elevation) const {
        return blocked[static_cast<std::size_t>(azimuth) * elevations + static_cast<std::size_t>(elevation)] != 0;
    }
    /// The upper edge of the highest blocked cell of an azimuth, degrees; 0 when none is. There may be gaps below.
    [[nodiscard]] int highest(int azimuth) const;
    /// The part of the hemisphere's solid angle that is open, 0 … 1.
    [[nodiscard]] double open_share() const;
};
SkyMask sky_mask(const UrbanScene& scene, const Eigen::Vector3d& antenna);

}  // namespace skyloop::inline study
