#include "world/propagation/ionosphere_waves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "world/gnss/shell_ionosphere.hpp"

namespace skyloop::inline world {
namespace {

constexpr ThinShell wave_shell{};
constexpr double share_of_trains = 0.5,
                 share_of_irregularities = 0.8660254037844386;  // of σ; their squares add up to 1
constexpr double shortest_wave_m = 120e3, longest_wave_m = 250e3;
constexpr double farthest_from_pole = 30 * std::numbers::pi / 180;
constexpr NoiseOctave amplitude_octave[] = {{Metres(300e3), 1}};
// Fitted to the power 1.89 of the distance from 3 to 150 km, within 7 %.
constexpr NoiseOctave irregularity_octaves[] = {{Metres(15e3), 0.0335}, {Metres(240e3), 0.99944}};

// The northern one.
Eigen::Vector3d source_of(std::uint64_t key) {
    const double off = farthest_from_pole * uniform_of_bits(key);
    const double longitude = 2 * std::numbers::pi * uniform_of_bits(spread_bits(key));
    return {std::sin(off) * std::cos(longitude), std::sin(off) * std::sin(longitude), std::cos(off)};
}

}  // namespace

IonosphereWaves::Train IonosphereWaves::train(std::uint64_t key, MetresPerSecond speed) {
    return {shortest_wave_m + (longest_wave_m - shortest_wave_m) * uniform_of_bits(key),
            uniform_of_bits(spread_bits(key + 1)), DriftingField(spread_bits(key + 2), amplitude_octave, speed)};
}

IonosphereWaves::IonosphereWaves(const IonosphereWaveParameters& parameters, std::uint64_t key)
    : parameters_(parameters),
      source_(source_of(spread_bits(key))),
      irregularities_(spread_bits(key + 1), irregularity_octaves, parameters.speed),
      trains_{train(spread_bits(key + 2), parameters.speed), train(spread_bits(key + 3), parameters.speed)} {}

Tecu IonosphereWaves::vertical(const SatelliteInView& satellite, const TruthState& truth) {
    const Metres radius = wave_shell.earth_radius + wave_shell.height;
    const Eigen::Vector3d place = sphere_crossing(truth, satellite, radius);
    Memory& memory = memories_.of(satellite.id, [](SatelliteId) { return Memory{}; });
    const double cosine = std::clamp(source_.dot(place) / radius.value(), -1.0, 1.0);
    const double from_north = std::acos(cosine);
    const double run = parameters_.speed.value() * to_seconds(truth.time.time_since_epoch()).value();
    double waves = 0;
    for (std::size_t i = 0; i < trains_.size(); ++i) {
        const Train& train = trains_[i];
        const double away = i == 0 ? from_north : std::numbers::pi - from_north;
        const double fade = (1 + (i == 0 ? cosine : -cosine)) / 2;
        const double turns = (radius.value() * away - run) / train.length + train.phase;
        waves += std::sqrt(2 * std::max(fade, 0.0)) * std::cos(2 * std::numbers::pi * (turns - std::round(turns))) *
                 train.amplitude.at(place, truth.time, memory.amplitudes[i]);
    }
    const double rest = irregularities_.at(place, truth.time, memory.irregularities);
    return parameters_.content * (share_of_trains * waves + share_of_irregularities * rest);
}

Tecu IonosphereWaves::slant(const SatelliteInView& satellite, const TruthState& truth) {
    return vertical(satellite, truth) *
           single_layer_mapping(wave_shell, satellite.elevation, truth.geodetic.height.above_ellipsoid);
}

}  // namespace skyloop::inline world
