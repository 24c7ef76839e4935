/// A recorded path that can be asked at any time.
/// A recorded path as a run plays it: later, faster, from its middle, again and again.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "motion/trajectory/path_attitude.hpp"
#include "motion/trajectory/track.hpp"
#include "motion/trajectory/trajectory.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop::inline motion {

/// How a curve is led through a track.
struct CurveSettings {
    std::optional<VehicleClass> vehicle{};  ///< stands by its motion where the rows tell no attitude; nothing: it is
                                            ///< not told how it stands
    std::optional<Angle> heading{};         ///< until it first moves; nothing: where it first goes
    Smoothing smoothing = Smoothing::none;
};

/// Where the attitude of a path comes from.
enum class AttitudeSource { none, rows, motion };
/// "not told", "of the rows", "from the motion".
std::string_view attitude_source_name(AttitudeSource source);

/// What became of the rows of a track.
struct CurveReport {
    std::size_t stretches = 1;  ///< between which the path jumps
    std::size_t rows_with_velocity = 0;
    std::size_t rows_with_attitude = 0;
    std::size_t cubic_pieces = 0;    ///< whose acceleration steps, because a smooth one would swing out
    std::size_t contradictions = 0;  ///< steps whose velocities do not fit their places, by more than 1 m/s and a fifth
    AttitudeSource attitude = AttitudeSource::none;
    SmoothingReport smoothing{};
};

/// The curve through the rows of a clean track: quintic Hermite pieces, so that position, velocity and acceleration are
/// continuous and the rows' own positions and velocities are kept (FEEDS.md 1.13.2 and 1.13.3), unless they are to be
/// smoothed first. Where a piece would swing out, it is a cubic one, whose acceleration steps at its ends. Long gaps
/// are crossed on a straight line at the height between their ends, after a smooth change of velocity. Nothing leads to
/// a row that is a jump: until then the path stands at the row before.
///
/// Attitudes of the rows are led through by an AttitudeCurve when there are two or more; otherwise they follow from the
/// motion of a vehicle class that was named. at() is pure and takes logarithmic time.
class RecordedPath : public FilePath {
public:
    /// @param track after clean_track(): two rows or more, ascending
    /// @param gaps what clean_track() gave
    /// @param start when the first row happens
    RecordedPath(const Track& track, std::span<const TrackGap> gaps, GpsTime start, const CurveSettings& settings = {});
    /// Before the first row it stands there, after the last one it stands there.
    [[nodiscard]] TruthState at(GpsTime time) const override;
    /// From the first row to the last.
    [[nodiscard]] Seconds duration() const override { return Seconds(pieces_.back().begins + pieces_.back().length); }
    /// ECEF, m/s²: the derivative of at()'s velocity; 0 before and after.
    [[nodiscard]] Eigen::Vector3d acceleration(GpsTime time) const override;
    [[nodiscard]] const CurveReport& report() const { return report_; }
    /// Pieces whose acceleration steps.
    [[nodiscard]] std::size_t cubic_pieces() const { return report_.cubic_pieces; }
    /// Pieces whose rows' velocities do not fit their positions, by more than 1 m/s and a fifth of the speed.
    [[nodiscard]] std::size_t contradictions() const { return report_.contradictions; }

private:
    struct Piece {
        double begins = 0, length = 0;             // s after the start
        Eigen::Vector3d anchor;                    // position at its beginning, ECEF
        Eigen::Matrix<double, 3, 6> coefficients;  // of powers of u = (t − begins) / length, m
        // Of its way, what the velocities that the rows tell do not make: their places are rounded. The place takes it
        // smoothly, and velocity and acceleration know nothing of it.
        Eigen::Vector3d rounding = Eigen::Vector3d::Zero();
        bool cubic = false;  // a curve of the third degree, else of the fifth
        // After the time; order 1 or 2.
        [[nodiscard]] Eigen::Vector3d derivative(double u, int order) const;
    };
    // Where a piece is asked, and u there.
    struct Place {
        const Piece* piece;
        double u;
        bool inside;  // of the time from the first row to the last
    };
    struct Builder;

    [[nodiscard]] Place place_at(double t) const;
    void stand_by_motion(std::span<const double> stretch_begins, const CurveSettings& settings);

    GpsTime start_;
    std::vector<Piece> pieces_;
    AttitudeCurve attitude_;
    CurveReport report_;
};

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

}  // namespace skyloop::inline motion
