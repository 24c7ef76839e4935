/// The rays of one satellite that a city lets through, bent or mirrored, and how strong they are.
#pragma once

#include <span>
#include <vector>

#include "world/propagation/fresnel.hpp"
#include "world/propagation/ray_traced_scene.hpp"

namespace skyloop {

/// A way to the antenna, in the scene's frame.
struct ArrivingRay {
    Eigen::Vector3d from;  ///< unit
    double excess = 0;     ///< over the direct line, m
    double excess_rate = 0;
    double amplitude = 1;  ///< at the antenna's output, over that of an unobstructed direct ray
    Angle lag;             ///< beside what the excess does
    int reflections = 0;
};

/// Where antenna and satellite are, and what was found between them.
struct ArrivingSatellite {
    const SceneObserver& observer;
    const Eigen::Matrix3d& to_antenna;  ///< from the scene's frame to east, north, up at the antenna
    const SceneSatellite& satellite;
    const SatellitePaths& found;
    Hertz carrier;
    Decibels around;  ///< foliage loss that the arrival has already, of crowns wherever the antenna is
};

/// What the direct ray loses.
struct DirectLoss {
    Decibels edges, foliage;
};

/// Strengths of rays by materials, edges, trees and the antenna.
class SceneRays {
public:
    SceneRays(const UrbanScene& scene, const RayTracedSceneSettings& settings);
    /// Every ray but the direct one, −40 dB or stronger; strongest first.
    [[nodiscard]] std::vector<ArrivingRay> beside_direct(const ArrivingSatellite& arriving) const;
    /// Of a satellite in sight.
    [[nodiscard]] DirectLoss direct_loss(const ArrivingSatellite& arriving) const;

private:
    [[nodiscard]] Decibels crown_loss(const ArrivingSatellite& arriving, std::span<const Eigen::Vector3d> bends) const;
    [[nodiscard]] ArrivingRay reflected(const ArrivingSatellite& arriving, const ScenePath& path) const;
    void add_bent(const ArrivingSatellite& arriving, std::vector<ArrivingRay>& rays) const;
    [[nodiscard]] double gain_over_direct(const ArrivingSatellite& arriving, const Eigen::Vector3d& from) const;

    const UrbanScene& scene_;
    const RayTracedSceneSettings& settings_;
    std::vector<SurfaceMaterial> materials_;
};

/// East, north, up as azimuth and elevation.
SkyDirection sky_direction(const Eigen::Vector3d& enu);

}  // namespace skyloop
