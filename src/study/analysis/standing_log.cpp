#include "study/analysis/standing_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/core/std_additions.hpp"
#include "base/time/utc_time.hpp"

namespace skyloop::inline study {
namespace {

// Metres east and north.
struct PlanPoint {
    double east = 0, north = 0;
    [[nodiscard]] double distance(const PlanPoint& other) const {
        return std::hypot(east - other.east, north - other.north);
    }
};

// The fixes of a span of time.
struct PlanSpan {
    std::vector<double> east, north;
    [[nodiscard]] PlanPoint middle() {  // changes their order
        return {middle_of(east), middle_of(north)};
    }
    [[nodiscard]] PlanPoint mean() const {
        PlanPoint sum;
        for (std::size_t i = 0; i < east.size(); ++i)
            sum.east += east[i], sum.north += north[i];
        const auto n = static_cast<double>(east.size());
        return {sum.east / n, sum.north / n};
    }
};

using PlanSpans = std::map<std::int64_t, PlanSpan>;  // by their number from the first fix on

PlanSpans spans_of(const PositionErrors& plan, const FixTimes& times, double length_s) {
    PlanSpans spans;
    for (std::size_t i = 0; i < times.at.size(); ++i) {
        PlanSpan& span = spans[static_cast<std::int64_t>((times.at[i] - times.at.front()) / length_s)];
        span.east.push_back(plan.east[i]);
        span.north.push_back(plan.north[i]);
    }
    return spans;
}

// When a fix was made, for people: UTC where the log has a date.
std::string time_of_fix(const FixSeries& series, std::size_t index) {
    std::size_t fixes = 0;
    for (const FixSample& sample : series.samples)
        if (sample.has_fix && fixes++ == index && series.dated && sample.time) return utc_text(*sample.time);
    return fmt::format("fix {}", index + 1);
}

Result<void> check_times(const FixSeries& series, const FixTimes& times, const StandingLimits& limits) {
    const double longest = std::max(limits.longest_gap.value(), 3 * times.step);
    for (std::size_t i = 1; i < times.at.size(); ++i) {
        const double step = times.at[i] - times.at[i - 1];
        if (step < 0)
            return fail(ErrorCode::input, fmt::format("{}: time goes back by {:.1f} s after {}; expected a log in the "
                                                      "order of time",
                                                      series.name, -step, time_of_fix(series, i - 1)));
        if (step > longest)
            return fail(ErrorCode::input,
                        fmt::format("{}: has no fix for {:.1f} s after {}; expected gaps of at most {:g} s, or a part "
                                    "of it without, by --skip and --count",
                                    series.name, step, time_of_fix(series, i - 1), longest));
    }
    return {};
}

// One that goes elsewhere.
Result<void> check_place(const FixSeries& series, const PositionErrors& plan, const FixTimes& times,
                         const StandingLimits& limits) {
    constexpr double minute_s = 60;
    std::map<std::int64_t, PlanPoint> minutes;
    PlanSpan all;
    PlanSpans spans = spans_of(plan, times, minute_s);
    for (auto& [number, minute] : spans) {
        const PlanPoint middle = minutes[number] = minute.middle();
        all.east.push_back(middle.east);
        all.north.push_back(middle.north);
    }
    const PlanPoint centre = all.middle();
    for (const auto& [number, middle] : minutes)
        if (const double away = middle.distance(centre); away > limits.farthest_minute.value())
            return fail(ErrorCode::input,
                        fmt::format("{}: moves: in minute {} it is {:.0f} m from the middle of all; expected a "
                                    "receiver at rest, whose minutes lie within {:g} m of it",
                                    series.name, number + 1, away, limits.farthest_minute.value()));
    return {};
}

// One that goes round its middle.
Result<void> check_steps(const FixSeries& series, const PositionErrors& plan, const FixTimes& times,
                         const StandingLimits& limits) {
    constexpr double span_s = 10;
    std::size_t steps = 0, longer = 0;
    const PlanSpans spans = spans_of(plan, times, span_s);
    for (auto span = spans.begin(); span != spans.end(); ++span) {
        const auto next = spans.find(span->first + 1);
        if (next == spans.end()) continue;
        ++steps;
        if (span->second.mean().distance(next->second.mean()) > limits.longest_step.value()) ++longer;
    }
    const double share = steps > 0 ? static_cast<double>(longer) / static_cast<double>(steps) : 0;
    if (share <= limits.most_of_longer_steps) return {};
    return fail(ErrorCode::input,
                fmt::format("{}: moves: in {:.0f} % of its time it goes more than {:g} m in 10 s; "
                            "expected a receiver at rest, of which at most {:g} % do",
                            series.name, 100 * share, limits.longest_step.value(), 100 * limits.most_of_longer_steps));
}

// Of one that held its position only the rounding of coordinates is left.
Result<void> check_errors(const FixSeries& series, const SampleStatistics& horizontal) {
    constexpr double least_m = 0.001;
    if (horizontal.std >= least_m) return {};
    return fail(ErrorCode::input,
                fmt::format("{}: all fixes are at one place; expected a receiver that does not hold its position at "
                            "rest, so that there are errors to be fitted to",
                            series.name));
}

Geodetic place_of(const FixSeries& series, const PositionErrors& errors) {
    if (errors.point) return *errors.point;
    const auto first = std::find_if(series.samples.begin(), series.samples.end(),
                                    [](const FixSample& sample) { return sample.has_fix; });
    return *first->truth;
}

std::optional<GpsTime> time_of_first(const FixSeries& series) {
    if (!series.dated) return std::nullopt;
    const auto first = std::find_if(series.samples.begin(), series.samples.end(),
                                    [](const FixSample& sample) { return sample.has_fix; });
    return first == series.samples.end() ? std::nullopt : first->time;
}

}  // namespace

FixSeries dated_from(FixSeries series, GpsTime start) {
    if (series.dated || !series.interval) return series;
    const FixTimes times = fix_times(series);
    std::size_t fix = 0;
    for (FixSample& sample : series.samples) {
        sample.time.reset();
        if (sample.has_fix) sample.time = advanced(start, Seconds(times.at[fix++] - times.at.front()));
    }
    series.dated = true;
    return series;
}

Result<StandingLog> standing_log(FixSeries series, const std::optional<Geodetic>& reference,
                                 const StandingLimits& limits) {
    if (!series.interval)
        return fail(ErrorCode::input, fmt::format("{}: has no times; expected a log that has some, or --interval with "
                                                  "the seconds between its fixes",
                                                  series.name));
    const FixTimes times = fix_times(series);
    const double length = times.at.empty() ? 0 : times.at.back() - times.at.front() + times.step;
    if (const auto checked = check_times(series, times, limits); !checked) return fail(checked.error());
    if (times.at.size() < 2 || length < limits.shortest.value())
        return fail(ErrorCode::input,
                    fmt::format("{}: is {:.0f} s long, of {} fixes; expected {:g} s or more, since errors wander for "
                                "minutes",
                                series.name, length, times.at.size(), limits.shortest.value()));
    const PositionErrors plan = position_errors(without_truth(series));
    if (const auto checked = check_place(series, plan, times, limits); !checked) return fail(checked.error());
    if (const auto checked = check_steps(series, plan, times, limits); !checked) return fail(checked.error());
    PositionErrors errors = position_errors(series, reference);
    const SampleStatistics horizontal = sample_statistics(errors.horizontal).value_or(SampleStatistics{});
    if (const auto checked = check_errors(series, horizontal); !checked) return fail(checked.error());
    const Geodetic place = place_of(series, errors);
    const auto start = time_of_first(series);
    return StandingLog{std::move(series), std::move(errors), horizontal, place, start, Seconds(length)};
}

}  // namespace skyloop::inline study
