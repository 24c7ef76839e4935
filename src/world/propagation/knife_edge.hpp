/// Waves that bend around edges.
#pragma once

#include "base/core/units.hpp"

namespace skyloop {

/// Below this a wave passes clear of the edge.
constexpr double knife_edge_clear = -0.78;

/// Fresnel parameter of an edge against a source that is very far: θ √(2d ∕ λ) (MODELS.md 7.10).
/// @param detour angle between the source and the edge; below 0 when the source is in sight
/// @param distance of the edge
double knife_edge_parameter(Angle detour, Metres distance, Hertz carrier);

/// How far away an edge is of which a wave passes just clear at an angle: λ ∕ 2 (0.78 ∕ θ)². One that is farther away
/// does not weaken it.
/// @param beside angle between the source, which is in sight, and the edge
Metres knife_edge_reach(Angle beside, Hertz carrier);

/// J(v) = 6.9 + 20 lg(√((v − 0.1)² + 1) + v − 0.1), 0 below −0.78 (ITU-R P.526; MODELS.md 7.10).
Decibels knife_edge_loss(double v);

}  // namespace skyloop
