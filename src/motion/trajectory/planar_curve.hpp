/// Curves in a plane, by the length along them.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace skyloop::inline motion {

/// A point of a curve; m, rad, 1/m.
struct CurvePoint {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< east, north
    double heading = 0;                                  ///< of the curve, clockwise from north
    double curvature = 0;                                ///< change of heading per metre: positive to the right
};

/// A curve whose curvature is continuous, so that what runs along it has no step in its acceleration.
class PlanarCurve {
public:
    virtual ~PlanarCurve() = default;
    /// @param way m from its beginning; a closed curve goes on with its next lap
    [[nodiscard]] virtual CurvePoint at(double way) const = 0;
    /// Of one lap where it is closed, m.
    [[nodiscard]] virtual double length() const = 0;
};

/// Straights, arcs and the clothoids between them: pieces whose curvature changes evenly. Positions are integrals by
/// Gauss and Legendre over less than 0.2 rad of turn, exact to the last digits.
class ClothoidCurve : public PlanarCurve {
public:
    explicit ClothoidCurve(const CurvePoint& beginning) : end_(beginning) {}
    /// Adds a piece from the curvature as it is. @param length m
    void run(double length, double to_curvature);
    /// From here on the curve repeats itself. It has come back to its beginning, curvature and heading included.
    void close() { closed_ = true; }
    /// After the last piece.
    [[nodiscard]] const CurvePoint& end() const { return end_; }

    [[nodiscard]] CurvePoint at(double way) const override;
    [[nodiscard]] double length() const override { return length_; }

private:
    struct Piece {
        double begins;
        CurvePoint from;
        double sharpness;  // change of curvature per metre
    };
    std::vector<Piece> pieces_;
    CurvePoint end_;
    double length_ = 0;
    bool closed_ = false;
};

/// How a vehicle turns: the curvature grows evenly, stays, and shrinks again (FEEDS.md 2.2).
struct TurnShape {
    double angle = 0;   ///< of the whole turn, rad, positive to the right; less than 2π
    double radius = 0;  ///< smallest, m
    double ramp = 0;    ///< length over which the curvature grows to 1 / radius, m
};
/// A turn that is too small for its radius stays wider.
void add_turn(ClothoidCurve& curve, const TurnShape& turn);
/// m
double turn_length(const TurnShape& turn);
/// How far before the corner of two straights the turn between them begins, m; the angle is less than π.
double tangent_length(const TurnShape& turn);

/// A circle, beginning at an azimuth from its centre.
class CircleCurve : public PlanarCurve {
public:
    struct Shape {
        Eigen::Vector2d centre = Eigen::Vector2d::Zero();
        double radius = 100;
        double start_azimuth = 0;  ///< rad
        bool anticlockwise = false;
    };
    explicit CircleCurve(const Shape& shape) : shape_(shape) {}
    [[nodiscard]] CurvePoint at(double way) const override;
    [[nodiscard]] double length() const override;

private:
    Shape shape_;
};

/// Bernoulli's lemniscate, beginning at its crossing (FEEDS.md 2.3): x = a cos τ / (1 + sin² τ), y = x sin τ.
class LemniscateCurve : public PlanarCurve {
public:
    struct Shape {
        Eigen::Vector2d centre = Eigen::Vector2d::Zero();
        double half_length = 100;  ///< a, from the crossing to the far end of a loop, m
        double heading = 0;        ///< of its long axis, clockwise from north, rad
    };
    explicit LemniscateCurve(const Shape& shape);
    [[nodiscard]] CurvePoint at(double way) const override;
    [[nodiscard]] double length() const override { return ways_.back(); }

private:
    Shape shape_;
    std::vector<double> ways_;  // at even steps of τ
};

}  // namespace skyloop::inline motion
