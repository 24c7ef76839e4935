#include "skyloop/scene/scene_path.hpp"

#include <cmath>

#include "skyloop/scene/urban_scene.hpp"

namespace skyloop {
namespace {

Eigen::Vector3d mirrored_direction(const ScenePlane& plane, const Eigen::Vector3d& direction) {
    return direction - plane.normal * (2 * plane.normal.dot(direction));
}

}  // namespace

UnfoldedPath unfold(const UrbanScene& scene, std::span<const std::uint32_t> planes, const Eigen::Vector3d& antenna,
                    const Eigen::Vector3d& satellite) {
    const std::span<const ScenePlane> all = scene.planes();
    Eigen::Vector3d image = antenna;
    for (const std::uint32_t index : planes)
        image -= all[index].normal * (2 * (all[index].normal.dot(image) - all[index].offset));
    const Eigen::Vector3d way = satellite - image;
    const double length = way.norm();
    UnfoldedPath path;
    path.departure = way / length;
    path.arrival = path.departure;
    for (std::size_t i = planes.size(); i > 0; --i)
        path.arrival = mirrored_direction(all[planes[i - 1]], path.arrival);
    // The difference of two lengths of 20,000 km would lose nine digits; the difference of their squares does not.
    const Eigen::Vector3d both = 2 * satellite - antenna - image;
    path.excess = (antenna - image).dot(both) / (length + (satellite - antenna).norm());
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
        direction = mirrored_direction(plane, direction);
        points.push_back(place);
    }
    return points;
}

std::vector<double> incidence_cosines(const UrbanScene& scene, const ScenePath& path) {
    std::vector<double> cosines;
    cosines.reserve(path.planes.size());
    Eigen::Vector3d direction = path.arrival;
    for (const std::uint32_t index : path.planes) {
        const ScenePlane& plane = scene.planes()[index];
        cosines.push_back(std::abs(plane.normal.dot(direction)));
        direction = mirrored_direction(plane, direction);
    }
    return cosines;
}

}  // namespace skyloop
