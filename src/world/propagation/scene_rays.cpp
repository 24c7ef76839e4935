#include "detail/scene_rays.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "world/propagation/knife_edge.hpp"
#include "world/propagation/reflected_wave.hpp"
#include "world/propagation/scene_edges.hpp"

namespace skyloop {
namespace {

constexpr double faintest_ray = 0.01;  // −40 dB
constexpr Angle knife_edge_lag =
    Angle::degrees(45);  // of the bent ray deep in the shadow (ITU-R P.526, Fresnel integral)

double amplitude_of(Decibels loss) { return std::pow(10, -loss.value() / 20); }

SceneRay line_to(const ArrivingSatellite& arriving) {
    const Eigen::Vector3d way = arriving.satellite.position - arriving.observer.position;
    return {arriving.observer.position, way.normalized()};
}

}  // namespace

SkyDirection sky_direction(const Eigen::Vector3d& enu) {
    const double azimuth = std::atan2(enu.x(), enu.y());
    return {Angle::radians(azimuth < 0 ? azimuth + 2 * std::numbers::pi : azimuth),
            Angle::radians(std::atan2(enu.z(), std::hypot(enu.x(), enu.y())))};
}

SceneRays::SceneRays(const UrbanScene& scene, const RayTracedSceneSettings& settings)
    : scene_(scene), settings_(settings) {
    for (const std::string& name : scene.materials())
        materials_.push_back(surface_material(name).value_or(*surface_material("concrete")));
}

// Of the way from the antenna by the places where it turns to the satellite: what the crowns around leave of the limit.
Decibels SceneRays::crown_loss(const ArrivingSatellite& arriving, std::span<const Eigen::Vector3d> bends) const {
    const CrownLoss& crowns = settings_.crowns;
    if (crowns.factor == 0) return {};
    double metres = 0;
    Eigen::Vector3d place = arriving.observer.position;
    for (const Eigen::Vector3d& bend : bends) {
        const Eigen::Vector3d leg = bend - place;
        metres += scene_.length_in_foliage({place, leg.normalized()}, leg.norm());
        place = bend;
    }
    metres += scene_.length_in_foliage({place, (arriving.satellite.position - place).normalized()});
    const Decibels loss(crowns.db_per_m * metres * crowns.factor);
    return std::clamp(crowns.most * crowns.factor - arriving.around, Decibels(0), loss);
}

double SceneRays::gain_over_direct(const ArrivingSatellite& arriving, const Eigen::Vector3d& from) const {
    const auto gain = [&](const Eigen::Vector3d& direction) {
        return settings_.antenna.gain(sky_direction(arriving.to_antenna * direction));
    };
    return amplitude_of(gain(line_to(arriving).direction) - gain(from));
}

ArrivingRay SceneRays::reflected(const ArrivingSatellite& arriving, const ScenePath& path) const {
    std::vector<ReflectingSurface> surfaces;
    for (const std::uint32_t index : path.planes) {
        const ScenePlane& plane = scene_.planes()[index];
        surfaces.push_back({plane.normal, complex_permittivity_p2040(materials_[plane.material], arriving.carrier)});
    }
    const CircularWave wave = reflected_wave(surfaces, path.arrival, arriving.carrier, settings_.wall_roughness);
    const std::complex<double> heard = heard_by_right_hand(wave, settings_.opposite_hand_rejection);
    // Where its rays turn is worked out for trees alone.
    const Decibels crowns = scene_.foliage().empty()
                                ? Decibels(0)
                                : crown_loss(arriving, reflection_points(scene_, path, arriving.observer.position));
    return {path.arrival,
            path.excess,
            path.excess_rate,
            std::abs(heard) * amplitude_of(crowns) * gain_over_direct(arriving, path.arrival),
            Angle::radians(-std::arg(heard)),
            path.reflections()};
}

void SceneRays::add_bent(const ArrivingSatellite& arriving, std::vector<ArrivingRay>& rays) const {
    const SceneRay line = line_to(arriving);
    const Eigen::Vector3d& antenna = arriving.observer.position;
    for (const SceneEdge& edge : edges_around_obstacle(scene_, line)) {
        const double v = knife_edge_parameter(edge.detour, edge.distance, arriving.carrier);
        const Eigen::Vector3d place = antenna + edge.distance.value() * edge.direction;
        const Decibels loss = knife_edge_loss(v) + crown_loss(arriving, std::span(&place, 1));
        const Eigen::Vector3d onward = (arriving.satellite.position - place).normalized();
        const double detour = (place - antenna).norm() + nearer_by(antenna, place, arriving.satellite.position);
        const double rate = excess_growth({edge.direction, onward, line.direction}, arriving.observer.velocity,
                                          arriving.satellite.velocity);
        rays.push_back({edge.direction, detour, rate, amplitude_of(loss) * gain_over_direct(arriving, edge.direction),
                        knife_edge_lag, 0});
    }
}

std::vector<ArrivingRay> SceneRays::beside_direct(const ArrivingSatellite& arriving) const {
    std::vector<ArrivingRay> rays;
    for (const ScenePath& path : arriving.found.paths)
        rays.push_back(reflected(arriving, path));
    if (!arriving.found.line_of_sight && settings_.diffraction) add_bent(arriving, rays);
    rays.erase(std::remove_if(rays.begin(), rays.end(), [](const auto& r) { return !(r.amplitude >= faintest_ray); }),
               rays.end());
    std::stable_sort(rays.begin(), rays.end(), [](const ArrivingRay& a, const ArrivingRay& b) {
        return a.amplitude != b.amplitude ? a.amplitude > b.amplitude : a.excess < b.excess;
    });
    return rays;
}

DirectLoss SceneRays::direct_loss(const ArrivingSatellite& arriving) const {
    DirectLoss loss;
    loss.foliage = crown_loss(arriving, {});
    if (!settings_.diffraction) return loss;
    const SceneRay line = line_to(arriving);
    for (const SceneEdge& edge : edges_near_sight(scene_, line, arriving.carrier))
        loss.edges += knife_edge_loss(knife_edge_parameter(-edge.detour, edge.distance, arriving.carrier));
    return loss;
}

}  // namespace skyloop
