#include "study/analysis/scene_sky.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "world/gnss/orbit.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline study {
namespace {

SkyDirection direction_angles(const Eigen::Vector3d& unit) {
    double azimuth = std::atan2(unit.x(), unit.y());
    if (azimuth < 0) azimuth += 2 * std::numbers::pi;
    return {Angle::radians(azimuth), Angle::radians(std::asin(std::clamp(unit.z(), -1.0, 1.0)))};
}

ReflectedPath described_path(const UrbanScene& scene, const ScenePath& path, const Eigen::Vector3d& antenna) {
    const double half_power_db = 10 * std::log10(2.0);
    ReflectedPath described;
    for (const std::uint32_t plane : path.planes)
        described.surfaces.push_back(scene.planes()[plane].kind);
    described.points = reflection_points(scene, path, antenna);
    for (const Eigen::Vector3d& point : described.points)
        described.places.push_back(to_geodetic(scene.frame().to_ecef(Position<Enu>(point))));
    described.arrival = direction_angles(path.arrival);
    described.excess = Metres(path.excess);
    described.excess_rate = MetresPerSecond(path.excess_rate);
    described.loss = Decibels(half_power_db * path.reflections());
    return described;
}

}  // namespace

Reception SceneReception::reception() const {
    if (line_of_sight) return Reception::line_of_sight;
    return paths.empty() ? Reception::blocked : Reception::reflected;
}

SceneSatellite scene_satellite(const LocalFrame& frame, const SatelliteInView& satellite) {
    const double travel = satellite.travel_time.value();
    const Position<Ecef> position(turned_by(satellite.position_at_transmission.vector(), travel));
    const Velocity<Ecef> velocity(turned_by(satellite.velocity_at_transmission.vector(), travel));
    return {satellite.id, frame.to_enu(position).vector(), frame.to_enu(velocity).vector()};
}

std::vector<SceneSatellite> scene_satellites(const LocalFrame& frame, const SkyView& sky) {
    std::vector<SceneSatellite> satellites;
    satellites.reserve(sky.satellites.size());
    for (const SatelliteInView& satellite : sky.satellites)
        satellites.push_back(scene_satellite(frame, satellite));
    return satellites;
}

SceneReception scene_reception(const UrbanScene& scene, const SatellitePaths& found, const Eigen::Vector3d& antenna) {
    SceneReception reception{found.line_of_sight, {}};
    for (const ScenePath& path : found.paths)
        reception.paths.push_back(described_path(scene, path, antenna));
    return reception;
}

int SkyMask::highest(int azimuth) const {
    for (int elevation = elevations - 1; elevation >= 0; --elevation)
        if (at(azimuth, elevation)) return elevation + 1;
    return 0;
}

double SkyMask::open_share() const {
    // A ring of one degree has a solid angle that is proportional to the difference of the sines of its edges.
    double open = 0;
    for (int elevation = 0; elevation < elevations; ++elevation) {
        const double ring = std::sin(Angle::degrees(elevation + 1).rad()) - std::sin(Angle::degrees(elevation).rad());
        int cells = 0;
        for (int azimuth = 0; azimuth < azimuths; ++azimuth)
            cells += at(azimuth, elevation) ? 0 : 1;
        open += ring * cells / azimuths;
    }
    return open;
}

SkyMask sky_mask(const UrbanScene& scene, const Eigen::Vector3d& antenna) {
    std::vector<SceneRay> rays;
    rays.reserve(std::size_t{SkyMask::azimuths} * SkyMask::elevations);
    for (int azimuth = 0; azimuth < SkyMask::azimuths; ++azimuth)
        for (int elevation = 0; elevation < SkyMask::elevations; ++elevation)
            rays.push_back(
                {antenna, direction_towards(Angle::degrees(azimuth + 0.5), Angle::degrees(elevation + 0.5))});
    SkyMask mask;
    scene.blocked(rays, mask.blocked);
    return mask;
}

}  // namespace skyloop::inline study
