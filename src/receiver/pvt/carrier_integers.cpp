#include <Eigen/Cholesky>

#include <algorithm>

#include "detail/carrier_state.hpp"
#include "detail/square.hpp"
#include "receiver/pvt/integer_search.hpp"

namespace skyloop::inline receiver {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t least_pairs = 4;
constexpr double hope_within_m = 15e3;

double variance_of_phase(const SingleDifference& d) { return d.phase_variance + d.echo_variance; }

}  // namespace

std::vector<AmbiguityPair> CarrierFilter::State::pairs(double most_variance, Seconds tracked) const {
    std::vector<AmbiguityPair> pairs;
    for (const auto& [name, group] : groups_) {
        std::optional<Index> reference;
        for (const SingleDifference* d : group) {
            const Tracked& t = tracked_.at(ambiguity_of(*d));
            if (!d->whole || d->elevation < p_.integers_from || variance_of_phase(*d) > most_variance ||
                difference(*time_, t.since) < tracked)
                continue;
            const Index at = state_.index(ambiguity_of(*d));
            if (reference)
                pairs.push_back({at, *reference});
            else
                reference = at;
        }
    }
    return pairs;
}

// By how much ambiguities are not whole: the covariance of their echoes, cycles².
MatrixXd CarrierFilter::State::echoes(const std::vector<AmbiguityPair>& pairs) const {
    const auto echo = [&](Index at) { return tracked_.at(state_.names()[static_cast<std::size_t>(at)]).echo_variance; };
    const auto count = static_cast<Index>(pairs.size());
    MatrixXd covariance = MatrixXd::Zero(count, count);
    for (Index i = 0; i < count; ++i) {
        const AmbiguityPair& one = pairs[static_cast<std::size_t>(i)];
        for (Index j = 0; j < count; ++j)
            if (pairs[static_cast<std::size_t>(j)].reference == one.reference) covariance(i, j) = echo(one.reference);
        covariance(i, i) += echo(one.at);
    }
    return covariance;
}

std::optional<FixedOffset> CarrierFilter::State::fix(const std::vector<AmbiguityPair>& pairs) {
    const auto count = static_cast<Index>(pairs.size());
    const MatrixXd& p = state_.covariance;
    VectorXd floats(count);
    MatrixXd differenced(count, state_.size());
    for (Index i = 0; i < count; ++i) {
        const AmbiguityPair& pair = pairs[static_cast<std::size_t>(i)];
        floats(i) = state_.values(pair.at) - state_.values(pair.reference);
        differenced.row(i) = p.row(pair.at) - p.row(pair.reference);
    }
    MatrixXd covariance = echoes(pairs);
    for (Index i = 0; i < count; ++i) {
        const AmbiguityPair& pair = pairs[static_cast<std::size_t>(i)];
        covariance.col(i) += differenced.col(pair.at) - differenced.col(pair.reference);
    }
    const auto found = search_integers(floats, covariance);
    if (!found || found->success < p_.least_success || found->gap() < p_.least_gap) return std::nullopt;
    const Eigen::LDLT<MatrixXd> weights(covariance);
    const MatrixXd of_place = differenced.leftCols<3>();
    FixedOffset fixed;
    fixed.offset = state_.values.head<3>() - of_place.transpose() * weights.solve(floats - found->best);
    fixed.covariance =
        std::max(excess_, found->misfit()) * (p.topLeftCorner<3, 3>() - of_place.transpose() * weights.solve(of_place));
    if (fixed.covariance.trace() > square(p_.most_when_fixed.value())) return std::nullopt;
    fixed.ratio = found->ratio();
    fixed.ambiguities = static_cast<int>(count);
    if (!fixed_since_) fixed_since_ = time_;
    if (difference(*time_, *fixed_since_) >= p_.hold_after) hold(pairs, found->best);
    return fixed;
}

// An echo that lasts is the same in every epoch: whole numbers say something new about it by and by.
void CarrierFilter::State::hold(const std::vector<AmbiguityPair>& pairs, const VectorXd& whole) {
    constexpr double held_to_cycles = 0.03;
    MatrixXd design = MatrixXd::Zero(whole.size(), state_.size());
    for (Index i = 0; i < whole.size(); ++i) {
        design(i, pairs[static_cast<std::size_t>(i)].at) = 1;
        design(i, pairs[static_cast<std::size_t>(i)].reference) = -1;
    }
    const double repeated = std::max(1.0, 2 * p_.phase_memory.value() / std::max(passed_.value(), 1e-3));
    state_.absorb(design, whole - design * state_.values,
                  repeated * echoes(pairs) + square(held_to_cycles) * MatrixXd::Identity(whole.size(), whole.size()));
}

// The largest variance of a phase among so many of the best ones.
double CarrierFilter::State::variance_of_best(double share) const {
    std::vector<double> variances;
    for (const SingleDifference& d : present_)
        variances.push_back(variance_of_phase(d));
    const auto at = variances.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(variances.size() - 1));
    std::nth_element(variances.begin(), at, variances.end());
    return *at;
}

// All of them, then those that have been tracked for a while, then ever better ones.
std::optional<FixedOffset> CarrierFilter::State::fix() {
    struct Part {
        double share;
        Seconds tracked;
    };
    const Seconds settled = p_.settled_after, later = 3 * settled;
    std::size_t last = 0;
    for (const Part part : {Part{1, settled}, {0.8, settled}, {1, later}, {0.8, later}, {0.6, later}, {0.4, later}}) {
        const std::vector<AmbiguityPair> chosen = pairs(variance_of_best(part.share), part.tracked);
        if (chosen.size() < least_pairs || chosen.size() == last) continue;
        last = chosen.size();
        if (auto fixed = fix(chosen)) {
            unfixed_since_.reset();
            hope_ = hope_lasts;
            return fixed;
        }
    }
    fixed_since_.reset();
    if (!unfixed_since_) unfixed_since_ = time_;
    hopeless_ = length_m_ < hope_within_m && difference(*time_, *unfixed_since_) >= hope_;
    return std::nullopt;
}

}  // namespace skyloop::inline receiver
