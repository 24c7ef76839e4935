/// What rough walls scatter beside their specular reflections.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "base/core/units.hpp"
#include "world/scene/path_finder.hpp"

namespace skyloop::inline world {

/// How walls scatter.
struct WallScatteringSettings {
    /// S: amplitude of what a piece of wall scatters in all, over what falls on it; 0: none. Degli-Esposti, Fuschini,
    /// Vitucci and Falciasecca 2007 (IEEE TAP 55(1)) measured 0.4 to 0.6 on buildings; by the upper end errors at rest
    /// in streets of Munich beat at half of the places.
    double coefficient = 0.6;
    Seconds averaging{0.5};  ///< over which receivers average what beats
    std::uint64_t seed = 1;
};

/// One group of scattered rays of about the same delay.
struct ScatteredGroup {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< unit, where most of it comes from
    double excess = 0;                               ///< over the direct line, m, mean by power
    std::complex<double> amplitude;                  ///< over the direct ray's; its phase beside what the excess does
};

/// The façades around an antenna as pieces of the same solid angle, each with a random amplitude and phase of its own
/// that stay with the place on the wall (0.25 m): Lambertian scattering, |E|² = S² cos θ/π dΩ of what falls in at θ
/// from the wall's normal (Degli-Esposti et al. 2007, equation 8), half of it in the wrong hand of polarisation. At
/// rest their sum beats as satellites move; in motion what turns faster than the receiver averages is lost.
///
/// State: what is seen from the antenna at this epoch.
class WallScattering {
public:
    static constexpr std::size_t group_count = 3;
    WallScattering(const UrbanScene& scene, const WallScatteringSettings& settings);
    [[nodiscard]] bool acts() const { return settings_.coefficient > 0; }
    void look_around(const SceneObserver& observer);
    /// What the place of a specular reflection takes of it: frames and balconies as a normal field over the façade, of
    /// σ 5 dB and 1/e after 0.6 m, whose lower half, windows, takes nothing. Ours.
    [[nodiscard]] Decibels unevenness(const Eigen::Vector3d& place) const;
    /// Groups by excess: below 15 m, below 60 m, beyond. A piece that the satellite does not shine on gives nothing.
    [[nodiscard]] std::array<ScatteredGroup, group_count> of(const SceneSatellite& satellite, Hertz carrier) const;

private:
    struct Piece {
        Eigen::Vector3d place, from, normal;
        double distance = 0;
        std::complex<double> roughness;  // of mean power 1
    };
    const UrbanScene& scene_;
    WallScatteringSettings settings_;
    SceneObserver observer_;
    std::vector<Piece> pieces_;
};

}  // namespace skyloop::inline world
