/// Stretches of a ray that lie in crowns of trees.
#pragma once

#include <vector>

#include "world/scene/urban_scene.hpp"

namespace skyloop {

/// Gathered volume by volume. Woods overlap, where one is drawn within another or two files hold the same one: a metre
/// in several crowns is one metre.
class CrownStretches {
public:
    /// @param length metres of the ray that count
    CrownStretches(const SceneRay& ray, double length) : ray_(ray), length_(length) {}

    void add(const FoliageVolume& volume);
    /// Metres in any of the volumes, whatever their order to the last bit.
    [[nodiscard]] double metres();

private:
    struct Stretch {
        double begin, end;  ///< m along the ray
        auto operator<=>(const Stretch&) const = default;
    };
    const SceneRay& ray_;
    double length_;
    std::vector<Stretch> stretches_;
};

}  // namespace skyloop
