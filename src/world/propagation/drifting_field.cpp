#include "world/propagation/drifting_field.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace skyloop::inline world {

Eigen::Vector3d sphere_crossing(const TruthState& truth, const SatelliteInView& satellite, Metres radius) {
    const Eigen::Vector3d& antenna = truth.position.vector();
    const double outside = radius.value() * radius.value() - antenna.squaredNorm();
    if (outside < 0) return antenna.normalized() * radius.value();
    const Eigen::Vector3d ray = (satellite.position_at_transmission.vector() - antenna).normalized();
    const double upwards = antenna.dot(ray);
    return antenna + ray * (std::sqrt(upwards * upwards + outside) - upwards);
}

Eigen::Vector3d direction_of_bits(std::uint64_t bits) {
    const double z = 2 * uniform_of_bits(bits) - 1, turn = 2 * std::numbers::pi * uniform_of_bits(spread_bits(bits));
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(turn), across * std::sin(turn), z};
}

DriftingField::DriftingField(std::uint64_t key, std::span<const NoiseOctave> octaves, MetresPerSecond speed)
    : drift_(direction_of_bits(spread_bits(key)) * speed.value()) {
    for (const NoiseOctave& octave : octaves)
        octaves_.push_back({spread_bits(key + octaves_.size() + 1), 1 / octave.cell.value(), octave.deviation});
}

double DriftingField::at(const Eigen::Vector3d& place, GpsTime time, FieldMemory& memory) const {
    memory.resize(octaves_.size());
    const Eigen::Vector3d in_flow = place - drift_ * to_seconds(time.time_since_epoch()).value();
    double sum = 0;
    for (std::size_t i = 0; i < octaves_.size(); ++i) {
        const Octave& octave = octaves_[i];
        const Eigen::Vector3d cells = in_flow * octave.per_cell;
        sum += octave.deviation * memory[i].at(octave.key, {cells.x(), cells.y(), cells.z()});
    }
    return sum;
}

}  // namespace skyloop::inline world
