/// Satellite tracks around the Earth in the Earth-fixed frame, seen isometrically.
#pragma once

#include <span>
#include <string>

#include "study/plot/svg_document.hpp"
#include "world/sky/satellite_tracks.hpp"

namespace skyloop::inline study {

/// Where an Earth-fixed point lies in an isometric picture: the X, Y and Z axes are equally foreshortened, Z points up,
/// X to the lower left, Y to the lower right. Unit: that of the point.
struct IsometricPoint {
    double right = 0, up = 0;
    double towards_viewer = 0;
};
IsometricPoint isometric(const Position<Ecef>& point);

/// True for a point that the Earth (a sphere of the equatorial radius) hides from the viewer of that picture.
bool hidden_by_earth(const IsometricPoint& point);

inline constexpr double track_plot_width = 720;
inline constexpr double track_plot_height = 800;

/// The picture as an SVG document: every track as a line that ends in a labelled mark, the Earth with its graticule,
/// axes in megametres. What is behind the Earth is lighter. A gap in time of a track is a gap in its line.
std::string track_plot_svg(std::span<const SatelliteTrack> tracks, const std::string& title);

}  // namespace skyloop::inline study
