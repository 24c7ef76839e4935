/// The grid on which SBAS tells the ionosphere, and the thin shell that it lies on.
#pragma once

#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "world/gnss/shell_ionosphere.hpp"

namespace skyloop::inline world {

/// The shell of the grid (DO-229, A.4.4.10.1).
inline constexpr ThinShell sbas_shell{Metres(6378136.3), Metres(350000)};

/// A point of the grid, degrees, −180 … 175 east.
struct SbasGridPoint {
    int latitude = 0, longitude = 0;
    auto operator<=>(const SbasGridPoint&) const = default;
};

inline constexpr int sbas_band_count = 11;
/// The points of a band in the order of its mask (DO-229, table A-14; ICAO Annex 10, table B-33): of bands 0 to 8,
/// forty degrees of longitude each, meridian after meridian from south to north; of 9 and 10, the caps from latitude 60
/// on, parallel after parallel.
const std::vector<SbasGridPoint>& sbas_band(int band);
/// Where a point of the bands 0 to 8 stands.
struct SbasMaskPlace {
    int band = 0;
    int number = 0;  ///< in its mask, from 1 on; 0: it is no point of the grid
};
SbasMaskPlace sbas_mask_place(const SbasGridPoint& point);

/// The square of the grid around a pierce point: its south-western corner, its size, and where in it, 0 … 1.
struct SbasCell {
    SbasGridPoint corner;
    int size = 5;  ///< degrees
    double east = 0, north = 0;
    /// Its corners from the north-eastern one on, counter-clockwise.
    [[nodiscard]] std::array<SbasGridPoint, 4> corners() const;
};
/// 5° up to latitude 55 and 10° up to 75 (DO-229, A.4.4.10.2, without the squares of 5° by 10° there, which need the
/// caps' bands). Nothing beyond.
std::optional<SbasCell> sbas_cell(const PiercePoint& where);

}  // namespace skyloop::inline world
