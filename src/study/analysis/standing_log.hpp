/// A log of a receiver that stood still: what a sensor model can be fitted to.
#pragma once

#include <optional>

#include "base/core/result.hpp"
#include "study/analysis/fix_series.hpp"
#include "study/analysis/statistics.hpp"

namespace skyloop::inline study {

/// What is asked of one. The limits are ours, held to records: of two receivers under trees, 7 h each, the minutes lie
/// up to 36 m from the middle and 0.6 % of the steps of 10 s are longer than 10 m; of a car's 64 % are.
struct StandingLimits {
    Seconds shortest{600};               ///< errors wander for minutes
    Seconds longest_gap{10};             ///< between fixes; at least three intervals
    Metres farthest_minute{50};          ///< from the middle of all, medians
    Metres longest_step{10};             ///< between the means of two times 10 s
    double most_of_longer_steps = 0.05;  ///< share
};

/// The log and the horizontal error in it.
struct StandingLog {
    FixSeries series;
    PositionErrors errors;
    SampleStatistics horizontal;   ///< of the radial error, metres
    Geodetic place;                ///< of the antenna: by the file, by the reference, or the mean of the fixes
    std::optional<GpsTime> start;  ///< of the first fix; nothing: the log tells no date
    Seconds length;                ///< from the first fix to one interval after the last
};

/// A series whose log tells no date, with times for its fixes: the first was made at `start`, the others as long after
/// it as the log or its interval says. One that is dated, or has no interval, stays as it is.
FixSeries dated_from(FixSeries series, GpsTime start);

/// Takes a series for one. Fails with `input` and one sentence where it is none: it has no times, time goes back in it,
/// it is too short, has a gap or moves, or its receiver held its position, so that there is no error.
/// @param reference where the antenna is, for a file that does not know
Result<StandingLog> standing_log(FixSeries series, const std::optional<Geodetic>& reference = std::nullopt,
                                 const StandingLimits& limits = {});

}  // namespace skyloop::inline study
