/// The delay of the true ionosphere: a model, and how the day departs from it.
#pragma once

#include <cstdint>
#include <memory>

#include "world/propagation/effect.hpp"
#include "world/propagation/ionosphere_truth.hpp"
#include "world/propagation/knotted_process.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/per_satellite.hpp"

namespace skyloop {

/// What departs from a model of the ionosphere, as a share of its delay: s_v x_v + s_g ψ/9° (x_n cos A + x_e sin A) +
/// s_i x_i, with ψ the angle at the centre of the Earth to the pierce point (MODELS.md 7.2, whose 0.05 are
/// semicircles). Smooth processes.
///
/// State: the common processes and one for each satellite that has been in view.
class IonosphereResidual {
public:
    IonosphereResidual(const IonosphereParameters& parameters, const ErrorTerm& term, std::uint64_t seed);
    /// Of one satellite. @param antenna where it stands
    double share(SatelliteId satellite, const SkyDirection& direction, const Geodetic& antenna, GpsTime time);

private:
    IonosphereParameters parameters_;
    ErrorTerm term_;
    std::uint64_t seed_;
    KnottedProcess vertical_, north_, east_;
    PerSatellite<KnottedProcess> singles_;
};

/// Whose delays depart from the model. Galileo's receivers may correct with another one than the others.
struct ResidualReach {
    bool galileo = false;
    bool others = false;
};

/// Writes the ionospheric delay of each arrival at the carrier of its first signal: that of the model, and the
/// residual's share of it.
class IonosphereDelay : public PropagationEffect {
public:
    /// @param model not null  @param residual by the parameters' choice
    IonosphereDelay(std::unique_ptr<IonosphereTruth> model, const ModernPropagationParameters& parameters,
                    const ResidualReach& residual, std::uint64_t seed);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    std::unique_ptr<IonosphereTruth> model_;
    IonosphereResidual residual_;
    ResidualReach reach_;
    double factor_, residual_factor_;
};

}  // namespace skyloop
