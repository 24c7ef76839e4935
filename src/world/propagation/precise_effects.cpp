#include "world/propagation/precise_effects.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/geo/local_frame.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/sun_and_moon.hpp"

namespace skyloop::inline world {
namespace {

// Of the satellite, in the frame of the instant of reception.
Position<Ecef> place_at_reception(const SatelliteInView& satellite) {
    return Position<Ecef>(turned_by(satellite.position_at_transmission.vector(), satellite.travel_time.value()));
}

Eigen::Vector3d direction_from(const TruthState& truth, const Position<Ecef>& satellite) {
    return (satellite - truth.position).vector().normalized();
}

Angle angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return Angle::radians(std::acos(std::clamp(a.dot(b), -1.0, 1.0)));
}

}  // namespace

void SatelliteAntennaPhase::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    const double factor = term_.factor();
    if (factor == 0) return;
    const Position<Ecef> sun = sun_position(truth.time);
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        if (!satellite.record_error) return;
        const AntennaCalibration* const antenna = catalogue_->satellites.of(satellite.id, truth.time);
        if (antenna == nullptr) return;
        const Position<Ecef> place = place_at_reception(satellite);
        const SatelliteAxes axes = yaw_steering(place, sun);
        const Eigen::Vector3d sight = direction_from(truth, place);
        const Angle nadir = angle_between(axes.z, -sight);
        for (SignalArrival& signal : arrival.signals) {
            const PhaseCentre* const centre = antenna->at(satellite.id.constellation, signal.signal);
            if (centre == nullptr) continue;
            const Eigen::Vector3d& o = centre->offset;
            const Eigen::Vector3d offset = axes.x * o.x() + axes.y * o.y() + axes.z * o.z();
            signal.satellite_antenna = factor * (Metres(offset.dot(sight)) + centre->variation(nadir));
        }
    });
}

void ReceiverAntennaPhase::apply(Arrivals& arrivals, const SkyView& sky, const TruthState&) {
    const double factor = term_.factor();
    if (factor == 0) return;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const double e = satellite.elevation.rad(), a = satellite.azimuth.rad();
        const Eigen::Vector3d north_east_up(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
        const Angle zenith = Angle::degrees(90) - satellite.elevation;
        for (SignalArrival& signal : arrival.signals)
            if (const PhaseCentre* const centre = antenna_.at(satellite.id.constellation, signal.signal))
                signal.receiver_antenna = factor * (Metres(-centre->offset.dot(north_east_up)) +
                                                    centre->variation(zenith, satellite.azimuth));
    });
}

double wind_up_cycles(const Position<Ecef>& satellite, const Position<Ecef>& antenna, const Geodetic& place,
                      const Position<Ecef>& sun) {
    const SatelliteAxes axes = yaw_steering(satellite, sun);
    const LocalFrame local(place);
    const Eigen::Vector3d north = local.to_ecef(Displacement<Enu>(0, 1, 0)).vector();
    const Eigen::Vector3d west = local.to_ecef(Displacement<Enu>(-1, 0, 0)).vector();
    const Eigen::Vector3d ray = (antenna - satellite).vector().normalized();
    const Eigen::Vector3d sent = axes.x - ray * ray.dot(axes.x) - ray.cross(axes.y);
    const Eigen::Vector3d heard = north - ray * ray.dot(north) + ray.cross(west);
    const double cosine = std::clamp(sent.dot(heard) / (sent.norm() * heard.norm()), -1.0, 1.0);
    return std::copysign(std::acos(cosine) / (2 * std::numbers::pi), ray.dot(sent.cross(heard)));
}

void CarrierWindUp::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    const double factor = term_.factor();
    if (factor == 0) return;
    const Position<Ecef> sun = sun_position(truth.time);
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        std::optional<double>& last = cycles_.of(satellite.id, [](SatelliteId) { return std::optional<double>(); });
        const double within = wind_up_cycles(place_at_reception(satellite), truth.position, truth.geodetic, sun);
        last = last ? within + std::round(*last - within) : within;
        arrival.wind_up = factor * *last;
    });
}

namespace {

struct TideRaiser {
    Position<Ecef> position;
    double mass;  // over that of the Earth
};

// The part of one of them, by the Love numbers of degrees 2 and 3.
Eigen::Vector3d tide_of(const TideRaiser& raiser, const Eigen::Vector3d& up, double sine_of_latitude) {
    constexpr double earth_radius = 6378136.6;
    const double away = raiser.position.vector().norm();
    const Eigen::Vector3d towards = raiser.position.vector() / away;
    const double c = towards.dot(up);
    const double square = sine_of_latitude * sine_of_latitude;
    const double h2 = 0.6078 - 0.0006 * (3 * square - 1) / 2, l2 = 0.0847 + 0.0002 * (3 * square - 1) / 2;
    constexpr double h3 = 0.292, l3 = 0.015;
    const double ratio = earth_radius / away;
    const double second = raiser.mass * earth_radius * ratio * ratio * ratio, third = second * ratio;
    const Eigen::Vector3d level = towards - c * up;
    return second * (h2 * (3 * c * c - 1) / 2 * up + 3 * l2 * c * level) +
           third * (h3 * (5 * c * c * c - 3 * c) / 2 * up + l3 * (15 * c * c - 3) / 2 * level);
}

}  // namespace

TideRaisers TideRaisers::at(GpsTime time) {
    return {sun_position(time), moon_position(time), Angle::radians(world::sidereal_time(time))};
}

Displacement<Ecef> solid_tide(const Position<Ecef>& place, const TideRaisers& raisers) {
    const Eigen::Vector3d up = place.vector().normalized();
    const double sine = up.z(), cosine = std::hypot(up.x(), up.y());
    constexpr double sun_mass = 332946.0482, moon_mass = 0.0123000371;
    Eigen::Vector3d moved = tide_of({raisers.sun, sun_mass}, up, sine) + tide_of({raisers.moon, moon_mass}, up, sine);
    constexpr double k1_m = -0.025;
    moved += k1_m * sine * cosine * std::sin(raisers.sidereal_time.rad() + std::atan2(up.y(), up.x())) * up;
    return Displacement<Ecef>(moved);
}

void SolidTideEffect::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    const double factor = term_.factor();
    if (factor == 0) return;
    const Eigen::Vector3d moved = factor * solid_tide(truth.position, TideRaisers::at(truth.time)).vector();
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        arrival.solid_tide = Metres(-moved.dot(direction_from(truth, place_at_reception(satellite))));
    });
}

}  // namespace skyloop::inline world
