#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/false_place.hpp"
#include "detail/fault_catalogue.hpp"
#include "detail/signal_selector.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/shell_ionosphere.hpp"

namespace skyloop::inline run {
namespace {

// What a satellite's clock is ahead of what it broadcasts: s, by the time since the start.
template <class Ahead>
Result<Fault> make_clock_fault(const Parameters& parameters, Ahead ahead) {
    auto chosen = ChosenSatellites::read(parameters);
    if (!chosen) return fail(chosen.error());
    return fault_of<&Fault::arrivals>([chosen = std::move(*chosen), ahead, rates = RateOfChange()](
                                          Arrivals& arrivals, const FaultMoment& moment) mutable {
        chosen.choose(arrivals);
        const Metres shorter(speed_of_light * ahead(moment.since_start.value()) * moment.strength);
        for (Arrival& arrival : arrivals.satellites) {
            if (!chosen.has(arrival.id)) continue;
            arrival.signal_in_space_error -= shorter;
            arrival.range_rate_error -= rates.of(arrival.id, shorter, moment.now);
        }
    });
}

Result<Fault> make_satellite_clock_step(const Parameters& parameters, const FaultContext&) {
    const double step = parameters.number("step_ns") * 1e-9;
    return make_clock_fault(parameters, [step](double) { return step; });
}

Result<Fault> make_satellite_clock_drift(const Parameters& parameters, const FaultContext&) {
    const double drift = parameters.number("drift_ns_per_s") * 1e-9;
    return make_clock_fault(parameters, [drift](double t) { return drift * t; });
}

// How far a record is off at full growth, along the satellite's way in space, across it and outwards, m.
struct OrbitError {
    double along = 0, cross = 0, radial = 0;
    [[nodiscard]] Eigen::Vector3d of(const SatelliteInView& satellite) const {
        const Eigen::Vector3d& place = satellite.position_at_transmission.vector();
        const Eigen::Vector3d turn = earth_rotation_rate * Eigen::Vector3d(-place.y(), place.x(), 0);
        const Eigen::Vector3d outwards = place.normalized();
        const Eigen::Vector3d motion = satellite.velocity_at_transmission.vector() + turn;
        const Eigen::Vector3d across = outwards.cross(motion).normalized();
        return turned_by(Eigen::Vector3d(along * across.cross(outwards) + cross * across + radial * outwards),
                         satellite.travel_time.value());
    }
};

// A receiver that computes the satellite in front of where it is computes another range: what is measured is short of
// it by the part of the error along the line of sight.
Result<Fault> make_wrong_ephemeris(const Parameters& parameters, const FaultContext&) {
    auto chosen = ChosenSatellites::read(parameters);
    if (!chosen) return fail(chosen.error());
    const OrbitError error{parameters.optional_number("along_track_m").value_or(0),
                           parameters.optional_number("cross_track_m").value_or(0),
                           parameters.optional_number("radial_m").value_or(0)};
    if (error.along == 0 && error.cross == 0 && error.radial == 0)
        return fail(ErrorCode::usage, "no error is told; expected along_track_m, cross_track_m or radial_m");
    const double growth = parameters.number("growth_s");
    return fault_of<&Fault::arrivals>([chosen = std::move(*chosen), error, growth, rates = RateOfChange()](
                                          Arrivals& arrivals, const FaultMoment& moment) mutable {
        if (!knows_the_sky(moment, arrivals)) return;
        chosen.choose(arrivals);
        const double grown = growth > 0 ? std::min(moment.since_start.value() / growth, 1.0) : 1;
        for (std::size_t i = 0; i < arrivals.satellites.size(); ++i) {
            Arrival& arrival = arrivals.satellites[i];
            if (!chosen.has(arrival.id)) continue;
            const SatelliteInView& satellite = moment.sky->satellites[i];
            const Eigen::Vector3d place =
                turned_by(satellite.position_at_transmission.vector(), satellite.travel_time.value());
            const Eigen::Vector3d line = (place - moment.truth->position.vector()).normalized();
            const Metres off(-grown * moment.strength * line.dot(error.of(satellite)));
            arrival.signal_in_space_error += off;
            arrival.range_rate_error += rates.of(arrival.id, off, moment.now);
        }
    });
}

Result<Fault> make_unhealthy(const Parameters& parameters, const FaultContext&) {
    return fault_of_selected(parameters, [](Arrival& arrival, const SignalSelector&, const FaultMoment&) {
        arrival.called_unhealthy = true;
    });
}

// Vertical delay at L1 beside what the day has: a plane, or a wedge with a plateau behind it, that may move.
struct StormFront {
    double factor = 1;
    double vertical = 0;
    double gradient = 0;             // m/km
    Angle towards;                   // into which the delay grows
    std::optional<Geodetic> foot{};  // where it begins to grow at the start; nothing: over the antenna
    std::optional<double> width{};   // km over which it grows
    double speed = 0;                // m/s, against `towards`: the high delays come on
    [[nodiscard]] bool passes() const { return foot || speed != 0; }
};

constexpr ThinShell storm_shell{Metres(6371000), Metres(350000)};

// How far the point lies beyond the great circle that is square to a direction at a place, as an angle at the centre.
double beyond(const Geodetic& place, Angle towards, const PiercePoint& point) {
    const double from = place.latitude.rad(), to = point.latitude.rad();
    const double east = (point.longitude - place.longitude).rad();
    const double eastwards = std::cos(to) * std::sin(east);
    const double northwards = std::cos(from) * std::sin(to) - std::sin(from) * std::cos(to) * std::cos(east);
    const double sine = std::sin(towards.rad()) * eastwards + std::cos(towards.rad()) * northwards;
    return std::asin(std::clamp(sine, -1.0, 1.0));
}

// Where the ray crosses the shell, km over the ground towards where the storm grows.
double way_into_storm(const StormFront& storm, const SkyDirection& direction, const FaultMoment& moment) {
    const double radius = storm_shell.earth_radius.value() / 1000;
    const SkyDirection above{direction.azimuth, std::max(direction.elevation, Angle())};
    const double come = storm.speed * moment.since_start.value() / 1000;
    if (storm.foot && moment.truth != nullptr)
        return come +
               radius * beyond(*storm.foot, storm.towards, pierce_point(storm_shell, moment.truth->geodetic, above));
    const double across = pierce_angle(storm_shell, above.elevation).rad();
    return come + radius * across * std::cos((direction.azimuth - storm.towards).rad());
}

void storm_over(Arrival& arrival, const StormFront& storm, const FaultMoment& moment, RateOfChange& rates) {
    double way = way_into_storm(storm, arrival.direction, moment);
    if (storm.width) way = std::clamp(way, 0.0, *storm.width);
    const double vertical = storm.vertical + storm.gradient * way;
    const double slant = single_layer_mapping(storm_shell, arrival.direction.elevation);
    const double carrier = arrival.signals.empty() ? carrier_frequency_l1 : arrival.signals[0].carrier.value();
    const double ratio = carrier_frequency_l1 / carrier;
    const double added = arrival.iono_delay.value() * (storm.factor - 1) + vertical * slant * ratio * ratio;
    const Metres before = arrival.iono_delay, wanted = before + Metres(moment.strength * added);
    // There is no less than no ionosphere.
    arrival.iono_delay = std::max(wanted, Metres(0));
    arrival.false_iono_delay += arrival.iono_delay - before;
    if (storm.passes())
        arrival.false_iono_rate += rates.of(arrival.id, arrival.iono_delay - before, moment.now);
    else if (wanted > Metres(0))
        arrival.false_iono_rate += MetresPerSecond(moment.strength_rate * added);
}

Result<StormFront> read_storm(const Parameters& parameters) {
    StormFront storm{parameters.number("tec_factor"), parameters.number("vertical_delay_m"),
                     parameters.number("gradient_mm_per_km") / 1000,
                     Angle::degrees(parameters.number("gradient_towards_deg"))};
    storm.width = parameters.optional_number("front_width_km");
    storm.speed = parameters.number("front_speed_mps");
    if (const std::vector<double> foot = parameters.numbers("front_at"); !foot.empty()) {
        const auto place = ToldPlace::read(parameters, "front_at");
        if (!place) return fail(place.error());
        storm.foot = Geodetic::degrees(foot[0], foot[1], 0);
    }
    if (storm.factor == 1 && storm.vertical == 0 && storm.gradient == 0)
        return fail(ErrorCode::usage, "no storm is told; expected tec_factor, vertical_delay_m or gradient_mm_per_km");
    if (storm.gradient == 0 && (storm.foot || storm.width || storm.speed != 0))
        return fail(ErrorCode::usage, "a front without gradient_mm_per_km; expected one above 0");
    return storm;
}

Result<Fault> make_ionospheric_storm(const Parameters& parameters, const FaultContext&) {
    const auto storm = read_storm(parameters);
    if (!storm) return fail(storm.error());
    return fault_of<&Fault::arrivals>(
        [storm = *storm, rates = RateOfChange()](Arrivals& arrivals, const FaultMoment& moment) mutable {
            for (Arrival& arrival : arrivals.satellites)
                storm_over(arrival, storm, moment, rates);
        });
}

Result<Fault> make_scintillation(const Parameters& parameters, const FaultContext&) {
    const double s4 = parameters.number("s4"), phase = parameters.number("sigma_phi_rad");
    return fault_of_selected(parameters, [=](Arrival& arrival, const SignalSelector&, const FaultMoment& moment) {
        arrival.amplitude_scintillation = std::max(arrival.amplitude_scintillation, s4 * moment.strength);
        arrival.phase_scintillation = std::max(arrival.phase_scintillation, Angle::radians(phase * moment.strength));
    });
}

constexpr auto satellite_kinds = std::to_array<FaultKind>({
    {"satellite_clock_step",
     "The clock of a satellite jumps and its record does not tell: its range is off by the step, and the "
     "carrier's count breaks.",
     "A failing or exchanged atomic clock on board.",
     ParameterList{needed_number("step_ns", -1e9, 1e9, "ns by which the clock jumps ahead; 1 ns is 0.3 m")} +
         chosen_satellites,
     make_satellite_clock_step, of_measurements},
    {"satellite_clock_drift", "The clock of a satellite runs away from its record: its range error grows.",
     "A dying atomic clock, as that of GPS satellite SVN 23 on 2004-01-01, which led to hundreds of "
     "kilometres of range error.",
     ParameterList{needed_number("drift_ns_per_s", -1e6, 1e6, "ns that the clock gains each second")} +
         chosen_satellites,
     make_satellite_clock_drift, of_measurements},
    {"wrong_ephemeris",
     "The record that a satellite broadcasts puts it elsewhere: its range is off by what of that lies "
     "along the line of sight.",
     "A bad upload, as to all of GLONASS on 2014-04-01, or a manoeuvre of a satellite that is still set "
     "healthy.",
     ParameterList{number_parameter("along_track_m", no_standard, -1e6, 1e6, "m along the satellite's way"),
                   number_parameter("cross_track_m", no_standard, -1e6, 1e6, "m across it, along its angular momentum"),
                   number_parameter("radial_m", no_standard, -1e6, 1e6, "m away from the Earth"),
                   number_parameter("growth_s", 0, 0, 1e6, "s over which the error grows from nothing")} +
         chosen_satellites,
     make_wrong_ephemeris, of_measurements},
    {"unhealthy", "Satellites send that they are not to be used; they are tracked and not used.",
     "Maintenance, or a failure that the ground has seen: eight GLONASS satellites at once on 2014-04-14.",
     satellite_selector, make_unhealthy, !of_measurements, !with_strength},
    {"ionospheric_storm",
     "The ionosphere delays more than the receiver's broadcast correction knows: positions are off by "
     "metres, heights most. On a ramp Doppler follows; without one all counts of cycles break.",
     "Geomagnetic storms, as those of October 2003 and May 2024.",
     {number_parameter("tec_factor", 1, 0, 20, "by which the day's electron content is multiplied"),
      number_parameter("vertical_delay_m", 0, -50, 200, "m at L1 that are added overhead"),
      number_parameter("gradient_mm_per_km", 0, 0, 1000, "mm at L1 by which that grows with each km over the ground"),
      number_parameter("gradient_towards_deg", 0, -360, 360, "degrees from north, where it grows to"),
      place_parameter(
          "front_at",
          "where it begins to grow at the start, one front for all receivers; not given: over each antenna"),
      number_parameter("front_width_km", no_standard, 1, 10000,
                       "km over which it grows, with as much as there behind it; not given: on and on"),
      number_parameter("front_speed_mps", 0, -2000, 2000,
                       "m/s by which the front comes on, against the direction where it grows to")},
     make_ionospheric_storm},
    {"scintillation",
     "Amplitude and phase of the selected signals flicker: C/N0 fades, ranges get noisy, cycles slip, and from "
     "S4 of 0.71 on phases are lost.",
     "Bubbles in the equatorial ionosphere after sunset, aurora.",
     ParameterList{number_parameter("s4", 0.6, 0, 1, "amplitude index at the first carrier"),
                   number_parameter("sigma_phi_rad", 0.3, 0, 3, "rad, 1 σ of the phase at the first carrier")} +
         satellite_selector,
     make_scintillation, of_measurements},
});

}  // namespace

std::vector<FaultKind> satellite_fault_kinds() {
    return all_kinds_of(FaultLayer::signals, {satellite_kinds, range_fault_kinds()});
}

}  // namespace skyloop::inline run
