#include "world/propagation/ionosphere_delay.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "world/gnss/thin_shell.hpp"
#include "world/propagation/free_space.hpp"

namespace skyloop {
namespace {

constexpr Nanoseconds ionosphere_spacing = std::chrono::seconds(60);
}  // namespace

IonosphereResidual::IonosphereResidual(const IonosphereParameters& parameters, const ErrorTerm& term,
                                       std::uint64_t seed)
    : parameters_(parameters),
      term_(term),
      seed_(seed),
      vertical_({1, parameters.common_time}, ionosphere_spacing, term.stream(seed, "ionosphere_residual.vertical")),
      north_({1, parameters.common_time}, ionosphere_spacing, term.stream(seed, "ionosphere_residual.north")),
      east_({1, parameters.common_time}, ionosphere_spacing, term.stream(seed, "ionosphere_residual.east")) {}

double IonosphereResidual::share(SatelliteId satellite, const SkyDirection& direction, const Geodetic& antenna,
                                 GpsTime time) {
    KnottedProcess& single = singles_.of(satellite, [this](SatelliteId id) {
        return KnottedProcess({1, parameters_.single_time}, ionosphere_spacing,
                              term_.stream(seed_, "ionosphere_residual." + to_string(id)));
    });
    const double away = gradient_arm(direction.elevation, antenna.height.above_ellipsoid);
    const double slope =
        north_.at(time) * std::cos(direction.azimuth.rad()) + east_.at(time) * std::sin(direction.azimuth.rad());
    return parameters_.common * vertical_.at(time) + parameters_.gradient * away * slope +
           parameters_.single * single.at(time);
}

IonosphereDelay::IonosphereDelay(std::unique_ptr<IonosphereTruth> model, const ModernPropagationParameters& parameters,
                                 const ResidualReach& residual, std::uint64_t seed)
    : model_(std::move(model)),
      residual_(parameters.ionosphere_model, parameters.ionosphere_residual, seed),
      reach_(residual),
      factor_(parameters.ionosphere.factor()),
      residual_factor_(parameters.ionosphere_residual.factor()) {}

void IonosphereDelay::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    if (factor_ == 0) return;
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        const SatelliteInView& satellite = sky.satellites[i];
        Arrival& arrival = arrivals.satellites[i];
        arrival.iono_delay = model_->delay(satellite, truth, first_carrier(arrival)) * factor_;
        const bool departs = satellite.id.constellation == Constellation::galileo ? reach_.galileo : reach_.others;
        if (residual_factor_ == 0 || !departs) continue;
        const SkyDirection direction{satellite.azimuth, satellite.elevation};
        const double share = residual_.share(satellite.id, direction, truth.geodetic, truth.time);
        // However the day departs from the model, electrons never speed the code up.
        arrival.iono_delay = arrival.iono_delay * std::max(1 + residual_factor_ * share, 0.0);
    }
}

}  // namespace skyloop
