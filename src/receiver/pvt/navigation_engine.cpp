#include "receiver/pvt/navigation_engine.hpp"

#include <cmath>
#include <utility>

#include "detail/navigation_engine_state.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

// Two carriers are of use even where no group delay is broadcast.
UntoldDelay untold_delay(const CorrectionParameters& parameters) {
    const bool two_carriers = parameters.ionosphere_free || parameters.ionosphere_memory > Seconds(0);
    return two_carriers ? UntoldDelay::none : UntoldDelay::unknown;
}

GpsTime whole_millisecond(GpsTime time) { return std::chrono::round<std::chrono::milliseconds>(time); }

}  // namespace

NavigationEngine::State::State(const NavigationParameters& parameters, const NavigationKnowledge& knowledge)
    : parameters_(parameters),
      knowledge_(knowledge),
      received_(*knowledge.broadcast, parameters),
      transmitters_(received_, untold_delay(parameters.corrections)),
      corrections_(parameters.corrections,
                   {knowledge.broadcast->ionosphere(), knowledge.geoid, knowledge.leap_seconds}),
      air_({IonosphereCorrection::klobuchar, TroposphereCorrection::niell, 0.5, true, false},
           {knowledge.broadcast->ionosphere(), knowledge.geoid, knowledge.leap_seconds}),
      monitor_(parameters.integrity),
      smoother_(parameters.filter.code_smoothing),
      filter_(parameters.filter),
      report_(*knowledge.broadcast, received_),
      maker_(parameters, augmentation_),
      noise_(parameters.filter.kind),
      baseline_(parameters.carrier, air_),
      pair_(parameters.carrier, air_),
      position_(knowledge.last_place) {}

// A restart, and the very first start.
void NavigationEngine::State::begin(const ReceiverSettings& settings, GpsTime time) {
    if (restarts_ == settings.restarts) return;
    restarts_ = settings.restarts;
    received_.restart(settings.start, time);
    filter_.reset();
    smoother_.reset();
    report_.reset();
    augmentation_.reset();
    maker_.reset();
    baseline_.reset();
    pair_.reset();
    motion_.reset();
    noise_.reset();
    clock_known_at_.reset();
    if (settings.start != StartKind::cold) return;
    position_.reset();
    height_.reset();
    course_ = Angle();
}

GpsTime NavigationEngine::State::presumed_time(const Observations& observations) const {
    double bias_m = 0;
    // After a jump by whole milliseconds the clock is within half of one.
    if (clock_known_at_ && !observations.clock_was_set)
        bias_m = clock_bias_.value() +
                 clock_drift_.value() * difference(observations.receive_time, *clock_known_at_).value();
    return whole_millisecond(advanced(observations.receive_time, Seconds(-bias_m / speed_of_light)));
}

// The less exact the longer ago it was solved. What flies holds none (RECEIVER.md 4.8).
std::optional<HeldHeight> NavigationEngine::State::held_height(const ReceiverSettings& settings) const {
    if (!position_ || !height_ || settings.dynamic_model >= DynamicModel::airborne_1g) return std::nullopt;
    const double moved = height_->rate.value() * difference(time_, height_->time).value();
    return HeldHeight{height_->then.height, Metres(std::hypot(height_->then.deviation.value(), moved))};
}

void NavigationEngine::State::solve_position(const ReceiverSettings& settings, EpochSolution& epoch) {
    const CorrectionParameters& c = parameters_.corrections;
    const bool models = c.ionosphere != IonosphereCorrection::none || c.troposphere != TroposphereCorrection::none;
    const bool corrects = models && corrected_ == CorrectionState::none;
    SinglePointSetup setup{time_,     parameters_.weights, settings.elevation_mask, corrects ? &corrections_ : nullptr,
                           position_, std::nullopt};
    setup.noise = noise_.average();
    if (parameters_.fixed_position && settings.dynamic_model == DynamicModel::stationary) {
        setup.start = to_ecef(*parameters_.fixed_position);
        epoch.point = solve_clocks(epoch.equations, setup);
        epoch.time_only = true;
        return;
    }
    const auto solved = [&] {
        return c.ionosphere_free ? solve_free_of_ionosphere(monitor_, epoch.equations, setup)
                                 : monitor_.solve(epoch.equations, setup);
    };
    std::optional<CheckedSolution> checked = solved();
    if (!checked && setup.start) {
        // Perhaps the last position is too far off to begin with.
        setup.start.reset();
        checked = solved();
        setup.start = position_;
    }
    if (!checked) setup.held_height = held_height(settings);
    if (setup.held_height) checked = monitor_.solve(epoch.equations, setup);
    if (!checked) return;
    epoch.point = std::move(checked->solution);
    epoch.test = checked->test;
}

void NavigationEngine::State::solve_doppler(EpochSolution& epoch) const {
    if (!epoch.point || epoch.time_only) return;
    std::vector<DopplerEquation> equations;
    equations.reserve(epoch.equations.size());
    for (std::size_t i = 0; i < epoch.equations.size(); ++i) {
        const Observation& o = *epoch.primaries[i];
        const RangeOutcome& r = epoch.point->ranges[i];
        if (!r.used || !o.doppler) continue;
        const double wavelength = speed_of_light / o.carrier.value();
        const double noise =
            std::hypot(parameters_.weights.range_rate.value(), wavelength * o.doppler_deviation.value());
        equations.push_back({r.line, r.satellite, r.satellite_velocity, epoch.equations[i].transmitter.clock_drift,
                             MetresPerSecond(-wavelength * o.doppler->value()), MetresPerSecond(noise)});
    }
    std::optional<Eigen::Vector3d> up;
    if (epoch.point->height_held)
        up = LocalFrame(to_geodetic(epoch.point->position)).to_ecef(Displacement<Enu>(0, 0, 1)).vector();
    epoch.velocity = solve_velocity(equations, up);
}

EpochSolution NavigationEngine::State::solve_epoch(const Observations& observations, const ReceiverSettings& settings) {
    EpochSolution epoch;
    time_ = presumed_time(observations);
    corrected_ = CorrectionState::none;
    // Records change at whole epochs: the second look is for a clock that was farther off than expected.
    for (int look = 0; look < 2; ++look) {
        received_.listen(observations, time_);
        epoch = EpochSolution();
        if (!received_.time_known()) return epoch;
        transmitters_.choose_records_at(time_);
        const Observations& used = corrected(observations, settings.corrections);
        const bool with_reference = corrected_ != CorrectionState::none;
        const auto place = position_ ? std::optional(to_geodetic(*position_)) : std::nullopt;
        augmentation_.begin({received_, observations, settings, time_, place});
        static_cast<EpochEquations&>(epoch) = maker_.make(transmitters(), used, settings, with_reference);
        solve_position(settings, epoch);
        if (!epoch.point) return epoch;
        if (keep_strongest(*epoch.point, settings.most_satellites, epoch.equations, epoch.primaries)) {
            epoch.point.reset();
            solve_position(settings, epoch);
            if (!epoch.point) return epoch;
        }
        const GpsTime solved = whole_millisecond(
            advanced(observations.receive_time, Seconds(-epoch.point->clock().value() / speed_of_light)));
        if (solved == time_) break;
        time_ = solved;
    }
    solve_doppler(epoch);
    solve_baseline(epoch, observations, settings.corrections);
    return epoch;
}

// As measured, or with what a reference station tells taken off.
const Observations& NavigationEngine::State::corrected(const Observations& observations,
                                                       const Corrections& corrections) {
    constexpr int enough = 4;  // satellites for a position
    corrected_ = CorrectionState::none;
    reference_.reset();
    if (corrections.at_most == CorrectionState::none || !corrections.reference || corrections.reference->moves ||
        reference_age(*corrections.reference) > corrections.differential_timeout)
        return observations;
    corrected_observations_ = observations;
    if (correct_codes(corrected_observations_, *corrections.reference, transmitters()) < enough) return observations;
    corrected_ = CorrectionState::differential;
    reference_ = ReferenceSpacing{Metres(0), reference_age(*corrections.reference)};
    return corrected_observations_;
}

void NavigationEngine::State::solve_baseline(const EpochSolution& epoch, const Observations& observations,
                                             const Corrections& corrections) {
    carrier_.reset();
    usable_.clear();
    if (!epoch.point) return;
    for (std::size_t i = 0; i < epoch.equations.size(); ++i)
        if (epoch.point->ranges[i].used) usable_.insert(epoch.equations[i].satellite);
    if (!reference_) return;
    reference_->length = (epoch.point->position - *corrections.reference->position).length();
    if (corrections.at_most < CorrectionState::rtk_float || epoch.time_only || epoch.point->height_held ||
        reference_age(*corrections.reference) > corrections.float_timeout)
        return;
    const bool may_fix = corrections.at_most == CorrectionState::rtk_fixed &&
                         reference_age(*corrections.reference) <= corrections.fixed_timeout;
    carrier_ = baseline_.solve({time_, observations, *corrections.reference, epoch.point->position, usable_, may_fix},
                               transmitters());
    if (carrier_) corrected_ = carrier_->fixed ? CorrectionState::rtk_fixed : CorrectionState::rtk_float;
}

std::optional<RelativePosition> NavigationEngine::State::relate(const Observations& observations,
                                                                const ReferenceStation& base) {
    if (!position_ || usable_.empty()) return std::nullopt;
    pair_.remember(time_, observations, usable_, *position_);
    return pair_.solve(base, transmitters());
}

// From a base that moves the vector alone is exact: the place stays as good as this receiver's own.
void NavigationEngine::State::solve_vector(const Observations& observations, const Corrections& corrections, Fix& fix) {
    relative_.reset();
    if (!fix.has_position() || !corrections.reference || corrections.at_most < CorrectionState::rtk_float) return;
    const ReferenceStation& reference = *corrections.reference;
    if (carrier_) relative_ = relative_position(*carrier_, reference);
    if (!reference.moves) return;
    relative_ = relate(observations, reference);
    fix.type = pair_.type_at(time_).value_or(fix.type);
}

Fix NavigationEngine::State::solve(const Observations& observations, const ReceiverSettings& settings) {
    begin(settings, observations.receive_time);
    const bool smooths = parameters_.filter.code_smoothing > Seconds(0);
    Observations smoothed = smooths ? observations : Observations();
    smoother_.smooth(smoothed);
    const CorrectionState before = corrected_;
    const EpochSolution epoch = solve_epoch(smooths ? smoothed : observations, settings);
    // Old solutions with errors of another size must not stay in the filter.
    if (corrected_ != before) filter_.reset();
    Fix fix;
    fix.time = time_;
    fix.leap_seconds = knowledge_.leap_seconds.offset(time_);
    maker_.solved(epoch.point && !epoch.point->height_held && epoch.point->dop.pdop <= soundest_pdop);
    if (epoch.point) {
        fill_solved(epoch, settings, fix);
        clock_known_at_ = observations.receive_time;
        clock_bias_ = epoch.point->clock();
        clock_drift_ = fix.clock_drift;
        velocity_known_ = epoch.velocity.has_value();
        if (!epoch.time_only) position_ = epoch.point->position;
    } else {
        fill_coasting(settings, fix);
        if (fix.type == FixType::none) noise_.reset();
    }
    solve_vector(observations, settings.corrections, fix);
    // What is carried on is carried on from the last solution.
    if (epoch.point || fix.type == FixType::none) last_ = fix;
    const auto place = epoch.time_only ? std::optional(to_ecef(*parameters_.fixed_position)) : position_;
    fix.satellites =
        report_.list({observations, time_, place, epoch.equations, epoch.point ? &epoch.point->ranges : nullptr});
    for (SatelliteStatus& s : fix.satellites)
        s.used = s.used && !fix.withheld;
    return fix;
}

NavigationEngine::NavigationEngine(const NavigationParameters& parameters, const NavigationKnowledge& knowledge)
    : state_(std::make_unique<State>(parameters, knowledge)) {}
NavigationEngine::~NavigationEngine() = default;
NavigationEngine::NavigationEngine(NavigationEngine&&) noexcept = default;
NavigationEngine& NavigationEngine::operator=(NavigationEngine&&) noexcept = default;

Fix NavigationEngine::solve(const Observations& observations, const ReceiverSettings& settings) {
    return state_->solve(observations, settings);
}
void NavigationEngine::hear(std::span<const Subframe> messages, const ReceiverSettings& settings) {
    state_->hear(messages, settings);
}
bool NavigationEngine::velocity_known() const { return state_->velocity_known(); }
std::optional<RelativePosition> NavigationEngine::relate(const Observations& observations,
                                                         const ReferenceStation& base) {
    return state_->relate(observations, base);
}
std::optional<FixType> NavigationEngine::pair_type() const { return state_->pair_type(); }
const std::optional<RelativePosition>& NavigationEngine::relative() const { return state_->relative(); }

}  // namespace skyloop::inline receiver
