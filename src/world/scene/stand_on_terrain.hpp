/// Buildings and woods whose heights count from the ground, on the ground of a terrain model.
#pragma once

#include <cstddef>

#include "world/scene/urban_scene.hpp"

namespace skyloop {

/// Moves them up or down: a building to the lowest ground below its corners, woods, in pieces of at most 60 m, to the
/// mean of theirs. Both are in one frame. @returns how many stand beyond the terrain and stay as they were
std::size_t stand_on_terrain(CityModel& city, const UrbanScene& terrain);

}  // namespace skyloop
