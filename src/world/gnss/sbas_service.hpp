/// Satellite-based augmentation: whose satellite a PRN is, and where its corrections serve.
#pragma once

#include <optional>

#include "base/geo/geodetic.hpp"

namespace skyloop::inline world {

/// In the order of UBX-NAV-SBAS, sys.
enum class SbasSystem { waas, egnos, msas, gagan };

/// ICAO SARPs, SBAS providers of 2024. @return nothing for another's
std::optional<SbasSystem> sbas_system(int prn);

/// Where the corrections of a system serve, degrees.
struct SbasServiceArea {
    int south = 0, north = 0, west = 0, east = 0;
    [[nodiscard]] bool holds(const Geodetic& place) const;
};

/// Boxes around the service areas that the providers publish: WAAS Performance Standard (2008) figure 3-1, EGNOS Open
/// Service SDD 2.3 section 3.2, ICAO SBAS status papers for MSAS and GAGAN; the edges are ours.
SbasServiceArea sbas_service_area(SbasSystem system);

/// Whether a satellite says of itself that it is under test, by message 0: EGNOS's test platform (EGNOS Open Service
/// SDD 2.3, table of the space segment).
bool sbas_under_test(int prn);

}  // namespace skyloop::inline world
