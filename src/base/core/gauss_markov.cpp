#include "base/core/gauss_markov.hpp"

#include <cmath>

namespace skyloop {

GaussMarkovStep gauss_markov_step(const GaussMarkovParameters& parameters, Seconds dt) {
    const double tau = parameters.correlation_time.value();
    if (dt.value() <= 0) return {1, 0};
    if (tau <= 0) return {0, parameters.sigma};
    const double x = dt.value() / tau;
    // 1 − φ² by expm1: a direct difference would lose its digits over short steps.
    return {std::exp(-x), parameters.sigma * std::sqrt(-std::expm1(-2 * x))};
}

GaussMarkov::GaussMarkov(GaussMarkovParameters parameters, RandomStream stream)
    : parameters_(parameters), stream_(stream), value_(parameters.sigma * stream_.normal()) {}

double GaussMarkov::advance(Seconds dt) {
    if (dt.value() <= 0) return value_;
    const GaussMarkovStep step = gauss_markov_step(parameters_, dt);
    value_ = step.phi * value_ + step.noise * stream_.normal();
    return value_;
}

}  // namespace skyloop
