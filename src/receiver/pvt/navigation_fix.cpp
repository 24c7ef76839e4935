// The fix that is told of what was solved.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/geo/local_frame.hpp"
#include "detail/navigation_engine_state.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr double coasting_acceleration = 1;  // m/s², by which a lost fix may have left its course

}  // namespace

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
    ExpectedError expected = left ? expected_error_left(point, parameters_, air_.at(to_geodetic(point.position), time_))
                                  : expected_error(point, parameters_.accuracy);
    fix.time_accuracy = Metres(std::sqrt(expected.clock));
    if (epoch.time_only) return Metres(0);
    if (carrier_) expected.position = carrier_->covariance;
    const Eigen::Matrix3d q = in_enu(LocalFrame(fix.position), expected.position);
    const Metres floor = carrier_ ? parameters_.carrier.told_floor : Metres(0);
    const ToldAccuracy told = reference_ ? told_accuracy(q, fix.dop, floor, *reference_, parameters_.carrier)
                                         : told_accuracy(q, fix.dop, kind, parameters_.differential);
    fix.horizontal_accuracy = told.horizontal;
    fix.vertical_accuracy = told.vertical;
    fix.speed_accuracy = told_speed_accuracy(epoch.velocity, parameters_.accuracy);
    fix.course_accuracy = told_course_accuracy(fix.speed, fix.speed_accuracy);
    fix.correlation = error_correlation(expected, epoch.velocity, fix.position);
    return Metres(std::sqrt(q(2, 2)));
}

bool NavigationEngine::State::is_augmented(const EpochSolution& epoch) const {
    constexpr int enough = 4;  // augmented ranges for a position of their own
    int augmented = 0;
    for (std::size_t i = 0; i < epoch.equations.size(); ++i)
        augmented += epoch.equations[i].sbas && epoch.point->ranges[i].used ? 1 : 0;
    return augmented >= enough;
}

FixType NavigationEngine::State::type_of(const EpochSolution& epoch) const {
    if (epoch.point->height_held) return FixType::fix_2d;
    static constexpr std::array differential{FixType::fix_3d, FixType::dgnss, FixType::rtk_float, FixType::rtk_fixed};
    const FixType type = differential[static_cast<std::size_t>(differential_kind())];
    return type == FixType::fix_3d && is_augmented(epoch) ? FixType::dgnss : type;
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
    const Position<Ecef> position = carrier_ ? carrier_->position : point.position;
    filtered.position = position;
    if (epoch.velocity) filtered.velocity = epoch.velocity->velocity;
    if (parameters_.filter.kind == FilterKind::smoothed) {
        const Metres deviation(std::max(1.0, noise_.average()) * std::sqrt(point.covariance.trace()));
        PositionInput input{time_, position, deviation, std::nullopt, {}};
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
    if (fix.type == FixType::dgnss && is_augmented(epoch)) fix.sbas_source = augmentation_.source();
    const Metres height_deviation = fill_accuracy(epoch, fix);
    if (point.height_held) return;
    const MetresPerSecond rate(std::hypot(fix.velocity.down, fix.speed_accuracy.value()));
    height_ = LastHeight{{to_geodetic(position).height, height_deviation}, time_, rate};
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

DifferentialKind NavigationEngine::State::differential_kind() const {
    return corrected_ == CorrectionState::none ? parameters_.differential.kind
                                               : static_cast<DifferentialKind>(corrected_);
}

}  // namespace skyloop::inline receiver
