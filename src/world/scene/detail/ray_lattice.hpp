/// The directions in which a search sends its rays.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace skyloop::inline world {

/// An interval of the sine of elevation; below the horizon it is negative.
struct ElevationBand {
    double lowest = 0, highest = 0;
};

/// Makes bands ascending and disjoint.
void merge_bands(std::vector<ElevationBand>& bands);

/// A Fibonacci hemisphere: point i of N at height 1 − (i + ½)/N and azimuth i times the golden angle, each point with
/// the same solid angle (Swinbank, Purser 2006). Kept in rows of like elevation and, in a row, by azimuth, there and
/// back in turn: neighbours in the list point alike, which packets of rays gain from.
class RayLattice {
public:
    explicit RayLattice(int points);
    /// Mean distance of neighbours, rad.
    [[nodiscard]] double spacing() const { return spacing_; }
    /// Appends the directions within the bands, turned about the vertical; those below the horizon are the mirrored
    /// lattice's.
    ///
    /// @param bands ascending and disjoint
    /// @param turn share of a full turn
    void select(std::span<const ElevationBand> bands, double turn, std::vector<Eigen::Vector3d>& directions) const;

private:
    struct Row {
        std::size_t first = 0, last = 0;  ///< points [first, last)
        double lowest = 0, highest = 0;   ///< sines of elevation
    };
    void select_half(std::span<const ElevationBand> bands, double sign, const Eigen::Vector2d& turn,
                     std::vector<Eigen::Vector3d>& directions) const;

    std::vector<Eigen::Vector3d> points_;
    std::vector<Row> rows_;
    double spacing_ = 0;
};

}  // namespace skyloop::inline world
