/// The path of a vehicle that somebody else flies now.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string_view>

#include "skyloop/base/units.hpp"
#include "skyloop/trajectory/trajectory.hpp"
#include "skyloop/trajectory/truth_sample.hpp"

namespace skyloop {

/// What becomes of a path whose source is silent (FEEDS.md 3.1).
struct LivePathSettings {
    Geodetic before{};   ///< where the vehicle stands until the first sample
    Seconds delay{0};    ///< the path is this much late, so that slow sources are interpolated and not extrapolated
    Seconds coast{0.3};  ///< after the newest sample the vehicle goes on with its velocity and acceleration
    Seconds fade{1.5};   ///< until then it comes to rest
};

/// How fresh a path is.
enum class LiveState { silent, live, coasting, fading, holding };
/// "live"
std::string_view live_state_name(LiveState state);

/// What a path has seen.
struct LivePathCounts {
    std::uint64_t samples = 0;
    std::uint64_t late = 0;     ///< older than one before: left out
    std::uint64_t refused = 0;  ///< not finite, off the Earth, too fast
    std::uint64_t jumps = 0;    ///< resets: said by the source, or too far from where it was
    std::uint64_t coasts = 0;   ///< times that it was asked for beyond its newest sample by more than two of its steps
    std::uint64_t holds = 0;    ///< times that it came to rest for want of samples
};

/// Samples of the last seconds and the way through them: between two samples a quintic curve that keeps their
/// positions, velocities and accelerations; beyond the newest as LivePathSettings says. A sample that is far from where
/// the path was expected is a jump, which nothing leads across; a smaller difference after a silence is taken away
/// smoothly within 0.3 s.
///
/// State: the samples. Not for several threads; at() may be asked in any order within the last two seconds.
class LivePath : public Trajectory {
public:
    explicit LivePath(const LivePathSettings& settings);
    /// @param time of the sample in the run, SourceClock::stamp()
    void add(GpsTime time, const TruthSample& sample);
    [[nodiscard]] TruthState at(GpsTime time) const override;
    [[nodiscard]] LiveState state(GpsTime time) const;
    /// Of the newest sample; nothing before the first.
    [[nodiscard]] std::optional<GpsTime> newest() const;
    [[nodiscard]] const LivePathCounts& counts() const { return counts_; }

private:
    struct Knot;
    LivePathSettings settings_;
    std::deque<Knot> knots_;
    LivePathCounts counts_;
};

}  // namespace skyloop
