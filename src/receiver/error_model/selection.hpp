/// Which satellites a sensor model uses.
#pragma once

#include <optional>
#include <vector>

#include "world/flow/arrivals.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/sky_view.hpp"

namespace skyloop {

/// A satellite is used when it is healthy and passes all of these; every limit is inclusive (MODELS.md D-18, D-19).
struct SelectionRule {
    Angle elevation_mask = Angle::degrees(5);           ///< at or above
    bool hidden_too = false;                            ///< true: use a satellite even when no ray of it arrives
    std::optional<DbHz> snr_cutoff = std::nullopt;      ///< at or above; a satellite without C/N0 fails
    std::optional<int> max_reflections = std::nullopt;  ///< one that needs more is invisible
};

/// The satellites of `sky` as the receiver reports them, in its order. An invisible one has no C/N0.
/// @param arrivals one for each satellite of `sky`
std::vector<SatelliteStatus> select_satellites(const SkyView& sky, const Arrivals& arrivals, const SelectionRule& rule);

/// Directions of the used ones.
std::vector<SkyDirection> used_directions(const std::vector<SatelliteStatus>& satellites);

}  // namespace skyloop
