#include "world/sbas/ionosphere_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/geo/local_frame.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline world {
namespace {

// The share of each single satellite is not the grid's.
IonosphereParameters without_singles(IonosphereParameters parameters) {
    parameters.single = 0;
    return parameters;
}

// A satellite that stands still above a point; models keep what they have computed by its number, which no satellite of
// the sky has.
SatelliteInView above(const SbasGridPoint& point) {
    constexpr double height_m = 20.2e6;
    SatelliteInView satellite;
    satellite.id = {Constellation::gps, 100'000 + 1000 * (point.latitude + 90) + point.longitude + 180};
    satellite.elevation = Angle::degrees(90);
    satellite.position_at_transmission = to_ecef(Geodetic::degrees(point.latitude, point.longitude, height_m));
    return satellite;
}

// The direction in which an antenna has a point of the grid on its shell; below the horizon level.
SkyDirection towards(const Geodetic& place, const SbasGridPoint& point) {
    const Geodetic on_ground = Geodetic::degrees(point.latitude, point.longitude, 0);
    const double up_lat = on_ground.latitude.rad(), lat = place.latitude.rad();
    const double turn = on_ground.longitude.rad() - place.longitude.rad();
    const double north = std::cos(lat) * std::sin(up_lat) - std::sin(lat) * std::cos(up_lat) * std::cos(turn);
    const double east = std::cos(up_lat) * std::sin(turn);
    const double across = std::hypot(north, east);
    const double along = std::sin(lat) * std::sin(up_lat) + std::cos(lat) * std::cos(up_lat) * std::cos(turn);
    const double ratio = sbas_shell.earth_radius.value() / (sbas_shell.earth_radius + sbas_shell.height).value();
    const double elevation = std::atan2(along - ratio, across);
    return {Angle::radians(std::atan2(east, north)), Angle::radians(std::max(elevation, 0.0))};
}

}  // namespace

Result<IonosphereMonitor> IonosphereMonitor::create(const ModernPropagationParameters& parameters,
                                                    const ModernContext& context, const Geodetic& place) {
    auto model = make_ionosphere_truth(parameters.ionosphere_model, context);
    if (!model) return fail(model.error());
    return IonosphereMonitor(std::move(*model), parameters, context, place);
}

IonosphereMonitor::IonosphereMonitor(IonosphereTruth model, const ModernPropagationParameters& parameters,
                                     const ModernContext& context, const Geodetic& place)
    : model_(std::move(model)),
      residual_(without_singles(parameters.ionosphere_model), parameters.ionosphere_residual, context.seed),
      place_(place),
      factor_(parameters.ionosphere.factor()),
      residual_factor_(
          residual_reach(parameters.ionosphere_model, context).others ? parameters.ionosphere_residual.factor() : 0),
      single_(residual_factor_ * parameters.ionosphere_model.single),
      waves_(ionosphere_group_delay(parameters.ionosphere_model.waves.content, Hertz(carrier_frequency_l1)) *
             (factor_ * parameters.ionosphere_residual.factor())) {}

double IonosphereMonitor::residual(const SbasGridPoint& point, GpsTime time) {
    if (residual_factor_ == 0) return 0;
    const Geodetic ground{place_.latitude, place_.longitude, {}};
    return residual_factor_ * residual_.share({Constellation::gps, 0}, towards(ground, point), ground, time);
}

IonosphereMonitor::Delay IonosphereMonitor::at(const SbasGridPoint& point, GpsTime time) {
    if (factor_ == 0) return {};
    TruthState truth;
    truth.time = time;
    truth.geodetic = Geodetic::degrees(point.latitude, point.longitude, 0);
    truth.position = to_ecef(truth.geodetic);
    const Metres model = model_(above(point), truth, Hertz(carrier_frequency_l1)) * factor_;
    const Metres vertical = std::max(model * (1 + residual(point, time)), Metres(0));
    return {vertical, Metres(std::hypot(single_ * vertical.value(), waves_.value()))};
}

}  // namespace skyloop::inline world
