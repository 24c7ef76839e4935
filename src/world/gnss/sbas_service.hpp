/// Satellite-based augmentation: whose satellite a PRN is, and where its corrections serve.
#pragma once

#include <optional>

#include "base/geo/geodetic.hpp"

namespace skyloop::inline world {

/// In the order of UBX-NAV-SBAS, sys.
enum class SbasSystem { waas, egnos, msas, gagan };

/// ICAO SARPs, SBAS providers of 2024. @return nothing for another's
std::optional<SbasSystem> sbas_system(int prn);

/// Whether the ionosphere's grid of the system covers a place. Boxes around the service areas that the providers
/// publish: WAAS Performance Standard (2008) figure 3-1, EGNOS Open Service SDD 2.3 section 3.2, ICAO SBAS status
/// papers for MSAS and GAGAN; the edges are ours.
bool serves(SbasSystem system, const Geodetic& place);

}  // namespace skyloop::inline world
