// The rays of one satellite that a city lets through, bent or mirrored, and how strong they are.
#include "world/propagation/ray_traced_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "world/gnss/orbit.hpp"
#include "world/propagation/diffraction.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/reflection.hpp"

namespace skyloop::inline world {
namespace {

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
    const WallScattering& scattering;
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
    /// What walls scatter, −40 dB or stronger.
    [[nodiscard]] std::vector<ArrivingRay> scattered(const ArrivingSatellite& arriving) const;
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

constexpr double faintest_ray = 0.01;  // −40 dB
constexpr Angle knife_edge_lag =
    Angle::degrees(45);  // of the bent ray deep in the shadow (ITU-R P.526, Fresnel integral)

double amplitude_of(Decibels loss) { return std::pow(10, -loss.value() / 20); }

SceneRay line_to(const ArrivingSatellite& arriving) {
    const Eigen::Vector3d way = arriving.satellite.position - arriving.observer.position;
    return {arriving.observer.position, way.normalized()};
}

/// East, north, up as azimuth and elevation.
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
    // Where its rays turn is worked out for trees and rough walls alone.
    Decibels loss(0);
    if (!scene_.foliage().empty() || arriving.scattering.acts()) {
        const std::vector<Eigen::Vector3d> turns = reflection_points(scene_, path, arriving.observer.position);
        loss = crown_loss(arriving, turns);
        for (const Eigen::Vector3d& turn : turns)
            loss += arriving.scattering.unevenness(turn);
    }
    return {path.arrival,
            path.excess,
            path.excess_rate,
            std::abs(heard) * amplitude_of(loss) * gain_over_direct(arriving, path.arrival),
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

std::vector<ArrivingRay> SceneRays::scattered(const ArrivingSatellite& arriving) const {
    std::vector<ArrivingRay> rays;
    for (const ScatteredGroup& group : arriving.scattering.of(arriving.satellite, arriving.carrier)) {
        const double amplitude = std::abs(group.amplitude);
        if (amplitude < faintest_ray) continue;
        rays.push_back({group.from, group.excess, 0, amplitude * gain_over_direct(arriving, group.from),
                        Angle::radians(-std::arg(group.amplitude)), 1});
    }
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

const Decibels half_power(10 * std::log10(2.0));

PathSearchSettings search_of(const RayTracedSceneSettings& settings) {
    PathSearchSettings search = settings.search;
    search.blocked_only = settings.profile == SceneProfile::baseline;
    if (search.rays == 0) search.rays = default_rays(settings.epochs_per_second);
    return search;
}

// From where the antenna's own frame sees it: what other effects go by, too.
SceneSatellite in_scene(const LocalFrame& frame, const LocalFrame& antenna, const SatelliteInView& seen) {
    const double a = seen.azimuth.rad(), e = seen.elevation.rad();
    const Eigen::Vector3d towards(std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e));
    const Position<Ecef> place = antenna.to_ecef(Position<Enu>(towards * seen.range.value()));
    const Velocity<Ecef> velocity(turned_by(seen.velocity_at_transmission.vector(), seen.travel_time.value()));
    return {seen.id, frame.to_enu(place).vector(), frame.to_enu(velocity).vector()};
}

// Turns vectors of the scene's frame into east, north, up at the antenna.
Eigen::Matrix3d turn_to_antenna(const LocalFrame& scene, const LocalFrame& antenna) {
    Eigen::Matrix3d turn;
    for (int i = 0; i < 3; ++i)
        turn.col(i) = antenna.to_enu(scene.to_ecef(Displacement<Enu>(Eigen::Vector3d::Unit(i)))).vector();
    return turn;
}

// Says where an antenna is that hears nothing.
std::string closed_in_notice(const UrbanScene& scene, const Eigen::Vector3d& place) {
    const auto ground = scene.ground_at(place.x(), place.y());
    if (ground && *ground > place.z())
        return fmt::format("the antenna is {:.1f} m below the ground of the scene: no signal arrives",
                           *ground - place.z());
    const auto top = scene.top_at(place.x(), place.y());
    if (!top) return "the antenna is closed in by the scene: no signal arrives";
    return fmt::format("the antenna is inside a building of the scene, {:.1f} m below its top: no signal arrives",
                       *top - place.z());
}

// The article's rule (MODELS.md R-21 … R-23); paths come by number of reflections, then by length.
void arrive_by_article(Arrival& arrival, const SatellitePaths& found) {
    arrival.line_of_sight = found.line_of_sight;
    if (found.line_of_sight) return;
    if (found.paths.empty()) return hide(arrival);
    const ScenePath& shortest = found.paths.front();
    arrival.reflections = shortest.reflections();
    arrival.excess_path = Metres(shortest.excess);
    arrival.excess_rate = MetresPerSecond(shortest.excess_rate);
    arrival.reflection_loss = half_power * shortest.reflections();
}

// The loss of one ray and the others against it.
void follow(Arrival& arrival, const ArrivingRay& tracked, std::span<const ArrivingRay> others,
            const Eigen::Matrix3d& to_antenna) {
    arrival.paths = 1 + static_cast<int>(others.size());
    arrival.reflections = tracked.reflections;
    arrival.excess_path = Metres(tracked.excess);
    arrival.excess_rate = MetresPerSecond(tracked.excess_rate);
    arrival.echoes.reserve(others.size());
    for (const ArrivingRay& ray : others)
        arrival.echoes.push_back({sky_direction(to_antenna * ray.from), Metres(ray.excess - tracked.excess),
                                  MetresPerSecond(ray.excess_rate - tracked.excess_rate),
                                  ray.amplitude / tracked.amplitude, ray.lag - tracked.lag, ray.reflections});
}

void arrive_by_rays(Arrival& arrival, const SceneRays& city, const ArrivingSatellite& arriving) {
    arrival.line_of_sight = arriving.found.line_of_sight;
    arrival.echoes_known = true;
    arrival.echoes.clear();
    std::vector<ArrivingRay> rays = city.beside_direct(arriving);
    if (!arrival.line_of_sight && rays.empty()) return hide(arrival);
    const std::vector<ArrivingRay> scattered = city.scattered(arriving);
    rays.insert(rays.end(), scattered.begin(), scattered.end());
    if (arrival.line_of_sight) {
        const DirectLoss loss = city.direct_loss(arriving);
        arrival.reflection_loss = loss.edges;
        arrival.foliage_loss += loss.foliage;
        ArrivingRay direct;
        direct.amplitude = amplitude_of(loss.edges + loss.foliage);
        return follow(arrival, direct, rays, arriving.to_antenna);
    }
    arrival.reflection_loss = Decibels(-20 * std::log10(rays.front().amplitude));
    follow(arrival, rays.front(), std::span(rays).subspan(1), arriving.to_antenna);
}

}  // namespace

RayTracedScene::RayTracedScene(std::shared_ptr<const UrbanScene> scene, const RayTracedSceneSettings& settings)
    : finder_(std::move(scene), search_of(settings)),
      settings_(settings),
      scattering_(finder_.scene(), settings.scattering) {}

void RayTracedScene::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    const LocalFrame& frame = scene().frame();
    observer_ = {truth.time, scene().above_surface(frame.to_enu(truth.position).vector()),
                 frame.to_enu(truth.velocity).vector()};
    const LocalFrame antenna(truth.geodetic);
    std::vector<SceneSatellite> satellites;
    satellites.reserve(sky.satellites.size());
    for (const SatelliteInView& seen : sky.satellites)
        satellites.push_back(in_scene(frame, antenna, seen));
    paths_ = finder_.epoch(observer_, satellites);

    if (settings_.profile == SceneProfile::modern) scattering_.look_around(observer_);
    const SceneRays city(scene(), settings_);
    const Eigen::Matrix3d to_antenna = turn_to_antenna(frame, antenna);
    for (std::size_t i = 0; i < arrivals.satellites.size(); ++i) {
        Arrival& arrival = arrivals.satellites[i];
        if (settings_.profile == SceneProfile::baseline)
            arrive_by_article(arrival, paths_[i]);
        else
            arrive_by_rays(arrival, city,
                           {observer_, to_antenna, satellites[i], paths_[i], first_carrier(arrival),
                            arrival.foliage_loss, scattering_});
    }
    notice_.reset();
    const auto arrives = [](const Arrival& arrival) { return arrival.paths > 0; };
    if (std::ranges::none_of(arrivals.satellites, arrives) && sees_no_sky(scene(), observer_.position))
        notice_ = closed_in_notice(scene(), observer_.position);
}

}  // namespace skyloop::inline world
