#include "world/propagation/surroundings_stretch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <numbers>

namespace skyloop::inline world {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point>;
using Line = bg::model::linestring<Point>;

// On the plane that touches the Earth at a place, m east and north.
Polygon polygon_around(const Geodetic& place, const StretchOfPlace& area) {
    constexpr double radius = 6371000;
    Polygon polygon;
    for (const Geodetic& corner : area.corners) {
        const double east = std::remainder(corner.longitude.rad() - place.longitude.rad(), 2 * std::numbers::pi);
        const double north = corner.latitude.rad() - place.latitude.rad();
        bg::append(polygon.outer(), Point(radius * std::cos(place.latitude.rad()) * east, radius * north));
    }
    bg::correct(polygon);
    return polygon;
}

Line edges_of(const Polygon& polygon) { return {polygon.outer().begin(), polygon.outer().end()}; }

double weight_of(double since, double left, double ramp) {
    const double nearer = std::min(since, left);
    if (nearer < 0) return 0;
    return ramp > 0 ? std::min(nearer / ramp, 1.0) : 1;
}

// From the origin straight on until the polygon ends; where there is no heading, to its nearest edge.
double way_to_edge(const Polygon& polygon, std::optional<Angle> heading) {
    const Point here(0, 0);
    const Line edges = edges_of(polygon);
    const double nearest = bg::distance(here, edges);
    if (!heading) return nearest;
    constexpr double farther_than_any = 1e6;
    const Line ahead{here,
                     Point(farther_than_any * std::sin(heading->rad()), farther_than_any * std::cos(heading->rad()))};
    std::vector<Point> crossings;
    bg::intersection(ahead, edges, crossings);
    double way = farther_than_any;
    for (const Point& crossing : crossings)
        way = std::min(way, bg::distance(here, crossing));
    return crossings.empty() ? nearest : way;
}

StretchPlace place_along(double since, double left, double ramp) {
    return {weight_of(since, left, ramp), since >= 0 && left >= 0, since, left};
}

struct PlaceFinder {
    const Whereabouts& antenna;
    double ramp;

    StretchPlace operator()(const StretchOfWay& way) const {
        return place_along((antenna.travelled - way.from).value(), (way.to - antenna.travelled).value(), ramp);
    }
    StretchPlace operator()(const StretchOfTime& time) const {
        StretchPlace place =
            place_along((antenna.elapsed - time.from).value(), (time.to - antenna.elapsed).value(), ramp);
        place.since *= antenna.speed.value();
        if (std::isfinite(place.left)) place.left *= antenna.speed.value();
        return place;
    }
    StretchPlace operator()(const StretchOfPlace& area) const {
        const Polygon polygon = polygon_around(antenna.place, area);
        const Point here(0, 0);
        if (!bg::covered_by(here, polygon)) return {};
        const double edge = bg::distance(here, edges_of(polygon));
        const auto back = antenna.heading ? std::optional(*antenna.heading + Angle::degrees(180)) : std::nullopt;
        return {weight_of(edge, edge, ramp), true, way_to_edge(polygon, back), way_to_edge(polygon, antenna.heading)};
    }
};

}  // namespace

StretchPlace place_in(const SurroundingsStretch& stretch, const Whereabouts& antenna) {
    return std::visit(PlaceFinder{antenna, stretch.ramp}, stretch.extent);
}

Result<StretchOfPlace> stretch_of_place(const std::vector<Geodetic>& corners) {
    if (corners.size() < 3)
        return fail(ErrorCode::input, fmt::format("has {} corners; expected at least three", corners.size()));
    StretchOfPlace place{corners};
    const Polygon polygon = polygon_around(corners.front(), place);
    Polygon around;
    bg::convex_hull(polygon, around);
    if (!(std::abs(bg::area(around)) > 0))
        return fail(ErrorCode::input, "has no area; expected corners of a polygon, around it");
    if (!bg::is_simple(edges_of(polygon)))
        return fail(ErrorCode::input, "has edges that cross; expected the corners in their order around the polygon");
    return place;
}

}  // namespace skyloop::inline world
