/// What a CarrierFilter knows, and what it does with it.
#pragma once

#include <Eigen/Core>

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "named_state.hpp"
#include "receiver/pvt/carrier_filter.hpp"

namespace skyloop::inline receiver {

// Differences of one signal of one system, the highest satellite first, which is the one that others are compared to.
using Group = std::vector<const SingleDifference*>;

struct GroupEquations {
    Eigen::MatrixXd design;
    Eigen::VectorXd misfit;
    Eigen::MatrixXd noise;
};

// Two ambiguities of one signal, by their places in the state.
struct AmbiguityPair {
    Eigen::Index at, reference;
};

inline StateName ambiguity_of(const SingleDifference& d) { return {StateName::Kind::ambiguity, d.satellite, d.signal}; }

class CarrierFilter::State {
public:
    // Echoes of a street that a receiver has left stay in the ambiguities for minutes. Where these could be whole, it
    // is sooner to begin anew; the next time it takes twice as long, as a weak sky needs it.
    static constexpr Seconds hope_lasts{30};
    explicit State(const CarrierParameters& parameters, Seconds hope = hope_lasts) : p_(parameters), hope_(hope) {}

    std::optional<CarrierOffset> update(std::span<const SingleDifference> differences, const Spacing& spacing,
                                        GpsTime time);
    std::optional<FixedOffset> fix();
    [[nodiscard]] bool contradicted() const { return misfits_ >= p_.most_misfits || hopeless_; }
    [[nodiscard]] Seconds hope_of_next() const { return hopeless_ ? 2 * hope_ : hope_lasts; }
    [[nodiscard]] bool outlived(GpsTime time) const { return time_ && difference(time, *time_) > p_.memory; }

private:
    struct Tracked {
        GpsTime since, seen;
        GpsTime code_since;        // slips do not touch the loop of the code
        bool fresh = true;         // its code has not counted yet
        double echo_variance = 0;  // of its phase, cycles²
    };

    [[nodiscard]] double variance_of(const StateName& name, const Spacing& spacing) const;
    void arrange(std::span<const SingleDifference> differences, const Spacing& spacing, GpsTime time);
    void predict(const Spacing& spacing);
    void begin_ambiguity(const SingleDifference& d, GpsTime time, Seconds tracked);
    [[nodiscard]] Eigen::RowVectorXd row_of(const SingleDifference& d, bool phase) const;
    [[nodiscard]] double code_weakness(const SingleDifference& d, bool at_first) const;
    enum class Says { phase, code, news_of_code };  // since the epoch before
    [[nodiscard]] GroupEquations equations(const Group& group, Says says) const;
    void use_codes(const Group& group);
    bool use_phases(Group group, GpsTime time);
    [[nodiscard]] double misfit_of_codes() const;
    [[nodiscard]] std::vector<AmbiguityPair> pairs(double most_variance, Seconds tracked) const;
    [[nodiscard]] double variance_of_best(double share) const;
    [[nodiscard]] Eigen::MatrixXd echoes(const std::vector<AmbiguityPair>& pairs) const;
    std::optional<FixedOffset> fix(const std::vector<AmbiguityPair>& pairs);
    void hold(const std::vector<AmbiguityPair>& pairs, const Eigen::VectorXd& whole);

    CarrierParameters p_;
    NamedState state_;
    std::map<StateName, Tracked> tracked_;
    std::vector<SingleDifference> present_;  // of the last epoch
    std::map<std::pair<Constellation, Signal>, Group> groups_;
    std::optional<GpsTime> time_, fixed_since_, unfixed_since_;
    double length_m_ = 0;                           // of the baseline
    Seconds hope_;                                  // for which ambiguities that could be whole may float
    bool hopeless_ = false;                         // they have floated longer
    Seconds passed_;                                // since the epoch before
    int misfits_ = 0;                               // epochs in a row in which most phases did not fit
    double misfit_squares_ = 0, misfit_count_ = 0;  // of this epoch's phases, in their expected variances
    double excess_ = 1, code_excess_ = 1;           // of the variances, as misfits of the last seconds show it
};

}  // namespace skyloop::inline receiver
