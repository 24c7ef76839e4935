/// From the delays of satellites to the scale of the position error.
#pragma once

#include <span>
#include <vector>

#include "receiver/error_model/parameters.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/fix.hpp"

namespace skyloop {

/// User equivalent range error of one satellite: the fractions of its delays that are left uncorrected, and the whole
/// detour of a reflected path (MODELS.md 3.9 and D-09).
Metres user_equivalent_range_error(const Arrival& arrival, const BaselineParameters& parameters);

/// Spread over satellites: sample standard deviation (n − 1), or root mean square. 0 for fewer than two values or none.
Metres uere_spread(std::span<const Metres> errors, UereStatistic statistic);

/// The scale of an epoch's position error.
struct UereScale {
    Metres sigma_uere;
    Metres position_error;  ///< E = PDOP·σ_uere, three-dimensional
};
/// σ_uere over the used satellites of `fix`, and E with its PDOP (MODELS.md 3.9).
/// @param fix its satellites are those of `arrivals`, in the same order
UereScale uere_scale(const Fix& fix, const Arrivals& arrivals, const BaselineParameters& parameters);

}  // namespace skyloop
