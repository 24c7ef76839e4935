/// The path of a vehicle that somebody else flies now.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "base/core/units.hpp"
#include "motion/trajectory/trajectory.hpp"

namespace skyloop::inline motion {

/// What becomes of a path whose source is silent (FEEDS.md 3.1).
struct LivePathSettings {
    Geodetic before{};  ///< where the vehicle stands until the first sample
    /// Nobody named `before`: once there is a sample, the vehicle stands where the first one is up to its time.
    bool begins_at_first = false;
    Seconds delay{0};  ///< the path is this much late, so that slow sources are interpolated and not extrapolated
    /// After the newest sample the vehicle goes on with its velocity, while its acceleration and turn rate fade.
    Seconds coast{0.3};
    Seconds fade{1.5};  ///< until then it comes to rest
};

/// How fresh a path is.
enum class LiveState { silent, live, coasting, fading, holding };

/// What a path has seen.
struct LivePathCounts {
    std::uint64_t samples = 0;
    std::uint64_t late = 0;     ///< older than one before: left out
    std::uint64_t refused = 0;  ///< not finite, off the Earth, too fast
    std::uint64_t jumps = 0;    ///< resets: said by the source, or too far from where it was
    std::uint64_t coasts = 0;   ///< times that it was asked for beyond its newest sample by more than two of its steps
    std::uint64_t holds = 0;    ///< times that it came to rest for want of samples
};

/// Why a sample says nothing that a vehicle does, FEEDS.md 3.1: a number and what was expected; nothing: it may be so.
std::optional<std::string> implausible(const TruthSample& sample);

/// Samples of the last seconds and the way through them: between two samples a quintic curve that keeps their
/// positions, velocities and accelerations, and of samples that tell their velocity the velocities between those, which
/// places rounded to centimetres do not bend; beyond the newest as LivePathSettings says, where a source whose samples
/// are far apart is given one and a half of its steps. What a sample does not tell of its velocity and acceleration is
/// estimated from the ones before it; an attitude that it does not tell is the one before it, turned on by the turn
/// rate, which fades. A sample that is far from where the path was expected (FEEDS.md 3.1: more than 2 m and than half
/// of its speed times the silence) is a jump, which nothing leads across; a smaller difference from what was shown is
/// taken away smoothly: within 0.3 s after a silence, else within two steps.
///
/// State: the samples of five seconds, at most 8192, and what was asked for beyond the newest. Not for several threads;
/// at() may be asked in any order within the last two seconds, and its latest time counts as shown.
class LivePath : public Trajectory {
public:
    /// Accelerations and turn rates from here on are no vehicle's: they are estimated, as if they had not been told.
    static constexpr double hardest_mps2 = 1000, fastest_turn_radps = 200;

    explicit LivePath(const LivePathSettings& settings);
    /// @param time of the sample in the run, SourceClock::stamp()
    void add(GpsTime time, const TruthSample& sample);
    [[nodiscard]] TruthState at(GpsTime time) const override;
    [[nodiscard]] LiveState state(GpsTime time) const;
    /// Of the newest sample; nothing before the first.
    [[nodiscard]] std::optional<GpsTime> newest() const;
    /// When the vehicle comes to rest, unless another sample comes; nothing before the first.
    [[nodiscard]] std::optional<GpsTime> rests_at() const;
    [[nodiscard]] const LivePathCounts& counts() const { return counts_; }

    /// A state of motion; ECEF, m and s.
    struct Motion {
        Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity = position, acceleration = position;
        std::optional<Eigen::Quaterniond> body_to_ned{};
        Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();  ///< body axes, rad/s
    };
    /// How long a path goes on without samples, s.
    struct Patience {
        double live = 0;         ///< as if there were samples
        double coast = 0;        ///< with the velocity it had
        double fade = 0;         ///< until it has come to rest
        double fading_time = 0;  ///< in which acceleration and turn rate fall to 1/e
    };

private:
    // A sample, completed.
    struct Knot {
        GpsTime time;
        std::optional<Nanoseconds> source_time{};
        Motion motion{};
        bool own_velocity = false, own_attitude = false;  // the source told it
        bool begins = false;                              // nothing leads from the knot before to this one
    };
    // The path went on from the sample at `knot` alone, and was asked for until `until`. From there what it then
    // differed from the path through the samples is taken away.
    struct Shown {
        GpsTime knot, until;
        Motion from{};  // at `knot`
        Patience patience{};
        Motion shown{};  // at `until`
        Motion difference{};
        Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
        double length = 0;  // s of taking away; zero: at once
    };

    [[nodiscard]] Knot completed(GpsTime time, const TruthSample& sample) const;
    void complete_attitude(Knot& knot, const TruthSample& sample) const;
    [[nodiscard]] Eigen::Vector3d told_turn_rate(const Knot& newest) const;
    [[nodiscard]] Eigen::Vector3d estimated(const Eigen::Vector3d Motion::*member, const Knot& newest) const;
    [[nodiscard]] bool is_jump(const Knot& knot) const;
    [[nodiscard]] Patience patience() const;
    [[nodiscard]] Motion through_samples(GpsTime time) const;
    [[nodiscard]] Motion shown_at(GpsTime time) const;
    void remember_shown(const Knot& next);
    void measure(Shown& shown) const;
    void learn_step(double step_s);
    void forget();
    void look_at_age(double age_s) const;

    LivePathSettings settings_;
    std::deque<Knot> knots_;
    std::deque<Shown> shown_;
    bool forgot_ = false;                          // there were samples before the first of knots_
    double step_s_ = 0;                            // usual distance of samples; zero: not known yet
    mutable std::optional<GpsTime> asked_;         // latest since the newest sample came
    mutable std::optional<GpsTime> latest_;        // that was ever asked for
    mutable bool coasts_ = false, holds_ = false;  // then
    mutable LivePathCounts counts_;
};

}  // namespace skyloop::inline motion
