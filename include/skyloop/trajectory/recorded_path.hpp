/// A recorded path that can be asked at any time.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "skyloop/trajectory/track.hpp"
#include "skyloop/trajectory/trajectory.hpp"

namespace skyloop {

/// The curve through the rows of a clean track: quintic Hermite pieces, so that position, velocity and acceleration are
/// continuous and the rows' own positions and velocities are kept (FEEDS.md 1.13.2 and 1.13.3). Where a piece would
/// swing out, it is a cubic one, whose acceleration steps at its ends. Long gaps are crossed on a straight line at the
/// height between their ends, after a smooth change of velocity. at() is pure and takes logarithmic time.
class RecordedPath : public Trajectory {
public:
    /// @param track after clean_track(): two rows or more, ascending
    /// @param gaps what clean_track() gave
    /// @param start when the first row happens
    RecordedPath(const Track& track, std::span<const TrackGap> gaps, GpsTime start);
    /// Before the first row it stands there, after the last one it stands there.
    [[nodiscard]] TruthState at(GpsTime time) const override;
    /// From the first row to the last.
    [[nodiscard]] Seconds duration() const { return Seconds(pieces_.back().begins + pieces_.back().length); }
    /// Pieces whose acceleration steps.
    [[nodiscard]] std::size_t cubic_pieces() const { return cubic_; }
    /// Pieces whose rows' velocities do not fit their positions, by more than 1 m/s and a fifth of the speed.
    [[nodiscard]] std::size_t contradictions() const { return contradictions_; }

    /// A point that the curve goes through; seconds, metres.
    struct Knot {
        double time = 0;
        Eigen::Vector3d position, velocity, acceleration;
        bool has_velocity = false;
    };

private:
    struct Piece {
        double begins = 0, length = 0;             // s after the start
        Eigen::Vector3d anchor;                    // position at its beginning, ECEF
        Eigen::Matrix<double, 3, 6> coefficients;  // of powers of u = (t − begins) / length, m
    };
    void add_piece(const Knot& from, const Knot& to);

    GpsTime start_;
    std::vector<Piece> pieces_;
    std::size_t cubic_ = 0, contradictions_ = 0;
};

}  // namespace skyloop
