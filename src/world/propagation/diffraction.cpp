#include "world/propagation/diffraction.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "world/gnss/constants.hpp"

namespace skyloop::inline world {

double knife_edge_parameter(Angle detour, Metres distance, Hertz carrier) {
    return detour.rad() * std::sqrt(2 * distance.value() * carrier.value() / speed_of_light);
}

Metres knife_edge_reach(Angle beside, Hertz carrier) {
    const double ratio = knife_edge_clear / beside.rad();
    return Metres(ratio * ratio * speed_of_light / (2 * carrier.value()));
}

Decibels knife_edge_loss(double v) {
    if (!(v > knife_edge_clear)) return Decibels(0);
    const double x = v - 0.1;
    return Decibels(6.9 + 20 * std::log10(std::sqrt(x * x + 1) + x));
}

namespace {

// Degrees away from the line at which is looked; between two of them the edge is found by bisection.
constexpr std::array turns_to_edge{0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 11.0, 15.0, 20.0, 27.0, 36.0, 45.0};
// Beside a free line those up to 8°; farther off it edges weaken a wave that are within some 4 m alone.
constexpr std::size_t beside_turns = 9;
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

// Turned by `blocked` a ray meets the obstacle within `reach` metres, by `free` it does not; radians.
struct EdgeBracket {
    double blocked, free;
    double reach = 1e9;
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
        (scene.blocked(fan.turned(side, middle), bracket.reach) ? bracket.blocked : bracket.free) = middle;
    }
}

// Where a turned ray grazes the obstacle, and the straight edge there.
struct GrazedEdge {
    Eigen::Vector3d point, along;  // `along` is a unit vector
    Eigen::Vector3d side;          // to which the line to the satellite was turned: away from what blocks it, or to it
    std::uint32_t plane;
    bool line_blocked;
};

// The side of the facet next to which it is met; nothing where none is as near as the bisection leaves open.
std::optional<GrazedEdge> edge_of_facet(const UrbanScene& scene, const SceneHit& hit, const Eigen::Vector3d& place) {
    const auto corners = scene.triangle(hit.triangle);
    std::optional<GrazedEdge> nearest;
    double least = 0.01 + 5e-4 * hit.distance;  // m; facets that are seen flatly are met further inside
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector3d& from = corners.at(i);
        const Eigen::Vector3d way = corners.at((i + 1) % corners.size()) - from, along = way.normalized();
        const Eigen::Vector3d point = from + std::clamp((place - from).dot(along), 0.0, way.norm()) * along;
        const double off = (place - point).norm();
        if (off < least) least = off, nearest = GrazedEdge{point, along, {}, hit.plane, false};
    }
    return nearest;
}

// How far along the edge the way over it to a source that is very far is shortest, m: there it leaves the edge at the
// angle at which it meets it.
double shortest_over(const GrazedEdge& edge, const SceneRay& to_satellite) {
    constexpr double least_sine = 1e-3;
    const double cosine = edge.along.dot(to_satellite.direction), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    if (sine < least_sine) return 0;
    const Eigen::Vector3d from = edge.point - to_satellite.origin;
    const double foot = -from.dot(edge.along);
    return foot + (from + foot * edge.along).norm() * cosine / sine;
}

// The obstacle ends there: it stands on the one side of the edge, and a ray comes by on the other.
bool bends_there(const UrbanScene& scene, const SceneRay& to_satellite, const GrazedEdge& edge, double along) {
    constexpr double same_face = 0.5;  // m
    const Eigen::Vector3d way = edge.point + along * edge.along - to_satellite.origin;
    Eigen::Vector3d outwards = edge.along.cross(way).normalized();
    if ((outwards.dot(edge.side) > 0) != edge.line_blocked) outwards = -outwards;
    const Eigen::Vector3d inner = way - off_edge * outwards, outer = way + off_edge * outwards;
    const SceneHit hit = scene.first_hit({to_satellite.origin, inner.normalized()});
    if (!hit.any() || (hit.plane != edge.plane && std::abs(hit.distance - inner.norm()) > same_face)) return false;
    if (scene.blocked({to_satellite.origin, outer.normalized()}, outer.norm())) return false;
    return !edge.line_blocked || !scene.blocked({to_satellite.origin + outer, to_satellite.direction});
}

// Where the ray over the edge bends: the shortest way, or the end of the edge before it. Nothing: the edge is none.
std::optional<Eigen::Vector3d> bend_of(const UrbanScene& scene, const SceneRay& to_satellite, const GrazedEdge& edge) {
    const auto bends = [&](double along) { return bends_there(scene, to_satellite, edge, along); };
    double good = shortest_over(edge, to_satellite);
    if (!bends(good)) {
        double bad = std::exchange(good, 0);
        if (!bends(good)) return std::nullopt;
        for (int i = 0; i < bisections; ++i) {
            const double middle = (good + bad) / 2;
            (bends(middle) ? good : bad) = middle;
        }
    }
    return edge.point + good * edge.along;
}

// Of an obstacle that a ray turned to `side` just meets. Without a straight edge it is where the free ray passes.
std::optional<SceneEdge> edge_met(const UrbanScene& scene, const SightFan& fan, const Eigen::Vector3d& side,
                                  const EdgeBracket& bracket, bool line_blocked) {
    const SceneRay &line = fan.to_satellite, grazing = fan.turned(side, bracket.blocked);
    const SceneHit hit = scene.first_hit(grazing);
    if (!hit.any() || (!line_blocked && scene.planes()[hit.plane].kind == SurfaceKind::ground)) return std::nullopt;
    if (auto edge = edge_of_facet(scene, hit, line.origin + hit.distance * grazing.direction)) {
        edge->side = side, edge->line_blocked = line_blocked;
        if (const auto bend = bend_of(scene, line, *edge)) {
            const Eigen::Vector3d way = *bend - line.origin, towards = way.normalized();
            return SceneEdge{
                towards, Metres(way.norm()),
                Angle::radians(std::atan2(towards.cross(line.direction).norm(), towards.dot(line.direction)))};
        }
    }
    const SceneEdge passed{fan.turned(side, bracket.free).direction, Metres(hit.distance),
                           Angle::radians(bracket.free)};
    const Eigen::Vector3d place = line.origin + hit.distance * passed.direction + off_edge * side;
    if (line_blocked && scene.blocked({place, line.direction})) return std::nullopt;
    return passed;
}

// An oblique edge is met by rays turned up and by rays turned aside.
bool is_among(std::span<const SceneEdge> edges, const SceneEdge& edge) {
    const auto place = [](const SceneEdge& e) -> Eigen::Vector3d { return e.distance.value() * e.direction; };
    const double same = 0.05 + 1e-3 * edge.distance.value();  // m
    return std::any_of(edges.begin(), edges.end(),
                       [&](const SceneEdge& other) { return (place(other) - place(edge)).norm() < same; });
}

// For each side where it changes first whether a ray is blocked.
using SideChanges = std::vector<std::optional<EdgeBracket>>;

SideChanges changes_along(const UrbanScene& scene, const SightFan& fan, std::span<const Eigen::Vector3d> sides,
                          std::span<const double> degrees, bool line_blocked) {
    std::vector<SceneRay> rays;
    for (const Eigen::Vector3d& side : sides)
        for (const double angle : degrees)
            rays.push_back(fan.turned(side, Angle::degrees(angle).rad()));
    std::vector<std::uint8_t> answers(rays.size());
    scene.blocked(rays, answers);
    SideChanges changes;
    for (std::size_t i = 0; i < sides.size(); ++i)
        changes.push_back(
            first_change(degrees, std::span(answers).subspan(i * degrees.size(), degrees.size()), line_blocked));
    return changes;
}

// Farther off a free line: as far away as an edge still weakens the wave.
std::optional<EdgeBracket> near_change(const UrbanScene& scene, const SightFan& fan, const Eigen::Vector3d& side,
                                       Hertz carrier) {
    double before = Angle::degrees(turns_to_edge[beside_turns - 1]).rad();
    for (const double degrees : std::span(turns_to_edge).subspan(beside_turns)) {
        const double here = Angle::degrees(degrees).rad();
        const double reach = knife_edge_reach(Angle::radians(before), carrier).value();
        if (scene.blocked(fan.turned(side, here), reach)) return EdgeBracket{here, before, reach};
        before = here;
    }
    return std::nullopt;
}

std::vector<SceneEdge> edges_at(const UrbanScene& scene, const SightFan& fan, std::span<const Eigen::Vector3d> sides,
                                SideChanges changes, bool line_blocked) {
    std::vector<SceneEdge> edges;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (!changes[i]) continue;
        bisect(scene, fan, sides[i], *changes[i]);
        const auto edge = edge_met(scene, fan, sides[i], *changes[i], line_blocked);
        if (edge && !is_among(edges, *edge)) edges.push_back(*edge);
    }
    return edges;
}

}  // namespace

std::vector<SceneEdge> edges_around_obstacle(const UrbanScene& scene, const SceneRay& to_satellite) {
    const SightFan fan(to_satellite);
    const std::array sides{fan.up, fan.right, Eigen::Vector3d(-fan.right)};
    return edges_at(scene, fan, sides, changes_along(scene, fan, sides, turns_to_edge, true), true);
}

std::vector<SceneEdge> edges_near_sight(const UrbanScene& scene, const SceneRay& to_satellite, Hertz carrier) {
    const SightFan fan(to_satellite);
    const std::array sides{fan.up, fan.right, Eigen::Vector3d(-fan.right), Eigen::Vector3d(-fan.up)};
    SideChanges changes = changes_along(scene, fan, sides, std::span(turns_to_edge).first(beside_turns), false);
    for (std::size_t i = 0; i < sides.size(); ++i)
        if (!changes[i]) changes[i] = near_change(scene, fan, sides[i], carrier);
    return edges_at(scene, fan, sides, std::move(changes), false);
}

}  // namespace skyloop::inline world
