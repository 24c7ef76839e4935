/// Cartesian positions, displacements and velocities that know their frame.
#pragma once

#include <Eigen/Core>

#include "base/core/units.hpp"

namespace skyloop::inline base {

/// Earth-centred, Earth-fixed, WGS-84; metres.
struct Ecef {};
/// East, north, up of a LocalFrame; metres.
struct Enu {};

/// A vector of metres between two points of `Frame`.
template <class Frame>
class Displacement {
public:
    Displacement() = default;
    explicit Displacement(const Eigen::Vector3d& metres) : vector_(metres) {}
    Displacement(double x, double y, double z) : vector_(x, y, z) {}
    [[nodiscard]] const Eigen::Vector3d& vector() const { return vector_; }
    [[nodiscard]] Metres length() const { return Metres(vector_.norm()); }
    friend Displacement operator+(const Displacement& a, const Displacement& b) {
        return Displacement(a.vector_ + b.vector_);
    }
    friend Displacement operator-(const Displacement& a, const Displacement& b) {
        return Displacement(a.vector_ - b.vector_);
    }
    friend Displacement operator*(const Displacement& a, double factor) { return Displacement(a.vector_ * factor); }

private:
    Eigen::Vector3d vector_ = Eigen::Vector3d::Zero();
};

/// A point of `Frame`, metres. Points subtract to a displacement; two points do not add.
template <class Frame>
class Position {
public:
    Position() = default;
    explicit Position(const Eigen::Vector3d& metres) : vector_(metres) {}
    Position(double x, double y, double z) : vector_(x, y, z) {}
    [[nodiscard]] const Eigen::Vector3d& vector() const { return vector_; }
    friend Position operator+(const Position& p, const Displacement<Frame>& d) {
        return Position(p.vector_ + d.vector());
    }
    friend Displacement<Frame> operator-(const Position& a, const Position& b) {
        return Displacement<Frame>(a.vector_ - b.vector_);
    }

private:
    Eigen::Vector3d vector_ = Eigen::Vector3d::Zero();
};

/// A velocity seen in `Frame`, metres per second.
template <class Frame>
class Velocity {
public:
    Velocity() = default;
    explicit Velocity(const Eigen::Vector3d& metres_per_second) : vector_(metres_per_second) {}
    Velocity(double x, double y, double z) : vector_(x, y, z) {}
    [[nodiscard]] const Eigen::Vector3d& vector() const { return vector_; }
    [[nodiscard]] MetresPerSecond length() const { return MetresPerSecond(vector_.norm()); }

private:
    Eigen::Vector3d vector_ = Eigen::Vector3d::Zero();
};

}  // namespace skyloop::inline base
