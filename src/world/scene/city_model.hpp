/// A city before rays can be traced in it: triangles, what they are made of, and trees.
/// Wide outlines in pieces, each small against the curve of the Earth and the slope of the ground.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"

namespace skyloop::inline world {

/// What a surface is for: walls reflect in every profile, roofs and ground where a profile says so.
enum class SurfaceKind : std::uint8_t { wall, roof, ground };

inline constexpr std::array surface_kind_names{"wall", "roof", "ground"};

/// One facet; corners are indices of CityModel::vertices. Either side of it reflects and blocks.
struct CityTriangle {
    std::array<std::uint32_t, 3> corners{};
    SurfaceKind kind = SurfaceKind::wall;
    std::uint8_t material = 0;  ///< index of CityModel::materials
};

/// Crowns of trees: what is inside an upright prism.
struct FoliageVolume {
    std::vector<Eigen::Vector2d> ring;  ///< east, north, m; not closed, either sense
    double base = 0, top = 0;           ///< up, m
    /// Up, m: where the ground was taken to be from which base and top count; absent where the file told all heights.
    std::optional<double> ground{};
};

/// Where crowns begin of trees that stand on `ground`, m: trunks, a quarter of the height, let signals through.
inline double crown_base(double ground, double top) { return ground + (top - ground) / 4; }

/// A building whose heights count from the ground, wherever that is: vertices in a row.
struct GroundedBuilding {
    std::uint32_t first = 0, count = 0;  ///< of CityModel::vertices; no other building has them
    double ground = 0;                   ///< up, m: where the ground was taken to be
};

/// Everything that stands around: coordinates are metres east, north and up in the LocalFrame at `origin`.
struct CityModel {
    Geodetic origin;
    std::vector<Eigen::Vector3d> vertices;
    std::vector<CityTriangle> triangles;
    /// Names of surface_material(); the first is what triangles are made of that no file tells more of.
    std::vector<std::string> materials{"concrete"};
    std::vector<FoliageVolume> foliage;
    std::vector<GroundedBuilding> grounded;  ///< those of files that tell no height of their ground

    /// The index of a material, added when it is new; 0 when there are 256 already.
    std::uint8_t material_index(std::string_view name);
    /// Adds a triangle with corners of its own.
    void add_triangle(const std::array<Eigen::Vector3d, 3>& corners, SurfaceKind kind, std::uint8_t material = 0);
    /// Adds a plane quadrilateral, corners in order around it.
    void add_quad(const std::array<Eigen::Vector3d, 4>& corners, SurfaceKind kind, std::uint8_t material = 0);
};

/// Twice the area of a ring, negative where it runs clockwise.
double doubled_area(const std::vector<Eigen::Vector2d>& ring);

/// Whether a place lies in a ring, by the even-odd rule.
bool inside_ring(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& place);

/// Halves a ring, its longer side first, until no piece is wider than `width`, m, or than 1/256 of the whole. Pieces
/// share borders and together cover what the ring covers by the even-odd rule; where that is in several parts, a piece
/// joins them by edges that are run through twice. Pieces without area are left out, and rings with a corner that is no
/// number.
std::vector<std::vector<Eigen::Vector2d>> ring_pieces(std::vector<Eigen::Vector2d> ring, double width);

}  // namespace skyloop::inline world
