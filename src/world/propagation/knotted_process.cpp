#include "world/propagation/knotted_process.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop::inline world {
namespace {

constexpr double knots_of_memory = 10;
constexpr Nanoseconds closest_knots = std::chrono::milliseconds(1);

Nanoseconds spacing_within(Nanoseconds most, Seconds correlation_time) {
    if (!(correlation_time.value() > 0)) return most;
    const double parts = std::ceil(knots_of_memory * to_seconds(most).value() / correlation_time.value() - 1e-9);
    return std::max(most / static_cast<std::int64_t>(std::clamp(parts, 1.0, 1e6)), closest_knots);
}

}  // namespace

KnottedProcess::KnottedProcess(GaussMarkovParameters parameters, Nanoseconds spacing, RandomStream stream)
    : parameters_(parameters),
      spacing_(spacing_within(spacing, parameters.correlation_time)),
      stream_(stream),
      step_(gauss_markov_step(parameters, to_seconds(spacing_))) {}

KnottedProcess KnottedProcess::walk(double per_root_second, Nanoseconds spacing, RandomStream stream) {
    KnottedProcess process({per_root_second, Seconds(0)}, spacing, stream);
    process.walk_ = true;
    process.step_ = {1, per_root_second * std::sqrt(to_seconds(spacing).value())};
    return process;
}

void KnottedProcess::draw(std::int64_t steps) {
    GaussMarkovStep step = step_;
    if (steps > 1) {
        const double count = static_cast<double>(steps);
        step = walk_ ? GaussMarkovStep{1, step_.noise * std::sqrt(count)}
                     : gauss_markov_step(parameters_, to_seconds(spacing_) * count);
    }
    newest_ = step.phi * newest_ + step.noise * stream_.normal();
    std::rotate(values_.begin(), values_.begin() + 1, values_.end());
    values_.back() = newest_;
}

void KnottedProcess::move_to(std::int64_t knot) {
    if (!started_) {
        newest_ = walk_ ? 0 : parameters_.sigma * stream_.normal();
        values_.back() = newest_;
        for (int i = 0; i < 3; ++i)
            draw(1);
        started_ = true;
    } else {
        // Of a long absence only the end is drawn: all four knots anew.
        const std::int64_t missed = knot - knot_ - 4;
        if (missed > 0) {
            draw(missed + 1);
            knot_ += missed + 1;
        }
        for (; knot_ < knot; ++knot_)
            draw(1);
    }
    knot_ = knot;
}

double KnottedProcess::at(GpsTime time) {
    const std::int64_t since = time.time_since_epoch().count(), spacing = spacing_.count();
    const std::int64_t knot = since / spacing - (since % spacing < 0 ? 1 : 0);
    if (!started_ || knot > knot_) move_to(knot);
    const double u = static_cast<double>(since - knot_ * spacing) / static_cast<double>(spacing);
    const auto& [before, from, to, after] = values_;
    const double slope_from = (to - before) / 2, slope_to = (after - from) / 2;
    const double c2 = 3 * (to - from) - 2 * slope_from - slope_to;
    const double c3 = 2 * (from - to) + slope_from + slope_to;
    rate_ = (slope_from + u * (2 * c2 + u * 3 * c3)) / to_seconds(spacing_).value();
    return from + u * (slope_from + u * (c2 + u * c3));
}

}  // namespace skyloop::inline world
