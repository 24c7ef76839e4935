#include "skyloop/propagation/scene_edges.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

namespace skyloop {
namespace {

// Degrees away from the line at which is looked; between two of them the edge is found by bisection.
constexpr std::array behind_steps{0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 11.0, 15.0, 20.0, 27.0, 36.0, 45.0};
constexpr std::array beside_steps{0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};
constexpr int bisections = 14;     // of 9°: to 0.0006°
constexpr double off_edge = 0.05;  // m past an edge, where the way on to the satellite is tried

// The line to the satellite, and the sides to which it may be turned.
struct SightFan {
    explicit SightFan(const SceneRay& line) : to_satellite(line) {
        const Eigen::Vector3d& u = line.direction;
        const Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(u);
        right = level.norm() > 1e-9 ? Eigen::Vector3d(-level.normalized()) : Eigen::Vector3d::UnitX();
        up = right.cross(u);
    }
    [[nodiscard]] SceneRay turned(const Eigen::Vector3d& side, double angle) const {
        return {to_satellite.origin, std::cos(angle) * to_satellite.direction + std::sin(angle) * side};
    }
    const SceneRay& to_satellite;
    Eigen::Vector3d up, right;
};

// Turned by `blocked` a ray meets the obstacle, by `free` it does not; radians.
struct EdgeBracket {
    double blocked, free;
};

std::optional<EdgeBracket> first_change(std::span<const double> degrees, std::span<const std::uint8_t> answers,
                                        bool line_blocked) {
    double before = 0;
    for (std::size_t i = 0; i < degrees.size(); ++i) {
        const double here = Angle::degrees(degrees[i]).rad();
        if ((answers[i] != 0) != line_blocked)
            return line_blocked ? EdgeBracket{before, here} : EdgeBracket{here, before};
        before = here;
    }
    return std::nullopt;
}

void bisect(const UrbanScene& scene, const SightFan& fan, const Eigen::Vector3d& side, EdgeBracket& bracket) {
    for (int i = 0; i < bisections; ++i) {
        const double middle = (bracket.blocked + bracket.free) / 2;
        (scene.blocked(fan.turned(side, middle)) ? bracket.blocked : bracket.free) = middle;
    }
}

bool seen_from_edge(const UrbanScene& scene, const SceneRay& to_satellite, const SceneEdge& edge,
                    const Eigen::Vector3d& side) {
    const Eigen::Vector3d place = to_satellite.origin + edge.distance.value() * edge.direction + off_edge * side;
    return !scene.blocked({place, to_satellite.direction});
}

std::vector<SceneEdge> edges_along(const UrbanScene& scene, const SightFan& fan, std::span<const Eigen::Vector3d> sides,
                                   bool line_blocked) {
    const std::span<const double> steps =
        line_blocked ? std::span<const double>(behind_steps) : std::span<const double>(beside_steps);
    std::vector<SceneRay> rays;
    for (const Eigen::Vector3d& side : sides)
        for (const double degrees : steps)
            rays.push_back(fan.turned(side, Angle::degrees(degrees).rad()));
    std::vector<std::uint8_t> answers(rays.size());
    scene.blocked(rays, answers);

    std::vector<SceneEdge> edges;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        auto bracket = first_change(steps, std::span(answers).subspan(i * steps.size(), steps.size()), line_blocked);
        if (!bracket) continue;
        bisect(scene, fan, sides[i], *bracket);
        const SceneHit hit = scene.first_hit(fan.turned(sides[i], bracket->blocked));
        if (!hit.any()) continue;
        if (!line_blocked && scene.planes()[hit.plane].kind == SurfaceKind::ground) continue;
        const SceneEdge edge{fan.turned(sides[i], bracket->free).direction, Metres(hit.distance),
                             Angle::radians(bracket->free)};
        if (!line_blocked || seen_from_edge(scene, fan.to_satellite, edge, sides[i])) edges.push_back(edge);
    }
    return edges;
}

}  // namespace

std::vector<SceneEdge> edges_around_obstacle(const UrbanScene& scene, const SceneRay& to_satellite) {
    const SightFan fan(to_satellite);
    const std::array sides{fan.up, fan.right, Eigen::Vector3d(-fan.right)};
    return edges_along(scene, fan, sides, true);
}

std::vector<SceneEdge> edges_near_sight(const UrbanScene& scene, const SceneRay& to_satellite) {
    const SightFan fan(to_satellite);
    const std::array sides{fan.up, fan.right, Eigen::Vector3d(-fan.right), Eigen::Vector3d(-fan.up)};
    return edges_along(scene, fan, sides, false);
}

}  // namespace skyloop
