/// Obstacles that somebody else has found: a game engine that casts its own rays.
#pragma once

#include <map>
#include <memory>

#include "base/core/std_additions.hpp"
#include "world/propagation/propagation_effect.hpp"

namespace skyloop::inline world {

/// What is told of the way from one satellite to the antenna.
struct ToldPath {
    /// A reflection; `strength` is that over the direct ray without anything in its way, in general below 0 dB.
    struct Reflection {
        Metres excess;  ///< of its way over the direct one, not below 0
        Decibels strength;
    };
    static constexpr std::size_t most_reflections = 4;

    bool blocked = false;  ///< no direct ray arrives
    Decibels attenuation;  ///< of the direct ray, by leaves or glass
    InplaceVector<Reflection, most_reflections> reflections{};
};

/// What is told of all satellites of one antenna. Each statement holds until the next one of its satellite.
using ToldPaths = std::map<SatelliteId, ToldPath>;

/// Lets ToldPaths act as RayTracedScene does: writes line_of_sight, paths, reflections, excess_path, reflection_loss
/// and the echoes, and adds to foliage_loss. What is told replaces what a scene before it has found; satellites that
/// nothing is told of stay as they are. In sight the direct ray is tracked, else the strongest reflection; without any
/// the satellite is hidden. Reflections lag by half a turn, as at a hard surface, beside what their excess does, which
/// is taken to stay as long as the statement.
class ToldObstacles : public PropagationEffect {
public:
    /// @param told is read at each epoch, by the same thread that changes it
    explicit ToldObstacles(std::shared_ptr<const ToldPaths> told) : told_(std::move(told)) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    std::shared_ptr<const ToldPaths> told_;
};

}  // namespace skyloop::inline world
