/// The true ionosphere, by one of several models.
/// The delay of the true ionosphere: a model, and how the day departs from it.
/// How restless the ionosphere is towards each satellite.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "base/core/result.hpp"
#include "base/time/knotted_process.hpp"
#include "base/time/utc_time.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"
#include "world/propagation/ionosphere_waves.hpp"
#include "world/propagation/modern_effects.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/per_satellite.hpp"
#include "world/propagation/propagation_effect.hpp"

namespace skyloop::inline world {

/// How much a model of the ionosphere delays the code of a satellite along its ray; instants come in ascending order.
using IonosphereTruth = std::function<Metres(const SatelliteInView&, const TruthState&, Hertz carrier)>;

/// The model that the parameters name: with the coefficients of the broadcast, or the parameters' own where the
/// broadcast has none. Over a thin shell (ionex, constant) a delay is mapped by single_layer_mapping(); above the shell
/// there is none. Past the last of its maps ionex holds that one, turned with the Sun. Fails as modern_effects() does.
Result<IonosphereTruth> make_ionosphere_truth(const IonosphereParameters& parameters, const ModernContext& context);

/// NeQuick-G, each month by its own tables. It takes a millisecond or so a ray: each satellite's is traced for the
/// whole half minutes of GPS time alone, from where satellite and antenna then are, and the electron content is linear
/// in between. The satellite is carried ahead of the epoch by its velocity and the Earth's attraction, to within a
/// metre. Fails when the folder lacks a table, naming the month.
Result<IonosphereTruth> make_nequick_truth(const EffectiveIonisation& ionisation, const ModernContext& context);

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
/// By the parameters' choice, and by what the receivers correct with.
ResidualReach residual_reach(const IonosphereParameters& parameters, const ModernContext& context);

/// Writes the ionospheric delay of each arrival at the carrier of its first signal: that of the model, the residual's
/// share of it, and what travels through the ionosphere, wherever the model has one. The residual's factor scales both.
class IonosphereDelay : public PropagationEffect {
public:
    /// @param model not empty  @param residual by the parameters' choice
    IonosphereDelay(IonosphereTruth model, const ModernPropagationParameters& parameters, const ResidualReach& residual,
                    std::uint64_t seed);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    IonosphereTruth model_;
    IonosphereResidual residual_;
    IonosphereWaves waves_;
    bool calm_ = false;  // no waves
    ResidualReach reach_;
    double factor_, residual_factor_;
};

/// S4 beyond which no loop's variance is defined is 1/√2 (MODELS.md 7.11); what is written stays below it.
inline constexpr double strongest_s4 = 0.7;

/// Modified dip latitude where the Earth's field is that of a dipole with its pole at 79.74° N, 71.78° W:
/// tan μ = I/√cos φ with tan I = 2 tan φ_m (Rawer 1963).
Angle dipole_modified_dip(const Geodetic& place);

/// What hour and place leave of the worst hour's scintillation, 0 … 1. @param hours UT
double evening_share(const ScintillationParameters& parameters, const Geodetic& place, double hours);

/// Writes S4 and the phase's deviation of each arrival, at its first signal. Both grow towards the horizon with the
/// slant through a shell at 350 km, S4 by its power 0.9 and the phase by its root, and fall with the carrier, by its
/// powers 1.5 and 1 (Priyadarshi 2015, on the weak-scatter theory of Rino 1979).
class ScintillationIndices : public PropagationEffect {
public:
    ScintillationIndices(const ScintillationParameters& parameters, const ErrorTerm& term, LeapSeconds leap_seconds);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    ScintillationParameters parameters_;
    double factor_;
    LeapSeconds leap_seconds_;
};

}  // namespace skyloop::inline world
