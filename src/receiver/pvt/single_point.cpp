#include "receiver/pvt/single_point.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/geo/local_frame.hpp"
#include "detail/dilution.hpp"
#include "detail/measured_delays.hpp"
#include "detail/normal_equations.hpp"
#include "detail/square.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline receiver {
namespace {

// Steps shrink with their square over the satellites' distance: after this one 1e-9 m are left.
constexpr double converged_m = 1e-3;
// The first steps go without corrections, until the place is known well enough for directions.
constexpr double near_m = 1000;
// A correction changes by at most some 3e-3 of the way that the receiver moves.
constexpr double correction_reach_m = 2e-4;
// Of the residuals' deviation: corrections need not be finer than noise.
constexpr double noise_reach = 0.02;
constexpr double weight_reach_m = 100;
constexpr int most_steps = 20;
constexpr int most_passes = 8;
// Passes after which the mask decides no more, lest a satellite on its edge come and go.
constexpr int masking_passes = 3;
constexpr double farthest_m = 1e8;

using Eigen::Matrix3d;
using Eigen::Vector3d;

double orbit_deviation(const WeightParameters& weights, Constellation constellation) {
    if (constellation == Constellation::beidou) return weights.beidou_orbits.value();
    if (constellation == Constellation::glonass) return weights.glonass_orbits.value();
    return 0;
}

struct RangeWork {
    Vector3d transmission;  // satellite, in the frame of transmission
    Vector3d satellite;     // the same in the frame of reception
    Vector3d line;
    double travel_s = 0;
    double observed = 0;  // corrected pseudorange + c·satellite clock
    double misfit = 0;    // observed − computed, the receiver's clock in it
    double weight = 0;    // 1/m²; 0: not used
    std::size_t clock = 0;
    SkyDirection direction;
    double code_variance = 0;        // of echoes, s0² + s1²/sin² e
    Metres ionosphere, troposphere;  // taken off
    double ionosphere_variance = 0;  // of what was measured of it
};

// The satellites of one clock.
struct ClockMean {
    int count = 0;
    double weight = 0;
    Vector3d row = Vector3d::Zero();  // weighted mean of −line
    double misfit = 0;                // weighted mean
};
using ClockMeans = std::array<ClockMean, clock_count>;

Vector3d up_at(const Geodetic& place) {
    const double cos_lat = std::cos(place.latitude.rad());
    return {cos_lat * std::cos(place.longitude.rad()), cos_lat * std::sin(place.longitude.rad()),
            std::sin(place.latitude.rad())};
}

// One epoch on its way to a solution.
class Adjustment {
public:
    Adjustment(std::span<const RangeEquation> equations, const SinglePointSetup& setup)
        : equations_(equations), setup_(setup), work_(equations.size()) {
        if (setup.start) position_ = setup.start->vector();
        for (std::size_t i = 0; i < equations.size(); ++i) {
            work_[i].transmission = equations[i].transmitter.position.vector();
            work_[i].clock = clock_of(equations[i].satellite.constellation);
            work_[i].observed =
                equations[i].pseudorange.value() + speed_of_light * equations[i].transmitter.clock_bias.value();
            work_[i].weight = believed(equations[i]) ? 1 : 0;
        }
    }

    // Brings the position near, from wherever it starts.
    bool approach() {
        for (int i = 0; i < most_steps; ++i) {
            const std::optional<double> step = improve();
            if (!step) return false;
            if (*step < near_m) return true;
        }
        return false;
    }

    // Corrects, weighs and solves until nothing moves.
    bool refine() {
        for (int pass = 0; pass < most_passes; ++pass) {
            const Vector3d before = position_;
            correct(pass < masking_passes);
            double step = near_m;
            for (int i = 0; i < most_steps && step >= converged_m; ++i) {
                const std::optional<double> moved_by = improve();
                if (!moved_by) return false;
                step = *moved_by;
            }
            if (step >= converged_m) return false;
            const double reach =
                setup_.corrections ? std::max(correction_reach_m, noise_reach * misfit_deviation()) : weight_reach_m;
            if ((position_ - before).norm() < reach) break;
        }
        return true;
    }

    void correct(bool mask);
    [[nodiscard]] std::optional<SinglePoint> result(bool position_known);

private:
    static bool believed(const RangeEquation& e) {
        return e.selected && !e.excluded && e.transmitter.healthy && std::isfinite(e.pseudorange.value());
    }
    void look();
    void correct_air();
    void take_measured_ionosphere();
    [[nodiscard]] ClockMeans means() const;
    [[nodiscard]] double misfit_deviation();
    [[nodiscard]] NormalEquations normal_equations(const ClockMeans& clocks) const;
    std::optional<double> improve();
    void tell_ranges(const ClockMeans& clocks, SinglePoint& solution) const;

    std::span<const RangeEquation> equations_;
    const SinglePointSetup& setup_;
    std::vector<RangeWork> work_;
    Vector3d position_ = Vector3d::Zero();
    double ionosphere_doubt_ = 1;
};

// Where the satellites are from the present position.
void Adjustment::look() {
    for (RangeWork& w : work_) {
        if (w.travel_s == 0) {
            w.travel_s = (w.transmission - position_).norm() / speed_of_light;
            w.travel_s = (turned_by(w.transmission, w.travel_s) - position_).norm() / speed_of_light;
        }
        w.satellite = turned_by(w.transmission, w.travel_s);
        // The travel time of the last look may be that of another place.
        const double late = (w.satellite - position_).norm() / speed_of_light - w.travel_s;
        w.satellite += late * earth_rotation_rate * Vector3d(w.satellite.y(), -w.satellite.x(), 0);
        const Vector3d way = w.satellite - position_;
        const double range = way.norm();
        w.travel_s = range / speed_of_light;
        w.line = way / range;
        w.misfit = w.observed - range;
    }
}

ClockMeans Adjustment::means() const {
    ClockMeans clocks;
    for (const RangeWork& w : work_) {
        if (w.weight == 0) continue;
        ClockMean& c = clocks[w.clock];
        ++c.count;
        c.weight += w.weight;
        c.row -= w.weight * w.line;
        c.misfit += w.weight * w.misfit;
    }
    for (ClockMean& c : clocks) {
        if (c.count == 0) continue;
        c.row /= c.weight;
        c.misfit /= c.weight;
    }
    return clocks;
}

// Of the ranges about their clocks, m.
double Adjustment::misfit_deviation() {
    look();
    const ClockMeans clocks = means();
    double sum = 0;
    int count = 0;
    for (const RangeWork& w : work_) {
        if (w.weight == 0) continue;
        const double misfit = w.misfit - clocks[w.clock].misfit;
        sum += misfit * misfit;
        ++count;
    }
    return count > 0 ? std::sqrt(sum / count) : 0;
}

NormalEquations Adjustment::normal_equations(const ClockMeans& clocks) const {
    NormalEquations n;
    for (const RangeWork& w : work_) {
        if (w.weight == 0 || clocks[w.clock].count < 2) continue;
        const Vector3d row = -w.line - clocks[w.clock].row;
        n.matrix.noalias() += w.weight * row * row.transpose();
        n.right += w.weight * (w.misfit - clocks[w.clock].misfit) * row;
    }
    if (setup_.held_height) {
        const Geodetic place = to_geodetic(Position<Ecef>(position_));
        const Vector3d up = up_at(place);
        const double low = (setup_.held_height->height.above_ellipsoid - place.height.above_ellipsoid).value();
        const double variance = setup_.held_height->deviation.value() * setup_.held_height->deviation.value();
        n.matrix.noalias() += up * up.transpose() / variance;
        n.right += up * low / variance;
    }
    return n;
}

// One step of Gauss and Newton. Returns its length.
std::optional<double> Adjustment::improve() {
    look();
    const ClockMeans clocks = means();
    int redundancy = setup_.held_height ? -2 : -3;
    for (const ClockMean& c : clocks)
        if (c.count >= 2) redundancy += c.count - 1;
    if (redundancy < 0) return std::nullopt;
    const NormalEquations n = normal_equations(clocks);
    const std::optional<Matrix3d> inverse = inverse_of(n.matrix);
    if (!inverse) return std::nullopt;
    const Vector3d step = *inverse * n.right;
    position_ += step;
    if (!(position_.norm() < farthest_m)) return std::nullopt;
    return step.norm();
}

// Directions, and what the models say of the air there.
void Adjustment::correct_air() {
    look();
    const LocalFrame frame(to_geodetic(Position<Ecef>(position_)));
    std::optional<SiteCorrections> site;
    if (setup_.corrections) site.emplace(setup_.corrections->at(frame.origin(), setup_.time));
    for (std::size_t i = 0; i < work_.size(); ++i) {
        const RangeEquation& e = equations_[i];
        RangeWork& w = work_[i];
        const LookAngles look = frame.look_angles(Position<Ecef>(w.satellite));
        w.direction = {look.azimuth, look.elevation};
        w.code_variance = square(setup_.weights.floor.value()) +
                          square(setup_.weights.at_zenith.value() / std::max(std::sin(look.elevation.rad()), 0.02));
        if (!site) continue;
        w.troposphere = site->troposphere(look.elevation);
        if (e.carrier > Hertz(0)) w.ionosphere = site->ionosphere(e.satellite.constellation, w.direction, e.carrier);
    }
    const bool measured = std::any_of(equations_.begin(), equations_.end(), [](const auto& e) { return e.ionosphere; });
    if (site && measured) take_measured_ionosphere();
}

void Adjustment::take_measured_ionosphere() {
    std::vector<WeighedDelay> delays;
    for (std::size_t i = 0; i < work_.size(); ++i)
        if (work_[i].ionosphere > Metres(0))
            delays.push_back({work_[i].ionosphere.value(), square(setup_.noise) * work_[i].code_variance,
                              equations_[i].ionosphere, 0, i});
    ionosphere_doubt_ = weigh_measured_delays(delays);
    for (const WeighedDelay& d : delays) {
        work_[d.index].ionosphere = Metres(d.delay);
        work_[d.index].ionosphere_variance = d.variance;
    }
}

void Adjustment::correct(bool mask) {
    correct_air();
    for (std::size_t i = 0; i < work_.size(); ++i) {
        const RangeEquation& e = equations_[i];
        RangeWork& w = work_[i];
        const double delay = (w.troposphere + w.ionosphere).value();
        // The signal left later than the delayed pseudorange says.
        w.transmission = e.transmitter.position.vector() + delay / speed_of_light * e.transmitter.velocity.vector();
        w.observed =
            e.pseudorange.value() - delay +
            speed_of_light * (e.transmitter.clock_bias.value() + e.transmitter.clock_drift * delay / speed_of_light);
        if (mask) w.weight = believed(e) && w.direction.elevation >= setup_.elevation_mask ? 1 : 0;
        if (w.weight == 0) continue;
        const double orbits = orbit_deviation(setup_.weights, e.satellite.constellation);
        const double variance =
            w.code_variance + orbits * orbits + e.deviation.value() * e.deviation.value() + w.ionosphere_variance;
        w.weight = 1 / std::max(variance, 1e-6);
    }
}

void Adjustment::tell_ranges(const ClockMeans& clocks, SinglePoint& solution) const {
    for (const RangeWork& w : work_) {
        RangeOutcome r;
        const ClockMean& c = clocks[w.clock];
        r.direction = w.direction;
        r.line = w.line;
        r.satellite = Position<Ecef>(w.satellite);
        const RangeEquation& e = equations_[solution.ranges.size()];
        r.satellite_velocity = Velocity<Ecef>(turned_by(e.transmitter.velocity.vector(), w.travel_s));
        r.used = w.weight > 0 && solution.clocks[w.clock].has_value();
        if (solution.clocks[w.clock]) r.residual = Metres(w.misfit - c.misfit);
        r.carrier = e.carrier;
        r.ionosphere = w.ionosphere;
        r.grid = e.grid;
        r.troposphere = w.troposphere;
        if (r.used) {
            const Vector3d row = -w.line - c.row;
            r.variance = 1 / w.weight;
            r.position_gain = w.weight * (solution.covariance * row);
            r.cofactor = row.dot(solution.covariance * row) + 1 / c.weight;
            r.clock_gain = -clocks[solution.reference].row.dot(r.position_gain);
            if (w.clock == solution.reference) r.clock_gain += w.weight / c.weight;
            solution.statistic += w.weight * r.residual.value() * r.residual.value();
            ++solution.used;
        }
        solution.ranges.push_back(r);
    }
}

std::optional<SinglePoint> Adjustment::result(bool position_known) {
    look();
    const ClockMeans clocks = means();
    SinglePoint s;
    s.position = Position<Ecef>(position_);
    s.height_held = setup_.held_height.has_value() && !position_known;
    int unknowns = position_known ? 0 : (s.height_held ? 2 : 3);
    for (std::size_t i = clock_count; i-- > 0;) {
        if (clocks[i].count < (position_known ? 1 : 2)) continue;
        s.clocks[i] = Metres(clocks[i].misfit);
        s.reference = i;
        ++unknowns;
    }
    if (!s.clocks[s.reference]) return std::nullopt;
    const ClockMean& reference = clocks[s.reference];
    if (!position_known) {
        const std::optional<Matrix3d> inverse = inverse_of(normal_equations(clocks).matrix);
        if (!inverse) return std::nullopt;
        s.covariance = *inverse;
    }
    s.clock_variance = 1 / reference.weight + reference.row.dot(s.covariance * reference.row);
    s.position_clock = -s.covariance * reference.row;
    s.ionosphere_doubt = ionosphere_doubt_;
    s.ranges.reserve(work_.size());
    tell_ranges(clocks, s);
    s.redundancy = s.used - unknowns;
    if (!position_known) {
        const std::optional<Dop> dop = dilution_of(equations_, s);
        if (!dop) return std::nullopt;
        s.dop = *dop;
    } else {
        s.dop.gdop = s.dop.tdop = 1 / std::sqrt(static_cast<double>(reference.count));
    }
    return s;
}

}  // namespace

std::size_t clock_of(Constellation constellation) {
    switch (constellation) {
        case Constellation::galileo:
            return 1;
        case Constellation::beidou:
            return 2;
        case Constellation::glonass:
            return 3;
        case Constellation::navic:
            return 4;
        default:
            return 0;
    }
}

std::optional<SinglePoint> solve_single_point(std::span<const RangeEquation> equations, const SinglePointSetup& setup) {
    if (setup.held_height && !setup.start) return std::nullopt;
    Adjustment adjustment(equations, setup);
    if (!adjustment.approach() || !adjustment.refine()) return std::nullopt;
    return adjustment.result(false);
}

std::optional<SinglePoint> solve_clocks(std::span<const RangeEquation> equations, const SinglePointSetup& setup) {
    if (!setup.start) return std::nullopt;
    Adjustment adjustment(equations, setup);
    adjustment.correct(true);
    return adjustment.result(true);
}

}  // namespace skyloop::inline receiver
