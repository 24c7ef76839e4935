#include "world/propagation/ray_traced_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>

#include "base/geo/local_frame.hpp"
#include "detail/hidden_arrival.hpp"
#include "detail/scene_rays.hpp"
#include "world/gnss/earth_turn.hpp"
#include "world/propagation/free_space.hpp"

namespace skyloop {
namespace {

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
    const std::vector<ArrivingRay> rays = city.beside_direct(arriving);
    if (arrival.line_of_sight) {
        const DirectLoss loss = city.direct_loss(arriving);
        arrival.reflection_loss = loss.edges;
        arrival.foliage_loss += loss.foliage;
        ArrivingRay direct;
        direct.amplitude = std::pow(10, -(loss.edges + loss.foliage).value() / 20);
        return follow(arrival, direct, rays, arriving.to_antenna);
    }
    if (rays.empty()) return hide(arrival);
    arrival.reflection_loss = Decibels(-20 * std::log10(rays.front().amplitude));
    follow(arrival, rays.front(), std::span(rays).subspan(1), arriving.to_antenna);
}

}  // namespace

RayTracedScene::RayTracedScene(std::shared_ptr<const UrbanScene> scene, const RayTracedSceneSettings& settings)
    : finder_(std::move(scene), search_of(settings)), settings_(settings) {}

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

    const SceneRays city(scene(), settings_);
    const Eigen::Matrix3d to_antenna = turn_to_antenna(frame, antenna);
    for (std::size_t i = 0; i < arrivals.satellites.size(); ++i) {
        Arrival& arrival = arrivals.satellites[i];
        if (settings_.profile == SceneProfile::baseline)
            arrive_by_article(arrival, paths_[i]);
        else
            arrive_by_rays(
                arrival, city,
                {observer_, to_antenna, satellites[i], paths_[i], first_carrier(arrival), arrival.foliage_loss});
    }
    notice_.reset();
    const auto arrives = [](const Arrival& arrival) { return arrival.paths > 0; };
    if (std::ranges::none_of(arrivals.satellites, arrives) && sees_no_sky(scene(), observer_.position))
        notice_ = closed_in_notice(scene(), observer_.position);
}

}  // namespace skyloop
