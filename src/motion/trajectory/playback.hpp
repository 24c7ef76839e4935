/// A recorded path as a run plays it: later, faster, from its middle, again and again.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/core/result.hpp"
#include "motion/trajectory/attitude_curve.hpp"
#include "motion/trajectory/trajectory.hpp"

namespace skyloop {

/// What happens after the last row.
enum class EndOfPath {
    hold,  ///< the vehicle stands there
    stop,  ///< the run ends
    loop   ///< the path begins anew
};

struct Playback {
    Seconds delay{0};       ///< the vehicle stands at the place where it begins for so long
    Seconds skip{0};        ///< so far into the track it begins
    double time_scale = 1;  ///< seconds of the track in one second of the run; speeds grow with it
    EndOfPath end = EndOfPath::hold;
    [[nodiscard]] bool alters() const {
        return delay.value() != 0 || skip.value() != 0 || time_scale != 1 || end == EndOfPath::loop;
    }
};

/// Plays a recorded path. At the time t after the start the track is at s = skip + (t − delay)·scale; its velocity and
/// turn rate are those of the track times scale. A loop goes on at the first row, whatever was skipped; where the last
/// row is near the first one, within 50 m and 5 s of the way at the mean of their speeds, and the first one lies ahead,
/// a curve of degree five closes it, in the shortest time in which it accelerates no more than its ends, or than 2
/// m/s²; rows within half a metre follow at once; else the path jumps.
class PlayedPath : public Trajectory {
public:
    /// @param path whose first row happens at `start`
    /// @param start when the delay begins
    PlayedPath(std::shared_ptr<const FilePath> path, GpsTime start, const Playback& playback);
    [[nodiscard]] TruthState at(GpsTime time) const override;

    [[nodiscard]] const FilePath& path() const { return *path_; }
    /// When the last row is reached for the first time.
    [[nodiscard]] GpsTime first_end() const { return run_time_of(path_->duration().value()); }
    /// When the path is first at a time of the track, s; before the start for what is skipped.
    [[nodiscard]] GpsTime run_time_of(double track_s) const;
    /// Of one round, in the run; nothing: it does not loop.
    [[nodiscard]] std::optional<Seconds> period() const;
    /// A loop whose end is far from its beginning.
    [[nodiscard]] bool jumps_back() const { return jumps_back_; }

private:
    void close();
    [[nodiscard]] TruthState on_closing(double s) const;

    std::shared_ptr<const FilePath> path_;
    GpsTime start_;
    Playback playback_;
    bool jumps_back_ = false;
    double closing_s_ = 0;                              // of the track; 0: no curve closes the loop
    Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();  // of the closing curve, ECEF, m
    Eigen::Matrix<double, 3, 6> closing_ = Eigen::Matrix<double, 3, 6>::Zero();  // powers of u, m
    AttitudeCurve closing_attitude_;
};

}  // namespace skyloop
