#include "receiver/pvt/carrier_filter.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <set>

#include "detail/named_state.hpp"
#include "detail/square.hpp"
#include "receiver/pvt/integer_search.hpp"

namespace skyloop::inline receiver {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = StateName::Kind;

constexpr double place_deviation_m = 30, ambiguity_deviation_m = 100;  // before anything is known
constexpr std::size_t least_satellites = 4, least_pairs = 4;
// A phase that fits neither by its deviation nor by a part of a cycle has lost its count.
constexpr double misfit_deviations = 5, misfit_m = 0.05;
constexpr double most_misfit_of_codes = 25;  // of their variances

StateName ambiguity_of(const SingleDifference& d) { return {Kind::ambiguity, d.satellite, d.signal}; }

// What fits worse than its variance expects makes a solution that is worse by as much.
void follow(double& excess, double misfit, Seconds passed) {
    constexpr double averaged_over_s = 20, most = 25;
    excess += -std::expm1(-passed.value() / averaged_over_s) * (std::clamp(misfit, 1.0, most) - excess);
}

// Differences of one signal of one system, the highest satellite first, which is the one that others are compared to.
using Group = std::vector<const SingleDifference*>;

struct GroupEquations {
    MatrixXd design;
    VectorXd misfit;
    MatrixXd noise;
};

// Two ambiguities of one signal, by their places in the state.
struct AmbiguityPair {
    Index at, reference;
};

}  // namespace

class CarrierFilter::State {
public:
    explicit State(const CarrierParameters& parameters) : p_(parameters) {}

    std::optional<CarrierOffset> update(std::span<const SingleDifference> differences, const Spacing& spacing,
                                        GpsTime time);
    std::optional<FixedOffset> fix();
    [[nodiscard]] bool contradicted() const { return misfits_ >= p_.most_misfits; }
    [[nodiscard]] bool outlived(GpsTime time) const { return time_ && difference(time, *time_) > p_.memory; }

private:
    struct Tracked {
        GpsTime since, seen;
        bool fresh = true;  // its code has not counted yet
    };

    [[nodiscard]] double variance_of(const StateName& name, const Spacing& spacing) const;
    void arrange(std::span<const SingleDifference> differences, const Spacing& spacing, GpsTime time);
    void predict(const Spacing& spacing, Seconds passed);
    void begin_ambiguity(const SingleDifference& d, GpsTime time);
    [[nodiscard]] Eigen::RowVectorXd row_of(const SingleDifference& d, bool phase) const;
    [[nodiscard]] bool settled(const SingleDifference& d) const;
    [[nodiscard]] double code_weakness(const SingleDifference& d, Seconds passed) const;
    [[nodiscard]] GroupEquations equations(const Group& group, bool phase, Seconds passed) const;
    void use_codes(const Group& group, Seconds passed);
    bool use_phases(Group group, GpsTime time);
    [[nodiscard]] double misfit_of_codes() const;
    [[nodiscard]] std::vector<AmbiguityPair> pairs(double most_variance, Seconds tracked) const;
    [[nodiscard]] double variance_of_best(double share) const;
    std::optional<FixedOffset> fix(const std::vector<AmbiguityPair>& pairs, double least_success);
    void hold(const std::vector<AmbiguityPair>& pairs, const VectorXd& whole);

    CarrierParameters p_;
    NamedState state_;
    std::map<StateName, Tracked> tracked_;
    std::vector<SingleDifference> present_;  // of the last epoch
    std::map<std::pair<Constellation, Signal>, Group> groups_;
    std::optional<GpsTime> time_, fixed_since_;
    int misfits_ = 0;                               // epochs in a row in which most phases did not fit
    double misfit_squares_ = 0, misfit_count_ = 0;  // of this epoch's phases, in their expected variances
    double excess_ = 1, code_excess_ = 1;           // of the variances, as misfits of the last seconds show it
};

double CarrierFilter::State::variance_of(const StateName& name, const Spacing& spacing) const {
    constexpr double least = 1e-4;  // m
    switch (name.kind) {
        case Kind::wet:
            return square(least + std::min(p_.wet_per_length * spacing.length_m, p_.wet_most.value()) +
                          p_.wet_per_height * std::abs(spacing.height_m));
        case Kind::ionosphere:
            return square(least + std::min(p_.ionosphere_per_length * spacing.length_m, p_.ionosphere_most.value()));
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
        if (known == tracked_.end() || d.broken)
            begin_ambiguity(d, time);
        else
            known->second.seen = time;
    }
}

void CarrierFilter::State::begin_ambiguity(const SingleDifference& d, GpsTime time) {
    const StateName name = ambiguity_of(d);
    tracked_[name] = {time, time, true};
    state_.restart(state_.index(name), (d.phase_m - d.code_m) / d.wavelength_m,
                   square(ambiguity_deviation_m / d.wavelength_m));
}

void CarrierFilter::State::predict(const Spacing& spacing, Seconds passed) {
    for (const Kind axis : {Kind::place_x, Kind::place_y, Kind::place_z})
        state_.restart(state_.index({axis}), 0, square(place_deviation_m));
    const double wet_left = std::exp(-passed.value() / p_.wet_memory.value());
    const double ionosphere_left = std::exp(-passed.value() / p_.ionosphere_memory.value());
    for (Index i = 0; i < state_.size(); ++i) {
        const StateName& name = state_.names()[static_cast<std::size_t>(i)];
        if (name.kind == Kind::wet) state_.relax(i, wet_left, variance_of(name, spacing));
        if (name.kind == Kind::ionosphere) state_.relax(i, ionosphere_left, variance_of(name, spacing));
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

bool CarrierFilter::State::settled(const SingleDifference& d) const {
    return difference(*time_, tracked_.at(ambiguity_of(d)).since) >= p_.settled_after;
}

// By how much the variance of a code is larger. Loops that have just begun are off by more than they will be; after
// that errors last, so that codes say something new by and by.
double CarrierFilter::State::code_weakness(const SingleDifference& d, Seconds passed) const {
    constexpr double of_young = 4;
    if (!settled(d)) return of_young;
    if (tracked_.at(ambiguity_of(d)).fresh) return 1;
    return std::max(1.0, 2 * p_.code_memory.value() / std::max(passed.value(), 1e-3));
}

GroupEquations CarrierFilter::State::equations(const Group& group, bool phase, Seconds passed) const {
    const auto count = static_cast<Index>(group.size());
    MatrixXd rows(count, state_.size());
    VectorXd observed(count), variances(count);
    for (Index i = 0; i < count; ++i) {
        const SingleDifference& d = *group[static_cast<std::size_t>(i)];
        rows.row(i) = row_of(d, phase);
        observed(i) = phase ? d.phase_m : d.code_m;
        variances(i) = phase ? d.phase_variance : d.code_variance * code_weakness(d, passed);
    }
    const VectorXd off = observed - rows * state_.values;
    const Index others = count - 1;
    GroupEquations e{rows.bottomRows(others).rowwise() - rows.row(0), off.tail(others).array() - off(0),
                     MatrixXd::Constant(others, others, variances(0))};
    e.noise.diagonal() += variances.tail(others);
    return e;
}

void CarrierFilter::State::use_codes(const Group& group, Seconds passed) {
    const GroupEquations e = equations(group, false, passed);
    state_.absorb(e.design, e.misfit, e.noise);
    for (const SingleDifference* d : group)
        if (settled(*d)) tracked_.at(ambiguity_of(*d)).fresh = false;
}

// False: most of them do not fit what was known. One that does not is taken for a slip; when it is the reference, the
// others do not.
bool CarrierFilter::State::use_phases(Group group, GpsTime time) {
    bool fits = true;
    while (group.size() >= 2) {
        const GroupEquations e = equations(group, true, {});
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
            begin_ambiguity(*group[*i], time);
            group.erase(group.begin() + static_cast<std::ptrdiff_t>(*i));
        }
    }
    return fits;
}

// In their expected variances, after the phases have had their say.
double CarrierFilter::State::misfit_of_codes() const {
    double squares = 0, count = 0;
    for (const auto& [name, group] : groups_) {
        const GroupEquations e = equations(group, false, 2 * p_.code_memory);
        squares += e.misfit.cwiseAbs2().cwiseQuotient(e.noise.diagonal()).sum();
        count += static_cast<double>(e.misfit.size());
    }
    return count > 0 ? squares / count : 1;
}

std::optional<CarrierOffset> CarrierFilter::State::update(std::span<const SingleDifference> differences,
                                                          const Spacing& spacing, GpsTime time) {
    const Seconds passed = time_ ? difference(time, *time_) : Seconds(0);
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
    predict(spacing, passed);
    std::erase_if(groups_, [](const auto& group) { return group.second.size() < 2; });
    for (auto& [name, group] : groups_) {
        std::ranges::stable_sort(group, std::ranges::greater(), [](const auto* d) { return d->elevation; });
        use_codes(group, passed);
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
    follow(excess_, phases, passed);
    follow(code_excess_, codes, passed);
    return CarrierOffset{state_.values.head<3>(),
                         std::max(excess_, code_excess_) * state_.covariance.topLeftCorner<3, 3>()};
}

std::vector<AmbiguityPair> CarrierFilter::State::pairs(double most_variance, Seconds tracked) const {
    std::vector<AmbiguityPair> pairs;
    for (const auto& [name, group] : groups_) {
        std::optional<Index> reference;
        for (const SingleDifference* d : group) {
            const Tracked& t = tracked_.at(ambiguity_of(*d));
            if (!d->whole || d->elevation < p_.integers_from || d->phase_variance > most_variance ||
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

std::optional<FixedOffset> CarrierFilter::State::fix(const std::vector<AmbiguityPair>& pairs, double least_success) {
    const auto count = static_cast<Index>(pairs.size());
    const MatrixXd& p = state_.covariance;
    VectorXd floats(count);
    MatrixXd differenced(count, state_.size());
    for (Index i = 0; i < count; ++i) {
        const AmbiguityPair& pair = pairs[static_cast<std::size_t>(i)];
        floats(i) = state_.values(pair.at) - state_.values(pair.reference);
        differenced.row(i) = p.row(pair.at) - p.row(pair.reference);
    }
    MatrixXd covariance(count, count);
    for (Index i = 0; i < count; ++i) {
        const AmbiguityPair& pair = pairs[static_cast<std::size_t>(i)];
        covariance.col(i) = differenced.col(pair.at) - differenced.col(pair.reference);
    }
    const auto found = search_integers(floats, covariance);
    if (!found || found->success < least_success || found->ratio() < p_.least_ratio) return std::nullopt;
    const Eigen::LDLT<MatrixXd> weights(covariance);
    const MatrixXd of_place = differenced.leftCols<3>();
    FixedOffset fixed;
    fixed.offset = state_.values.head<3>() - of_place.transpose() * weights.solve(floats - found->best);
    fixed.covariance = excess_ * (p.topLeftCorner<3, 3>() - of_place.transpose() * weights.solve(of_place));
    fixed.ratio = found->ratio();
    fixed.ambiguities = static_cast<int>(count);
    if (!fixed_since_) fixed_since_ = time_;
    if (difference(*time_, *fixed_since_) >= p_.hold_after) hold(pairs, found->best);
    return fixed;
}

void CarrierFilter::State::hold(const std::vector<AmbiguityPair>& pairs, const VectorXd& whole) {
    constexpr double held_to_cycles = 0.03;
    MatrixXd design = MatrixXd::Zero(whole.size(), state_.size());
    for (Index i = 0; i < whole.size(); ++i) {
        design(i, pairs[static_cast<std::size_t>(i)].at) = 1;
        design(i, pairs[static_cast<std::size_t>(i)].reference) = -1;
    }
    state_.absorb(design, whole - design * state_.values,
                  square(held_to_cycles) * MatrixXd::Identity(whole.size(), whole.size()));
}

// The largest variance of a phase among so many of the best ones.
double CarrierFilter::State::variance_of_best(double share) const {
    std::vector<double> variances;
    for (const SingleDifference& d : present_)
        variances.push_back(d.phase_variance);
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
        const double least = part.share < 1 ? p_.least_success_of_part : p_.least_success;
        if (auto fixed = fix(chosen, least)) return fixed;
    }
    fixed_since_.reset();
    return std::nullopt;
}

CarrierFilter::CarrierFilter(const CarrierParameters& parameters)
    : parameters_(parameters), state_(std::make_unique<State>(parameters_)) {}
CarrierFilter::~CarrierFilter() = default;

void CarrierFilter::reset() { state_ = std::make_unique<State>(parameters_); }

std::optional<CarrierOffset> CarrierFilter::update(std::span<const SingleDifference> differences,
                                                   const Spacing& spacing, GpsTime time) {
    if (state_->contradicted() || state_->outlived(time)) reset();
    return state_->update(differences, spacing, time);
}
std::optional<FixedOffset> CarrierFilter::fix() { return state_->fix(); }

}  // namespace skyloop::inline receiver
