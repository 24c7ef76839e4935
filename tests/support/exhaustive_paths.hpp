/// All paths of few reflections, by trying.
#pragma once

#include "world/scene/path_finder.hpp"

namespace skyloop::test {

/// Every path up to a few reflections, slow and complete: what a PathFinder is measured against. They share
/// UrbanScene::first_hit and nothing else: here the satellite is mirrored, in long double, and no ray is guessed.
///
/// One and two reflections: all pairs of planes, each by image points. Three: all sequences of orientations that walls
/// have, for a launch direction depends, but for the finite distance of a satellite, on orientations alone; a path that
/// passes an edge within that, millimetres, can be missed. The time grows with planes² and orientations³.
///
/// @param settings the kinds that reflect, blocked_only and most_reflections, here 1 … 3: more are not sought
/// @returns one for each satellite, in their order
std::vector<SatellitePaths> exhaustive_paths(const UrbanScene& scene, const SceneObserver& observer,
                                             std::span<const SceneSatellite> satellites,
                                             const PathSearchSettings& settings);

}  // namespace skyloop::test
