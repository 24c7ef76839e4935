/// Paths that a few numbers describe.
#pragma once

#include <vector>

#include "base/core/result.hpp"
#include "motion/trajectory/trajectory.hpp"

namespace skyloop::inline motion {

/// Stands still.
class FixedPoint : public Trajectory {
public:
    explicit FixedPoint(const Geodetic& place);
    [[nodiscard]] TruthState at(GpsTime time) const override;

private:
    Geodetic place_;
    Position<Ecef> ecef_;
};

/// A corner of a Waypoints path.
struct Waypoint {
    Geodetic place;
    MetresPerSecond speed{10};  ///< along the ellipsoid, from here to the next waypoint
    Seconds hold;               ///< time spent here before leaving
};

/// Along geodesics from corner to corner at constant speed, height changing evenly; then stands at the last.
class Waypoints : public Trajectory {
public:
    /// @param start when the path leaves its first corner (after its hold)
    /// @param corners at least two, each with a positive speed
    Waypoints(GpsTime start, std::vector<Waypoint> corners);
    [[nodiscard]] TruthState at(GpsTime time) const override;
    /// From the start until the last corner is reached.
    [[nodiscard]] Seconds duration() const;

private:
    struct Leg {
        Waypoint from;
        Geodetic to;
        Angle azimuth;
        double length = 0;   ///< over ground, m
        double departs = 0;  ///< s after the start
        double arrives = 0;  ///< s after the start
    };
    GpsTime start_;
    std::vector<Leg> legs_;
    Geodetic last_;
};

/// Round a centre at constant height and speed.
class Circle : public Trajectory {
public:
    struct Shape {
        Geodetic centre;
        Metres radius{100};
        MetresPerSecond speed{10};  ///< positive: clockwise seen from above
        Angle start_azimuth;        ///< from the centre, where the path begins
    };
    Circle(GpsTime start, const Shape& shape) : start_(start), shape_(shape) {}
    [[nodiscard]] TruthState at(GpsTime time) const override;

private:
    GpsTime start_;
    Shape shape_;
};

}  // namespace skyloop::inline motion
