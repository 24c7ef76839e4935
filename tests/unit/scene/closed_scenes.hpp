/// Scenes whose paths are known without tracing a ray.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "world/scene/path_finder.hpp"

namespace skyloop::test {

inline const GpsTime scene_noon = to_gps_time(2300, 43200);

inline CityModel empty_scene_city() {
    CityModel city;
    city.origin = Geodetic::degrees(48.1, 11.6, 500);
    return city;
}

/// An upright wall from one place to another.
inline void add_wall(CityModel& city, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double base, double top) {
    city.add_quad({Eigen::Vector3d(from.x(), from.y(), base),
                   {to.x(), to.y(), base},
                   {to.x(), to.y(), top},
                   {from.x(), from.y(), top}},
                  SurfaceKind::wall);
}

/// A house with a flat roof, turned by `yaw` radians.
inline void add_house(CityModel& city, const Eigen::Vector2d& centre, const Eigen::Vector2d& half, double top,
                      double yaw) {
    const Eigen::Vector2d along = half.x() * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
    const Eigen::Vector2d across = half.y() * Eigen::Vector2d(-std::sin(yaw), std::cos(yaw));
    const std::array<Eigen::Vector2d, 4> ring{centre - along - across, centre + along - across, centre + along + across,
                                              centre - along + across};
    for (std::size_t i = 0; i < 4; ++i)
        add_wall(city, ring[i], ring[(i + 1) % 4], 0, top);
    const auto corner = [&](std::size_t i) { return Eigen::Vector3d(ring[i].x(), ring[i].y(), top); };
    city.add_quad({corner(0), corner(1), corner(2), corner(3)}, SurfaceKind::roof);
}

/// Houses on a grid, a street of 16 m between them, a bit askew, on level ground. With an even number of houses a
/// street runs along x = 0.
inline CityModel house_grid_city(int per_side, unsigned seed, double askew = 0.06) {
    CityModel city = empty_scene_city();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(-1, 1);
    for (int i = 0; i < per_side; ++i) {
        for (int j = 0; j < per_side; ++j) {
            const Eigen::Vector2d centre(44 * (i - (per_side - 1) / 2.0), 44 * (j - (per_side - 1) / 2.0));
            const Eigen::Vector2d half(12.5 + share(random), 12.5 + share(random));
            const double top = 26 + 12 * share(random);
            add_house(city, centre, half, top, askew * share(random));
        }
    }
    const double edge = 44.0 * per_side;
    city.add_quad({Eigen::Vector3d(-edge, -edge, 0), {edge, -edge, 0}, {edge, edge, 0}, {-edge, edge, 0}},
                  SurfaceKind::ground);
    return city;
}

inline std::shared_ptr<const UrbanScene> built_scene(const CityModel& city) {
    auto scene = UrbanScene::build(city);
    return scene ? *scene : nullptr;
}

/// The unit vector at an elevation and an angle from +x towards +y, degrees.
inline Eigen::Vector3d heading(double elevation_deg, double angle_deg) {
    const double elevation = elevation_deg * std::numbers::pi / 180;
    const double angle = angle_deg * std::numbers::pi / 180;
    return {std::cos(elevation) * std::cos(angle), std::cos(elevation) * std::sin(angle), std::sin(elevation)};
}

/// So far that the wave is plane.
constexpr double infinitely_far = 1e14;
constexpr double gps_distance = 2.02e7;

inline SceneSatellite satellite_at(int number, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                   double distance) {
    return {{Constellation::gps, number}, from + distance * direction, Eigen::Vector3d::Zero()};
}

/// Satellites all over the sky above 5°, moving at 3.9 km/s.
inline std::vector<SceneSatellite> scattered_satellites(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<SceneSatellite> satellites;
    for (int i = 1; i <= count; ++i) {
        const double sine = 0.087 + 0.913 * share(random);
        const Eigen::Vector3d direction = heading(std::asin(sine) * 180 / std::numbers::pi, 360 * share(random));
        satellites.push_back(satellite_at(i, Eigen::Vector3d::Zero(), direction, gps_distance));
        const Eigen::Vector3d other = heading(90 * share(random), 360 * share(random));
        satellites.back().velocity = 3900 * direction.cross(other).normalized();
    }
    return satellites;
}

/// Searches at once and for all satellites.
inline PathSearchSettings search_of_everything(int rays = 20000) {
    PathSearchSettings settings;
    settings.rays = rays;
    settings.blocked_only = false;
    settings.search_ahead = false;
    return settings;
}

inline std::vector<SatellitePaths> paths_at(const CityModel& city, const Eigen::Vector3d& antenna,
                                            const std::vector<SceneSatellite>& satellites,
                                            const PathSearchSettings& settings) {
    PathFinder finder(built_scene(city), settings);
    return finder.epoch({scene_noon, antenna, Eigen::Vector3d::Zero()}, satellites);
}

/// Walls at x = 0 and x = width, just so high that a wave towards +x that reflects `reflections` times, the last time
/// at x = 0, comes out, and no other: after k widths of way across, waves that have reflected k times come from x = 0,
/// and those that began at the other wall from x = width. `direction` points to the satellite.
inline CityModel canyon_for(int reflections, double width, const Eigen::Vector3d& antenna,
                            const Eigen::Vector3d& direction) {
    const double top = antenna.z() + reflections * width * direction.z() / direction.x();
    CityModel city = empty_scene_city();
    add_wall(city, {0, -8000}, {0, 8000}, -5, top);
    add_wall(city, {width, -8000}, {width, 8000}, -5, top);
    return city;
}

/// Excess length there, by the images of the antenna.
inline double canyon_excess(int reflections, double width, double x, double towards) {
    double image = x;
    for (int left = reflections; left > 0; --left)
        image = left % 2 == 1 ? -image : 2 * width - image;
    return (x - image) * towards;
}

}  // namespace skyloop::test
