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

double longitude_from(const Geodetic& origin, const Geodetic& place) {
    return std::remainder(place.longitude.rad() - origin.longitude.rad(), 2 * std::numbers::pi);
}

Polygon::ring_type ring_around(const Geodetic& place, const EarthPolygon::Ring& corners) {
    constexpr double radius = 6371000;
    Polygon::ring_type ring;
    for (const Geodetic& corner : corners)
        ring.emplace_back(radius * std::cos(place.latitude.rad()) * longitude_from(place, corner),
                          radius * (corner.latitude.rad() - place.latitude.rad()));
    return ring;
}

// On the plane that touches the Earth at a place, m east and north.
Polygon polygon_around(const Geodetic& place, const EarthPolygon& area) {
    Polygon polygon;
    polygon.outer() = ring_around(place, area.outer());
    for (const EarthPolygon::Ring& hole : area.holes())
        polygon.inners().push_back(ring_around(place, hole));
    bg::correct(polygon);
    return polygon;
}

Line line_of(const Polygon::ring_type& ring) { return {ring.begin(), ring.end()}; }

bg::model::multi_linestring<Line> edges_of(const Polygon& polygon) {
    bg::model::multi_linestring<Line> edges{line_of(polygon.outer())};
    for (const auto& hole : polygon.inners())
        edges.push_back(line_of(hole));
    return edges;
}

double weight_of(double since, double left, double ramp) {
    const double nearer = std::min(since, left);
    if (nearer < 0) return 0;
    return ramp > 0 ? std::min(nearer / ramp, 1.0) : 1;
}

// From the origin straight on until the polygon ends; where there is no heading, to its nearest edge.
double way_to_edge(const Polygon& polygon, std::optional<Angle> heading) {
    const Point here(0, 0);
    const auto edges = edges_of(polygon);
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
        StretchPlace place;
        for (const EarthPolygon& polygon : area.polygons)
            if (polygon.may_hold(antenna.place))
                if (const StretchPlace one = within(polygon); one.inside && one.weight >= place.weight) place = one;
        return place;
    }

private:
    [[nodiscard]] StretchPlace within(const EarthPolygon& area) const {
        const Polygon polygon = polygon_around(antenna.place, area);
        const Point here(0, 0);
        if (!bg::covered_by(here, polygon)) return {};
        const double edge = bg::distance(here, edges_of(polygon));
        const auto back = antenna.heading ? std::optional(*antenna.heading + Angle::degrees(180)) : std::nullopt;
        return {weight_of(edge, edge, ramp), true, way_to_edge(polygon, back), way_to_edge(polygon, antenna.heading)};
    }
};

}  // namespace

EarthPolygon::EarthPolygon(Ring outer, std::vector<Ring> holes) : outer_(std::move(outer)), holes_(std::move(holes)) {
    if (outer_.empty()) return;
    south_ = north_ = outer_.front().latitude;
    for (const Geodetic& corner : outer_) {
        const Angle longitude = Angle::radians(longitude_from(outer_.front(), corner));
        south_ = std::min(south_, corner.latitude);
        north_ = std::max(north_, corner.latitude);
        west_ = std::min(west_, longitude);
        east_ = std::max(east_, longitude);
    }
}

bool EarthPolygon::may_hold(const Geodetic& place) const {
    if (outer_.empty() || place.latitude < south_ || place.latitude > north_) return false;
    const Angle longitude = Angle::radians(longitude_from(outer_.front(), place));
    return longitude >= west_ && longitude <= east_;
}

StretchPlace place_in(const SurroundingsStretch& stretch, const Whereabouts& antenna) {
    return std::visit(PlaceFinder{antenna, stretch.ramp}, stretch.extent);
}

Result<void> check_polygon(const EarthPolygon& area) {
    const EarthPolygon::Ring& corners = area.outer();
    if (corners.size() < 3)
        return fail(ErrorCode::input, fmt::format("has {} corners; expected at least three", corners.size()));
    const Polygon polygon = polygon_around(corners.front(), area);
    Polygon around;
    bg::convex_hull(polygon, around);
    if (!(std::abs(bg::area(around)) > 0))
        return fail(ErrorCode::input, "has no area; expected corners of a polygon, around it");
    if (!bg::is_simple(line_of(polygon.outer())))
        return fail(ErrorCode::input, "has edges that cross; expected the corners in their order around the polygon");
    return {};
}

}  // namespace skyloop::inline world
