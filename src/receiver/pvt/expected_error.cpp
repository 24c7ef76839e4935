#include "receiver/pvt/expected_error.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "world/gnss/constants.hpp"
#include "world/gnss/shell_ionosphere.hpp"

namespace skyloop::inline receiver {
namespace {

// What one unit of an error that all satellites share does to the solution.
struct SharedError {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double clock = 0;

    void add(const RangeOutcome& range, double metres) {
        position += metres * range.position_gain;
        clock += metres * range.clock_gain;
    }
};

}  // namespace

ExpectedError expected_error(const SinglePoint& solution, const AccuracyParameters& parameters) {
    SharedError ionosphere, north, east, troposphere;
    for (const RangeOutcome& r : solution.ranges) {
        if (!r.used) continue;
        const double delay = solution.ionosphere_doubt * r.ionosphere.value();
        const double away = gradient_arm(r.direction.elevation);
        ionosphere.add(r, parameters.ionosphere_share * delay + parameters.grid_share * r.grid.value());
        north.add(r, parameters.ionosphere_tilt * delay * away * std::cos(r.direction.azimuth.rad()));
        east.add(r, parameters.ionosphere_tilt * delay * away * std::sin(r.direction.azimuth.rad()));
        troposphere.add(r, parameters.troposphere_share * r.troposphere.value());
    }
    ExpectedError expected{solution.covariance, solution.clock_variance, solution.position_clock};
    for (const SharedError& e : {ionosphere, north, east, troposphere}) {
        expected.position += e.position * e.position.transpose();
        expected.clock += e.clock * e.clock;
        expected.position_clock += e.clock * e.position;
    }
    return expected;
}

double NoiseScale::of(const SinglePoint& solution, const ResidualTest& test, GpsTime time) {
    constexpr double averaged_over_s = 20, doubted_after_s = 3, believed_after_s = 10;
    constexpr double least = 0.3, most = 10, most_of_all = 50;
    // Of a held height the residuals say nothing.
    if (solution.redundancy <= 0 || solution.height_held) return 1;
    const double seen = std::clamp(std::sqrt(solution.statistic / solution.redundancy), least, most);
    const double of_all = std::clamp(test.of_all, seen, most_of_all);
    if (!since_) since_ = last_ = time;
    const double dt = std::max(difference(time, last_).value(), 0.0);
    const auto fresh = [dt](double over_s) { return -std::expm1(-dt / over_s); };
    average_ += fresh(averaged_over_s) * (seen - average_);
    of_all_ += fresh(of_all > of_all_ ? doubted_after_s : averaged_over_s) * (of_all - of_all_);
    last_ = time;
    const double scale = std::max({average_, of_all_, test.consistent ? 0 : seen});
    if (filter_ == FilterKind::none) return scale;
    return scale * std::sqrt(1 + 4 * std::exp(-difference(time, *since_).value() / believed_after_s));
}

SinglePoint with_noise(SinglePoint solution, double scale) {
    solution.covariance *= scale * scale;
    solution.clock_variance *= scale * scale;
    solution.position_clock *= scale * scale;
    return solution;
}

bool leaves_delays(const NavigationParameters& parameters) {
    return parameters.differential.kind == DifferentialKind::sbas || parameters.accuracy.whole_ionosphere ||
           parameters.accuracy.whole_troposphere;
}

ExpectedError expected_error_left(SinglePoint solution, const NavigationParameters& parameters,
                                  const SiteCorrections& air) {
    AccuracyParameters accuracy = parameters.accuracy;
    const bool augmented = parameters.differential.kind == DifferentialKind::sbas;
    const double left = augmented ? parameters.differential.sbas_left : 1;
    if (augmented || accuracy.whole_ionosphere) {
        accuracy.ionosphere_share = 1;
        for (RangeOutcome& r : solution.ranges)
            if (r.carrier > Hertz(0)) r.ionosphere = left * air.ionosphere(Constellation::gps, r.direction, r.carrier);
    }
    if (accuracy.whole_troposphere) {
        accuracy.troposphere_share = 1;
        for (RangeOutcome& r : solution.ranges)
            r.troposphere = air.troposphere(r.direction.elevation);
    }
    // Better orbits and clocks are less noise; what the satellites share is as large as it is.
    if (augmented) {
        solution.covariance *= parameters.differential.sbas_scale * parameters.differential.sbas_scale;
        solution.position_clock *= parameters.differential.sbas_scale;
    }
    return expected_error(solution, accuracy);
}

ErrorCorrelation error_correlation(const ExpectedError& expected, const std::optional<SinglePointVelocity>& velocity,
                                   const Geodetic& place) {
    const LocalFrame frame(place);
    Eigen::Matrix4d covariance;
    covariance.topLeftCorner<3, 3>() = in_enu(frame, expected.position);
    covariance.topRightCorner<3, 1>() = frame.to_enu(Displacement<Ecef>(expected.position_clock)).vector();
    covariance.bottomLeftCorner<1, 3>() = covariance.topRightCorner<3, 1>().transpose();
    covariance(3, 3) = expected.clock;
    ErrorCorrelation correlation;
    correlation.position_clock = correlation_of(covariance);
    if (velocity) correlation.velocity = correlation_of(in_enu(frame, velocity->covariance));
    return correlation;
}

MetresPerSecond told_speed_accuracy(const std::optional<SinglePointVelocity>& velocity,
                                    const AccuracyParameters& parameters) {
    constexpr MetresPerSecond not_solved{20};  // as u-blox tells it before the first fix
    if (!velocity) return not_solved;
    return MetresPerSecond(parameters.velocity_scale * std::sqrt(velocity->covariance.trace()));
}

Angle told_course_accuracy(MetresPerSecond speed, MetresPerSecond speed_accuracy) {
    const double turn = speed.value() > 0 ? speed_accuracy.value() / speed.value() : std::numbers::pi;
    return Angle::radians(std::min(turn, std::numbers::pi));
}

ToldAccuracy told_accuracy(const Eigen::Matrix3d& covariance, const Dop& dop, Metres floor,
                           const ReferenceSpacing& reference, const CarrierParameters& parameters) {
    const double apart = parameters.told_per_length * reference.length.value();
    const double old = parameters.per_age.value() * reference.age.value();
    const double of_ranges = floor.value() * floor.value() + apart * apart;
    const auto told = [&](double variance, double dilution) {
        return Metres(std::sqrt(variance + dilution * dilution * of_ranges + old * old));
    };
    return {told(covariance(0, 0) + covariance(1, 1), dop.hdop), told(covariance(2, 2), dop.vdop)};
}

ToldAccuracy told_accuracy(const Eigen::Matrix3d& covariance, const Dop& dop, DifferentialKind kind,
                           const DifferentialParameters& parameters) {
    if (kind == DifferentialKind::rtk_float || kind == DifferentialKind::rtk_fixed) {
        const Metres good = kind == DifferentialKind::rtk_fixed ? parameters.fixed_accuracy : parameters.float_accuracy;
        return {good * std::max(1.0, dop.hdop), good * std::max(parameters.vertical_proportion, dop.vdop)};
    }
    const double scale = kind == DifferentialKind::sbas ? parameters.sbas_scale : 1;
    return {Metres(scale * std::sqrt(covariance(0, 0) + covariance(1, 1))),
            Metres(scale * std::sqrt(covariance(2, 2)))};
}

}  // namespace skyloop::inline receiver
