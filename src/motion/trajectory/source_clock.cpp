#include "motion/trajectory/source_clock.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace skyloop::inline motion {
namespace {

constexpr std::int64_t clock_second_ns = 1'000'000'000;
constexpr std::int64_t clock_window_ns = 5 * clock_second_ns;
constexpr std::int64_t clock_bucket_ns = clock_second_ns / 10;
constexpr std::int64_t clock_recent_ns = clock_second_ns / 2;                   // a step is believed after so long
constexpr std::int64_t slope_window_ns = 2 * clock_second_ns;                   // over less, the scatter hides the rate
constexpr std::int64_t clock_youth_ns = slope_window_ns + 4 * clock_bucket_ns;  // so long the edge is used as it is
constexpr std::int64_t longest_source_ns = 4'000'000'000 * clock_second_ns;
constexpr std::int64_t farthest_source_ns = 1'000'000'000 * clock_second_ns;
constexpr std::int64_t restart_back_ns = clock_second_ns, restart_forward_ns = 60 * clock_second_ns;
constexpr double clock_slew = 0.002, clock_step_ns = 250e6;  // FEEDS.md 3.2
constexpr double least_slope = -0.5, most_slope = 1.0;       // of offsets, for rates of 2 to 0.5

struct HullPoint {
    double x = 0, y = 0;
};

// The edge of the lower convex hull above the middle of the points: of all lines that no point lies below, the one
// nearest to them all together.
std::pair<HullPoint, HullPoint> lower_edge(std::vector<HullPoint> points) {
    std::sort(points.begin(), points.end(),
              [](const HullPoint& a, const HullPoint& b) { return a.x < b.x || (a.x == b.x && a.y > b.y); });
    std::vector<HullPoint> hull;
    double mean = 0;
    for (const HullPoint& point : points) {
        mean += point.x / static_cast<double>(points.size());
        while (hull.size() >= 2) {
            const HullPoint &a = hull[hull.size() - 2], &b = hull.back();
            if ((b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x) > 0) break;
            hull.pop_back();
        }
        hull.push_back(point);
    }
    std::size_t right = 1;
    while (right + 1 < hull.size() && hull[right].x < mean)
        ++right;
    return hull.size() < 2 ? std::pair(hull[0], hull[0]) : std::pair(hull[right - 1], hull[right]);
}

}  // namespace

SourceClock::SourceClock(ClockMode mode, GpsTime start, std::int64_t start_steady_ns)
    : mode_(mode), start_(start), start_ns_(start_steady_ns), first_time_(start) {}

GpsTime SourceClock::at_steady(std::int64_t steady_ns) const {
    // Farther than a century from the start there is nothing; it also keeps the sum in its type.
    constexpr std::int64_t farthest_ns = 3'000'000'000 * clock_second_ns;
    return start_ + Nanoseconds(std::clamp(steady_ns - start_ns_, -farthest_ns, farthest_ns));
}

SourceClock::Stamp SourceClock::stamp(std::optional<Nanoseconds> source_time, std::int64_t received_ns,
                                      std::optional<Nanoseconds> own_step) {
    if (!source_time || source_time->count() > longest_source_ns || source_time->count() < -longest_source_ns)
        return stamp_arrival(received_ns, own_step);
    const std::int64_t source_ns = source_time->count();
    Stamp stamp;
    stamp.restarted = restarts(source_ns, received_ns);
    const bool leapt = leaps_ahead({source_ns, received_ns});
    if (leapt) forget_way(received_ns);
    if (!first_source_ns_) begin_source(source_ns, received_ns);
    if (!base_ns_) base_ns_ = received_ns - source_ns;
    if (!newest_source_ns_ || source_ns > *newest_source_ns_) {
        newest_source_ns_ = source_ns;
        newest_received_ns_ = received_ns;
    }
    remember({source_ns, received_ns});
    stamp.stepped = (follow_edge({source_ns, received_ns}) || leapt) && !stamp.restarted;
    stamp.time = *run_time(Nanoseconds(source_ns));
    return stamp;
}

// The first time that it tells goes on where arrivals have brought the run.
void SourceClock::begin_source(std::int64_t source_ns, std::int64_t received_ns) {
    first_source_ns_ = source_ns;
    if (!first_arrival_ns_) return;
    const std::int64_t since = std::clamp<std::int64_t>(received_ns - *first_arrival_ns_, 0, farthest_source_ns);
    first_time_ = std::max(untimed_.value_or(first_time_), first_time_ + Nanoseconds(since));
}

bool SourceClock::restarts(std::int64_t source_ns, std::int64_t received_ns) {
    if (!newest_source_ns_) {
        first_received_ns_ = received_ns;
        return false;
    }
    const bool back = source_ns < *newest_source_ns_ - restart_back_ns;
    // In lock-step a long way is what was asked for, and is gone as fast as the machine can.
    const bool leap = mode_ == ClockMode::follow && source_ns > *newest_source_ns_ + restart_forward_ns;
    if (!back && !leap) return false;
    first_time_ = *run_time(Nanoseconds(*newest_source_ns_));
    first_source_ns_ = source_ns;
    newest_source_ns_.reset();
    forget_way(received_ns);
    return true;
}

// Delays are never negative: what is earlier than the way in use by more than a step is of a clock that has leapt
// ahead, and nothing in the window is of it. While no rate is known, a source that hurries is early, too, by as much as
// has passed at most.
bool SourceClock::leaps_ahead(Seen seen) const {
    if (mode_ != ClockMode::realtime || !used_) return false;
    const std::int64_t hurried_ns = rate_known_ ? 0 : std::max<std::int64_t>(0, seen.received_ns - used_received_ns_);
    return used_->offset(seen.source_ns) - offset_of(seen) > clock_step_ns + static_cast<double>(hurried_ns);
}

// What is said next is the first that is known of the way.
void SourceClock::forget_way(std::int64_t received_ns) {
    window_.clear();
    base_ns_.reset();
    edge_.reset();
    used_.reset();
    rate_known_ = false;
    held_slope_ = 0;
    first_received_ns_ = received_ns;
}

// A step ahead that is slewed to. A line through what was before and after it would take it for a rate. Farther below
// the edge than the others scatter above it lies nothing else; of a few, though, nobody knows the scatter.
bool SourceClock::slips_ahead(Seen seen) const {
    constexpr std::size_t enough = 8;
    constexpr double least_ns = 50e6, scatters = 3;
    if (mode_ != ClockMode::realtime || !rate_known_ || window_.size() < enough) return false;
    const double below_ns = edge_->offset(seen.source_ns) - offset_of(seen);
    if (below_ns < least_ns) return false;
    double above_ns = 0;
    for (const Seen& other : window_)
        above_ns += offset_of(other) - edge_->offset(other.source_ns);
    return below_ns * static_cast<double>(window_.size()) > scatters * above_ns;
}

// A bucket is finished when the next one begins; then the edge is found anew.
void SourceClock::remember(Seen seen) {
    if (slips_ahead(seen)) {
        held_slope_ = edge_->slope;
        rate_known_ = false;
        window_.clear();
    }
    const bool same =
        !window_.empty() && window_.back().received_ns / clock_bucket_ns == seen.received_ns / clock_bucket_ns;
    if (same) {
        if (offset_of(seen) <= offset_of(window_.back())) window_.back() = seen;
        return;
    }
    while (!window_.empty() && window_.front().received_ns < seen.received_ns - clock_window_ns)
        window_.pop_front();
    if (!window_.empty()) fit();
    if (has_stepped(seen.received_ns)) {
        while (window_.front().received_ns < seen.received_ns - clock_recent_ns)
            window_.pop_front();
        held_slope_ = 0;
        fit();
        first_received_ns_ = seen.received_ns;  // young again
    }
    window_.push_back(seen);
}

void SourceClock::fit() {
    const Seen origin = window_.back();
    std::vector<HullPoint> points;
    for (const Seen& seen : window_)
        points.push_back({static_cast<double>(seen.source_ns - origin.source_ns), offset_of(seen)});
    const auto [left, right] = lower_edge(std::move(points));
    const bool long_enough = window_.back().received_ns - window_.front().received_ns >= slope_window_ns;
    Line line;
    line.at_source_ns = origin.source_ns + std::llround(right.x);
    line.offset_ns = right.y;
    line.slope = held_slope_;
    rate_known_ = long_enough && right.x > left.x;
    if (rate_known_) line.slope = std::clamp((right.y - left.y) / (right.x - left.x), least_slope, most_slope);
    if (!long_enough)  // no rate of its own yet: the shortest way counts
        for (const Seen& seen : window_)
            line.offset_ns = std::min(
                line.offset_ns, offset_of(seen) - line.slope * static_cast<double>(seen.source_ns - line.at_source_ns));
    edge_ = line;
}

// Everything that came in the last half second was later than the edge by more than a step, and evenly so: the source
// has paused, or its clock has leapt back a little. Waiting until the window forgets would leave the path behind for
// seconds. Delays that grow are a slow source, which the edge learns.
bool SourceClock::has_stepped(std::int64_t now_ns) const {
    constexpr int enough = 3;
    constexpr double even_ns = 100e6;
    if (!used_) return false;
    int late = 0;
    double least = 0, most = 0;
    for (auto seen = window_.rbegin(); seen != window_.rend() && seen->received_ns >= now_ns - clock_recent_ns;
         ++seen) {
        const double delay = offset_of(*seen) - used_->offset(seen->source_ns);
        if (delay < clock_step_ns) return false;
        least = late == 0 ? delay : std::min(least, delay);
        most = late == 0 ? delay : std::max(most, delay);
        ++late;
    }
    return late >= enough && most - least < even_ns;
}

double SourceClock::offset_of(Seen seen) const {
    return static_cast<double>(seen.received_ns - seen.source_ns - *base_ns_);
}

// Moves the way in use towards the edge. True when it stepped.
bool SourceClock::follow_edge(Seen seen) {
    const double offset = offset_of(seen);
    const double target = std::min(offset, edge_ ? edge_->offset(seen.source_ns) : offset);
    const bool young = seen.received_ns - first_received_ns_ < clock_youth_ns;
    if (!used_ || seen.source_ns < used_->at_source_ns) {
        // A statement that was overtaken tells at most that the way is shorter.
        if (!used_) used_ = Line{seen.source_ns, target, 0};
        used_received_ns_ = std::max(used_received_ns_, seen.received_ns);
        return false;
    }
    const double slope = edge_ ? edge_->slope : 0;
    const auto passed = static_cast<double>(seen.source_ns - used_->at_source_ns);
    Line next{seen.source_ns, used_->offset_ns + slope * passed, slope};
    const double error = target - next.offset_ns;
    const bool step = std::abs(error) > clock_step_ns;
    const double most =
        clock_slew * static_cast<double>(std::max<std::int64_t>(0, seen.received_ns - used_received_ns_));
    next.offset_ns = step || young ? target : next.offset_ns + std::clamp(error, -most, most);
    used_ = next;
    used_received_ns_ = seen.received_ns;
    return step;
}

// Follow and lock-step: the first statement is the start. Where a source mixes both, one without a time stands as far
// behind the newest that had one as it came later, at the source's own rate.
SourceClock::Stamp SourceClock::stamp_arrival(std::int64_t received_ns, std::optional<Nanoseconds> own_step) {
    Stamp stamp;
    if (mode_ == ClockMode::realtime) {
        stamp.time = at_steady(rhythm_.evened(received_ns, own_step));
    } else if (newest_source_ns_) {
        constexpr double longest_ns = 1e15, most_rate = 100;
        const double since = std::clamp(static_cast<double>(received_ns - newest_received_ns_), 0.0, longest_ns);
        const double rate_now = std::clamp(rate().value_or(1), 0.0, most_rate);
        stamp.time = *run_time(Nanoseconds(*newest_source_ns_ + std::llround(since * rate_now)));
    } else {
        const std::int64_t evened_ns = rhythm_.evened(received_ns, own_step);
        if (!first_arrival_ns_) first_arrival_ns_ = evened_ns;
        untimed_ = std::max(untimed_.value_or(first_time_), first_time_ + Nanoseconds(evened_ns - *first_arrival_ns_));
        stamp.time = *untimed_;
    }
    return stamp;
}

std::optional<GpsTime> SourceClock::run_time(Nanoseconds source_time) const {
    const std::int64_t source_ns = std::clamp(source_time.count(), -longest_source_ns, longest_source_ns);
    if (mode_ == ClockMode::realtime) {
        if (!used_) return std::nullopt;
        const double offset = std::clamp(used_->offset(source_ns), -1e18, 1e18);
        // Times far from all that was heard would leave the type.
        const std::int64_t base = std::clamp(source_ns - *newest_source_ns_, -farthest_source_ns, farthest_source_ns) +
                                  *newest_source_ns_ + *base_ns_;
        return at_steady(base + std::llround(offset));
    }
    if (!first_source_ns_) return std::nullopt;
    return first_time_ + Nanoseconds(std::clamp(source_ns - *first_source_ns_, -longest_source_ns, longest_source_ns));
}

void SourceClock::set_run(GpsTime now, std::int64_t steady_ns) {
    start_ = now;
    start_ns_ = steady_ns;
}

std::optional<double> SourceClock::rate() const {
    if (window_.empty()) return std::nullopt;
    // Late statements may stand behind it.
    const auto newest =
        std::max_element(window_.begin(), window_.end(), [](Seen a, Seen b) { return a.source_ns < b.source_ns; });
    const auto received = static_cast<double>(newest->received_ns - window_.front().received_ns);
    if (received < static_cast<double>(clock_bucket_ns)) return std::nullopt;
    if (mode_ == ClockMode::realtime && edge_ && received > static_cast<double>(slope_window_ns) &&
        edge_->slope > least_slope && edge_->slope < most_slope)
        return 1 / (1 + edge_->slope);
    return static_cast<double>(newest->source_ns - window_.front().source_ns) / received;
}

}  // namespace skyloop::inline motion
