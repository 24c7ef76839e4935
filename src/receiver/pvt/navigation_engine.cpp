#include "receiver/pvt/navigation_engine.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/geo/local_frame.hpp"
#include "receiver/pvt/equation_maker.hpp"
#include "receiver/pvt/expected_error.hpp"
#include "receiver/pvt/integrity.hpp"
#include "receiver/pvt/motion_check.hpp"
#include "receiver/pvt/observation_equations.hpp"
#include "receiver/pvt/position_filter.hpp"
#include "receiver/pvt/satellite_report.hpp"
#include "receiver/pvt/single_point.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr double coasting_acceleration = 1;  // m/s², by which a lost fix may have left its course

// Two carriers are of use even where no group delay is broadcast.
UntoldDelay untold_delay(const CorrectionParameters& parameters) {
    const bool two_carriers = parameters.ionosphere_free || parameters.ionosphere_memory > Seconds(0);
    return two_carriers ? UntoldDelay::none : UntoldDelay::unknown;
}

GpsTime whole_millisecond(GpsTime time) { return std::chrono::round<std::chrono::milliseconds>(time); }

// What was made of one epoch before the filter.
struct EpochSolution : EpochEquations {
    std::optional<SinglePoint> point;
    std::optional<SinglePointVelocity> velocity;
    ResidualTest test;
    bool time_only = false;
};

}  // namespace

class NavigationEngine::State {
public:
    State(const NavigationParameters& parameters, const NavigationKnowledge& knowledge)
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
          maker_(parameters),
          noise_(parameters.filter.kind),
          position_(knowledge.last_place) {}

    Fix solve(const Observations& observations, const ReceiverSettings& settings);
    [[nodiscard]] bool velocity_known() const { return velocity_known_; }

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
    void fill_solved(const EpochSolution& epoch, const ReceiverSettings& settings, Fix& fix);
    void fill_motion(const FilteredPosition& filtered, const ReceiverSettings& settings, Fix& fix);
    Metres fill_accuracy(const EpochSolution& epoch, Fix& fix);
    void fill_coasting(const ReceiverSettings& settings, Fix& fix);
    void begin_regime(CorrectionState state);
    Observations prepared(const Observations& observations, const ReceiverSettings& settings);
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
    EquationMaker maker_;
    MotionCheck motion_;
    NoiseScale noise_;

    std::optional<int> restarts_;
    GpsTime time_;                           // true, as well as the receiver can tell
    std::optional<GpsTime> clock_known_at_;  // receiver's reading at the last solution
    Metres clock_bias_;
    MetresPerSecond clock_drift_;
    std::optional<Position<Ecef>> position_;  // the last one
    std::optional<LastHeight> height_;
    Angle course_;
    bool velocity_known_ = false;                        // of the last solution
    CorrectionState corrected_ = CorrectionState::none;  // by a base station, this epoch
    Fix last_;
};

// A restart, and the very first start.
void NavigationEngine::State::begin(const ReceiverSettings& settings, GpsTime time) {
    if (restarts_ == settings.restarts) return;
    restarts_ = settings.restarts;
    received_.restart(settings.start, time);
    filter_.reset();
    smoother_.reset();
    report_.reset();
    maker_.reset();
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
    // Records change at whole epochs: the second look is for a clock that was farther off than expected.
    for (int look = 0; look < 2; ++look) {
        received_.listen(observations, time_);
        epoch = EpochSolution();
        if (!received_.time_known()) return epoch;
        transmitters_.choose_records_at(time_);
        const bool corrected = corrected_ != CorrectionState::none;
        const auto place = position_ ? std::optional(to_geodetic(*position_)) : std::nullopt;
        static_cast<EpochEquations&>(epoch) = maker_.make(transmitters(), observations, settings, place, corrected);
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
    return epoch;
}

bool NavigationEngine::State::plausible(const FilteredPosition& filtered, const ReceiverSettings& settings) {
    if (parameters_.filter.kind == FilterKind::none) return true;
    const Geodetic place = to_geodetic(filtered.position);
    const Metres height = above_sea_level(place.height, reported_undulation(place)).above_sea_level;
    return motion_.passes(motion_limits(settings), time_, height, LocalFrame(place).to_enu(filtered.velocity).vector());
}

void NavigationEngine::State::fill_motion(const FilteredPosition& filtered, const ReceiverSettings& settings,
                                          Fix& fix) {
    fix.position = to_geodetic(filtered.position);
    fix.geoid_undulation = reported_undulation(fix.position);
    const Eigen::Vector3d v = LocalFrame(fix.position).to_enu(filtered.velocity).vector();
    fix.velocity = {v.y(), v.x(), -v.z()};
    fix.speed = MetresPerSecond(std::hypot(v.x(), v.y()));
    if (fix.speed >= settings.course_held_below) course_ = course_of(fix.velocity);
    fix.course = course_;
}

// Returns 1 σ of the height, whatever the receiver reports.
Metres NavigationEngine::State::fill_accuracy(const EpochSolution& epoch, Fix& fix) {
    const double scale = parameters_.accuracy.position_scale * noise_.of(*epoch.point, epoch.test, time_);
    const SinglePoint point = with_noise(*epoch.point, scale);
    const bool left = corrected_ == CorrectionState::none && leaves_delays(parameters_);
    const bool augmented = left && differential_kind() == DifferentialKind::sbas;
    const DifferentialKind kind = augmented ? DifferentialKind::none : differential_kind();
    const ExpectedError expected =
        left ? expected_error_left(point, parameters_, air_.at(to_geodetic(point.position), time_))
             : expected_error(point, parameters_.accuracy);
    fix.time_accuracy = Metres(std::sqrt(expected.clock));
    if (epoch.time_only) return Metres(0);
    const Eigen::Matrix3d q = in_enu(LocalFrame(fix.position), expected.position);
    const ToldAccuracy told = told_accuracy(q, fix.dop, kind, parameters_.differential);
    fix.horizontal_accuracy = told.horizontal;
    fix.vertical_accuracy = told.vertical;
    fix.speed_accuracy = told_speed_accuracy(epoch.velocity, parameters_.accuracy);
    fix.course_accuracy = told_course_accuracy(fix.speed, fix.speed_accuracy);
    fix.correlation = error_correlation(expected, epoch.velocity, fix.position);
    return Metres(std::sqrt(q(2, 2)));
}

FixType NavigationEngine::State::type_of(const EpochSolution& epoch) const {
    if (epoch.point->height_held) return FixType::fix_2d;
    static constexpr std::array differential{FixType::fix_3d, FixType::dgnss, FixType::rtk_float, FixType::rtk_fixed};
    const FixType type = differential[static_cast<std::size_t>(differential_kind())];
    constexpr int enough = 4;  // augmented ranges for a position of their own
    int augmented = 0;
    for (std::size_t i = 0; i < epoch.equations.size(); ++i)
        augmented += epoch.equations[i].augmented && epoch.point->ranges[i].used ? 1 : 0;
    return type == FixType::fix_3d && augmented >= enough ? FixType::dgnss : type;
}

void NavigationEngine::State::fill_solved(const EpochSolution& epoch, const ReceiverSettings& settings, Fix& fix) {
    const SinglePoint& point = *epoch.point;
    fix.clock_bias = point.clock();
    if (epoch.velocity) fix.clock_drift = epoch.velocity->clock_drift;
    fix.dop = point.dop;
    if (epoch.time_only) {
        fix.type = FixType::time_only;
        fill_accuracy(epoch, fix);
        return;
    }
    FilteredPosition filtered;
    filtered.position = point.position;
    if (epoch.velocity) filtered.velocity = epoch.velocity->velocity;
    if (parameters_.filter.kind == FilterKind::smoothed) {
        const Metres deviation(std::max(1.0, noise_.average()) * std::sqrt(point.covariance.trace()));
        PositionInput input{time_, point.position, deviation, std::nullopt, {}};
        if (epoch.velocity) {
            input.velocity = epoch.velocity->velocity;
            input.velocity_deviation = MetresPerSecond(std::sqrt(epoch.velocity->covariance.trace()));
        }
        // Carrier phases need no filter, which would only add the noise of the velocity.
        if (differential_kind() >= DifferentialKind::rtk_float) filter_.reset();
        filtered = filter_.update(input, settings);
    }
    if (!plausible(filtered, settings)) {
        filter_.reset();
        fix.withheld = true;
        return;
    }
    fill_motion(filtered, settings, fix);
    fix.type = type_of(epoch);
    const Metres height_deviation = fill_accuracy(epoch, fix);
    if (point.height_held) return;
    const MetresPerSecond rate(std::hypot(fix.velocity.down, fix.speed_accuracy.value()));
    height_ = LastHeight{{to_geodetic(point.position).height, height_deviation}, time_, rate};
}

void NavigationEngine::State::fill_coasting(const ReceiverSettings& settings, Fix& fix) {
    if (parameters_.filter.kind == FilterKind::none || !last_.has_position()) return;
    const std::optional<FilteredPosition> carried = filter_.coast(time_);
    if (!carried) return;
    Fix coasting = last_;
    coasting.time = fix.time;
    coasting.leap_seconds = fix.leap_seconds;
    coasting.satellites.clear();
    coasting.type = FixType::dead_reckoning;
    fill_motion(*carried, settings, coasting);
    const double t = carried->coasted.value();
    const double left = last_.speed_accuracy.value() * t + coasting_acceleration * t * t / 2;
    coasting.horizontal_accuracy = Metres(std::hypot(last_.horizontal_accuracy.value(), left));
    coasting.vertical_accuracy = Metres(std::hypot(last_.vertical_accuracy.value(), left));
    coasting.speed_accuracy = last_.speed_accuracy + MetresPerSecond(coasting_acceleration * t);
    coasting.clock_bias = clock_bias_ + Metres(clock_drift_.value() * t);
    fix = std::move(coasting);
}

// Old solutions with errors of another size must not stay in the filter; carrier phases need none.
void NavigationEngine::State::begin_regime(CorrectionState state) {
    if (state != corrected_ || state >= CorrectionState::rtk_float) filter_.reset();
    corrected_ = state;
}

Observations NavigationEngine::State::prepared(const Observations& observations, const ReceiverSettings& settings) {
    Observations result = observations;
    if (parameters_.filter.code_smoothing > Seconds(0)) smoother_.smooth(result);
    begin_regime(correct(result, settings.corrections));
    return result;
}

DifferentialKind NavigationEngine::State::differential_kind() const {
    return corrected_ == CorrectionState::none ? parameters_.differential.kind
                                               : static_cast<DifferentialKind>(corrected_);
}

Fix NavigationEngine::State::solve(const Observations& observations, const ReceiverSettings& settings) {
    begin(settings, observations.receive_time);
    const bool changed =
        parameters_.filter.code_smoothing > Seconds(0) || settings.corrections != CorrectionState::none;
    const Observations own = changed ? prepared(observations, settings) : Observations();
    if (!changed) begin_regime(CorrectionState::none);
    const EpochSolution epoch = solve_epoch(changed ? own : observations, settings);
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
bool NavigationEngine::velocity_known() const { return state_->velocity_known(); }

}  // namespace skyloop::inline receiver
