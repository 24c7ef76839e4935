/// What happens to the signals in the modern profile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geoid.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/precise_truth.hpp"
#include "world/gnss/shell_ionosphere.hpp"
#include "world/propagation/atmosphere_losses.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/named_ionosphere_maps.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/propagation_parameters.hpp"

namespace skyloop::inline world {

/// What the effects need to know of the run.
struct ModernContext {
    TimeSpan run{};                     ///< first and last instant of the run; of one without an end its first
    AtmosphereParameters atmosphere{};  ///< its clouds and its rain
    BroadcastIonosphere broadcast{};    ///< of the navigation data
    /// The model that the receiver corrects with, where it is one of these.
    std::optional<IonosphereModel> receiver_correction{};
    /// And Galileo's signals with, where it is another one.
    std::optional<IonosphereModel> galileo_correction{};
    std::optional<NamedIonosphereMaps> maps{};  ///< of kind `ionex`
    std::filesystem::path nequick_folder{};     ///< of kind `nequick_g`: share/skyloop/nequick_g
    /// Where the satellites are; null: where their records say, and nothing is as fine as what comes with it.
    std::shared_ptr<const PreciseTruth> precise{};
    std::optional<AntennaCalibration> receiver_antenna{};  ///< nothing: measured at its phase centre
    const Geoid* geoid = nullptr;  ///< must outlive the effects; without one heights stay ellipsoidal
    LeapSeconds leap_seconds = LeapSeconds::announced();
    std::uint64_t seed = 1;
    /// Of L1. Its rows take milliseconds each: receivers of one thread share them.
    std::shared_ptr<GasLossTable> gas_losses = std::make_shared<GasLossTable>();
};

/// The effects in the order of their application: signal in space, with precise products antennas, wind-up and tides,
/// ionosphere, troposphere, losses, scintillation,
/// link budget. Effects of the scene go before the last.
///
/// Fails when the ionosphere is to come from maps that are not there or that do not cover the run and the globe
/// (`input`, naming the file), or from NeQuick-G without the tables of a month.
Result<std::vector<std::unique_ptr<PropagationEffect>>> modern_effects(const ModernPropagationParameters& parameters,
                                                                       const ModernContext& context);

}  // namespace skyloop::inline world
