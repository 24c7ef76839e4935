/// Wide outlines in pieces, each small against the curve of the Earth and the slope of the ground.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace skyloop {

/// Halves a ring, its longer side first, until no piece is wider than `width`, m, or than 1/256 of the whole. Pieces
/// share borders and together cover what the ring covers by the even-odd rule; where that is in several parts, a piece
/// joins them by edges that are run through twice. Pieces without area are left out, and rings with a corner that is no
/// number.
std::vector<std::vector<Eigen::Vector2d>> ring_pieces(std::vector<Eigen::Vector2d> ring, double width);

}  // namespace skyloop
