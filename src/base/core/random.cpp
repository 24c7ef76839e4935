#include "base/core/random.hpp"

#include <bit>
#include <cmath>
#include <numbers>

#include "base/core/bytes.hpp"

namespace skyloop::inline base {
namespace {

// SplitMix64 (Steele, Lea and Flood, 2014): spreads a seed over the whole state.
std::uint64_t split_mix(std::uint64_t& x) {
    x += 0x9e3779b97f4a7c15u;
    std::uint64_t z = x;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) {
    std::uint64_t x = seed;
    x = split_mix(x) ^ fnv1a_64(name);
    for (std::uint64_t& word : state_)
        word = split_mix(x);
}

std::uint64_t RandomStream::bits() {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
}

double RandomStream::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

double RandomStream::normal() {
    if (spare_normal_) {
        const double value = *spare_normal_;
        spare_normal_.reset();
        return value;
    }
    for (;;) {
        const double u = 2 * uniform() - 1;
        const double v = 2 * uniform() - 1;
        const double s = u * u + v * v;
        if (s >= 1 || s == 0) continue;
        const double factor = std::sqrt(-2 * std::log(s) / s);
        spare_normal_ = v * factor;
        return u * factor;
    }
}

double IndexedNormals::at(std::int64_t index) const {
    std::uint64_t x = key_ ^ (static_cast<std::uint64_t>(index) * 0xd1342543de82ef95u);
    const double u = static_cast<double>((split_mix(x) >> 11) + 1) * 0x1p-53;  // (0, 1]
    const double v = static_cast<double>(split_mix(x) >> 11) * 0x1p-53;
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

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

}  // namespace skyloop::inline base
