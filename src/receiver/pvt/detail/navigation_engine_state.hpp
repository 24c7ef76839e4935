/// What a NavigationEngine knows and does, for the two files that it is written in.
#pragma once

#include <cmath>
#include <optional>

#include "base/geo/local_frame.hpp"
#include "receiver/pvt/augmentation.hpp"
#include "receiver/pvt/baseline_solver.hpp"
#include "receiver/pvt/equation_maker.hpp"
#include "receiver/pvt/expected_error.hpp"
#include "receiver/pvt/integrity.hpp"
#include "receiver/pvt/motion_check.hpp"
#include "receiver/pvt/moving_pair.hpp"
#include "receiver/pvt/navigation_engine.hpp"
#include "receiver/pvt/observation_equations.hpp"
#include "receiver/pvt/position_filter.hpp"
#include "receiver/pvt/satellite_report.hpp"
#include "receiver/pvt/single_point.hpp"

namespace skyloop::inline receiver {

/// What was made of one epoch before the filter.
struct EpochSolution : EpochEquations {
    std::optional<SinglePoint> point;
    std::optional<SinglePointVelocity> velocity;
    ResidualTest test;
    bool time_only = false;
};

class NavigationEngine::State {
public:
    State(const NavigationParameters& parameters, const NavigationKnowledge& knowledge);

    Fix solve(const Observations& observations, const ReceiverSettings& settings);
    // Messages of SBAS have no time of their own: what comes before the first fix is not kept (ours; modules that are
    // switched on use corrections one to two minutes later).
    void hear(std::span<const Subframe> messages, const ReceiverSettings& settings) {
        if (position_) augmentation_.hear(messages, settings);
    }
    std::optional<RelativePosition> relate(const Observations& observations, const ReferenceStation& base);
    [[nodiscard]] bool velocity_known() const { return velocity_known_; }
    [[nodiscard]] std::optional<FixType> pair_type() const { return pair_.type_at(time_); }
    [[nodiscard]] const std::optional<RelativePosition>& relative() const { return relative_; }

private:
    // Of the last fix in three dimensions.
    struct LastHeight {
        HeldHeight then;
        GpsTime time;
        MetresPerSecond rate;  // at which it may have changed since
    };

    void begin(const ReceiverSettings& settings, GpsTime time);
    TransmitterSource& transmitters() { return knowledge_.transmitters ? *knowledge_.transmitters : transmitters_; }
    [[nodiscard]] GpsTime presumed_time(const Observations& observations) const;
    EpochSolution solve_epoch(const Observations& observations, const ReceiverSettings& settings);
    [[nodiscard]] std::optional<HeldHeight> held_height(const ReceiverSettings& settings) const;
    void solve_position(const ReceiverSettings& settings, EpochSolution& epoch);
    void solve_doppler(EpochSolution& epoch) const;
    [[nodiscard]] bool plausible(const FilteredPosition& filtered, const ReceiverSettings& settings);
    [[nodiscard]] FixType type_of(const EpochSolution& epoch) const;
    [[nodiscard]] bool is_augmented(const EpochSolution& epoch) const;
    void fill_solved(const EpochSolution& epoch, const ReceiverSettings& settings, Fix& fix);
    void fill_motion(const FilteredPosition& filtered, const ReceiverSettings& settings, Fix& fix);
    Metres fill_accuracy(const EpochSolution& epoch, Fix& fix);
    void fill_coasting(const ReceiverSettings& settings, Fix& fix);
    const Observations& corrected(const Observations& observations, const Corrections& corrections);
    void solve_baseline(const EpochSolution& epoch, const Observations& observations, const Corrections& corrections);
    void solve_vector(const Observations& observations, const Corrections& corrections, Fix& fix);
    // To the millisecond, below which both clocks are off.
    [[nodiscard]] Seconds reference_age(const ReferenceStation& reference) const {
        return Seconds(std::round(1e3 * difference(time_, reference.epoch.time).value()) / 1e3);
    }
    [[nodiscard]] DifferentialKind differential_kind() const;
    [[nodiscard]] Metres reported_undulation(const Geodetic& at) const {
        const Geoid* geoid = knowledge_.geoid;
        return geoid ? geoid->undulation(at.latitude, at.longitude, knowledge_.geoid_step_deg) : Metres(0);
    }

    NavigationParameters parameters_;
    NavigationKnowledge knowledge_;
    ReceivedRecords received_;
    BroadcastTransmitters transmitters_;
    RangeCorrections corrections_;
    RangeCorrections air_;  // as far as the receiver can tell, corrected or not
    IntegrityMonitor monitor_;
    CodeSmoother smoother_;
    PositionFilter filter_;
    SatelliteReport report_;
    Augmentation augmentation_;
    EquationMaker maker_;
    MotionCheck motion_;
    NoiseScale noise_;
    BaselineSolver baseline_;
    MovingPair pair_;
    std::set<SatelliteId> usable_;              // of the last solution
    Observations corrected_observations_;       // of this epoch: its equations point to them
    std::optional<BaselineSolution> carrier_;   // by carrier phases, of this epoch
    std::optional<RelativePosition> relative_;  // the vector that is told at this epoch

    std::optional<int> restarts_;
    GpsTime time_;                           // true, as well as the receiver can tell
    std::optional<GpsTime> clock_known_at_;  // receiver's reading at the last solution
    Metres clock_bias_;
    MetresPerSecond clock_drift_;
    std::optional<Position<Ecef>> position_;  // the last one
    std::optional<LastHeight> height_;
    Angle course_;
    bool velocity_known_ = false;                        // of the last solution
    CorrectionState corrected_ = CorrectionState::none;  // by a reference station, this epoch
    std::optional<ReferenceSpacing> reference_;          // of that station, where it was used
    Fix last_;
};

}  // namespace skyloop::inline receiver
