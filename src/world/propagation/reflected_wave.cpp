#include "world/propagation/reflected_wave.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "world/propagation/fresnel.hpp"
#include "world/scene/scene_path.hpp"

namespace skyloop {
namespace {

using Field = Eigen::Vector3cd;
constexpr std::complex<double> imaginary_unit{0, 1};

// The waves that an antenna pointing up hears best and least from direction d: (φ̂ ∓ jθ̂)/√2, turned so that they are
// continuous around the zenith.
struct CircularBasis {
    explicit CircularBasis(const Eigen::Vector3d& d) {
        const double azimuth = std::atan2(d.y(), d.x());
        const double across = std::hypot(d.x(), d.y());
        const Eigen::Vector3d down(d.z() * std::cos(azimuth), d.z() * std::sin(azimuth), -across);
        const Eigen::Vector3d around(-std::sin(azimuth), std::cos(azimuth), 0);
        const std::complex<double> turn = std::polar(std::sqrt(0.5), azimuth);
        right = (around.cast<std::complex<double>>() - imaginary_unit * down) * turn;
        left = (around.cast<std::complex<double>>() + imaginary_unit * down) * std::conj(turn);
    }
    Field right, left;
};

// Unit, in the plane of the surface and across the plane of incidence; any in it from straight ahead.
Eigen::Vector3d across_incidence(const Eigen::Vector3d& normal, const Eigen::Vector3d& towards) {
    const Eigen::Vector3d across = normal.cross(towards);
    return across.norm() > 1e-9 ? Eigen::Vector3d(across.normalized()) : normal.unitOrthogonal();
}

}  // namespace

CircularWave reflected_wave(std::span<const ReflectingSurface> surfaces, const Eigen::Vector3d& arrival, Hertz carrier,
                            Metres roughness) {
    std::vector<Eigen::Vector3d> towards{arrival};  // before each reflection, as seen from the antenna
    for (const ReflectingSurface& surface : surfaces)
        towards.push_back(mirrored(surface.normal, towards.back()));
    Field field = CircularBasis(towards.back()).right;
    for (std::size_t i = surfaces.size(); i-- > 0;) {
        const ReflectingSurface& surface = surfaces[i];
        const Eigen::Vector3d in = -towards[i + 1], out = -towards[i];
        const double cosine = std::min(std::abs(surface.normal.dot(in)), 1.0);
        const Angle incidence = Angle::radians(std::acos(cosine));
        const FresnelReflection wall = fresnel_reflection(surface.permittivity, incidence);
        const Eigen::Vector3d across = across_incidence(surface.normal, in);
        const std::complex<double> te = wall.te * across.cast<std::complex<double>>().dot(field);
        const std::complex<double> tm = wall.tm * across.cross(in).cast<std::complex<double>>().dot(field);
        field = (te * across + tm * across.cross(out)) * roughness_factor(roughness, incidence, carrier);
    }
    const CircularBasis antenna(arrival);
    return {antenna.right.dot(field), antenna.left.dot(field)};
}

std::complex<double> heard_by_right_hand(const CircularWave& wave, Decibels rejection) {
    const std::complex<double> left = wave.left * std::pow(10, -rejection.value() / 20);
    const double phase = std::arg(std::abs(wave.right) >= std::abs(left) ? wave.right : left);
    return std::polar(std::hypot(std::abs(wave.right), std::abs(left)), phase);
}

}  // namespace skyloop
