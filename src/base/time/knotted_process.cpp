#include "base/time/knotted_process.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop::inline base {
namespace {

constexpr double knots_of_memory = 10;
constexpr double memories_of_span = 40;  // e^−40 is nothing beside 1 in 53 bits
constexpr std::int64_t most_knots_of_span = std::int64_t{1} << 40, most_missed = 256;
constexpr Nanoseconds closest_knots = std::chrono::milliseconds(1);

Nanoseconds spacing_within(Nanoseconds most, Seconds correlation_time) {
    if (!(correlation_time.value() > 0)) return most;
    const double parts = std::ceil(knots_of_memory * to_seconds(most).value() / correlation_time.value() - 1e-9);
    return std::max(most / static_cast<std::int64_t>(std::clamp(parts, 1.0, 1e6)), closest_knots);
}

}  // namespace

KnottedProcess::KnottedProcess(GaussMarkovParameters parameters, Nanoseconds spacing, RandomStream stream)
    : parameters_(parameters), spacing_(spacing_within(spacing, parameters.correlation_time)), normals_(stream) {}

void KnottedProcess::set_correlation_time(Seconds time) {
    if (time == parameters_.correlation_time) return;
    parameters_.correlation_time = time;
    step_ = gauss_markov_step(parameters_, to_seconds(spacing_));
    retuned_ = true;
    spans_.clear();
}

// In the middle of a span: the mean of what is known on both sides, and what is open yet.
double KnottedProcess::between(const Span& span) const {
    const double half = static_cast<double>(span.knots / 2) * to_seconds(spacing_).value();
    const GaussMarkovStep step = gauss_markov_step(parameters_, Seconds(half));
    const double known = 1 + step.phi * step.phi;
    return (span.first + span.last) * (step.phi / known) +
           step.noise / std::sqrt(known) * normals_.at(span.from + span.knots / 2);
}

double KnottedProcess::at_knot(std::int64_t knot) {
    while (!spans_.empty() && !spans_.back().holds(knot))
        spans_.pop_back();
    if (spans_.empty()) {
        std::int64_t knots = 1;
        const double memory = memories_of_span * parameters_.correlation_time.value() / to_seconds(spacing_).value();
        while (static_cast<double>(knots) < memory && knots < most_knots_of_span)
            knots *= 2;
        const std::int64_t from = knot - ((knot % knots) + knots) % knots;
        spans_.push_back(
            {from, knots, parameters_.sigma * normals_.at(from), parameters_.sigma * normals_.at(from + knots)});
    }
    while (spans_.back().from != knot) {
        const Span span = spans_.back();
        const std::int64_t half = span.knots / 2, middle = span.from + half;
        const double there = between(span);
        spans_.push_back(knot < middle ? Span{span.from, half, span.first, there}
                                       : Span{middle, half, there, span.last});
    }
    return spans_.back().first;
}

void KnottedProcess::draw(std::int64_t knot) {
    const double newest = values_.back();
    std::rotate(values_.begin(), values_.begin() + 1, values_.end());
    if (!retuned_) {
        values_.back() = at_knot(knot);
        return;
    }
    values_.back() = step_.phi * newest + step_.noise * normals_.at(knot);
}

void KnottedProcess::start(std::int64_t knot) {
    for (std::size_t i = 0; i < values_.size(); ++i)
        values_[i] = at_knot(knot - 1 + static_cast<std::int64_t>(i));
    knot_ = knot;
    started_ = true;
}

void KnottedProcess::move_to(std::int64_t knot) {
    if (!started_ || knot - knot_ > (retuned_ ? most_missed : 4)) start(knot);
    for (; knot_ < knot; ++knot_)
        draw(knot_ + 3);
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
