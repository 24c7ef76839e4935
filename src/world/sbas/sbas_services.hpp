/// What the SBAS satellites of a run send: corrections of its own errors.
#pragma once

#include <memory>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/sbas_message.hpp"
#include "world/propagation/modern_effects.hpp"

namespace skyloop::inline world {

/// Of what the errors are made, which the services measure.
struct SbasWorld {
    std::shared_ptr<const NavigationSource> navigation;
    const ModernPropagationParameters& parameters;
    const ModernContext& context;
    Geodetic place;  ///< of the run, where one station of a system that serves there stands
};

/// The systems of sbas_system() over GPS: each satellite sends the corrections of its system as they were four seconds
/// before the frame of six seconds that a message is in, and its own orbit. Satellites of other systems send their
/// orbit alone.
///
/// State: that of the systems' monitors. Two of the same run send the same.
/// @return null where the navigation data has no SBAS satellites
Result<std::unique_ptr<SbasSource>> sbas_services(const SbasWorld& world);

}  // namespace skyloop::inline world
