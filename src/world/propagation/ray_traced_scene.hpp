/// Buildings and trees between the satellites and the antenna.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "world/propagation/antenna_and_noise.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/wall_scattering.hpp"
#include "world/scene/path_finder.hpp"

namespace skyloop::inline world {

/// What walls do to the signals.
enum class SceneProfile {
    /// The article's rule (MODELS.md R-21…R-23): a satellite in line of sight has no multipath; one that is not comes
    /// over the path with the fewest reflections, among equals the shortest, and loses half of its power at each;
    /// without any it is hidden.
    baseline,
    /// Fresnel reflection by material, diffraction at edges, foliage, the antenna's pattern (MODELS.md 7.10). In sight
    /// the direct ray is tracked, else the strongest one, if it is above −40 dB; all others are echoes that the
    /// receiver's correlators sum up.
    modern,
};

/// What crowns of trees take from a ray: MODELS.md 7.5.
struct CrownLoss {
    double db_per_m = 0.8;  ///< at L1
    Decibels most{12};      ///< together with the crowns that stand around wherever the antenna is
    double factor = 1;      ///< of the error term; 0: trees do nothing
};

/// How a scene acts.
struct RayTracedSceneSettings {
    SceneProfile profile = SceneProfile::modern;
    PathSearchSettings search{};           ///< the profile decides whether paths of blocked satellites alone matter
    double epochs_per_second = 1;          ///< decides the number of rays where `search` does not
    AntennaPattern antenna{};              ///< modern
    Decibels opposite_hand_rejection{10};  ///< modern: of the antenna; 10 a patch, 20 a survey antenna
    Metres wall_roughness{0.01};           ///< modern: rms height
    bool diffraction = true;               ///< modern
    WallScatteringSettings scattering{};   ///< modern
    CrownLoss crowns{};                    ///< modern
};

/// Writes line_of_sight, paths, reflections, excess_path and reflection_loss, in the modern profile the echoes too, and
/// adds to foliage_loss. It comes after the other losses and before the link budget.
///
/// Materials that surface_material() does not know are taken for concrete. Strengths are those of the first carrier.
/// Rays that bend and are reflected as well are not followed. What walls scatter comes to what arrives otherwise; it
/// alone is not tracked.
///
/// State: the path finder's memory.
class RayTracedScene : public PropagationEffect {
public:
    RayTracedScene(std::shared_ptr<const UrbanScene> scene, const RayTracedSceneSettings& settings);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

    /// Of the last epoch, in the sky's order, in the scene's frame.
    [[nodiscard]] const std::vector<SatellitePaths>& paths() const { return paths_; }
    /// Where the antenna was then, m in the scene's frame; on a surface, just above it.
    [[nodiscard]] const Eigen::Vector3d& antenna() const { return observer_.position; }
    [[nodiscard]] const UrbanScene& scene() const { return finder_.scene(); }
    [[nodiscard]] const PathSearchCounters& counters() const { return finder_.counters(); }
    /// One sentence when nothing arrives since the antenna is inside a building or below the ground; nothing
    /// otherwise.
    [[nodiscard]] const std::optional<std::string>& notice() const { return notice_; }

private:
    PathFinder finder_;
    RayTracedSceneSettings settings_;
    SceneObserver observer_;
    WallScattering scattering_;
    std::vector<SatellitePaths> paths_;
    std::optional<std::string> notice_;
};

}  // namespace skyloop::inline world
