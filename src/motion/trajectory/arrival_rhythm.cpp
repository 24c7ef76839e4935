#include "motion/trajectory/source_clock.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/core/std_additions.hpp"

namespace skyloop::inline motion {
namespace {

constexpr std::size_t least_arrivals = 16, most_arrivals = 64, learn_every = 4;
constexpr double rhythm_gain = 0.05;   // FEEDS.md 3.2
constexpr double relock_periods = 10;  // FEEDS.md 3.2 has 3, which a fifth of loss makes it do each second or two
constexpr double begin_gain = 0.2;     // while only the vehicle's own steps are known
constexpr double most_slew = 0.1;      // periods: a better rhythm is gone over to, not stepped to
constexpr double lost_gain = 0.01, seldom_lost = 0.015, delay_bias = 0.25;
constexpr double longest_own_ns = 2e9, least_own_mps = 1;

struct LineFit {
    double slope = 0, at_zero = 0, rms = 0;
};

LineFit line_through(const std::vector<double>& x, const std::vector<double>& y) {
    const auto n = static_cast<double>(x.size());
    double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0, sum_rr = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        sum_x += x[i], sum_y += y[i], sum_xx += x[i] * x[i], sum_xy += x[i] * y[i];
    LineFit fit;
    fit.slope = (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
    fit.at_zero = (sum_y - fit.slope * sum_x) / n;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double rest = y[i] - fit.at_zero - fit.slope * x[i];
        sum_rr += rest * rest;
    }
    fit.rms = std::sqrt(sum_rr / n);
    return fit;
}

// The numbers of arrivals on a grid, the last one's zero, each at least one below the next.
std::vector<double> numbers_on(const LineFit& grid, const std::vector<double>& arrivals) {
    std::vector<double> numbers(arrivals.size());
    double next = 1;
    for (std::size_t i = arrivals.size(); i-- > 0;)
        next = numbers[i] = std::min(next - 1, std::round((arrivals[i] - grid.at_zero) / grid.slope));
    const double last = numbers.back();
    for (double& number : numbers)
        number -= last;
    return numbers;
}

std::vector<double> consecutive(std::size_t count) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < count; ++i)
        numbers.push_back(static_cast<double>(i) - static_cast<double>(count - 1));
    return numbers;
}

}  // namespace

std::optional<Nanoseconds> own_step(const TruthSample& before, const TruthSample& now) {
    if (!before.velocity || !now.velocity || now.jump) return std::nullopt;
    const Eigen::Vector3d velocity = (before.velocity->vector() + now.velocity->vector()) / 2;
    const double speed = velocity.norm();
    if (!(speed > least_own_mps)) return std::nullopt;
    const double step_ns = (now.position - before.position).vector().dot(velocity) / (speed * speed) * 1e9;
    if (!(step_ns > 0 && step_ns < longest_own_ns)) return std::nullopt;
    return Nanoseconds(std::llround(step_ns));
}

std::int64_t ArrivalRhythm::evened(std::int64_t received_ns, std::optional<Nanoseconds> step) {
    const Arrival arrival{received_ns, step ? static_cast<double>(step->count()) : 0};
    const auto since = static_cast<double>(received_ns - evened_ns_);
    if (period_ns_ <= 0 || std::abs(since) > relock_periods * period_ns_) return begin(arrival);
    const double periods = periods_since(arrival);
    lost_part_ += lost_gain * ((periods > 1 ? 1 : 0) - lost_part_);
    if (arrival.own_ns > 0 && own_period_ns_ > 0)
        own_period_ns_ += rhythm_gain * (arrival.own_ns / periods - own_period_ns_);
    const double residual = since - periods * period_ns_;
    evened_ns_ += std::llround(periods * period_ns_ + rhythm_gain * residual);
    if (arrivals_.size() < most_arrivals) {
        arrivals_.push_back(arrival);
        if (arrivals_.size() % learn_every == 0) learn();
    } else {
        period_ns_ += rhythm_gain * rhythm_gain / 4 * residual / periods;
    }
    return evened_ns_;
}

double ArrivalRhythm::periods_since(const Arrival& arrival) const {
    constexpr double farthest = 1.5;  // beyond, the vehicle's own step is not believed: it was set elsewhere
    const double by_arrival = static_cast<double>(arrival.received_ns - evened_ns_) / period_ns_;
    if (arrival.own_ns > 0 && own_period_ns_ > 0) {
        const double by_way = std::round(arrival.own_ns / own_period_ns_);
        if (by_way >= 1 && std::abs(by_way - by_arrival) < farthest) return by_way;
    }
    // Where hardly anything is lost, a long delay is the likelier one.
    const double bias = lost_part_ > seldom_lost ? 0 : delay_bias;
    return std::max(1.0, std::round(by_arrival - bias));
}

// No rhythm yet: the arrival as it is, or the vehicle's own step where it tells one.
std::int64_t ArrivalRhythm::begin(Arrival arrival) {
    if (period_ns_ > 0) arrivals_.clear();
    period_ns_ = own_period_ns_ = 0;
    const bool first = arrivals_.empty();
    arrivals_.push_back(arrival);
    const auto since = static_cast<double>(arrival.received_ns - evened_ns_);
    if (!first && arrival.own_ns > 0 && std::abs(since - arrival.own_ns) < arrival.own_ns)
        evened_ns_ += std::llround(arrival.own_ns + begin_gain * (since - arrival.own_ns));
    else
        evened_ns_ = arrival.received_ns;
    if (arrivals_.size() >= most_arrivals) arrivals_.pop_front();
    if (arrivals_.size() >= least_arrivals) learn();
    return evened_ns_;
}

void ArrivalRhythm::learn() {
    auto grid = told_grid();
    if (!grid) grid = likeliest_grid();
    if (!grid || !(grid->period_ns > 0)) return;
    period_ns_ = grid->period_ns;
    const auto behind = static_cast<double>(arrivals_.back().received_ns - evened_ns_) + grid->at_last_ns;
    const double most = most_slew * period_ns_;
    evened_ns_ += std::llround(std::clamp(behind, -most, most));
}

// By the steps that the vehicle tells itself.
std::optional<ArrivalRhythm::Grid> ArrivalRhythm::told_grid() {
    std::vector<double> own;
    for (std::size_t i = 1; i < arrivals_.size(); ++i)
        own.push_back(arrivals_[i].own_ns);
    std::vector<double> sorted = own;
    own_period_ns_ = middle_of(sorted);
    if (!(own_period_ns_ > 0)) return std::nullopt;
    std::vector<double> numbers{0}, times{0};
    for (std::size_t i = 0; i < own.size(); ++i) {
        const double periods = std::round(own[i] / own_period_ns_);
        if (periods < 1 || periods > relock_periods) return std::nullopt;
        numbers.push_back(numbers.back() + periods);
        times.push_back(static_cast<double>(arrivals_[i + 1].received_ns - arrivals_[0].received_ns));
    }
    const LineFit fit = line_through(numbers, times);
    return Grid{fit.slope, fit.at_zero + fit.slope * numbers.back() - times.back()};
}

// Each count of lost statements gives a grid. The scatter about it, measured in its periods, and the count say how
// likely it is: finer grids lie near to any arrivals, so that each lost statement must pay for itself.
std::optional<ArrivalRhythm::Grid> ArrivalRhythm::likeliest_grid() const {
    constexpr int rounds = 4;
    constexpr double cost_of_loss = 2.3, least_scatter = 0.01;  // a tenth of them lost
    std::vector<double> times;
    for (const Arrival& arrival : arrivals_)
        times.push_back(static_cast<double>(arrival.received_ns - arrivals_.back().received_ns));
    const auto count = static_cast<double>(times.size());
    std::optional<Grid> best;
    double best_cost = 0;
    for (std::size_t lost = 0; lost <= times.size() / 2; ++lost) {
        LineFit fit;
        fit.slope = -times.front() / (count - 1 + static_cast<double>(lost));
        std::vector<double> numbers;
        for (int round = 0; round < rounds && fit.slope > 0; ++round) {
            numbers = lost > 0 ? numbers_on(fit, times) : consecutive(times.size());
            fit = line_through(numbers, times);
        }
        if (!(fit.slope > 0)) continue;
        const double gaps = -numbers.front() - (count - 1);
        const double cost = count * std::log(std::max(fit.rms / fit.slope, least_scatter)) + cost_of_loss * gaps;
        if (best && cost >= best_cost) continue;
        best = Grid{fit.slope, fit.at_zero};
        best_cost = cost;
    }
    return best;
}

}  // namespace skyloop::inline motion
