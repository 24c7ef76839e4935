/// Crowns of trees, found by where a ray passes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "world/scene/urban_scene.hpp"

namespace skyloop::inline world {

/// Boxes around boxes around volumes, immutable. A ray looks at the volumes whose boxes it passes alone.
class FoliageTree {
public:
    explicit FoliageTree(std::vector<FoliageVolume> volumes);

    [[nodiscard]] const std::vector<FoliageVolume>& volumes() const { return volumes_; }
    /// foliage_length() of all volumes, the same to the last bit.
    [[nodiscard]] double length(const SceneRay& ray, double reach) const;
    /// Corners of the box around all volumes that have an inside; `lowest` is above `highest` where there are none.
    [[nodiscard]] Eigen::Vector3d lowest() const { return root().lowest; }
    [[nodiscard]] Eigen::Vector3d highest() const { return root().highest; }

private:
    struct Box {
        Eigen::Vector3d lowest = Eigen::Vector3d::Constant(1e300), highest = Eigen::Vector3d::Constant(-1e300);
        void extend(const Box& other);
        [[nodiscard]] bool passed_by(const SceneRay& ray, double reach) const;
    };
    /// In the order of a walk down the tree: behind a node come those within it, up to `end`.
    struct Node {
        Box box;
        std::uint32_t end = 0;
        std::uint32_t first = 0, count = 0;  ///< in `order_`; none but at the tree's leaves
    };
    static Box box_around(const FoliageVolume& volume);
    void add_nodes(std::span<std::uint32_t> order, const std::vector<Box>& boxes);
    [[nodiscard]] Box root() const { return nodes_.empty() ? Box{} : nodes_.front().box; }

    std::vector<FoliageVolume> volumes_;
    std::vector<std::uint32_t> order_;  ///< indices of volumes
    std::vector<Node> nodes_;
};

}  // namespace skyloop::inline world
