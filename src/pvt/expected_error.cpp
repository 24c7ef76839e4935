#include "skyloop/pvt/expected_error.hpp"

#include <cmath>
#include <initializer_list>

#include "skyloop/gnss/thin_shell.hpp"

namespace skyloop {
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
        const double delay = r.ionosphere.value();
        const double away = gradient_arm(r.direction.elevation);
        ionosphere.add(r, parameters.ionosphere_share * delay);
        north.add(r, parameters.ionosphere_tilt * delay * away * std::cos(r.direction.azimuth.rad()));
        east.add(r, parameters.ionosphere_tilt * delay * away * std::sin(r.direction.azimuth.rad()));
        troposphere.add(r, parameters.troposphere_share * r.troposphere.value());
    }
    ExpectedError expected{solution.covariance, solution.clock_variance};
    for (const SharedError& e : {ionosphere, north, east, troposphere}) {
        expected.position += e.position * e.position.transpose();
        expected.clock += e.clock * e.clock;
    }
    return expected;
}

}  // namespace skyloop
