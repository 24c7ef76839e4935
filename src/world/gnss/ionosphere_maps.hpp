/// Maps of the vertical electron content over the globe, and what lies between them.
#pragma once

#include <optional>
#include <vector>

#include "base/time/gps_time.hpp"
#include "world/gnss/thin_shell.hpp"

namespace skyloop {

/// Equally spaced values along a meridian or a parallel.
struct GridAxis {
    Angle first;
    Angle step;  ///< of either sign, not 0
    std::size_t count = 0;
};

/// The vertical electron content at one instant.
struct IonosphereMap {
    GpsTime time;
    /// TECU by latitude, then longitude; not a number where the map has no value.
    std::vector<double> content_tecu;
};

/// Maps on one grid, ascending in time (IONEX 1.0, Schaer, Gurtner and Feltens 1998).
struct IonosphereMaps {
    ThinShell shell;
    GridAxis latitude, longitude;
    std::vector<IonosphereMap> maps;
};

/// Vertical content of one map by bilinear interpolation. Beyond the last parallel, up to one step, its values hold; a
/// grid once around the globe closes on itself. Nothing where the grid does not reach or a value is missing.
std::optional<Tecu> map_content(const IonosphereMaps& maps, const IonosphereMap& map, const PiercePoint& where);

/// Vertical content of one map that is turned with the Sun, 360° a day, from its own instant to another, before or
/// after it. Nothing where map_content() has nothing.
std::optional<Tecu> turned_content(const IonosphereMaps& maps, const IonosphereMap& map, const PiercePoint& where,
                                   GpsTime time);

/// Vertical content between two maps: linear in time, each map turned with the Sun (IONEX 1.0, interpolation between
/// consecutive rotated maps). Nothing before the first map, after the last, or where a map has no
/// value.
std::optional<Tecu> vertical_content(const IonosphereMaps& maps, const PiercePoint& where, GpsTime time);

/// The same, but after the last map that one, turned with the Sun: for runs that outlast their maps.
std::optional<Tecu> held_content(const IonosphereMaps& maps, const PiercePoint& where, GpsTime time);

}  // namespace skyloop
