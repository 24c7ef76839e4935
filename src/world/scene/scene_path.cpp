#include "world/scene/scene_path.hpp"

#include "world/scene/urban_scene.hpp"

namespace skyloop::inline world {

double nearer_by(const Eigen::Vector3d& b, const Eigen::Vector3d& a, const Eigen::Vector3d& satellite) {
    const Eigen::Vector3d both = 2 * satellite - b - a;
    return (b - a).dot(both) / ((satellite - a).norm() + (satellite - b).norm());
}

double excess_growth(const WayDirections& way, const Eigen::Vector3d& antenna_velocity,
                     const Eigen::Vector3d& satellite_velocity) {
    return (way.departure - way.direct).dot(satellite_velocity) - (way.arrival - way.direct).dot(antenna_velocity);
}

UnfoldedPath unfold(const UrbanScene& scene, std::span<const std::uint32_t> planes, const Eigen::Vector3d& antenna,
                    const Eigen::Vector3d& satellite) {
    const std::span<const ScenePlane> all = scene.planes();
    Eigen::Vector3d image = antenna;
    for (const std::uint32_t index : planes)
        image -= all[index].normal * (2 * (all[index].normal.dot(image) - all[index].offset));
    const Eigen::Vector3d way = satellite - image;
    UnfoldedPath path;
    path.departure = way / way.norm();
    path.arrival = path.departure;
    for (std::size_t i = planes.size(); i > 0; --i)
        path.arrival = mirrored(all[planes[i - 1]].normal, path.arrival);
    path.excess = nearer_by(antenna, image, satellite);
    return path;
}

std::vector<Eigen::Vector3d> reflection_points(const UrbanScene& scene, const ScenePath& path,
                                               const Eigen::Vector3d& antenna) {
    std::vector<Eigen::Vector3d> points;
    points.reserve(path.planes.size());
    Eigen::Vector3d place = antenna;
    Eigen::Vector3d direction = path.arrival;
    for (const std::uint32_t index : path.planes) {
        const ScenePlane& plane = scene.planes()[index];
        place += direction * ((plane.offset - plane.normal.dot(place)) / plane.normal.dot(direction));
        direction = mirrored(plane.normal, direction);
        points.push_back(place);
    }
    return points;
}

}  // namespace skyloop::inline world
