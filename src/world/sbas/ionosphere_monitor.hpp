/// What monitor stations on the ground see of the ionosphere.
#pragma once

#include "base/core/result.hpp"
#include "world/gnss/sbas_grid.hpp"
#include "world/propagation/ionosphere_effects.hpp"
#include "world/propagation/modern_effects.hpp"

namespace skyloop::inline world {

/// The true vertical delays of GPS's L1 at the points of the grid: the run's model towards the zenith, times its
/// stochastic residual. That is a plane around each antenna; the grid has the plane around the place of the run. What
/// is smaller than the grid's squares, waves and each satellite's own share, is in the deviation.
///
/// State: the residual's processes, and that of the model.
class IonosphereMonitor {
public:
    /// Fails as modern_effects() does. @param place of the run
    static Result<IonosphereMonitor> create(const ModernPropagationParameters& parameters, const ModernContext& context,
                                            const Geodetic& place);

    struct Delay {
        Metres vertical;
        Metres deviation;  ///< 1 σ
    };
    /// Instants come in ascending order.
    Delay at(const SbasGridPoint& point, GpsTime time);

private:
    IonosphereMonitor(IonosphereTruth model, const ModernPropagationParameters& parameters,
                      const ModernContext& context, const Geodetic& place);
    [[nodiscard]] double residual(const SbasGridPoint& point, GpsTime time);

    IonosphereTruth model_;
    IonosphereResidual residual_;
    Geodetic place_;
    double factor_, residual_factor_;  // 0: none
    double single_;
    Metres waves_;  // 1 σ
};

}  // namespace skyloop::inline world
