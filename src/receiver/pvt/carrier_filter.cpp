#include "receiver/pvt/carrier_filter.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <set>

#include "detail/carrier_state.hpp"
#include "detail/square.hpp"

namespace skyloop::inline receiver {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = StateName::Kind;

// Before anything is known: a base that tells a wrong place moves the solution by as much, and ambiguities begin with
// what their codes say. Larger ones cost digits, which the whole numbers need.
constexpr double place_deviation_m = 1000, ambiguity_deviation_m = 20;
constexpr std::size_t least_satellites = 4;
// A phase that fits neither by its deviation nor by a part of a cycle has lost its count.
constexpr double misfit_deviations = 5, misfit_m = 0.05;
constexpr Seconds longest_step{3};           // of epochs of a signal that was not missed
constexpr double most_misfit_of_codes = 25;  // of their variances

// What fits worse than its variance expects makes a solution that is worse by as much.
void follow(double& excess, double misfit, Seconds passed) {
    constexpr double averaged_over_s = 20, most = 25;
    excess += -std::expm1(-passed.value() / averaged_over_s) * (std::clamp(misfit, 1.0, most) - excess);
}

}  // namespace

double CarrierFilter::State::variance_of(const StateName& name, const Spacing& spacing) const {
    // What a reference whose place is told wrong by some 100 m leaves goes into the ionosphere's part.
    constexpr double least = 1e-4, least_ionosphere = 5e-3;  // m
    switch (name.kind) {
        case Kind::wet:
            return square(least + std::min(p_.wet_per_length * spacing.length_m, p_.wet_most.value()) +
                          p_.wet_per_height * std::abs(spacing.height_m));
        case Kind::ionosphere:
            return square(least_ionosphere +
                          std::min(p_.ionosphere_per_length * spacing.length_m, p_.ionosphere_most.value()));
        default:
            return square(place_deviation_m);
    }
}

// Ambiguities of signals that are missed for a while are kept.
void CarrierFilter::State::arrange(std::span<const SingleDifference> differences, const Spacing& spacing,
                                   GpsTime time) {
    std::erase_if(tracked_, [&](const auto& one) { return difference(time, one.second.seen) > p_.memory; });
    std::set<StateName> wanted{{Kind::place_x}, {Kind::place_y}, {Kind::place_z}, {Kind::wet}};
    for (const SingleDifference& d : differences) {
        wanted.insert({Kind::ionosphere, d.satellite, {}});
        wanted.insert(ambiguity_of(d));
    }
    for (const auto& [name, tracked] : tracked_)
        wanted.insert(name);
    state_.arrange({wanted.begin(), wanted.end()}, [&](const StateName& name) { return variance_of(name, spacing); });
    for (const SingleDifference& d : differences) {
        const auto known = tracked_.find(ambiguity_of(d));
        const bool missed = known == tracked_.end() || difference(time, known->second.seen) > longest_step;
        if (missed || d.broken) begin_ambiguity(d, time, d.tracked);
        if (missed) tracked_.at(ambiguity_of(d)).code_since = advanced(time, -d.tracked);
        tracked_.at(ambiguity_of(d)).seen = time;
        tracked_.at(ambiguity_of(d)).echo_variance = d.echo_variance / square(d.wavelength_m);
    }
}

void CarrierFilter::State::begin_ambiguity(const SingleDifference& d, GpsTime time, Seconds tracked) {
    const StateName name = ambiguity_of(d);
    Tracked& now = tracked_[name];
    now.since = advanced(time, -tracked);
    now.seen = time;
    now.fresh = true;
    state_.restart(state_.index(name), (d.phase_m - d.code_m) / d.wavelength_m,
                   square(ambiguity_deviation_m / d.wavelength_m));
}

void CarrierFilter::State::predict(const Spacing& spacing) {
    for (const Kind axis : {Kind::place_x, Kind::place_y, Kind::place_z})
        state_.restart(state_.index({axis}), 0, square(place_deviation_m));
    const double wet_left = std::exp(-passed_.value() / p_.wet_memory.value());
    const double ionosphere_left = std::exp(-passed_.value() / p_.ionosphere_memory.value());
    const double echo_lost = -2 * std::expm1(-passed_.value() / p_.phase_memory.value());
    for (Index i = 0; i < state_.size(); ++i) {
        const StateName& name = state_.names()[static_cast<std::size_t>(i)];
        if (name.kind == Kind::wet) state_.relax(i, wet_left, variance_of(name, spacing));
        if (name.kind == Kind::ionosphere) state_.relax(i, ionosphere_left, variance_of(name, spacing));
        if (name.kind == Kind::ambiguity) state_.covariance(i, i) += echo_lost * tracked_.at(name).echo_variance;
    }
}

Eigen::RowVectorXd CarrierFilter::State::row_of(const SingleDifference& d, bool phase) const {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(state_.size());
    row.head<3>() = -d.line.transpose();
    row(state_.index({Kind::wet})) = d.wet_mapping;
    row(state_.index({Kind::ionosphere, d.satellite, {}})) = (phase ? -1 : 1) * d.ionosphere_factor;
    if (phase) row(state_.index(ambiguity_of(d))) = d.wavelength_m;
    return row;
}

// By how much the variance of a code is larger. A loop averages its noise away while it runs; what else a code is off
// by lasts. So what codes say grows by and by.
double CarrierFilter::State::code_weakness(const SingleDifference& d, bool at_first) const {
    const Tracked& tracked = tracked_.at(ambiguity_of(d));
    const double age_s = difference(*time_, tracked.code_since).value();
    const auto told_by = [&](double at_s) {
        const double averaged_s = std::max(at_s, 0.5);
        return averaged_s / (averaged_s + p_.code_averaging.value());
    };
    if (at_first || tracked.fresh) return 1 / told_by(age_s);
    const double more = told_by(age_s) - told_by(age_s - passed_.value());
    return 1 / std::max(more + 0.5 * passed_.value() / p_.code_memory.value(), 1e-4);
}

GroupEquations CarrierFilter::State::equations(const Group& group, Says says) const {
    const bool phase = says == Says::phase;
    const auto count = static_cast<Index>(group.size());
    MatrixXd rows(count, state_.size());
    VectorXd observed(count), variances(count);
    for (Index i = 0; i < count; ++i) {
        const SingleDifference& d = *group[static_cast<std::size_t>(i)];
        rows.row(i) = row_of(d, phase);
        observed(i) = phase ? d.phase_m : d.code_m;
        variances(i) = phase ? d.phase_variance : d.code_variance * code_weakness(d, says == Says::code);
    }
    const VectorXd off = observed - rows * state_.values;
    const Index others = count - 1;
    GroupEquations e{rows.bottomRows(others).rowwise() - rows.row(0), off.tail(others).array() - off(0),
                     MatrixXd::Constant(others, others, variances(0))};
    e.noise.diagonal() += variances.tail(others);
    return e;
}

void CarrierFilter::State::use_codes(const Group& group) {
    const GroupEquations e = equations(group, Says::news_of_code);
    state_.absorb(e.design, e.misfit, e.noise);
    for (const SingleDifference* d : group)
        tracked_.at(ambiguity_of(*d)).fresh = false;
}

// False: most of them do not fit what was known. One that does not is taken for a slip; when it is the reference, the
// others do not.
bool CarrierFilter::State::use_phases(Group group, GpsTime time) {
    bool fits = true;
    while (group.size() >= 2) {
        const GroupEquations e = equations(group, Says::phase);
        const VectorXd expected = (e.design * state_.covariance * e.design.transpose() + e.noise).diagonal();
        std::vector<std::size_t> slipped;
        for (Index i = 0; i < e.misfit.size(); ++i)
            if (std::abs(e.misfit(i)) > std::max(misfit_m, misfit_deviations * std::sqrt(expected(i))))
                slipped.push_back(static_cast<std::size_t>(i) + 1);
        if (slipped.empty()) {
            misfit_squares_ += e.misfit.cwiseAbs2().cwiseQuotient(expected).sum();
            misfit_count_ += static_cast<double>(e.misfit.size());
            state_.absorb(e.design, e.misfit, e.noise);
            return fits;
        }
        if (2 * slipped.size() >= group.size() && group.size() > 2) {
            fits = false;
            slipped.assign(1, 0);
        }
        for (auto i = slipped.rbegin(); i != slipped.rend(); ++i) {
            begin_ambiguity(*group[*i], time, Seconds(0));
            group.erase(group.begin() + static_cast<std::ptrdiff_t>(*i));
        }
    }
    return fits;
}

// In their expected variances, after the phases have had their say.
double CarrierFilter::State::misfit_of_codes() const {
    double squares = 0, count = 0;
    for (const auto& [name, group] : groups_) {
        const GroupEquations e = equations(group, Says::code);
        squares += e.misfit.cwiseAbs2().cwiseQuotient(e.noise.diagonal()).sum();
        count += static_cast<double>(e.misfit.size());
    }
    return count > 0 ? squares / count : 1;
}

std::optional<CarrierOffset> CarrierFilter::State::update(std::span<const SingleDifference> differences,
                                                          const Spacing& spacing, GpsTime time) {
    passed_ = time_ ? difference(time, *time_) : Seconds(0);
    length_m_ = spacing.length_m;
    present_.assign(differences.begin(), differences.end());
    groups_.clear();
    std::set<SatelliteId> satellites;
    for (const SingleDifference& d : present_) {
        satellites.insert(d.satellite);
        groups_[{d.satellite.constellation, d.signal}].push_back(&d);
    }
    if (satellites.size() < least_satellites) return std::nullopt;
    time_ = time;
    arrange(present_, spacing, time);
    predict(spacing);
    std::erase_if(groups_, [](const auto& group) { return group.second.size() < 2; });
    for (auto& [name, group] : groups_) {
        std::ranges::stable_sort(group, std::ranges::greater(), [](const auto* d) { return d->elevation; });
        use_codes(group);
    }
    std::size_t fitting = 0;  // groups
    for (const auto& [name, group] : groups_)
        if (use_phases(group, time)) ++fitting;
    // Phases of another reference under the same number may happen to fit at first, and lead away.
    const double codes = misfit_of_codes();
    const bool credible = codes <= most_misfit_of_codes;
    misfits_ = 2 * fitting >= groups_.size() && credible ? 0 : misfits_ + 1;
    if (contradicted() || !credible) return std::nullopt;
    const double phases = misfit_count_ > 0 ? misfit_squares_ / misfit_count_ : 1;
    misfit_squares_ = misfit_count_ = 0;
    follow(excess_, phases, passed_);
    follow(code_excess_, codes, passed_);
    return CarrierOffset{state_.values.head<3>(),
                         std::max(excess_, code_excess_) * state_.covariance.topLeftCorner<3, 3>()};
}

CarrierFilter::CarrierFilter(const CarrierParameters& parameters)
    : parameters_(parameters), state_(std::make_unique<State>(parameters_)) {}
CarrierFilter::~CarrierFilter() = default;

void CarrierFilter::reset() { state_ = std::make_unique<State>(parameters_); }

std::optional<CarrierOffset> CarrierFilter::update(std::span<const SingleDifference> differences,
                                                   const Spacing& spacing, GpsTime time) {
    if (state_->contradicted() || state_->outlived(time))
        state_ = std::make_unique<State>(parameters_, state_->hope_of_next());
    return state_->update(differences, spacing, time);
}
std::optional<FixedOffset> CarrierFilter::fix() { return state_->fix(); }

}  // namespace skyloop::inline receiver
