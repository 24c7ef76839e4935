/// The sky above a place as a polar picture: north up, the zenith in the middle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/analysis/sky_listing.hpp"
#include "world/gnss/dop.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline study {

/// One satellite of the picture.
struct SkyPlotSatellite {
    SatelliteId id;
    Angle azimuth;
    Angle elevation;
    std::optional<DbHz> cn0;               ///< the size of the mark: the smallest where others alone have one
    bool used = true;                      ///< a full mark, else a hollow one
    bool healthy = true;                   ///< else grey and crossed out
    std::optional<Reception> reception{};  ///< in a city: decides the colour
    std::vector<SkyDirection> trail;       ///< where it has been, oldest first; drawn as a thin line
};

/// Everything that the picture says.
struct SkyPlot {
    Geodetic place;
    GpsTime time;
    std::optional<Angle> mask;  ///< a dashed circle
    std::optional<Dop> dop;
    std::vector<SkyPlotSatellite> satellites;
    std::string title;  ///< empty: the place, which else stands below it where there are buildings alone
    std::optional<SkyMask> obstruction{};  ///< what buildings hide, filled
};

/// The picture of a listing, without trails.
SkyPlot sky_plot(const SkyListing& listing);

/// Size of the picture, pixels, and of the sky in it.
inline constexpr double sky_plot_width = 640;
inline constexpr double sky_plot_height = 736;
inline constexpr double sky_plot_centre_x = 320;
inline constexpr double sky_plot_centre_y = 358;
inline constexpr double sky_plot_radius = 248;

/// The picture as an SVG document. Satellites below the horizon are left out. In a city buildings stand around the
/// zenith as they block the sky, and the satellites' colours tell line of sight, reflected and blocked. Without any
/// satellite the buildings are all that it tells of.
std::string sky_plot_svg(const SkyPlot& plot);

}  // namespace skyloop::inline study
