/// Cities out of nothing: for the demonstration, for tests and for benchmarks.
#pragma once

#include <cstdint>
#include <vector>

#include "world/scene/city_model.hpp"

namespace skyloop::inline world {

/// Blocks of houses along a grid of streets 20 m wide, most of them a few degrees off the grid, low and high ones.
struct GeneratedCitySettings {
    std::size_t triangles = 10'000;  ///< about so many: to half a house of 10, or of some thousands with windows
    bool windows = false;            ///< recessed windows in every wall, a cell of 3 m each
    std::uint64_t seed = 1;
    double turned_blocks = 0.15;  ///< share of blocks that stand askew by up to 25°
    bool ground = true;
};

/// A city of blocks, and places on its streets.
struct GeneratedCity {
    CityModel city;
    std::vector<Eigen::Vector3d> street_places;  ///< 1.6 m above the ground, in its inner half
};

/// Deterministic: the same settings give the same bytes. The frame's origin lies in a crossing.
GeneratedCity generated_city(const GeneratedCitySettings& settings, const Geodetic& origin);

/// Two rows of houses along a street, in whose middle the frame's origin lies.
struct StreetCanyonSettings {
    double width = 20, length = 400;             ///< m between the walls, along the street
    double left_height = 40, right_height = 40;  ///< m, as seen along the azimuth; 0: no houses there
    double depth = 15;                           ///< of the houses, m
    double azimuth_deg = 0;                      ///< of the street, clockwise from north
    double gap_every = 0, gap_width = 0;         ///< side streets, m; 0: none; no gap at the origin
};
CityModel street_canyon(const StreetCanyonSettings& settings, const Geodetic& origin);

/// The small city that `--scene demo` names: about 2,000 triangles around `origin`, with a square, a canyon, a tower,
/// an arch of glass and a park.
CityModel demo_city(const Geodetic& origin);

}  // namespace skyloop::inline world
