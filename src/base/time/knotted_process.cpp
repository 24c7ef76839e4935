#include "base/time/knotted_process.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop::inline base {
namespace {

constexpr double knots_of_memory = 10;
constexpr std::int64_t knots_of_block = 32, most_missed = 256;
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
      normals_(stream),
      step_(gauss_markov_step(parameters, to_seconds(spacing_))) {}

KnottedProcess KnottedProcess::walk(double per_root_second, Nanoseconds spacing, RandomStream stream) {
    KnottedProcess process({per_root_second, Seconds(0)}, spacing, stream);
    process.walk_ = true;
    process.step_ = {1, per_root_second * std::sqrt(to_seconds(spacing).value())};
    return process;
}

void KnottedProcess::set_correlation_time(Seconds time) {
    if (time == parameters_.correlation_time) return;
    parameters_.correlation_time = time;
    step_ = gauss_markov_step(parameters_, to_seconds(spacing_));
}

// The value at a knot, so many steps after the newest; only a walk takes more than one.
void KnottedProcess::draw(std::int64_t steps, std::int64_t knot) {
    newest_ = step_.phi * newest_ + step_.noise * std::sqrt(static_cast<double>(steps)) * normals_.at(knot);
    std::rotate(values_.begin(), values_.begin() + 1, values_.end());
    values_.back() = newest_;
}

void KnottedProcess::start(std::int64_t knot) {
    std::int64_t first = knot - 1;
    if (!walk_) first -= ((first % knots_of_block) + knots_of_block) % knots_of_block;
    newest_ = walk_ ? 0 : parameters_.sigma * normals_.at(first);
    values_.back() = newest_;
    while (first < knot + 2)
        draw(1, ++first);
    knot_ = knot;
    started_ = true;
}

void KnottedProcess::move_to(std::int64_t knot) {
    const std::int64_t missed = started_ ? knot - knot_ - 4 : 0;
    if (!started_ || (missed > most_missed && !walk_)) {
        start(knot);
    } else if (missed > 0 && walk_) {  // of a long absence only the end is drawn: all four knots anew
        knot_ += missed + 1;
        draw(missed + 1, knot_ + 2);
    }
    for (; knot_ < knot; ++knot_)
        draw(1, knot_ + 3);
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

}  // namespace skyloop::inline base
