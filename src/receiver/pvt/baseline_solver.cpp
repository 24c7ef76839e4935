#include "receiver/pvt/baseline_solver.hpp"

#include <algorithm>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "detail/square.hpp"
#include "receiver/pvt/expected_error.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr int least_corrected = 4;

// From a place to where a satellite was when it sent.
struct Sight {
    double distance_m = 0;
    Eigen::Vector3d line;  // unit vector, ECEF of reception
    Position<Ecef> satellite;
};

Sight sight_of(const Transmitter& transmitter, const Position<Ecef>& place) {
    const Eigen::Vector3d& sent_from = transmitter.position.vector();
    Eigen::Vector3d satellite = sent_from;
    // Each look leaves 1e-6 of the error of the one before.
    for (int look = 0; look < 3; ++look)
        satellite = turned_by(sent_from, (satellite - place.vector()).norm() / speed_of_light);
    const Eigen::Vector3d way = satellite - place.vector();
    return {way.norm(), way / way.norm(), Position<Ecef>(satellite)};
}

const Observation* find_signal(const std::vector<Observation>& signals, const Observation& same) {
    const auto before = [](const Observation& a, const Observation& b) {
        return std::pair(a.satellite, a.signal) < std::pair(b.satellite, b.signal);
    };
    const auto at = std::lower_bound(signals.begin(), signals.end(), same, before);
    return at != signals.end() && at->satellite == same.satellite && at->signal == same.signal ? &*at : nullptr;
}

double phase_range(const Observation& o) { return *o.carrier_phase * speed_of_light / o.carrier.value(); }

bool has_phase(const Observation& o) { return o.pseudorange && o.carrier_phase && o.half_cycle_resolved; }

// By how much the variances of a weak signal, which echoes outdo sooner, are larger.
double weakness(DbHz cn0) {
    constexpr double strong_dbhz = 40;
    return std::pow(10, 0.1 * std::max(0.0, strong_dbhz - cn0.value()));
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// What one end sees of a satellite.
struct End {
    Sight sight;
    double clock_m = 0;  // of the satellite
    double dry_m = 0;    // delay of a standard atmosphere

    [[nodiscard]] double left_of(double range_m) const { return range_m - sight.distance_m + clock_m - dry_m; }
};

// A place with the air above it.
struct Site {
    Position<Ecef> place;
    LocalFrame frame;
    SiteCorrections air;

    Site(const Position<Ecef>& at, const RangeCorrections& corrections, GpsTime time)
        : place(at), frame(to_geodetic(at)), air(corrections.at(frame.origin(), time)) {}
    [[nodiscard]] End look(const Transmitter& transmitter) const {
        End end{sight_of(transmitter, place), speed_of_light * transmitter.clock_bias.value(), 0};
        end.dry_m = air.troposphere(elevation_of(end.sight)).value();
        return end;
    }
    [[nodiscard]] Angle elevation_of(const Sight& sight) const { return frame.look_angles(sight.satellite).elevation; }
};

// The two ends' looks at one satellite, by one of its signals.
struct BothEnds {
    End own, reference;
    Angle elevation;
};

SingleDifference difference_of(const Observation& own, const Observation& reference, const BothEnds& ends, Seconds age,
                               const CarrierParameters& parameters) {
    const double slant = 1 / std::max(std::sin(ends.elevation.rad()), 0.05);
    const double weak = weakness(own.cn0) + weakness(reference.cn0), old = parameters.per_age.value() * age.value();
    SingleDifference d;
    d.satellite = own.satellite;
    d.signal = own.signal;
    d.wavelength_m = speed_of_light / own.carrier.value();
    d.code_m = ends.own.left_of(own.pseudorange->value()) - ends.reference.left_of(reference.pseudorange->value());
    d.phase_m = ends.own.left_of(phase_range(own)) - ends.reference.left_of(phase_range(reference));
    d.line = ends.own.sight.line;
    d.elevation = ends.elevation;
    d.code_variance =
        weak * (square(parameters.code_floor.value()) + square(parameters.code_at_zenith.value() * slant)) +
        square(old);
    d.phase_variance = weak * square(parameters.phase_noise.value()) + square(old);
    d.echo_variance = weak * square(parameters.phase_echo_at_zenith.value() * slant);
    d.tracked = std::min(own.lock_time, reference.lock_time);
    d.ionosphere_factor = square(carrier_frequency(Signal::l1).value() / own.carrier.value());
    d.wet_mapping = slant;
    return d;
}

}  // namespace

int correct_codes(Observations& observations, const ReferenceStation& reference, TransmitterSource& transmitters) {
    if (!reference.position) return 0;
    std::vector<std::pair<Observation*, double>> corrections;
    std::vector<double> values;
    std::set<SatelliteId> satellites;
    for (Observation& o : observations.signals) {
        const Observation* other = find_signal(reference.epoch.signals, o);
        if (!o.pseudorange || other == nullptr || !other->pseudorange) continue;
        const auto sent = transmitters.at(o.satellite, o.signal, reference.epoch.time, *other->pseudorange);
        if (!sent) continue;
        const double distance = sight_of(*sent, *reference.position).distance_m;
        const double correction = other->pseudorange->value() - distance + speed_of_light * sent->clock_bias.value();
        corrections.emplace_back(&o, correction);
        values.push_back(correction);
        satellites.insert(o.satellite);
    }
    if (static_cast<int>(satellites.size()) < least_corrected) return static_cast<int>(satellites.size());
    const double clock = median(values);
    std::vector<Metres> corrected;
    corrected.reserve(corrections.size());
    for (const auto& [o, correction] : corrections)
        corrected.push_back(*o->pseudorange - Metres(correction - clock));
    for (Observation& o : observations.signals)
        o.pseudorange.reset();
    for (std::size_t i = 0; i < corrections.size(); ++i)
        corrections[i].first->pseudorange = corrected[i];
    return static_cast<int>(satellites.size());
}

RelativePosition relative_position(const BaselineSolution& solution, const ReferenceStation& reference) {
    const LocalFrame frame(to_geodetic(*reference.position));
    const Eigen::Vector3d enu = frame.to_enu(solution.vector).vector();
    const Eigen::Matrix3d covariance = in_enu(frame, solution.covariance);
    RelativePosition relative;
    relative.north_m = enu.y();
    relative.east_m = enu.x();
    relative.down_m = -enu.z();
    relative.deviation = Metres(std::sqrt((covariance(0, 0) + covariance(1, 1)) / 2));
    relative.down_deviation = Metres(std::sqrt(covariance(2, 2)));
    relative.base_moves = reference.moves;
    relative.fixed = solution.fixed;
    relative.base_station = reference.id;
    relative.age = solution.age;
    relative.ratio = solution.ratio;
    return relative;
}

// By the lock times that a message tells, which may be less than they are but not more.
bool BaselineSolver::reference_broke(const Observation& o, GpsTime time) {
    const auto [known, is_new] = counted_.try_emplace({o.satellite, o.signal}, Counted{time, o.lock_time});
    if (is_new) return true;
    const Counted before = known->second;
    if (time == before.time) return false;
    known->second = {time, o.lock_time};
    return o.lock_time < before.lock || o.lock_time < Seconds(0.5 * difference(time, before.time).value());
}

std::vector<SingleDifference> BaselineSolver::differences(const BaselineInput& input, TransmitterSource& transmitters) {
    const ReferenceEpoch& reference = input.reference.epoch;
    const Site here(input.place, air_, input.time), there(*input.reference.position, air_, input.time);
    const Seconds age = difference(input.time, reference.time);
    std::vector<SingleDifference> result;
    std::optional<SatelliteId> satellite;
    std::optional<BothEnds> ends;
    for (const Observation& o : input.observations.signals) {
        const Observation* other = find_signal(reference.signals, o);
        if (!input.usable.contains(o.satellite) || other == nullptr || !has_phase(o) || !has_phase(*other)) continue;
        if (satellite != o.satellite || !ends) {
            // One signal's transmitter does for all: group delays are the same at both ends.
            satellite = o.satellite;
            ends.reset();
            const auto own = transmitters.at(o.satellite, o.signal, input.observations.receive_time, *o.pseudorange);
            const auto others = transmitters.at(o.satellite, o.signal, reference.time, *other->pseudorange);
            if (!own || !others) continue;
            ends = BothEnds{here.look(*own), there.look(*others), {}};
            ends->elevation = here.elevation_of(ends->own.sight);
        }
        const GpsTime seen = std::exchange(own_[{o.satellite, o.signal}], input.time);
        SingleDifference d = difference_of(o, *other, *ends, age, parameters_);
        d.broken = reference_broke(*other, reference.time) || o.slipped || o.lock_time < difference(input.time, seen);
        d.whole = o.satellite.constellation != Constellation::glonass || input.reference.glonass_biases_known;
        result.push_back(d);
    }
    return result;
}

std::optional<BaselineSolution> BaselineSolver::solve(const BaselineInput& input, TransmitterSource& transmitters) {
    if (station_ && *station_ != input.reference.id) reset();
    station_ = input.reference.id;
    const std::vector<SingleDifference> all = differences(input, transmitters);
    const Displacement<Ecef> apart = input.place - *input.reference.position;
    const Metres height =
        to_geodetic(input.place).height.above_ellipsoid - to_geodetic(*input.reference.position).height.above_ellipsoid;
    const Spacing spacing{apart.length().value(), height.value()};
    const std::optional<CarrierOffset> floating = filter_.update(all, spacing, input.time);
    if (!floating) return std::nullopt;
    std::optional<FixedOffset> fixed;
    if (input.may_fix) fixed = filter_.fix();
    const CarrierOffset& best = fixed ? *fixed : *floating;
    BaselineSolution solution;
    solution.position = input.place + Displacement<Ecef>(best.offset);
    solution.vector = solution.position - *input.reference.position;
    solution.covariance = best.covariance;
    solution.fixed = fixed.has_value();
    solution.ratio = fixed ? fixed->ratio : 0;
    solution.ambiguities = fixed ? fixed->ambiguities : 0;
    std::set<SatelliteId> satellites;
    for (const SingleDifference& d : all)
        satellites.insert(d.satellite);
    solution.satellites = static_cast<int>(satellites.size());
    solution.age = difference(input.time, input.reference.epoch.time);
    return solution;
}

void BaselineSolver::reset() {
    filter_.reset();
    counted_.clear();
    own_.clear();
    station_.reset();
}

}  // namespace skyloop::inline receiver
